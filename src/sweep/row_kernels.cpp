// SPDX-License-Identifier: Apache-2.0
#include "sweep/row_kernels.h"

#include <glm/gtc/packing.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/row_kernels.cpp"
#include "core/simd_targets.h"

#include "sweep/stretches-inl.h"

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, kRayGroup>;
using Numbers = hn::Rebind<std::int32_t, Lanes>;
using Floats = hn::Vec<Lanes>;
using Ints = hn::Vec<Numbers>;

// Loads codes of voxels that lie side by side as floats.
HWY_INLINE Floats loadCodes(Lanes d, const std::uint8_t* from) {
  const hn::Rebind<std::uint8_t, Lanes> narrow;
  return hn::ConvertTo(d, hn::PromoteTo(Numbers(), hn::LoadU(narrow, from)));
}
HWY_INLINE Floats loadCodes(Lanes d, const std::uint16_t* from) {
  const hn::Rebind<std::uint16_t, Lanes> narrow;
  return hn::ConvertTo(d, hn::PromoteTo(Numbers(), hn::LoadU(narrow, from)));
}
HWY_INLINE Floats loadCodes(Lanes d, const HalfCode* from) {
  const hn::Rebind<hwy::float16_t, Lanes> narrow;
  const hn::Rebind<std::uint16_t, Lanes> bits;
  return hn::PromoteTo(d, hn::BitCast(narrow, hn::LoadU(bits, &from->bits)));
}
HWY_INLINE Floats loadCodes(Lanes d, const float* from) { return hn::LoadU(d, from); }

// As a + share (b - a): equal voxels give their value to the last bit.
HWY_INLINE Floats between(Floats a, Floats b, Floats share) { return hn::MulAdd(share, hn::Sub(b, a), a); }

template <class Code>
HWY_INLINE float codeOf(Code code) {
  return static_cast<float>(code);
}
HWY_INLINE float codeOf(HalfCode code) { return glm::unpackHalf1x16(code.bits); }

template <class Code>
void blend(const VoxelRows& rows, int count, float* out) {
  const Lanes d;
  const auto n = static_cast<int>(hn::Lanes(d));
  const auto* const a = static_cast<const Code*>(rows.rows[0]);
  const auto* const b = static_cast<const Code*>(rows.rows[1]);
  const auto* const c = static_cast<const Code*>(rows.rows[2]);
  const auto* const e = static_cast<const Code*>(rows.rows[3]);
  if (rows.stride != 1) {
    for (int i = 0; i < count; ++i) {
      const std::ptrdiff_t at = i * rows.stride;
      float value = codeOf(a[at]) + rows.v * (codeOf(b[at]) - codeOf(a[at]));
      if (rows.n > 0) {
        const float next = codeOf(c[at]) + rows.v * (codeOf(e[at]) - codeOf(c[at]));
        value += rows.n * (next - value);
      }
      out[i] = (value - rows.bias) * rows.factor + rows.first;
    }
    return;
  }
  const Floats v = hn::Set(d, rows.v), depth = hn::Set(d, rows.n), bias = hn::Set(d, rows.bias),
               factor = hn::Set(d, rows.factor), first = hn::Set(d, rows.first);
  const auto value = [&](int i) HWY_ATTR {
    Floats result = between(loadCodes(d, a + i), loadCodes(d, b + i), v);
    if (rows.n > 0) result = between(result, between(loadCodes(d, c + i), loadCodes(d, e + i), v), depth);
    return hn::MulAdd(hn::Sub(result, bias), factor, first);
  };
  // Rows end with bytes that may be read, and so do buffers with numbers that may be written.
  for (int i = 0; i < count; i += n) hn::StoreU(value(i), d, out + i);
}

void blendRowsOf(VoxelCode code, const VoxelRows& rows, int count, float* out) {
  if (code == VoxelCode::u8) blend<std::uint8_t>(rows, count, out);
  if (code == VoxelCode::u16) blend<std::uint16_t>(rows, count, out);
  if (code == VoxelCode::f16) blend<HalfCode>(rows, count, out);
  if (code == VoxelCode::f32) blend<float>(rows, count, out);
}

// Looks up numbers of a row, which are at most 2 lanes of it apart, by permutations of registers.
HWY_INLINE Floats lookUp(Lanes d, Floats low, Floats high, Ints index) {
  const Numbers di;
  const Ints last = hn::Set(di, static_cast<std::int32_t>(hn::Lanes(d)) - 1);
  const auto lanes = hn::IndicesFromVec(d, hn::And(index, last));
  return hn::IfThenElse(hn::RebindMask(d, hn::Gt(index, last)), hn::TableLookupLanes(high, lanes),
                        hn::TableLookupLanes(low, lanes));
}

void sampleRowsOf(const RowPlaces& places, int first, int count, int length, int fields, const float* const* rows,
                  float* const* out) {
  const Lanes d;
  const Numbers di;
  const auto n = static_cast<int>(hn::Lanes(d));
  const Floats steps = hn::Mul(hn::ConvertTo(d, hn::Iota(di, 0)), hn::Set(d, static_cast<float>(places.spacing)));
  const bool near = n >= 8 && places.spacing * (n - 1) + 2 < 2 * n;
  for (int i = first; i < first + count; i += n) {
    const double x = places.x0 + i * places.spacing;
    const double whole = std::floor(x);
    // Places beyond the row's ends get its end.
    const double begin = whole - static_cast<double>(places.begin);
    const Floats place = hn::Add(steps, hn::Set(d, static_cast<float>(x - whole)));
    Ints index = hn::ConvertTo(di, place);
    const Floats share = hn::Sub(place, hn::ConvertTo(d, index));
    if (near && begin >= 0 && begin + 2 * n <= length + kRowPadding) {
      const auto at = static_cast<std::ptrdiff_t>(begin);
      const Ints next = hn::Add(index, hn::Set(di, 1));
      for (int f = 0; f < fields; ++f) {
        const Floats low = hn::LoadU(d, rows[f] + at), high = hn::LoadU(d, rows[f] + at + n);
        hn::StoreU(between(lookUp(d, low, high, index), lookUp(d, low, high, next), share), d, out[f] + i);
      }
      continue;
    }
    const double bounded = std::min(std::max(begin, -1e9), 1e9);
    index = hn::Add(index, hn::Set(di, static_cast<std::int32_t>(bounded)));
    index = hn::Min(hn::Max(index, hn::Zero(di)), hn::Set(di, std::max(length - 2, 0)));
    for (int f = 0; f < fields; ++f)
      hn::StoreU(between(hn::GatherIndex(d, rows[f], index), hn::GatherIndex(d, rows[f] + 1, index), share), d,
                 out[f] + i);
  }
}

// exp(-x) for x >= 0, within 3e-7 of it.
HWY_INLINE Floats expNegative(Lanes d, Floats x) {
  const Numbers di;
  const Floats y = hn::Mul(hn::Min(x, hn::Set(d, 80.0f)), hn::Set(d, -1.44269504f));
  const Floats whole = hn::Round(y);
  const Floats f = hn::Mul(hn::Sub(y, whole), hn::Set(d, 0.69314718f));
  Floats p = hn::Set(d, 1.0f / 720);
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f / 120));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f / 24));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f / 6));
  p = hn::MulAdd(p, f, hn::Set(d, 0.5f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  const Ints exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127)));
  return hn::Mul(p, hn::BitCast(d, exponent));
}

// (1 - exp(-x)) / x without cancellation, as in shaders/optics/slab.glsl.
HWY_INLINE Floats slabFactorOf(Lanes d, Floats x) {
  Floats p = hn::Set(d, 1.0f / 5040);
  p = hn::MulAdd(p, x, hn::Set(d, -1.0f / 720));
  p = hn::MulAdd(p, x, hn::Set(d, 1.0f / 120));
  p = hn::MulAdd(p, x, hn::Set(d, -1.0f / 24));
  p = hn::MulAdd(p, x, hn::Set(d, 1.0f / 6));
  p = hn::MulAdd(p, x, hn::Set(d, -0.5f));
  p = hn::MulAdd(p, x, hn::Set(d, 1.0f));
  const Floats one = hn::Set(d, 1.0f), exact = hn::Div(hn::Sub(one, expNegative(d, x)), hn::Max(x, hn::Set(d, 0.5f)));
  return hn::IfThenElse(hn::Lt(x, hn::Set(d, 0.5f)), p, exact);
}

// The medium of a part of a ray: sigma_t, and sigma_s by colour.
struct MeanMedium {
  Floats sigma_t, red, green, blue;
};

// A value of the table, a whole step, and the sums up to it.
struct TableEnd {
  Floats step;
  Ints sum[4], rest[4];
};

// Means between two values that are whole steps.
class LinearMedium {
 public:
  explicit LinearMedium(const MediumTable& table)
      : points_(table.points()),
        sums_(table.sums()),
        rests_(table.rests()),
        steps_(table.steps()),
        unit_(table.sumUnit()) {}

  HWY_INLINE Ints entry(Lanes d, Floats step) const {
    const Floats within = hn::Min(hn::Max(step, hn::Zero(d)), hn::Set(d, static_cast<float>(steps_)));
    return hn::ShiftLeft<2>(hn::ConvertTo(Numbers(), within));
  }

  // The sum of extinction alone; colours follow where they are needed.
  HWY_INLINE TableEnd end(Lanes d, Floats step) const {
    TableEnd end;
    end.step = step;
    const Ints at = entry(d, step);
    end.sum[0] = hn::GatherIndex(Numbers(), sums_, at);
    end.sum[1] = end.sum[2] = end.sum[3] = hn::Zero(Numbers());
    end.rest[0] = end.rest[1] = end.rest[2] = end.rest[3] = hn::Zero(Numbers());
    if (rests_) end.rest[0] = hn::GatherIndex(Numbers(), rests_, at);
    return end;
  }
  HWY_INLINE void addColours(Lanes d, TableEnd& end) const {
    const Ints at = entry(d, end.step);
    for (int c = 1; c < 4; ++c) {
      end.sum[c] = hn::GatherIndex(Numbers(), sums_ + c, at);
      if (rests_) end.rest[c] = hn::GatherIndex(Numbers(), rests_ + c, at);
    }
  }

  // What is the same for all channels of a part.
  struct Part {
    hn::Mask<Lanes> single;  // both ends are one step
    Floats perStep;          // 1 / steps between them, times the unit of the sums, with the sign of the way
    Floats below, above;     // shares that lie outside of the table
  };
  HWY_INLINE Part part(Lanes d, const TableEnd& from, const TableEnd& to) const {
    const Floats last = hn::Set(d, static_cast<float>(steps_)), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Floats span = hn::Sub(to.step, from.step);
    Part part;
    part.single = hn::Lt(hn::Abs(span), hn::Set(d, 0.5f));
    const Floats share = hn::Div(one, hn::IfThenElse(part.single, one, span));
    part.perStep = hn::Mul(share, hn::Set(d, unit_));
    part.below = hn::Mul(share, hn::Sub(hn::Min(to.step, zero), hn::Min(from.step, zero)));
    part.above = hn::Mul(share, hn::Sub(hn::Max(to.step, last), hn::Max(from.step, last)));
    return part;
  }

  HWY_INLINE Floats mean(Lanes d, const Part& part, const TableEnd& from, const TableEnd& to, int c) const {
    Floats units = hn::ConvertTo(d, hn::Sub(to.sum[c], from.sum[c]));
    if (rests_)
      units = hn::MulAdd(hn::ConvertTo(d, hn::Sub(to.rest[c], from.rest[c])), hn::Set(d, 1.0f / MediumTable::kRests),
                         units);
    Floats mean = hn::Mul(units, part.perStep);
    mean = hn::MulAdd(part.below, hn::Set(d, points_[c]), mean);
    mean = hn::MulAdd(part.above, hn::Set(d, points_[4 * steps_ + c]), mean);
    if (!hn::AllFalse(d, part.single))
      mean = hn::IfThenElse(part.single, hn::GatherIndex(d, points_ + c, entry(d, from.step)), mean);
    return mean;
  }

 private:
  const float* points_;
  const std::int32_t *sums_, *rests_;
  int steps_;
  float unit_;
};

// The mean over values from one to another, in steps, of a 2D function for one gradient. Sums are interpolated between
// steps: rounded ones would be another mean where a peak is thinner than a step.
HWY_INLINE MeanMedium meanOnRow(Lanes d, const MediumTable& table, Floats from, Floats to, Floats gradient) {
  const Numbers di;
  const Floats zero = hn::Zero(d), one = hn::Set(d, 1.0f), last = hn::Set(d, static_cast<float>(table.steps()));
  const Floats lastRow = hn::Set(d, static_cast<float>(table.gradientSteps()));
  const auto within = [&](Floats x, Floats most) HWY_ATTR { return hn::Min(hn::Max(x, zero), most); };
  const Ints row = hn::ConvertTo(di, within(hn::Round(gradient), lastRow));
  const Ints first = hn::Mul(row, hn::Set(di, table.steps() + 1));
  const auto entryOf = [&](Floats step) HWY_ATTR { return hn::ShiftLeft<2>(hn::Add(first, hn::ConvertTo(di, step))); };
  const Floats insideFrom = within(from, last), insideTo = within(to, last);
  const Floats stepFrom = hn::Min(hn::Floor(insideFrom), hn::Sub(last, one));
  const Floats stepTo = hn::Min(hn::Floor(insideTo), hn::Sub(last, one));
  const Floats restFrom = hn::Sub(insideFrom, stepFrom), restTo = hn::Sub(insideTo, stepTo);
  const Ints a = entryOf(stepFrom), b = entryOf(stepTo);
  // Over less than a tenth of a step the mean is the medium at the nearest one.
  const Floats span = hn::Sub(to, from);
  const auto single = hn::Lt(hn::Abs(span), hn::Set(d, 0.1f));
  const Ints nearest = entryOf(hn::Round(insideFrom));
  const Floats share = hn::Div(one, hn::IfThenElse(single, one, span));
  const Floats perStep = hn::Mul(share, hn::Set(d, table.sumUnit()));
  // Shares that lie outside of the table, where the function is constant.
  const Floats below = hn::Mul(share, hn::Sub(hn::Min(to, zero), hn::Min(from, zero)));
  const Floats above = hn::Mul(share, hn::Sub(hn::Max(to, last), hn::Max(from, last)));
  const bool outside = !hn::AllFalse(d, hn::Gt(hn::Add(hn::Abs(below), hn::Abs(above)), zero));
  const auto mean = [&](int c) HWY_ATTR {
    const std::int32_t *const sums = table.sums() + c, *const next = sums + 4;
    const float* const points = table.points() + c;
    const Ints atA = hn::GatherIndex(di, sums, a), atB = hn::GatherIndex(di, sums, b);
    const Floats wayA = hn::ConvertTo(d, hn::Sub(hn::GatherIndex(di, next, a), atA));
    const Floats wayB = hn::ConvertTo(d, hn::Sub(hn::GatherIndex(di, next, b), atB));
    Floats sum = hn::MulAdd(restTo, wayB, hn::NegMulAdd(restFrom, wayA, hn::ConvertTo(d, hn::Sub(atB, atA))));
    sum = hn::Mul(sum, perStep);
    if (outside) {
      sum = hn::MulAdd(below, hn::GatherIndex(d, points, entryOf(zero)), sum);
      sum = hn::MulAdd(above, hn::GatherIndex(d, points, entryOf(last)), sum);
    }
    if (!hn::AllFalse(d, single)) sum = hn::IfThenElse(single, hn::GatherIndex(d, points, nearest), sum);
    return hn::Max(sum, zero);
  };
  return {mean(0), mean(1), mean(2), mean(3)};
}

// The light that arrives at the middle of a part, by channel.
struct Arriving {
  Floats red, green, blue, power;
};

class Accumulator {
 public:
  Accumulator(const RowRays& rays, const RowSegment& segment, int at) : rays_(rays), at_(at) {
    const Lanes d;
    opacity_ = hn::LoadU(d, rays.opacity + at);
    red_ = hn::LoadU(d, rays.red + at);
    green_ = hn::LoadU(d, rays.green + at);
    blue_ = hn::LoadU(d, rays.blue + at);
    seen_ = depth_ = middle_ = hn::Zero(d);
    if (rays.seen) {
      seen_ = hn::LoadU(d, rays.seen + at);
      depth_ = hn::LoadU(d, rays.depth + at);
      middle_ = hn::Set(d, 0.5f * (segment.from + segment.to));
    }
  }

  // sigma_s times the factor of the slab is what a ray of this length scatters, of light 1.
  HWY_INLINE void add(const MeanMedium& medium, Floats tau, Floats length, const Arriving& light) {
    const Lanes d;
    const Floats factor = slabFactorOf(d, tau), through = hn::Sub(hn::Set(d, 1.0f), opacity_);
    const Floats scattered = hn::Mul(hn::Mul(factor, length), through);
    const Floats gained = hn::Mul(hn::Mul(factor, tau), through);
    red_ = hn::MulAdd(hn::Mul(scattered, light.red), medium.red, red_);
    green_ = hn::MulAdd(hn::Mul(scattered, light.green), medium.green, green_);
    blue_ = hn::MulAdd(hn::Mul(scattered, light.blue), medium.blue, blue_);
    opacity_ = hn::Add(opacity_, gained);
    if (rays_.seen) {
      seen_ = hn::MulAdd(gained, light.power, seen_);
      depth_ = hn::MulAdd(gained, middle_, depth_);
    }
  }

  // A piece whose opacity is known, with its albedo.
  HWY_INLINE void add(const StretchPiece<Floats>& piece, const Arriving& light) {
    const Lanes d;
    const Floats gained = hn::Mul(piece.alpha, hn::Sub(hn::Set(d, 1.0f), opacity_));
    red_ = hn::MulAdd(hn::Mul(gained, light.red), piece.red, red_);
    green_ = hn::MulAdd(hn::Mul(gained, light.green), piece.green, green_);
    blue_ = hn::MulAdd(hn::Mul(gained, light.blue), piece.blue, blue_);
    opacity_ = hn::Add(opacity_, gained);
    if (rays_.seen) {
      seen_ = hn::MulAdd(gained, light.power, seen_);
      depth_ = hn::MulAdd(gained, middle_, depth_);
    }
  }
  HWY_INLINE Floats through() const { return hn::Sub(hn::Set(Lanes(), 1.0f), opacity_); }

  HWY_INLINE void store() const {
    const Lanes d;
    hn::StoreU(opacity_, d, rays_.opacity + at_);
    hn::StoreU(red_, d, rays_.red + at_);
    hn::StoreU(green_, d, rays_.green + at_);
    hn::StoreU(blue_, d, rays_.blue + at_);
    if (rays_.seen) {
      hn::StoreU(seen_, d, rays_.seen + at_);
      hn::StoreU(depth_, d, rays_.depth + at_);
    }
  }

 private:
  const RowRays& rays_;
  int at_;
  Floats opacity_, red_, green_, blue_, seen_, depth_, middle_;
};

HWY_INLINE Arriving arrivingAt(Lanes d, const RowSegment& segment, const float* const* front, const float* const* back,
                               int at, Floats place) {
  const Floats one = hn::Set(d, 1.0f);
  if (segment.lights == 0) return {one, one, one, one};
  const auto light = [&](int c) HWY_ATTR {
    return between(hn::LoadU(d, front[2 + c] + at), hn::LoadU(d, back[2 + c] + at), place);
  };
  const Floats first = light(0);
  if (segment.lights == 1) return {first, first, first, first};
  const Floats second = light(1), third = light(2);
  Floats power = hn::Mul(first, hn::Set(d, segment.power[0]));
  power = hn::MulAdd(second, hn::Set(d, segment.power[1]), power);
  power = hn::MulAdd(third, hn::Set(d, segment.power[2]), power);
  return {first, second, third, power};
}

// A number at the front and at the back of a part.
struct PartEnds {
  Floats front, back;
};

// Adds the space between two slices of classified voxels, between which the medium runs linearly.
HWY_INLINE void addClassified(const RowSegment& segment, Accumulator& sum, const float* const* front,
                              const float* const* back, int at, Floats begin, Floats end, Floats length) {
  const Lanes d;
  const auto read = [&](int field) HWY_ATTR {
    const Floats a = hn::LoadU(d, front[field] + at), b = hn::LoadU(d, back[field] + at);
    return PartEnds{between(a, b, begin), between(a, b, end)};
  };
  const PartEnds sigma = read(0), red = read(kColourFields), green = read(kColourFields + 1),
                 blue = read(kColourFields + 2);
  const Floats tau = hn::Mul(hn::Mul(hn::Set(d, 0.5f), hn::Add(sigma.front, sigma.back)), length);
  if (hn::AllFalse(d, hn::Gt(tau, hn::Zero(d)))) return;
  const Floats one = hn::Set(d, 1.0f);
  const Arriving light{one, one, one, one};
  const int parts = segment.midpoint || hn::AllFalse(d, hn::Gt(tau, hn::Set(d, 0.1f))) ? 1 : 8;
  const Floats part = hn::Mul(hn::Set(d, 1.0f / static_cast<float>(parts)), length);
  for (int i = 0; i < parts; ++i) {
    const Floats place = hn::Set(d, (static_cast<float>(i) + 0.5f) / static_cast<float>(parts));
    const auto mean = [&](const PartEnds& ends) HWY_ATTR { return between(ends.front, ends.back, place); };
    const MeanMedium medium{mean(sigma), mean(red), mean(green), mean(blue)};
    sum.add(medium, hn::Mul(medium.sigma_t, part), part, light);
  }
}

// Adds what a part of a ray emits: the mean radiance per length over the values of the second grid, which run linearly
// as those of the first do, and what of it gets out of the part. Over a part of constant sigma_t and emission that is
// their product with the length and with (1 - exp(-tau)) / tau. Where a part is thick it is cut into four or eight.
// @param value,gradient,glow  fields at both ends of the part
HWY_INLINE void addEmitted(const MediumTable& table, const RowSegment& segment, const RowRays& rays, int at,
                           const PartEnds& value, const PartEnds& gradient, PartEnds glow, Floats length) {
  const Lanes d;
  const Floats far = hn::Set(d, 1e30f);  // so that differences are finite
  glow = {hn::Max(hn::Min(glow.front, far), hn::Neg(far)), hn::Max(hn::Min(glow.back, far), hn::Neg(far))};
  const Floats zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const LinearMedium medium(table), emission(*segment.emission);
  const TableEnd glowFirst = emission.end(d, hn::Round(glow.front)), glowLast = emission.end(d, hn::Round(glow.back));
  const Floats most = emission.mean(d, emission.part(d, glowFirst, glowLast), glowFirst, glowLast, 0);
  if (hn::AllFalse(d, hn::Gt(most, zero))) return;
  const auto sigmaOver = [&](Floats begin, Floats end) HWY_ATTR {
    const Floats from = between(value.front, value.back, begin), to = between(value.front, value.back, end);
    if (table.is2d())
      return meanOnRow(d, table, from, to, between(gradient.front, gradient.back, hn::Mul(half, hn::Add(begin, end))))
          .sigma_t;
    const TableEnd a = medium.end(d, hn::Round(from)), b = medium.end(d, hn::Round(to));
    return medium.mean(d, medium.part(d, a, b), a, b, 0);
  };
  const Floats tau = hn::Mul(sigmaOver(zero, one), length);
  const auto thick = hn::Gt(tau, hn::Set(d, 0.1f)), thicker = hn::Gt(tau, one);
  const Floats size = hn::IfThenElse(thicker, hn::Set(d, 0.125f), hn::IfThenElse(thick, hn::Set(d, 0.25f), one));
  const int parts = hn::AllFalse(d, thick) ? 1 : hn::AllFalse(d, thicker) ? 4 : 8;
  Floats through = hn::Sub(one, hn::LoadU(d, rays.opacity + at)), done = zero;
  Floats colour[3];
  for (std::size_t c = 0; c < 3; ++c) colour[c] = hn::LoadU(d, rays.emitted[c] + at);
  TableEnd before = glowFirst;
  emission.addColours(d, before);
  for (int i = 0; i < parts; ++i) {
    // Rays that are through get parts of no length.
    const Floats until = hn::Min(hn::Add(done, size), one), part = hn::Mul(hn::Sub(until, done), length);
    const Floats depth = parts == 1 ? tau : hn::Mul(sigmaOver(done, until), part);
    TableEnd next = emission.end(d, hn::Round(between(glow.front, glow.back, until)));
    emission.addColours(d, next);
    const auto piece = emission.part(d, before, next);
    const Floats out = hn::Mul(hn::Mul(through, part), slabFactorOf(d, depth));
    for (int c = 0; c < 3; ++c) colour[c] = hn::MulAdd(out, emission.mean(d, piece, before, next, c + 1), colour[c]);
    through = hn::Mul(through, expNegative(d, depth));
    before = next;
    done = until;
  }
  for (std::size_t c = 0; c < 3; ++c) hn::StoreU(colour[c], d, rays.emitted[c] + at);
}

void integrateRowsOf(const MediumTable& table, const RowSegment& segment, const RowRays& rays, int first, int count,
                     const float* const* front, const float* const* back) {
  const Lanes d;
  const auto n = static_cast<int>(hn::Lanes(d));
  const LinearMedium linear(table);
  const bool is2d = table.is2d();
  const float whole = segment.to - segment.from;
  const Floats half = hn::Set(d, 0.5f), zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const Floats far = hn::Set(d, 1e30f);  // so that differences are finite; values may lie far beyond the table
  for (int group = first; group < first + count; group += kRayGroup) {
    for (int at = group; at < group + kRayGroup; at += n) {
      Floats from = hn::LoadU(d, front[0] + at), to = hn::LoadU(d, back[0] + at);
      Floats length = hn::Mul(hn::LoadU(d, rays.length + at), hn::Set(d, whole));
      Floats begin = zero, end = one;  // the part of the segment that is left
      if (segment.clipped) {
        const Floats start = hn::Set(d, segment.from), per = hn::Set(d, 1 / whole);
        begin = hn::Min(hn::Max(hn::Mul(hn::Sub(hn::LoadU(d, rays.enter + at), start), per), zero), one);
        end = hn::Min(hn::Max(hn::Mul(hn::Sub(hn::LoadU(d, rays.leave + at), start), per), begin), one);
        const Floats change = hn::Sub(to, from);
        to = hn::MulAdd(end, change, from);
        from = hn::MulAdd(begin, change, from);
        length = hn::Mul(length, hn::Sub(end, begin));
      }
      if (segment.classified) {
        Accumulator sum(rays, segment, at);
        addClassified(segment, sum, front, back, at, begin, end, length);
        sum.store();
        continue;
      }
      const Floats middle = hn::Mul(half, hn::Add(begin, end));
      from = hn::Max(hn::Min(from, far), hn::Neg(far));
      to = hn::Max(hn::Min(to, far), hn::Neg(far));
      if (segment.midpoint) from = to = hn::Mul(half, hn::Add(from, to));
      if (segment.emission) {
        const auto endsOf = [&](int field) HWY_ATTR {
          const Floats a = hn::LoadU(d, front[field] + at), b = hn::LoadU(d, back[field] + at);
          if (segment.midpoint) return PartEnds{between(a, b, middle), between(a, b, middle)};
          return PartEnds{between(a, b, begin), between(a, b, end)};
        };
        addEmitted(table, segment, rays, at, {from, to}, is2d ? endsOf(1) : PartEnds{zero, zero},
                   endsOf(kEmissionField), length);
      }
      if (is2d) {
        const Floats g0 = hn::LoadU(d, front[1] + at), g1 = hn::LoadU(d, back[1] + at);
        Accumulator sum(rays, segment, at);
        // Two halves, each with the gradient of its middle.
        const Floats part = hn::Mul(half, length);
        Floats value = from;
        for (const float share : {0.25f, 0.75f}) {
          const Floats place = between(begin, end, hn::Set(d, share));
          const Floats next = between(from, to, hn::Set(d, share + 0.25f));
          const MeanMedium medium =
              meanOnRow(d, table, value, next, between(g0, g1, segment.midpoint ? middle : place));
          sum.add(medium, hn::Mul(medium.sigma_t, part), part, arrivingAt(d, segment, front, back, at, place));
          value = next;
        }
        sum.store();
        continue;
      }
      const Floats exactFrom = from, exactTo = to;
      from = hn::Round(from);
      to = hn::Round(to);
      TableEnd begins = linear.end(d, from), ends = linear.end(d, to);
      const auto all = linear.part(d, begins, ends);
      const Floats sigma_t = linear.mean(d, all, begins, ends, 0), tau = hn::Mul(sigma_t, length);
      if (hn::AllFalse(d, hn::Gt(tau, zero))) continue;
      Accumulator sum(rays, segment, at);
      linear.addColours(d, begins);
      linear.addColours(d, ends);
      // Where a segment is thick, its front hides its back: it is taken in two or four parts, between which that is
      // exact. Each ray has its own parts, so that none depends on its neighbours: 1, 1/2 or 1/4 of the segment. Where
      // even a part may be opaque and of several colours, the table has stretches, over which all is exact.
      const auto ranges = hn::Gt(hn::Abs(hn::Sub(to, from)), one);
      const auto thick =
          table.stretches() ? hn::Gt(tau, hn::Set(d, 0.2f)) : hn::And(hn::Gt(tau, hn::Set(d, 0.2f)), ranges);
      if (hn::AllFalse(d, thick)) {
        const MeanMedium medium{sigma_t, linear.mean(d, all, begins, ends, 1), linear.mean(d, all, begins, ends, 2),
                                linear.mean(d, all, begins, ends, 3)};
        sum.add(medium, tau, length, arrivingAt(d, segment, front, back, at, middle));
      } else {
        auto byParts = hn::And(thick, ranges);
        if (const StretchTable* const stretches = table.stretches()) {
          const StretchWalk<Lanes> walk(d, *stretches, table.steps(), exactFrom, exactTo);
          const auto exactly = hn::And(thick, walk.isShort());
          byParts = hn::AndNot(exactly, thick);
          const auto add = [&](const StretchPiece<Floats>& piece) HWY_ATTR {
            sum.add(piece, arrivingAt(d, segment, front, back, at, between(begin, end, piece.place)));
            return hn::AllFalse(d, hn::And(exactly, hn::Gt(sum.through(), hn::Set(d, 1e-7f))));
          };
          const auto opacityOf = [&](Floats x) HWY_ATTR { return hn::Mul(x, slabFactorOf(d, x)); };
          if (!hn::AllFalse(d, exactly)) walk.along(length, exactly, opacityOf, add);
          length = hn::IfThenZeroElse(exactly, length);
        }
        const auto thicker = hn::And(hn::Gt(tau, hn::Set(d, 1.0f)), byParts);
        const Floats size = hn::IfThenElse(thicker, hn::Set(d, 0.25f), hn::IfThenElse(byParts, half, one));
        const int parts = hn::AllFalse(d, byParts) ? 1 : hn::AllFalse(d, thicker) ? 2 : 4;
        Floats done = zero;
        TableEnd before = begins;
        for (int i = 0; i < parts; ++i) {
          // Rays that are through get parts of no length.
          const Floats until = hn::Min(hn::Add(done, size), one), share = hn::Sub(until, done);
          const auto last = hn::Ge(until, one);
          TableEnd next = ends;
          if (!hn::AllTrue(d, last)) {
            next = linear.end(d, hn::IfThenElse(last, to, hn::Round(between(from, to, until))));
            linear.addColours(d, next);
          }
          const auto piece = linear.part(d, before, next);
          const MeanMedium medium{linear.mean(d, piece, before, next, 0), linear.mean(d, piece, before, next, 1),
                                  linear.mean(d, piece, before, next, 2), linear.mean(d, piece, before, next, 3)};
          const Floats part = hn::Mul(share, length);
          const Floats place = between(begin, end, hn::Mul(half, hn::Add(done, until)));
          sum.add(medium, hn::Mul(medium.sigma_t, part), part, arrivingAt(d, segment, front, back, at, place));
          before = next;
          done = until;
        }
      }
      sum.store();
    }
    bool full = segment.saturation > 0;
    for (int at = group; full && at < group + kRayGroup; at += n)
      full = hn::AllTrue(d, hn::Ge(hn::LoadU(d, rays.opacity + at), hn::Set(d, 1 - segment.saturation)));
    if (full) rays.full[group / kRayGroup] = 1;
  }
}

}  // namespace
}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace umbrick {
HWY_EXPORT(blendRowsOf);
HWY_EXPORT(sampleRowsOf);
HWY_EXPORT(integrateRowsOf);

void blendRows(VoxelCode code, const VoxelRows& rows, int count, float* out) {
  HWY_DYNAMIC_DISPATCH(blendRowsOf)(code, rows, count, out);
}

void sampleRows(const RowPlaces& places, int first, int count, int length, int fields, const float* const* rows,
                float* const* out) {
  HWY_DYNAMIC_DISPATCH(sampleRowsOf)(places, first, count, length, fields, rows, out);
}

void integrateRows(const MediumTable& table, const RowSegment& segment, const RowRays& rays, int first, int count,
                   const float* const* front, const float* const* back) {
  HWY_DYNAMIC_DISPATCH(integrateRowsOf)(table, segment, rays, first, count, front, back);
}

}  // namespace umbrick
#endif
