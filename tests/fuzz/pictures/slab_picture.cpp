// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pictures/slab_picture.h"

#include <openvdb/tools/Dense.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "support/test_scenes.h"
#include "umbrick/grid/float_grid.h"

namespace umbrick {
namespace {

// All voxels of a box, and the background around it.
class DenseField {
 public:
  DenseField(const ScalarGrid& grid, const IndexBox& domain, bool gradients) : low_(domain.min - 2) {
    const openvdb::FloatTree& tree = grid.grid->tree();
    background_ = std::isfinite(tree.background()) ? tree.background() : 0;
    const glm::ivec3 high = domain.max + 2;
    extent_ = high - low_ + 1;
    values_.resize(static_cast<std::size_t>(extent_.x) * static_cast<std::size_t>(extent_.y) *
                   static_cast<std::size_t>(extent_.z));
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(
        openvdb::CoordBBox(openvdb::Coord(low_.x, low_.y, low_.z), openvdb::Coord(high.x, high.y, high.z)),
        values_.data());
    openvdb::tools::copyToDense(tree, dense, true);
    for (float& value : values_)
      if (!std::isfinite(value)) value = background_;
    if (gradients) differentiate(glm::transpose(glm::inverse(glm::dmat3(grid.indexToWorld()))));
  }

  float background() const { return background_; }
  double value(const glm::dvec3& index) const { return interpolate(values_, background_, index); }
  double gradient(const glm::dvec3& index) const { return interpolate(gradients_, 0, index); }

 private:
  std::size_t place(const glm::ivec3& p) const {
    return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(extent_.y) + static_cast<std::size_t>(p.y)) *
               static_cast<std::size_t>(extent_.x) +
           static_cast<std::size_t>(p.x);
  }
  bool inside(const glm::ivec3& p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < extent_.x && p.y < extent_.y && p.z < extent_.z;
  }

  // Magnitudes of central differences, per world unit.
  void differentiate(const glm::dmat3& covariant) {
    gradients_.resize(values_.size());
    const auto at = [&](const glm::ivec3& p) { return double(inside(p) ? values_[place(p)] : background_); };
    for (int z = 0; z < extent_.z; ++z)
      for (int y = 0; y < extent_.y; ++y)
        for (int x = 0; x < extent_.x; ++x) {
          const glm::ivec3 p(x, y, z);
          const glm::dvec3 difference(at({x + 1, y, z}) - at({x - 1, y, z}), at({x, y + 1, z}) - at({x, y - 1, z}),
                                      at({x, y, z + 1}) - at({x, y, z - 1}));
          gradients_[place(p)] = static_cast<float>(glm::length(covariant * (0.5 * difference)));
        }
  }

  // Equal corners give their own value, to the last bit.
  double interpolate(const std::vector<float>& field, float outside, const glm::dvec3& index) const {
    const glm::dvec3 floor = glm::floor(index), f = index - floor;
    const glm::ivec3 corner = glm::ivec3(floor) - low_;
    const auto at = [&](int x, int y, int z) {
      const glm::ivec3 p = corner + glm::ivec3(x, y, z);
      return double(inside(p) ? field[place(p)] : outside);
    };
    if (!inside(corner) && !inside(corner + 1)) {
      const glm::ivec3 nearest = glm::clamp(corner, glm::ivec3(-1), extent_);
      if (glm::any(glm::greaterThan(glm::abs(corner - nearest), glm::ivec3(0)))) return outside;
    }
    const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
    const auto row = [&](int y, int z) { return mix(at(0, y, z), at(1, y, z), f.x); };
    return mix(mix(row(0, 0), row(1, 0), f.y), mix(row(0, 1), row(1, 1), f.y), f.z);
  }

  glm::ivec3 low_, extent_;
  float background_ = 0;
  std::vector<float> values_, gradients_;
};

// What a ray has gathered.
struct Gathered {
  glm::dvec3 light{0};
  double transmittance = 1;

  void add(const glm::dvec3& albedo, double tau) {
    light += transmittance * -std::expm1(-tau) * albedo;
    transmittance *= std::exp(-tau);
  }
  bool dark() const { return transmittance < 1e-7; }
};

// A stretch of a segment where extinction and albedo run linearly, from 0 to 1: in steps of a tenth of optical depth,
// each with the albedo at the centre of its extinction.
void addLinear(Gathered& ray, const Medium& first, const Medium& last, double length) {
  const double slope = last.sigma_t - first.sigma_t, wanted = 0.1 / length;
  for (double at = 0; at < 1 && !ray.dark();) {
    const double sigma_t = std::max(0.0, first.sigma_t + at * slope);
    // wanted = sigma_t h + slope h^2 / 2, or never when extinction falls to nothing before.
    const double root = sigma_t * sigma_t + 2 * slope * wanted;
    const double step = std::min(root > 0 ? 2 * wanted / (sigma_t + std::sqrt(root)) : 1, 1 - at);
    const double depth = (sigma_t + 0.5 * slope * step) * step;
    if (depth > 0) {
      const double centre = at + step * step * (0.5 * sigma_t + slope * step / 3) / depth;
      ray.add(first.albedo + centre * (last.albedo - first.albedo), depth * length);
    }
    at = step < 1e-12 ? 1 : at + step;
  }
}

// A segment along which the value runs linearly.
void addRamp(Gathered& ray, const TransferFunction& transfer, double front, double back, double length) {
  if (front == back) {
    const Medium medium = transfer(front);
    if (medium.sigma_t > 0) ray.add(medium.albedo, medium.sigma_t * length);
    return;
  }
  const std::vector<double>& nodes = transfer.values();
  const bool rising = front < back;
  const double low = std::min(front, back), high = std::max(front, back);
  auto begin = std::upper_bound(nodes.begin(), nodes.end(), low);
  auto end = std::lower_bound(begin, nodes.end(), high);
  double from = front;
  const auto piece = [&](double to) {
    const double share = (to - from) / (back - front);
    if (!(share > 0)) return;
    // Both ends of a piece are where the function may jump: its slope follows from inner points.
    const Medium a = transfer(from + 0.25 * (to - from)), b = transfer(from + 0.75 * (to - from));
    if (a.sigma_t > 0 || b.sigma_t > 0) {
      const auto line = [&](double t) {
        return Medium{a.albedo + (t - 0.25) * 2 * (b.albedo - a.albedo),
                      std::max(0.0, a.sigma_t + (t - 0.25) * 2 * (b.sigma_t - a.sigma_t))};
      };
      addLinear(ray, line(0), line(1), share * length);
    }
    from = to;
  };
  if (rising) {
    for (auto node = begin; node != end && !ray.dark(); ++node) piece(*node);
  } else {
    for (auto node = end; node != begin && !ray.dark(); --node) piece(*(node - 1));
  }
  if (!ray.dark()) piece(back);
}

// A segment along which value and gradient magnitude run linearly: cut where they cross the lines of the lattice, each
// piece by the midpoint rule on 16 parts.
void addPath(Gathered& ray, const TransferFunction& transfer, const glm::dvec2& front, const glm::dvec2& back,
             double length) {
  std::vector<double> cuts{0, 1};
  const auto addCuts = [&](const std::vector<double>& nodes, double from, double to) {
    for (const double node : nodes)
      if (node > std::min(from, to) && node < std::max(from, to)) cuts.push_back((node - from) / (to - from));
  };
  addCuts(transfer.values(), front.x, back.x);
  addCuts(transfer.gradients(), front.y, back.y);
  std::sort(cuts.begin(), cuts.end());
  constexpr int parts = 16;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double step = (cuts[i] - cuts[i - 1]) / parts;
    for (int k = 0; k < parts && step > 0 && !ray.dark(); ++k) {
      const glm::dvec2 at = front + (cuts[i - 1] + (k + 0.5) * step) * (back - front);
      const Medium medium = transfer(at.x, at.y);
      if (medium.sigma_t > 0) ray.add(medium.albedo, medium.sigma_t * step * length);
    }
  }
}

class SlabIntegrator {
 public:
  SlabIntegrator(const ScalarGrid& grid, const ResolvedScene& scene, const IndexBox& domain)
      : scene_(scene),
        transfer_(scene.transfer),
        field_(grid, domain, transfer_.is2d()),
        toIndex_(glm::inverse(grid.indexToWorld())),
        planes_(scene.clipPlanes) {
    if (scene.clipBox)
      for (const ClipPlane& plane : boxPlanes(*scene.clipBox)) planes_.push_back(plane);
    const double farther = transfer_.is2d() ? 1 : 0;
    const Box whole{glm::dvec3(domain.min) - farther, glm::dvec3(domain.max) + farther};
    const Box around{whole.min - 1.0, whole.max + 1.0};  // beyond the medium there is nothing
    around_ = boxPlanes(around, grid.indexToWorld());
    if (transfer_(field_.background()).sigma_t > 0)
      for (const ClipPlane& plane : boxPlanes(whole, grid.indexToWorld())) planes_.push_back(plane);
  }

  Gathered alongSlabs(const ViewRay& ray) const {
    Gathered gathered;
    const DepthInterval kept = keptOf(ray), seen = within(kept, ray);
    if (!(seen.length() > 0)) return gathered;
    const double spacing = scene_.sampling.spacing;
    const auto first = static_cast<std::int64_t>(std::floor(seen.first / spacing));
    const auto last = static_cast<std::int64_t>(std::floor(seen.last / spacing));
    for (std::int64_t i = std::max<std::int64_t>(0, first); i <= last && !gathered.dark(); ++i)
      addSlab(gathered, ray, std::max(kept.first, static_cast<double>(i) * spacing),
              std::min(kept.last, static_cast<double>(i + 1) * spacing), scene_.sampling.segments);
    return gathered;
  }

  Gathered alongCells(const ViewRay& ray, int parts) const {
    Gathered gathered;
    const DepthInterval seen = within(keptOf(ray), ray);
    if (!(seen.length() > 0)) return gathered;
    const glm::dvec3 from = indexAt(ray, seen.first), to = indexAt(ray, seen.last);
    std::vector<double> cuts{seen.first, seen.last};
    for (int axis = 0; axis < 3; ++axis) {
      const double way = to[axis] - from[axis];
      for (double face = std::ceil(std::min(from[axis], to[axis])); face < std::max(from[axis], to[axis]); ++face)
        cuts.push_back(std::clamp(seen.first + (face - from[axis]) / way * seen.length(), seen.first, seen.last));
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 1; i < cuts.size() && !gathered.dark(); ++i)
      addSlab(gathered, ray, cuts[i - 1], cuts[i], parts);
    return gathered;
  }

 private:
  DepthInterval keptOf(const ViewRay& ray) const {
    DepthInterval kept = keptDepths(ray, planes_);
    kept.first = std::max(kept.first, scene_.camera.nearDistance);
    return kept;
  }
  DepthInterval within(const DepthInterval& kept, const ViewRay& ray) const {
    const DepthInterval around = keptDepths(ray, around_);
    return {std::max(kept.first, around.first), std::min(kept.last, around.last)};
  }
  void addSlab(Gathered& gathered, const ViewRay& ray, double front, double back, int segments) const {
    if (!(back > front)) return;
    const double depth = (back - front) / segments, length = depth * ray.stretch();
    const bool ramps = scene_.sampling.quadrature == Quadrature::preintegrated;
    glm::dvec2 before = ramps ? fieldAt(ray, front) : glm::dvec2(0);
    for (int i = 0; i < segments && !gathered.dark(); ++i) {
      if (ramps) {
        const glm::dvec2 behind = fieldAt(ray, front + (i + 1) * depth);
        if (transfer_.is2d())
          addPath(gathered, transfer_, before, behind, length);
        else
          addRamp(gathered, transfer_, before.x, behind.x, length);
        before = behind;
      } else {
        const glm::dvec2 middle = fieldAt(ray, front + (i + 0.5) * depth);
        const Medium medium = transfer_(middle.x, middle.y);
        if (medium.sigma_t > 0) gathered.add(medium.albedo, medium.sigma_t * length);
      }
    }
  }
  glm::dvec3 indexAt(const ViewRay& ray, double depth) const {
    return glm::dvec3(toIndex_ * glm::dvec4(ray.at(depth), 1));
  }
  // Value, and gradient magnitude where the function asks for it.
  glm::dvec2 fieldAt(const ViewRay& ray, double depth) const {
    const glm::dvec3 index = indexAt(ray, depth);
    return {field_.value(index), transfer_.is2d() ? field_.gradient(index) : 0};
  }

  const ResolvedScene& scene_;
  const TransferFunction& transfer_;
  DenseField field_;
  glm::dmat4 toIndex_;
  std::vector<ClipPlane> planes_, around_;
};

Image picture(const ResolvedScene& scene, const std::function<Gathered(const ViewRay&)>& along) {
  Image image(scene.camera.width, scene.camera.height);
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      for (int x = 0; x < image.width; ++x) {
        const Gathered ray = along(viewRay(scene.camera, x + 0.5, y + 0.5));
        glm::dvec3 light = scene.ambient * ray.light;
        if (scene.background) light += ray.transmittance * *scene.background;
        for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(light[c]);
        image.at(x, y)[3] = static_cast<float>(scene.background ? 1 : 1 - ray.transmittance);
      }
  });
  return image;
}

}  // namespace

Image slabPicture(const ScalarGrid& grid, const ResolvedScene& scene, const IndexBox& domain) {
  const SlabIntegrator integrator(grid, scene, domain);
  return picture(scene, [&](const ViewRay& ray) { return integrator.alongSlabs(ray); });
}

Image cellPicture(const ScalarGrid& grid, const ResolvedScene& scene, const IndexBox& domain, int parts) {
  const SlabIntegrator integrator(grid, scene, domain);
  return picture(scene, [&](const ViewRay& ray) { return integrator.alongCells(ray, parts); });
}

}  // namespace umbrick
