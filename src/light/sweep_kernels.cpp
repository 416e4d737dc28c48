// SPDX-License-Identifier: Apache-2.0
#include "light/sweep_kernels.h"

#include "umbrick/light/extinction_table.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/sweep_kernels.cpp"
#include "core/simd_targets.h"

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using PathLanes = hn::CappedTag<float, kRowPadding / 2>;
using PathNumbers = hn::Rebind<std::int32_t, PathLanes>;
using PathFloats = hn::Vec<PathLanes>;
using PathInts = hn::Vec<PathNumbers>;

// Light outside of a cut is continued over so many places of light. Where the next one within lies nearer to the cut
// than kNear, the slope is that over kNear.
constexpr float kBeyond = 3, kNear = 0.125f;
// Behind the medium it goes on falling for so many slices.
constexpr float kBehind = 2;

// exp(-x) within 3e-7 of it for x up to kDarkDepth, 1 exactly at 0, and 0 from there on.
HWY_INLINE PathFloats expNegative(PathLanes d, PathFloats x) {
  const PathNumbers di;
  const PathFloats y = hn::Mul(hn::Min(x, hn::Set(d, 80.0f)), hn::Set(d, -1.44269504f));
  const PathFloats whole = hn::Round(y);
  const PathFloats f = hn::Mul(hn::Sub(y, whole), hn::Set(d, 0.69314718f));  // in [-0.347, 0.347]
  PathFloats p = hn::Set(d, 1.0f / 720);
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f / 120));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f / 24));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f / 6));
  p = hn::MulAdd(p, f, hn::Set(d, 0.5f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  const PathInts exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(di, whole), hn::Set(di, 127)));
  return hn::IfThenElseZero(hn::Lt(x, hn::Set(d, kDarkDepth)), hn::Mul(p, hn::BitCast(d, exponent)));
}

// As a + share (b - a): equal numbers give theirs to the last bit.
HWY_INLINE PathFloats between(PathFloats a, PathFloats b, PathFloats share) {
  return hn::MulAdd(share, hn::Sub(b, a), a);
}

template <int kSpacing>
HWY_INLINE PathFloats valuesAt(PathLanes d, const PathRow& row, int i) {
  const PathFloats u = hn::Set(d, row.u), v = hn::Set(d, row.v);
  const float *near = row.near + i * kSpacing, *far = row.far + i * kSpacing;
  PathFloats nearLeft, nearRight, farLeft, farRight;
  if constexpr (kSpacing == 2) {
    hn::LoadInterleaved2(d, near, nearLeft, nearRight);
    hn::LoadInterleaved2(d, far, farLeft, farRight);
  } else {
    nearLeft = hn::LoadU(d, near);
    nearRight = hn::LoadU(d, near + 1);
    farLeft = hn::LoadU(d, far);
    farRight = hn::LoadU(d, far + 1);
  }
  return between(between(nearLeft, farLeft, v), between(nearRight, farRight, v), u);
}

/// The mean of sigma_t over values that run linearly.
class MeanExtinction {
 public:
  explicit MeanExtinction(const PathMedium& medium) : medium_(medium) {}

  // Lanes whose values all lie at an end of the function where there is no extinction.
  HWY_INLINE hn::Mask<PathLanes> empty(PathLanes d, PathFloats from, PathFloats to) const {
    return hn::Or(hn::Le(hn::Max(from, to), hn::Set(d, medium_.emptyBelow)),
                  hn::Ge(hn::Min(from, to), hn::Set(d, medium_.emptyAbove)));
  }

  // Ends count as the nearest steps of the table.
  HWY_INLINE PathFloats operator()(PathLanes d, PathFloats from, PathFloats to, hn::Mask<PathLanes> empty) const {
    const PathFloats zero = hn::Zero(d), last = hn::Set(d, static_cast<float>(ExtinctionTable::kSteps));
    const PathFloats a = hn::Round(from), b = hn::Round(to), change = hn::Sub(b, a);
    const PathFloats insideA = hn::Min(hn::Max(a, zero), last), insideB = hn::Min(hn::Max(b, zero), last);
    const PathFloats sumA = hn::GatherIndex(d, medium_.integrals, hn::ConvertTo(PathNumbers(), insideA));
    const PathFloats sumB = hn::GatherIndex(d, medium_.integrals, hn::ConvertTo(PathNumbers(), insideB));
    // Beyond the table sigma_t is constant, and the same as in its first and last step.
    PathFloats sum = hn::Sub(sumB, sumA);
    sum = hn::MulAdd(hn::Sub(hn::Min(b, zero), hn::Min(a, zero)), hn::Set(d, medium_.below), sum);
    sum = hn::MulAdd(hn::Sub(hn::Max(b, last), hn::Max(a, last)), hn::Set(d, medium_.above), sum);
    const auto single = hn::Eq(change, zero);
    PathFloats mean = hn::Div(sum, hn::IfThenElse(single, hn::Set(d, 1.0f), change));
    if (!hn::AllFalse(d, hn::AndNot(empty, single))) mean = hn::IfThenElse(single, at(d, from), mean);
    return hn::IfThenZeroElse(empty, hn::Max(mean, zero));
  }

  // sigma_t of the step that a value lies in.
  HWY_INLINE PathFloats at(PathLanes d, PathFloats value) const {
    const PathFloats last = hn::Set(d, static_cast<float>(ExtinctionTable::kSteps));
    return hn::GatherIndex(d, medium_.means, hn::ConvertTo(PathNumbers(), hn::Min(hn::Max(value, hn::Zero(d)), last)));
  }

 private:
  const PathMedium& medium_;
};

// Optical depth of the surfaces that lie between two values. A voxel is inside of one where its value is larger.
HWY_INLINE PathFloats crossed(PathLanes d, const PathMedium& medium, PathFloats from, PathFloats to) {
  PathFloats depth = hn::Zero(d);
  for (int i = 0; i < medium.surfaceCount; ++i) {
    const PathFloats value = hn::Set(d, medium.surfaces[i].value);
    const auto differ = hn::Xor(hn::Gt(from, value), hn::Gt(to, value));
    depth = hn::Add(depth, hn::IfThenElseZero(differ, hn::Set(d, medium.surfaces[i].depth)));
  }
  return depth;
}

template <int kSpacing>
void carry(const PathRow& before, const PathRow& here, const PathMedium& medium, float* depth, float* through,
           int count) {
  const PathLanes d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const MeanExtinction mean(medium);
  const PathFloats dark = hn::Set(d, kDarkDepth), length = hn::Set(d, medium.length);
  for (int i = 0; i < count; i += lanes) {
    const PathFloats old = hn::LoadU(d, depth + i);
    if (hn::AllTrue(d, hn::Ge(old, dark))) {
      if (through) hn::StoreU(hn::Zero(d), d, through + i);
      continue;
    }
    const PathFloats from = valuesAt<kSpacing>(d, before, i), to = valuesAt<kSpacing>(d, here, i);
    const auto empty = mean.empty(d, from, to);
    const PathFloats surfaces = crossed(d, medium, from, to);
    PathFloats after = old;
    if (!hn::AllTrue(d, empty) || !hn::AllTrue(d, hn::Eq(surfaces, hn::Zero(d)))) {
      after = hn::Add(hn::MulAdd(length, mean(d, from, to, empty), old), surfaces);
      const PathFloats own =
          count - i < lanes ? hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(count - i)), after, old) : after;
      hn::StoreU(own, d, depth + i);
    }
    if (through) hn::StoreU(expNegative(d, after), d, through + i);
  }
}

// (1 - exp(-x)) / x, and the means of 1 - t and of t with the weight exp(-x t) over t in [0, 1].
struct Means {
  PathFloats whole, first, last;
};
HWY_INLINE Means meansOver(PathLanes d, PathFloats x) {
  const PathFloats one = hn::Set(d, 1.0f), e = expNegative(d, x), safe = hn::Max(x, hn::Set(d, 0.25f));
  const PathFloats per = hn::Div(one, safe);
  const PathFloats whole = hn::Mul(hn::Sub(one, e), per);
  const PathFloats last = hn::Mul(hn::Sub(whole, e), per);
  // Power series where differences would cancel.
  PathFloats small = hn::Set(d, 1.0f / 120);
  small = hn::MulAdd(small, x, hn::Set(d, -1.0f / 24));
  small = hn::MulAdd(small, x, hn::Set(d, 1.0f / 6));
  small = hn::MulAdd(small, x, hn::Set(d, -0.5f));
  small = hn::MulAdd(small, x, one);
  PathFloats smallLast = hn::Set(d, 1.0f / 144);
  smallLast = hn::MulAdd(smallLast, x, hn::Set(d, -1.0f / 30));
  smallLast = hn::MulAdd(smallLast, x, hn::Set(d, 1.0f / 8));
  smallLast = hn::MulAdd(smallLast, x, hn::Set(d, -1.0f / 3));
  smallLast = hn::MulAdd(smallLast, x, hn::Set(d, 0.5f));
  const auto isSmall = hn::Lt(x, hn::Set(d, 0.25f));
  Means means;
  means.whole = hn::IfThenElse(isSmall, small, whole);
  means.last = hn::IfThenElse(isSmall, smallLast, last);
  means.first = hn::Sub(means.whole, means.last);
  return means;
}

// How much more light than arrives there is at so many voxels outside of a cut. Light that falls off like an
// exponential is read linearly between there and the first voxel within. An eye that looks straight at the cut shall
// see as much of it on this way as there is:
//
//     int_0^b exp(-eye t) (P + (exp(-tau b) - P) t / b) dt  =  int_0^b exp(-(eye + tau) t) dt
//
// gives P at the cut, from which the line goes on outwards. tau, eye: optical depths of the way between two places, for
// light and eye. Ways are in such places.
HWY_INLINE PathFloats continued(PathLanes d, PathFloats outside, PathFloats tau, PathFloats eye) {
  const PathFloats way = hn::Min(hn::Max(outside, hn::Zero(d)), hn::Set(d, kBeyond));
  const PathFloats within = hn::Max(hn::Sub(hn::Ceil(way), way), hn::Set(d, kNear));
  const PathFloats next = expNegative(d, hn::Mul(tau, within));
  const Means means = meansOver(d, hn::Mul(eye, within));
  const PathFloats seen = meansOver(d, hn::Mul(hn::Add(eye, tau), within)).whole;
  const PathFloats cut = hn::Div(hn::NegMulAdd(next, means.last, seen), means.first);
  return hn::MulAdd(way, hn::Div(hn::Sub(cut, next), within), cut);
}

template <int kSpacing>
void carryCut(const PathRow& before, const PathRow& here, const PathMedium& medium, const RowPlane* planes,
              int planeCount, float* depth, float* through, int count) {
  const PathLanes d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const MeanExtinction mean(medium);
  const PathFloats zero = hn::Zero(d), length = hn::Set(d, medium.length);
  for (int i = 0; i < count; i += lanes) {
    const PathFloats path = hn::Add(hn::ConvertTo(d, hn::Iota(PathNumbers(), 0)), hn::Set(d, static_cast<float>(i)));
    // The medium is between `enter` and `leave`, in slices from this one on.
    PathFloats enter = hn::Set(d, -1e9f), leave = hn::Set(d, 1e9f), perPlace = hn::Set(d, 1.0f), cosine = perPlace;
    for (int p = 0; p < planeCount; ++p) {
      const PathFloats crossing =
          hn::MulAdd(path, hn::Set(d, -planes[p].step / planes[p].rate), hn::Set(d, -planes[p].base / planes[p].rate));
      if (planes[p].rate > 0) {
        const auto later = hn::Gt(crossing, enter);
        perPlace = hn::IfThenElse(later, hn::Set(d, planes[p].slicesPerPlace), perPlace);
        cosine = hn::IfThenElse(later, hn::Set(d, planes[p].cosine), cosine);
        enter = hn::Max(enter, crossing);
      } else
        leave = hn::Min(leave, crossing);
    }
    const PathFloats from = valuesAt<kSpacing>(d, before, i), to = valuesAt<kSpacing>(d, here, i);
    const PathFloats begin = hn::Min(hn::Max(enter, hn::Set(d, -1.0f)), zero);
    const PathFloats end = hn::Max(hn::Min(leave, zero), begin);
    const PathFloats change = hn::Sub(to, from);
    const PathFloats first = hn::MulAdd(begin, change, to), last = hn::MulAdd(end, change, to);
    const PathFloats old = hn::LoadU(d, depth + i);
    const PathFloats way = hn::Mul(length, hn::Sub(end, begin));
    const PathFloats after = hn::Add(hn::MulAdd(way, mean(d, first, last, mean.empty(d, first, last)), old),
                                     crossed(d, medium, first, last));
    const PathFloats own =
        count - i < lanes ? hn::IfThenElse(hn::FirstN(d, static_cast<std::size_t>(count - i)), after, old) : after;
    hn::StoreU(own, d, depth + i);
    if (!through) continue;
    const PathFloats sigma_t = mean.at(d, to);
    const PathFloats behind = hn::Min(hn::Max(zero, hn::Neg(leave)), hn::Set(d, kBehind));
    PathFloats light = expNegative(d, hn::MulAdd(hn::Mul(length, behind), sigma_t, after));
    const PathFloats far = hn::Div(enter, perPlace);
    const auto outside = hn::And(hn::Gt(far, zero), hn::Lt(far, hn::Set(d, kBeyond)));
    if (!hn::AllFalse(d, outside)) {
      const PathFloats tau = hn::Mul(hn::Mul(sigma_t, length), perPlace);
      const PathFloats more = continued(d, far, tau, hn::Mul(tau, cosine));
      light = hn::IfThenElse(outside, hn::Mul(light, more), light);
    }
    hn::StoreU(light, d, through + i);
  }
}

void carryRowOf(const PathRow& before, const PathRow& here, const PathMedium& medium, int spacing, float* depth,
                float* through, int count) {
  spacing == 2 ? carry<2>(before, here, medium, depth, through, count)
               : carry<1>(before, here, medium, depth, through, count);
}

void carryCutRowOf(const PathRow& before, const PathRow& here, const PathMedium& medium, const RowPlane* planes,
                   int planeCount, int spacing, float* depth, float* through, int count) {
  spacing == 2 ? carryCut<2>(before, here, medium, planes, planeCount, depth, through, count)
               : carryCut<1>(before, here, medium, planes, planeCount, depth, through, count);
}

void addRowOf(const float* before, const float* after, const PathShare& share, int channels, std::int32_t* const* light,
              int count) {
  const PathLanes d;
  const PathNumbers di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const PathFloats u = hn::Set(d, share.u), v = hn::Set(d, share.v);
  for (int i = 0; i < count; i += lanes) {
    const PathFloats left = between(hn::LoadU(d, after + i - 1), hn::LoadU(d, before + i - 1), v);
    const PathFloats right = between(hn::LoadU(d, after + i), hn::LoadU(d, before + i), v);
    PathFloats sum = between(right, left, u);
    if (count - i < lanes) sum = hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(count - i)), sum);
    if (hn::AllTrue(d, hn::Eq(sum, hn::Zero(d)))) continue;
    for (int c = 0; c < channels; ++c) {
      const PathInts added = hn::NearestInt(hn::Mul(sum, hn::Set(d, share.weight[static_cast<std::size_t>(c)])));
      hn::StoreU(hn::Add(hn::LoadU(di, light[c] + i), added), di, light[c] + i);
    }
  }
}

}  // namespace
}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace umbrick {
HWY_EXPORT(carryRowOf);
HWY_EXPORT(carryCutRowOf);
HWY_EXPORT(addRowOf);

void carryRow(const PathRow& before, const PathRow& here, const PathMedium& medium, int spacing, float* depth,
              float* through, int count) {
  HWY_DYNAMIC_DISPATCH(carryRowOf)(before, here, medium, spacing, depth, through, count);
}

void carryCutRow(const PathRow& before, const PathRow& here, const PathMedium& medium, const RowPlane* planes,
                 int planeCount, int spacing, float* depth, float* through, int count) {
  HWY_DYNAMIC_DISPATCH(carryCutRowOf)(before, here, medium, planes, planeCount, spacing, depth, through, count);
}

void addRow(const float* before, const float* after, const PathShare& share, int channels, std::int32_t* const* light,
            int count) {
  HWY_DYNAMIC_DISPATCH(addRowOf)(before, after, share, channels, light, count);
}

}  // namespace umbrick
#endif
