// The half of an environment map in front of the viewer, as directions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "umbrick/scene/light_set.h"

namespace umbrick {

/// An environment map where latitude and longitude are continuous: sine of the latitude s in [-1, 1], longitude as
/// column x, of period the map's width. A circle of latitude is in front of the viewer's plane on one interval of x,
/// whose ends are known: nothing of the map is cut along pixels.
class Environment : public Light {
 public:
  /// @param toWorld  of the source's frame  @param viewer  towards the viewer, unit length, world
  /// @throw InvalidArgument  a pixel that is negative or not finite
  Environment(const EnvironmentLight& light, const glm::dmat3& toWorld, const glm::dvec3& viewer);

  /// Median cut (Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling"): the front half is cut where half of
  /// its power is on each side, and so are the halves, across where they are longest; a direction is the centre of
  /// power of its part and has the radiance of all of it. Parts are flat pieces of Lambert's equal-area map of the
  /// hemisphere, which cuts along its axes: `rotation` turns them. They consist of cells of about 0.7 degrees: a light
  /// smaller than that is one direction.
  std::vector<LightDirection> directions(int count, double rotation) const override;
  /// By inversion: latitude by the power of its circles, then longitude by the power of pixels along the circle.
  LightDirection sample(double u, double v) const override;

 private:
  struct Cell {
    glm::dvec3 light{0};   // radiance times solid angle
    glm::dvec3 moment{0};  // of power, with directions in the world
  };
  struct Interval {
    double begin, end;  // columns, end - begin <= width
  };

  double sineOf(int row) const;
  Interval front(double s) const;
  int imageRow(int row) const { return row / subRows_; }
  glm::dvec3 pixel(int row, int column) const;
  glm::dvec3 direction(double s, double x) const;
  double powerUpTo(int row, double x) const;
  double powerOfCircle(int row, double s) const;
  double column(int row, double power) const;
  void sumAlongRows();
  double solidAngleInFront() const;
  void addToBlocks(int row, double s, double height, std::vector<Cell>& blocks) const;
  std::vector<Cell> gatherCells() const;

  std::shared_ptr<const Image> image_;
  int width_, rows_, subRows_;     // rows are parts of the image's
  int subColumns_, blockColumns_;  // a column in parts for cells, and how many parts a cell takes
  double scale_;                   // of radiance, 1/(4 pi) included
  glm::dmat3 axes_;                // of the map: front, right, up, in the world
  glm::dvec3 viewer_, viewerInMap_;
  std::vector<double> sums_;      // width + 1 per image row: power of the pixels to the left
  std::vector<double> rowsUpTo_;  // power of rows 0 to i
};

}  // namespace umbrick
