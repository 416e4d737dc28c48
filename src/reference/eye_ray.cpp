// SPDX-License-Identifier: Apache-2.0
#include "reference/eye_ray.h"

#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace umbrick {
namespace {

// The media at the corners of a cell: sigma_t, then sigma_s by colour.
class CellMedia {
 public:
  CellMedia(const FieldBlock& block, const glm::ivec3& cell, const TransferFunction& transfer) {
    const std::array<double, 8> values = cornersOf(block.values, cell);
    std::array<double, 8> gradients{};
    if (block.gradients) gradients = cornersOf(block.gradients, cell);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Medium medium = transfer(values[corner], gradients[corner]);
      const glm::dvec3 sigma_s = medium.sigma_s();
      const std::array<double, 4> four{medium.sigma_t, sigma_s.r, sigma_s.g, sigma_s.b};
      for (std::size_t i = 0; i < 4; ++i) numbers_[i][corner] = four[i];
    }
  }
  Cubic along(std::size_t i, const glm::dvec3& from, const glm::dvec3& to) const {
    return TrilinearCell(numbers_[i]).along(from, to);
  }

 private:
  std::array<std::array<double, 8>, 4> numbers_;
};

// Goes through the cells of a ray from front to back.
class Collector {
 public:
  Collector(const Classifier& classifier, const EyeRayOptions& options, double begin, std::vector<Scatterer>& parts,
            Emitted* emitted)
      : classifier_(classifier), options_(options), begin_(begin), parts_(parts), emitted_(emitted) {}

  // The opacity comes from the sum of optical depths. Products of 1 - x would add up their roundings, which all
  // have one sign.
  double opacity() const { return isDark() ? 1 : -std::expm1(-tau_); }
  bool isDark() const { return transmittance_ < options_.darkest; }

  /// Adds a cell, or part of one. `value` and `gradient` are over s in [0, 1], which is from `begin` to
  /// `end` of the ray.
  /// @param stretch  the stretch of a 1D function in which the cell lies; null: not known
  void add(const Cubic& value, const Cubic& gradient, double begin, double end,
           const LinearStretch* stretch = nullptr) {
    value_ = value;
    gradient_ = gradient;
    cellBegin_ = begin;
    length_ = end - begin;
    if (stretch)
      addSteps(classifier_.pieceOf(*stretch, value, 0, 1));
    else
      classifier_.forEachPiece(value, gradient, [&](const CellPiece& piece) { addSteps(piece); });
  }

  /// Adds what a cell, or part of one, emits: before its medium is added, which it still has to get through.
  /// @param glow  values of the second grid along the ray
  void emit(const Cubic& value, const Cubic& gradient, const Cubic& glow, double begin, double end) {
    length_ = end - begin;
    media_.clear();
    classifier_.forEachPiece(value, gradient, [&](const CellPiece& piece) { media_.push_back(piece); });
    emitted_->function.forEachPiece(glow, Cubic{}, [&](const CellPiece& piece) { emitOver(piece, glow); });
  }

  /// Adds a cell, or part of one, whose media are interpolated. @param sigma_s  by colour
  void addClassified(const Cubic& sigma_t, const std::array<Cubic, 3>& sigma_s, double begin, double end) {
    sigma_s_ = &sigma_s;
    cellBegin_ = begin;
    length_ = end - begin;
    addSteps(CellPiece{0, 1, sigma_t, nullptr});
    sigma_s_ = nullptr;
  }

 private:
  // The optical depth from the beginning of the cell up to s.
  double depthUpTo(double s) const {
    double tau = 0;
    for (const CellPiece& piece : media_)
      if (piece.begin < s) tau += length_ * std::max(0.0, piece.sigma_t.integral(piece.begin, std::min(piece.end, s)));
    return tau;
  }

  // Cuts a piece of the emission where the medium has another one.
  void emitOver(const CellPiece& piece, const Cubic& glow) {
    double begin = piece.begin;
    const auto upTo = [&](double s) {
      if (!(s > begin)) return;
      emitHalves(piece, glow, begin, std::min(s, piece.end), 40);
      begin = std::min(s, piece.end);
    };
    for (const CellPiece& medium : media_) {
      upTo(std::min(medium.begin, piece.end));
      upTo(std::min(medium.end, piece.end));
    }
    upTo(piece.end);
  }

  // Halves a part until five Gauss nodes integrate what is left of its light: exp(-x) over 0.5 to 1e-12.
  void emitHalves(const CellPiece& piece, const Cubic& glow, double begin, double end, int depth) {
    const double before = depthUpTo(begin);
    if (transmittance_ * std::exp(-before) < options_.darkest) return;
    if (depthUpTo(end) - before > 0.5 && depth > 0) {
      const double middle = 0.5 * (begin + end);
      emitHalves(piece, glow, begin, middle, depth - 1);
      emitHalves(piece, glow, middle, end, depth - 1);
      return;
    }
    constexpr double nodes[]{0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
    constexpr double weights[]{0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                               0.118463442528095};
    for (int i = 0; i < 5; ++i) {
      const double s = begin + nodes[i] * (end - begin);
      const double radiance = std::max(0.0, piece.sigma_t(s));
      emitted_->light += weights[i] * (end - begin) * length_ * transmittance_ * std::exp(-depthUpTo(s)) * radiance *
                         emitted_->function.albedo(piece, glow, Cubic{}, s);
    }
  }

  glm::dvec3 albedoAt(const CellPiece& piece, double s) const {
    if (!sigma_s_) return classifier_.albedo(piece, value_, gradient_, s);
    const double sigma_t = piece.sigma_t(s);
    if (!(sigma_t > 0)) return glm::dvec3(0);
    return glm::clamp(glm::dvec3((*sigma_s_)[0](s), (*sigma_s_)[1](s), (*sigma_s_)[2](s)) / sigma_t, 0.0, 1.0);
  }

  // Cuts a piece where a step ends.
  void addSteps(const CellPiece& piece) {
    double s = piece.begin;
    while (s < piece.end && !isDark()) {
      double end = piece.end;
      if (options_.step > 0) {
        stretch_ = static_cast<std::int64_t>(std::floor((at(s) - begin_) / options_.step + 1e-9));
        const double boundary = (begin_ + static_cast<double>(stretch_ + 1) * options_.step - cellBegin_) / length_;
        if (boundary > s && boundary < end) end = boundary;
      }
      addHalves(piece, s, end, length_ * piece.sigma_t.integral(s, end), 60);
      s = end;
    }
  }

  // Halves a part until it is thin enough for a few nodes.
  void addHalves(const CellPiece& piece, double begin, double end, double tau, int depth) {
    if (isDark() || !(tau > 0)) return;
    if (tau > options_.largestTau && depth > 0) {
      const double middle = 0.5 * (begin + end);
      const double first = length_ * piece.sigma_t.integral(begin, middle);
      addHalves(piece, begin, middle, first, depth - 1);
      addHalves(piece, middle, end, tau - first, depth - 1);
      return;
    }
    addPart(piece, begin, end, tau);
  }

  // The opacity of the part is exact. How it is spread over the part, for the centre and the albedo, is found with
  // three Gauss nodes. What comes before each node is integrated from the same nodes (the coefficients of the
  // Gauss-Legendre method of order six).
  void addPart(const CellPiece& piece, double begin, double end, double tau) {
    constexpr double root = 3.872983346207417;  // sqrt(15)
    constexpr double nodes[]{0.5 - root / 10, 0.5, 0.5 + root / 10}, weights[]{5, 8, 5};
    constexpr double before[3][3]{{5.0 / 36, 2.0 / 9 - root / 15, 5.0 / 36 - root / 30},
                                  {5.0 / 36 + root / 24, 2.0 / 9, 5.0 / 36 - root / 24},
                                  {5.0 / 36 + root / 30, 2.0 / 9 + root / 15, 5.0 / 36}};
    double s[3], sigma_t[3];
    for (int i = 0; i < 3; ++i) {
      s[i] = begin + nodes[i] * (end - begin);
      sigma_t[i] = std::max(0.0, piece.sigma_t(s[i]));
    }
    double sum = 0, centre = 0;
    glm::dvec3 albedo(0);
    for (int i = 0; i < 3; ++i) {
      const double depth = before[i][0] * sigma_t[0] + before[i][1] * sigma_t[1] + before[i][2] * sigma_t[2];
      const double weight = weights[i] * sigma_t[i] * attenuation(std::max(0.0, length_ * (end - begin) * depth));
      sum += weight;
      centre += weight * s[i];
      albedo += weight * albedoAt(piece, s[i]);
    }
    if (!(sum > 0)) {
      // A fitted cubic may be positive only between the nodes.
      sum = 1;
      centre = s[1];
      albedo = albedoAt(piece, s[1]);
    }
    Scatterer part;
    part.t = at(centre / sum);
    part.alpha = transmittance_ * -std::expm1(-tau);
    part.light = albedo * (part.alpha / sum);
    part.stretch = stretch_;
    tau_ += tau;
    transmittance_ = std::exp(-tau_);
    parts_.push_back(part);
  }

  // Returns exp(-x), where x is nearly always small. The series is off by less than x^5 / 120, which is 8e-8 at 0.1.
  static double attenuation(double x) {
    return x < 0.1 ? 1 - x * (1 - x * (0.5 - x * (1.0 / 6 - x * (1.0 / 24)))) : std::exp(-x);
  }

  double at(double s) const { return cellBegin_ + s * length_; }

  const Classifier& classifier_;
  const EyeRayOptions& options_;
  double begin_;
  std::vector<Scatterer>& parts_;
  Cubic value_, gradient_;
  const std::array<Cubic, 3>* sigma_s_ = nullptr;  // of classified voxels
  double cellBegin_ = 0, length_ = 0, tau_ = 0, transmittance_ = 1;
  std::int64_t stretch_ = 0;
  Emitted* emitted_;              // null: nothing emits
  std::vector<CellPiece> media_;  // of the cell that emits
};

}  // namespace

EyeRays::EyeRays(const Camera& camera, const glm::dmat4& indexToWorld)
    : camera_(camera),
      frame_(cameraFrame(camera)),
      plane_(screenPlane(camera)),
      worldToIndex_(glm::inverse(indexToWorld)),
      linear_(worldToIndex_) {}

EyeRays::Ray EyeRays::through(int x, int y, const glm::dvec2& place) const {
  const glm::dvec2 p = (glm::dvec2(x, y) + place) * plane_.pixelSize - plane_.halfExtent;
  const glm::dvec3 aside = p.x * frame_.right + p.y * frame_.up;
  const bool perspective = camera_.projection == Projection::perspective;
  Ray ray;
  ray.direction = perspective ? glm::normalize(frame_.forward + aside) : frame_.forward;
  ray.depthPerLength = glm::dot(ray.direction, frame_.forward);
  const glm::dvec3 origin(worldToIndex_ * glm::dvec4(perspective ? camera_.eye : camera_.eye + aside, 1));
  ray.index = IndexRay(origin, toIndex(ray.direction));
  return ray;
}

double collectScatterers(const Field& field, Field::Accessor& accessor, const Classifier& classifier,
                         const IndexRay& ray, const Interval& part, const EyeRayOptions& options,
                         std::vector<Scatterer>& parts, std::uint64_t& cells, Emitted* emitted) {
  Collector collector(classifier, options, part.begin, parts, emitted);
  field.walkBlocks(
      accessor, ray, part, [&](const FieldBlock& block, const glm::dvec3& origin, double begin, double end) {
        if (!block.values) {
          ++cells;
          collector.add(Cubic{{block.uniform, 0, 0, 0}}, Cubic{}, begin, end);
          return !collector.isDark();
        }
        return walkCells(block, origin, ray, begin, end, [&](const glm::ivec3& cell, double enter, double leave) {
          ++cells;
          const glm::dvec3 corner = origin + glm::dvec3(cell);
          const glm::dvec3 from = ray.at(enter) - corner, to = ray.at(leave) - corner;
          if (options.classifyVoxels) {
            const CellMedia media(block, cell, classifier.transfer());
            collector.addClassified(media.along(0, from, to),
                                    {media.along(1, from, to), media.along(2, from, to), media.along(3, from, to)},
                                    enter, leave);
            return !collector.isDark();
          }
          Cubic gradient;
          if (block.gradients) gradient = TrilinearCell(block.gradients, cell).along(from, to);
          const std::uint8_t kind = block.kind(cell);
          const Cubic value = TrilinearCell(block.values, cell).along(from, to);
          if (emitted && block.emissions)
            collector.emit(value, gradient, TrilinearCell(block.emissions, cell).along(from, to), enter, leave);
          collector.add(value, gradient, enter, leave,
                        kind == FieldBlock::kMixed ? nullptr : &classifier.stretch(kind - 1u));
          return !collector.isDark();
        });
      });
  return collector.opacity();
}

}  // namespace umbrick
