// Turns an environment map, or the half of it in front of the viewer, into directions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "umbrick/scene/light_set.h"

namespace umbrick {

/// An environment map with continuous latitude and longitude: the sine of the latitude is s in [-1, 1], and the
/// longitude is a column x, whose period is the map's width. A circle of latitude is in front of the viewer's plane on
/// one interval of x, whose ends are known: the map is not cut along pixels.
class Environment : public Light {
 public:
  /// @param toWorld  converts the source's frame to the world  @param viewer  towards the viewer, unit length, world
  /// @param whole  all of the map lights, else the half in front of the viewer
  /// @throw InvalidArgument  a pixel is negative or not finite
  Environment(const EnvironmentLight& light, const glm::dmat3& toWorld, const glm::dvec3& viewer, bool whole);

  /// Returns directions by median cut (Debevec 2005, "A Median Cut Algorithm for Light Probe Sampling"): the front half
  /// is cut where half of its power is on each side, and so are the halves, across where they are longest. A direction
  /// is the centre of power of its part and has the radiance of all of it. Parts are flat pieces of Lambert's
  /// equal-area map of the hemisphere, which is cut along its axes; `rotation` turns these. Those of a whole map are
  /// pieces of the map in equal areas (longitude and sine of the latitude), which `rotation` shifts. Parts consist of
  /// cells of about 0.7 degrees: a light smaller than that is one direction.
  std::vector<LightDirection> directions(int count, double rotation) const override;
  /// Returns a direction by inversion: latitude by the power of its circles, then longitude by the power of pixels
  /// along the circle.
  LightDirection sample(double u, double v) const override;

 private:
  struct Cell {
    glm::dvec3 light{0};   // radiance times solid angle
    glm::dvec3 moment{0};  // power times direction, in the world
  };
  struct Interval {
    double begin, end;  // columns, end - begin <= width
  };

  double sineOf(int row) const;
  Interval front(double s) const;  // all of the circle, where all of the map lights
  std::vector<glm::dvec2> placesOf(const std::vector<Cell>& cells, double rotation) const;
  int imageRow(int row) const { return row / subRows_; }
  glm::dvec3 pixel(int row, int column) const;
  glm::dvec3 direction(double s, double x) const;
  double powerUpTo(int row, double x) const;
  double powerOfCircle(int row, double s) const;
  double column(int row, double power) const;
  void sumAlongRows();
  double solidAngleOfLight() const;
  void addToBlocks(int row, double s, double height, std::vector<Cell>& blocks) const;
  std::vector<Cell> gatherCells() const;

  std::shared_ptr<const Image> image_;
  int width_, rows_, subRows_;     // rows are parts of the image's rows
  int subColumns_, blockColumns_;  // parts of a column for cells, and how many of them a cell takes
  double scale_;                   // of radiance, the factor 1/(4 pi) included
  glm::dmat3 axes_;                // of the map: front, right, up; in the world
  glm::dvec3 viewer_, viewerInMap_;
  bool whole_;
  std::vector<double> sums_;      // power of the pixels to the left; width + 1 numbers per image row
  std::vector<double> rowsUpTo_;  // power of rows 0 to i
};

}  // namespace umbrick
