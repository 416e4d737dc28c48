// Pictures must not depend on where values lie, how far apart they lie, how far others lie from them, and how fine
// slices are.
// SPDX-License-Identifier: Apache-2.0
#include "shade/hard_case.h"

using namespace umbrick;

namespace {

// Returns blobs with values from `offset` to `offset` + `range`, and one voxel far from all others if asked for.
ScalarGrid blobGrid(double offset, double range, double background, bool outlier = false) {
  return makeFilled(
      glm::ivec3(24), glm::ivec3(0),
      [&](const glm::ivec3& i) {
        // The voxel is in a corner, where nothing lies in front of it or behind it.
        if (outlier && i == glm::ivec3(22, 1, 1)) return -9999.0;
        return offset + range * smallBlobs(i);
      },
      static_cast<float>(background));
}

// Returns a function that depends only on the place in the range, and is transparent where empty space is.
TransferFunction rampOf(double offset, double range) {
  return TransferFunction({{offset + 0.1 * range, {kAlbedo, 0}},
                           {offset + 0.4 * range, {kAlbedo, 0.05}},
                           {offset + 0.6 * range, {{0.3, 0.5, 0.9}, 0.5}},
                           {offset + range, {{0.9, 0.9, 0.9}, 1}}});
}

double errorOf(const GlContext& context, const ScalarGrid& grid, const ResolvedScene& scene) {
  return rmsDifference(renderGrid(context, grid, scene).colour, renderReference(grid, scene).colour);
}

}  // namespace

TEST_CASE("The error does not depend on offset, range, background and outliers", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ResolvedScene plain = plainScene(rampOf(0, 1), smallCameras()[1], 0.5);
  const double base = errorOf(*context, blobGrid(0, 1, 0), plain);
  CHECK(base < 2e-3);
  for (const double offset : {0.0, 290.0, 101325.0, 1e6})
    for (const double range : {1e-3, 1.0, 100.0, 1e6})
      for (const bool farBackground : {false, true})
        for (const bool outlier : {false, true}) {
          // Voxels are single precision: nobody can render what they cannot tell apart.
          if (range < offset * 0x1p-20) continue;
          INFO("offset " << offset << ", range " << range << ", background 0: " << farBackground << ", outlier "
                         << outlier);
          const double background = farBackground ? 0 : offset;
          if (farBackground && offset > 0 && offset < range) continue;  // then 0 is one of the values
          const ScalarGrid grid = blobGrid(offset, range, background, outlier);
          ResolvedScene scene = plain;
          scene.transfer = rampOf(offset, range);
          // The bound is twice the error of the plain case, and the error of voxels rounded to 24 bits, whose
          // steps an interpolation hits at other places: sigma_t has a slope of 2.25 over the range, along a ray
          // of some 20 units.
          const double steps = std::abs(offset) * 0x1p-24 / range;
          CHECK(errorOf(*context, grid, scene) < 2 * base + 2.25 * 20 * steps);
        }
}

// Labels are whole numbers, and at a step the function has the value of its second side.
TEST_CASE("Values exactly on a step belong to its upper side in every format", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) {
    return i.x < 4 || i.x > 15 || i.y < 4 || i.y > 15 || i.z < 4 || i.z > 15 ? 0.0 : i.x < 10 ? 2.0 : 3.0;
  });
  const TransferFunction labels({{2, {glm::dvec3(1, 0, 0), 0}},
                                 {2, {glm::dvec3(1, 0, 0), 0.1}},
                                 {3, {glm::dvec3(1, 0, 0), 0.1}},
                                 {3, {glm::dvec3(0, 1, 0), 0.4}}});
  // The view is along the faces, where rays through the middle of a label meet nothing but that label and empty space.
  ResolvedScene scene = plainScene(labels, orthographicCamera({9.5, 9.5, 60}, glm::dvec3(9.5), 20, 20), 0.5);
  scene.camera.up = {0, 1, 0};
  const Image exact = renderReference(grid, scene).colour;
  for (const std::string format : {"unorm8", "unorm16", "half", "float32"})
    for (const Quadrature quadrature : {Quadrature::preintegrated, Quadrature::midpoint}) {
      INFO(format << ", midpoint " << (quadrature == Quadrature::midpoint));
      scene.bricks.format = format;
      scene.sampling.quadrature = quadrature;
      const Image found = renderGrid(*context, grid, scene).colour;
      for (const int x : {6, 7, 12, 13})
        for (int channel = 0; channel < 4; ++channel) {
          INFO("pixel " << x << ", channel " << channel);
          // The midpoint rule meets a label up to half a slab too soon or too late at either end: an optical depth of
          // 0.05, and 0.2 in front of others.
          CHECK(found.at(x, 10)[channel] == Approx(exact.at(x, 10)[channel]).margin(0.04));
        }
      CHECK(found.at(6, 10)[1] < 1e-6);  // nothing of the label beyond the step is seen
    }
}

// A format that rounds voxels must not move a voxel across the step on which its value lies.
TEST_CASE("Values exactly on a step stay there in formats that round them", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  for (const float label : {0.1f, 0.3f, 0.7f, 0.9f}) {
    const ScalarGrid grid = makeFilled(glm::ivec3(20), glm::ivec3(0), [&](const glm::ivec3& i) {
      if (i == glm::ivec3(1)) return 1.0;
      return std::min({i.x, i.y, i.z}) > 4 && std::max({i.x, i.y, i.z}) < 15 ? static_cast<double>(label) : 0.0;
    });
    ResolvedScene scene = plainScene(TransferFunction({{label, {kAlbedo, 0}}, {label, {kAlbedo, 0.3}}}),
                                     orthographicCamera({40, 20, 60}, glm::dvec3(9.5), 20, 16), 0.5);
    scene.bricks.format = "float32";
    const Image exact = renderGrid(*context, grid, scene).colour;
    CHECK(largestAlpha(exact) > 0.9);
    for (const std::string format : {"unorm8", "unorm16", "half"}) {
      INFO(label << " in " << format);
      scene.bricks.format = format;
      // A slope from 0 to the label is rounded to so many codes: with 8 bits to 26 of them for 0.1, so that its end is
      // met up to 1/26 of a voxel sooner or later.
      CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exact) < (format == "unorm8" ? 0.03 : 5e-3));
    }
  }
}

// Fixed point holds nothing beyond the largest voxel, but a function may have a step there.
TEST_CASE("A step beyond all values is not met by the largest of them", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = makeFilled(glm::ivec3(20), glm::ivec3(0), [](const glm::ivec3& i) {
    return std::min({i.x, i.y, i.z}) > 4 && std::max({i.x, i.y, i.z}) < 15 ? 20.0 : 0.0;
  });
  const Medium thin{{0.2, 0.9, 0.4}, 0.1}, dense{kAlbedo, 5};
  ResolvedScene scene = plainScene(TransferFunction({{20, {{0.2, 0.9, 0.4}, 0}}, {20, thin}, {25, thin}, {25, dense}}),
                                   orthographicCamera({40, 20, 60}, glm::dvec3(9.5), 20, 16), 0.5);
  scene.bricks.format = "float32";
  const Image exact = renderGrid(*context, grid, scene).colour;
  for (const std::string format : {"unorm8", "unorm16", "half"}) {
    INFO(format);
    scene.bricks.format = format;
    CHECK(rmsDifference(renderGrid(*context, grid, scene).colour, exact) < 0.03);
  }
}

TEST_CASE("A quarter of a volume may be a marker of missing data", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const auto marked = [&](double offset) {
    return makeFilled(
        glm::ivec3(24), glm::ivec3(0),
        [&](const glm::ivec3& i) {
          return i.x < 7 ? offset - 9999 : offset + 0.1 * glm::dot(glm::dvec3(i), glm::dvec3(0.31, 0.17, 0.11));
        },
        static_cast<float>(offset - 9999));
  };
  const auto errorAt = [&](double offset) {
    const ResolvedScene scene = plainScene(
        TransferFunction({{offset + 0.8, {kAlbedo, 0}}, {offset + 0.9, {kAlbedo, 1}}, {offset + 1, {kAlbedo, 0}}}),
        smallCameras()[1], 0.25);
    return errorOf(*context, marked(offset), scene);
  };
  // Voxels near 1e6 are multiples of 1/16: the field is the same as the other one, except for what
  // single precision rounds.
  CHECK(errorAt(1e6) < 2 * errorAt(0) + 2e-3);
}

TEST_CASE("A peak of any width keeps its optical depth, however fine the slices", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid(0, 1, 0);
  for (const double halfWidth : {1e-2, 1e-3, 1e-5}) {
    // The optical depth is the same along a given slope of values.
    const double most = 0.05 / halfWidth;
    ResolvedScene scene = plainScene(
        TransferFunction({{0.5 - halfWidth, {kAlbedo, 0}}, {0.5, {kAlbedo, most}}, {0.5 + halfWidth, {kAlbedo, 0}}}),
        smallCameras()[1], 0.25);
    const Image exact = renderReference(grid, scene).colour;
    CHECK(largestAlpha(exact) > 0.3);
    for (const auto& [spacing, segments] : {std::pair(6.0, 8), std::pair(1.0, 2), std::pair(0.5, 1), std::pair(0.25, 1),
                                            std::pair(0.25, 4), std::pair(0.25, 8)}) {
      scene.sampling.spacing = spacing;
      scene.sampling.segments = segments;
      const double error = rmsDifference(renderGrid(*context, grid, scene).colour, exact);
      INFO("half-width " << halfWidth << ", spacing " << spacing << " in " << segments << ", error " << error);
      // A ray's value counts as linear over a segment. Where it turns close to the peak, the whole peak is gained or
      // lost. That happens to a share of the rays which falls with the length of segments, so the root mean square
      // falls with the root of the length or, where peaks are as wide as what a segment spans, faster.
      CHECK(error < 0.07 * std::sqrt(spacing / segments));
    }
  }
}

TEST_CASE("A 2D function is exact between its lattice lines, steps and narrow peaks included", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const ScalarGrid grid = blobGrid(1000, 1, 1000);
  const Medium none{kAlbedo, 0}, thin{{0.2, 0.9, 0.4}, 0.3}, dense{kAlbedo, 60};
  // There is nothing below 1000.2, then a thin medium up to a peak of half-width 0.001 at 1000.6, denser
  // at larger gradients.
  const std::vector<double> values{1000.2, 1000.2, 1000.599, 1000.6, 1000.601};
  const std::vector<double> gradients{0, 0.1, 0.3};
  const std::vector<Medium> media{none,  thin, thin, thin, thin, none,  thin, thin,
                                  dense, thin, none, thin, thin, dense, thin};
  ResolvedScene scene = plainScene(TransferFunction(values, gradients, media), smallCameras()[1], 0.5);
  const Image exact = renderReference(grid, scene).colour;
  CHECK(largestAlpha(exact) > 0.3);
  double coarser = 1;
  for (const auto& [spacing, segments] : {std::pair(2.0, 4), std::pair(0.5, 2), std::pair(0.25, 4)}) {
    scene.sampling.spacing = spacing;
    scene.sampling.segments = segments;
    const double error = rmsDifference(renderGrid(*context, grid, scene).colour, exact);
    INFO("spacing " << spacing << " in " << segments << ", error " << error);
    CHECK(error < coarser);
    coarser = error;
  }
  CHECK(coarser < 3e-3);
}
