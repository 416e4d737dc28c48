// SPDX-License-Identifier: Apache-2.0
#include "study_page/pictures.h"

#include <algorithm>

#include "umbrick/image/colour_map.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/image/png.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/error_measures.h"

namespace umbrick::tools {
namespace {

void writeWithThumbnail(const PageFolder& folder, const std::string& id, const Image& picture) {
  if (picture.height > kThumbnailHeight) writePng(folder.smallPicture(id), shrunk(picture, kThumbnailHeight));
  writePng(folder.picture(id), picture);
}

}  // namespace

double errorScale(Model model) { return !traitsOf(model).occlusion ? 0.05 : 0.5; }

std::string errorPictureId(const std::string& id) { return id + ".error"; }

void writePictures(const PageFolder& folder, const StudyPicture& picture, const glm::dvec3& ambient) {
  folder.create();
  Image opaque = picture.image;
  for (std::size_t i = 3; i < opaque.pixels.size(); i += 4) opaque.pixels[i] = 1;
  writeWithThumbnail(folder, picture.id, opaque);
  if (!picture.truth) return;
  const double scale = errorScale(picture.model) * std::max({ambient.r, ambient.g, ambient.b, 1e-12});
  const Image error = errorMap(colourOf(picture.image), colourOf(*picture.truth));
  writeWithThumbnail(folder, errorPictureId(picture.id), colourMapped(error, 0, scale));
}

Image shrunk(const Image& image, int height) {
  const int step = (image.height + height - 1) / height;
  if (step <= 1) return image;
  Image small(std::max(1, image.width / step), std::max(1, image.height / step), image.channels);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0;
        int count = 0;
        for (int j = y * step; j < std::min((y + 1) * step, image.height); ++j)
          for (int i = x * step; i < std::min((x + 1) * step, image.width); ++i, ++count) sum += image.at(i, j)[c];
        small.at(x, y)[c] = static_cast<float>(sum / count);
      }
  return small;
}

}  // namespace umbrick::tools
