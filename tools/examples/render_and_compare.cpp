// Loads a volume, renders it by rays on the CPU, and compares the picture with the reference:
//   render_and_compare VOLUME PICTURE.png
// SPDX-License-Identifier: Apache-2.0
#include <umbrick/image/image_difference.h>
#include <umbrick/image/png.h>
#include <umbrick/reference/reference.h>
#include <umbrick/render/render.h>

#include <cstdio>
#include <exception>

int main(int count, char** arguments) try {
  if (count != 3) {
    std::fprintf(stderr, "usage: render_and_compare VOLUME PICTURE.png\n");
    return 2;
  }
  umbrick::Scene scene;  // everything that a picture depends on; what is not said follows from the volume
  scene.volume.file = arguments[1];
  scene.technique = umbrick::Technique::rays;
  scene.camera.width = scene.camera.height = 256;
  const umbrick::Volume volume(scene.volume);

  umbrick::VolumeView view(volume, scene);  // bricks and a renderer, on the CPU
  const umbrick::Image picture = view.render().colour;
  umbrick::writePng(arguments[2], picture);

  const umbrick::ReferencePicture truth = umbrick::renderReference(volume.grid(), view.renderer().scene());
  const umbrick::ImageDifference difference = umbrick::differenceOf(picture, truth.colour);
  std::printf("%s: RMSE %.2g, largest error %.2g at pixel (%d, %d)\n", arguments[2], difference.rmse,
              difference.maxError, difference.maxPixel.x, difference.maxPixel.y);
  return difference.rmse < 0.01 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "render_and_compare: %s\n", error.what());
  return 1;
}
