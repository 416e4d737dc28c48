// How much of the light arrives: media, views and options for the tests of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "reference/reference_fixture.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {

inline const glm::dvec3 kWhite(1);

inline ReferenceOptions quadrature(int directions) {
  ReferenceOptions options;
  options.directions = directions;
  options.tolerance = 1e-5;
  return options;
}

inline ReferenceOptions monteCarlo(int samples) {
  ReferenceOptions options;
  options.integrator = Integrator::monteCarlo;
  options.samples = samples;
  options.seed = 5;
  return options;
}

inline double meanVisibility(const ReferencePicture& picture) {
  double visible = 0, alpha = 0;
  for (int y = 0; y < picture.colour.height; ++y)
    for (int x = 0; x < picture.colour.width; ++x) {
      visible += *picture.visibility.at(x, y);
      alpha += picture.colour.at(x, y)[3];
    }
  return visible / alpha;
}

// The floor is in layer z = 4 and thin enough to cast no shadow on itself. The opaque roof above it is in layers around
// z = 14, begins at x = 12 and ends at x = far. A cone of 85 degrees reaches 114 to the side.
inline constexpr double kFloorDepth = 1e-4;  // optical depth, straight through
inline ScalarGrid floorAndRoof(int far = 150) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0);
  // The value is 1e6 from x = 13 on, so that it passes 1 at x = 12.000001.
  grid->denseFill({openvdb::Coord(13, -far, 14), openvdb::Coord(far, far, 14)}, 1e6f);
  grid->denseFill({openvdb::Coord(0, -16, 4), openvdb::Coord(11, 16, 4)}, -1);
  return makeGrid(grid);
}
inline TransferFunction floorAndRoofTransfer() {
  // The floor's layer is a hat of width 2 and area 1.
  return TransferFunction({{-1, {kWhite, kFloorDepth}}, {0, {kWhite, 0}}, {1, {kWhite, 0}}, {1, {kWhite, 1e3}}});
}

inline ResolvedScene lookingDownAt(const TransferFunction& transfer, Model model, double x, double theta) {
  // One pixel of no extent is the ray through its centre.
  Camera camera = orthographicCamera({x, 0, 40}, {x, 0, 0}, 1, 1);
  camera.up = {0, 1, 0};
  ResolvedScene scene = plainScene(transfer, camera, 1);
  scene.model = model;
  scene.occlusion.aperture = theta;
  return scene;
}

}  // namespace umbrick
