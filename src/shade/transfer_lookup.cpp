// SPDX-License-Identifier: Apache-2.0
#include "shade/transfer_lookup.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/vec4.hpp>
#include <limits>
#include <string>
#include <vector>

#include "shade/constants.h"
#include "umbrick/core/error.h"
#include "umbrick/optics/transfer_stretches.h"

namespace umbrick {
namespace {

constexpr double kFar = 1e38;  // stands for infinity, as in medium.glsl: where the constant ends of a function end
// Fixed-point texels become floats by a division or a product, and filters add up weights: the value that is read may
// be off by this share of it. For floats that is a unit in the last place.
constexpr double kReadRounding = 0x1p-22;
constexpr double kFloatRounding = 0x1p-23;

// medium.glsl finds the stretch of a value among so many, except the last, by comparison with their upper ends instead
// of a bisection.
constexpr std::size_t kComparedStretches = 25;
// So many vectors of uniforms are left for everything else.
constexpr GLint kOtherUniforms = 256;

// Returns the function with an extinction that single precision can multiply by a slab's length, and divide by. The
// extinction that is cut off is opaque over any length that a number could tell from 0.
TransferFunction bounded(const TransferFunction& transfer, double spacing) {
  const double most = 1e30 / std::max(spacing, 1.0);
  std::vector<Medium> media = transfer.media();
  for (Medium& medium : media) medium.sigma_t = std::min(medium.sigma_t, most);
  if (transfer.is2d()) return {transfer.values(), transfer.gradients(), std::move(media)};
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < media.size(); ++i) points.push_back({transfer.values()[i], media[i]});
  return TransferFunction(std::move(points));
}

// Returns how many bisections find one of so many stretches.
int bisections(const std::vector<AxisStretch>& stretches) {
  return std::bit_width(static_cast<unsigned>(stretches.size() - 1));
}

// Tells whether a voxel of the volume may have this very value.
bool mayBeVoxel(double value, const Bricks& volume) {
  const bool whole = volume.exactFormat == VoxelFormat::unorm8 || volume.exactFormat == VoxelFormat::unorm16;
  return volume.value.contains(static_cast<float>(value)) && (!whole || value == std::floor(value));
}

// Returns the lower and upper ends of the stretches in texel units. A value exactly on a step belongs to the
// upper side, also where its texel holds a little less and where that is read as a little less: steps are lowered
// by that much.
// @param stored  what a texel holds of a voxel of this value, where there may be one: others are cut off at the ends of
//   a format, which a step beyond them must not be
std::vector<glm::vec2> endsInTexels(const std::vector<AxisStretch>& stretches,
                                    const std::function<double(double)>& toTexel,
                                    const std::function<double(double)>& stored) {
  std::vector<glm::vec2> ends(stretches.size());
  double lower = -kFar;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    double upper = kFar;
    if (i + 1 < stretches.size()) {
      upper = toTexel(stretches[i].upper);
      const bool step = stretches[i].high != stretches[i + 1].low;
      if (step) {
        upper = std::min(upper, stored(stretches[i].upper));
        upper -= kReadRounding * std::abs(upper);
      }
      upper = std::clamp(upper, lower, kFar);
    }
    ends[i] = {static_cast<float>(lower), static_cast<float>(upper)};
    lower = upper;
  }
  return ends;
}

// Builds the texture that medium.glsl describes.
class StretchTexels {
 public:
  StretchTexels(int width, int height)
      : width_(width),
        height_(height),
        texels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), glm::vec4(0)) {}
  glm::vec4& at(std::size_t column, std::size_t row) {
    return texels_[row * static_cast<std::size_t>(width_) + column];
  }
  const glm::vec4& at(std::size_t column, std::size_t row) const {
    return texels_[row * static_cast<std::size_t>(width_) + column];
  }
  GlTexture upload(const GlFunctions& gl) const {
    GlTexture texture = makeTexture2d(gl, GL_RGBA32F, width_, height_, GL_NEAREST);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl.TextureSubImage2D(texture.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, texels_.data());
    return texture;
  }

 private:
  int width_, height_;
  std::vector<glm::vec4> texels_;
};

StretchTexels texelsOf1d(const TransferFunction& transfer, const std::vector<AxisStretch>& stretches,
                         const std::vector<glm::vec2>& ends, int width) {
  StretchTexels texels(width, 3);
  for (std::size_t column = 0; column < static_cast<std::size_t>(width); ++column) {
    const std::size_t i = std::min(column, stretches.size() - 1);
    const Medium &low = transfer.media()[stretches[i].low], &high = transfer.media()[stretches[i].high];
    texels.at(column, 0) = {ends[i], low.sigma_t, high.sigma_t};
    texels.at(column, 1) = {glm::vec3(low.albedo), 0};
    texels.at(column, 2) = {glm::vec3(high.albedo), 0};
  }
  return texels;
}

StretchTexels texelsOf2d(const TransferFunction& transfer, const std::vector<AxisStretch>& values,
                         const std::vector<glm::vec2>& valueEnds, const std::vector<AxisStretch>& gradients,
                         const std::vector<glm::vec2>& gradientEnds, int columns, int rows) {
  StretchTexels texels(std::max(2 * columns, rows), 2 + 2 * rows);
  for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i)
    texels.at(i, 0) = {valueEnds[std::min(i, values.size() - 1)], 0, 0};
  for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j)
    texels.at(j, 1) = {gradientEnds[std::min(j, gradients.size() - 1)], 0, 0};
  for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j)
    for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
      const AxisStretch &v = values[std::min(i, values.size() - 1)], &g = gradients[std::min(j, gradients.size() - 1)];
      const auto corner = [&](std::size_t value, std::size_t gradient) {
        const Medium& medium = transfer.media()[gradient * transfer.values().size() + value];
        return glm::vec4(glm::vec3(medium.albedo), static_cast<float>(medium.sigma_t));
      };
      texels.at(2 * i, 2 + 2 * j) = corner(v.low, g.low);
      texels.at(2 * i + 1, 2 + 2 * j) = corner(v.high, g.low);
      texels.at(2 * i, 3 + 2 * j) = corner(v.low, g.high);
      texels.at(2 * i + 1, 3 + 2 * j) = corner(v.high, g.high);
    }
  return texels;
}

// Checks that the driver has room for the stretches. Columns, and rows, are powers of two; a 2D function has two of
// them for a stretch, and two rows more.
void checkStretches(const GlFunctions& gl, const std::vector<AxisStretch>& stretches, bool is2d) {
  GLint edge = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &edge);
  const std::size_t most = std::bit_floor(static_cast<unsigned>(edge)) / (is2d ? 4 : 1);
  if (stretches.size() > most)
    throw InvalidArgument("transfer function: it has " + std::to_string(stretches.size() - 1) +
                          " different control points along an axis, more than the driver's limit of " +
                          std::to_string(most - 1));
}

}  // namespace

TransferLookup::TransferLookup(const GlFunctions& gl, const TransferFunction& transfer, const SamplingOptions& sampling,
                               const Bricks& volume, VoxelFormat format, const std::optional<TransferFunction>& emitted)
    : transfer_(bounded(transfer, sampling.spacing)),
      scale_(texelScale(volume, format)),
      background_(volume.background),
      emptyRounding_(format == VoxelFormat::half || format == VoxelFormat::float32 ? kFloatRounding
                                                                                   : 2 * kReadRounding),
      // Half-floats are off by 2^-11 of a magnitude, even where the values are stored exactly.
      gradientRounding_(format == VoxelFormat::half ? 0x1p-10 : 0x1p-20),
      mode_((transfer.is2d() ? 2 : 0) + (sampling.quadrature == Quadrature::midpoint ? 1 : 0)) {
  if (emitted) emission_.emplace(gl, *emitted);
  const std::vector<AxisStretch> values = axisStretches(transfer_.values());
  checkStretches(gl, values, transfer_.is2d());
  const std::vector<glm::vec2> valueEnds = endsInTexels(
      values, [&](double value) { return scale_.toTexel(value); },
      [&](double value) {
        return mayBeVoxel(value, volume) ? texelOf(static_cast<float>(value), scale_, format) : scale_.toTexel(value);
      });
  valueSteps_ = bisections(values);
  if (!transfer_.is2d()) {
    const StretchTexels texels = texelsOf1d(transfer_, values, valueEnds, 1 << valueSteps_);
    texture_ = texels.upload(gl);
    GLint vectors = 0;
    gl.GetIntegerv(GL_MAX_FRAGMENT_UNIFORM_VECTORS, &vectors);
    if (3 * static_cast<GLint>(values.size()) + kOtherUniforms <= vectors)
      for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t row = 0; row < 3; ++row) uniforms_.push_back(texels.at(i, row));
    return;
  }
  const std::vector<AxisStretch> gradients = axisStretches(transfer_.gradients());
  checkStretches(gl, gradients, true);
  const std::vector<glm::vec2> gradientEnds = endsInTexels(
      gradients, [](double gradient) { return gradient; },
      [&](double gradient) {
        const auto magnitude = static_cast<float>(gradient);
        return volume.gradient.contains(magnitude) ? gradientTexelOf(magnitude, format) : gradient;
      });
  gradientSteps_ = bisections(gradients);
  texture_ = texelsOf2d(transfer_, values, valueEnds, gradients, gradientEnds, 1 << valueSteps_, 1 << gradientSteps_)
                 .upload(gl);
}

std::size_t TransferLookup::freeUniforms(const GlFunctions& gl) const {
  GLint vectors = 0;
  gl.GetIntegerv(GL_MAX_FRAGMENT_UNIFORM_VECTORS, &vectors);
  const std::size_t used = uniforms_.size() + kOtherUniforms;
  return static_cast<std::size_t>(vectors) - std::min(used, static_cast<std::size_t>(vectors));
}

// Returns what values of a range may be read as. Empty space is read as it is.
Range TransferLookup::widened(const Range& values) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto slack = [&](double value) {
    return scale_.rounding + 2 * kReadRounding * std::abs(value - scale_.offset);
  };
  Range range = values;
  if (values.min != background_)
    range.min = std::nextafter(static_cast<float>(values.min - slack(values.min)), -kInfinity);
  if (values.max != background_)
    range.max = std::nextafter(static_cast<float>(values.max + slack(values.max)), kInfinity);
  return range;
}

bool TransferLookup::isVisible(const Range& value, const Range& gradient) const {
  if (value.empty()) return false;
  Range gradients{0, 0};
  if (transfer_.is2d()) {
    const auto slack = static_cast<float>(gradientRounding_);
    gradients = {gradient.min * (1 - slack), gradient.max * (1 + slack)};
  }
  return !transfer_.isTransparent(widened(value), gradients);
}

void TransferLookup::setConstants(ShaderConstants& constants) const {
  constants["kQuadrature"] = mode_;
  constants["kUniformStretches"] = static_cast<int>(uniforms_.size() / 3);
  constants["kValueSteps"] = valueSteps_;
  constants["kGradientSteps"] = gradientSteps_;
  constants["kEmission"] = emission_.has_value();
}

void TransferLookup::bind(const GlFunctions& gl) const {
  gl.BindTextureUnit(kTransferUnit, texture_.name());
  if (emission_) gl.BindTextureUnit(kEmissionUnit, emission_->texture());
}

void TransferLookup::setUniforms(GlProgram& program, const BrickAtlas& atlas) const {
  const double empty = atlas.texelOf(background_);
  program.set("empty_texel", glm::vec3(empty, std::abs(empty) * emptyRounding_, scale_.toTexel(background_)));
  if (emission_) emission_->setUniforms(program);
  if (uniforms_.empty()) return;
  program.set("stretches", uniforms_);
  if (uniforms_.size() / 3 > kComparedStretches) return;
  // The last places are filled with a number that no value exceeds, since values are clamped to kFar.
  std::vector<glm::vec4> ends(6, glm::vec4(2 * static_cast<float>(kFar)));
  for (std::size_t i = 0; 3 * i + 3 < uniforms_.size(); ++i) ends[i / 4][static_cast<int>(i % 4)] = uniforms_[3 * i].g;
  program.set("few_ends", ends);
}

}  // namespace umbrick
