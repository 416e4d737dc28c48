// The integral over the stretches of a transfer function, one after another, as shaders/shade/medium.glsl has it;
// Highway compiles this for each set of instructions.
// SPDX-License-Identifier: Apache-2.0

#if defined(UMBRICK_SWEEP_STRETCHES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef UMBRICK_SWEEP_STRETCHES_INL_H_
#undef UMBRICK_SWEEP_STRETCHES_INL_H_
#else
#define UMBRICK_SWEEP_STRETCHES_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>

#include "sweep/stretch_table.h"

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {
namespace {

// A piece of a ray within one stretch: its medium, and the place from which it scatters on average, as a share of the
// way.
template <class V>
struct StretchPiece {
  V place, tau, alpha, red, green, blue;
};

// Where the light comes from that a piece scatters, see scatteringCentroid of shaders/optics/ramp.glsl.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V centroidOf(D d, V front, V back, V tau, V alpha) {
  namespace hn = hwy::HWY_NAMESPACE;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const V sum = hn::Add(front, back);
  const V share = hn::IfThenElse(hn::Gt(sum, zero), hn::Div(front, hn::Max(sum, hn::Set(d, 1e-30f))), half);
  const V curve = hn::NegMulAdd(hn::Set(d, 2.0f), share, one), square = hn::Mul(share, share);
  const auto thick = hn::Gt(tau, hn::Set(d, 1e-3f));
  const V thin = hn::Div(one, hn::Max(tau, hn::Set(d, 1e-3f)));
  const auto at = [&](float w) HWY_ATTR {
    const V weight = hn::Set(d, w);
    const V depth =
        hn::IfThenElse(thick, hn::Neg(hn::Mul(hn::Log(d, hn::NegMulAdd(weight, alpha, one)), thin)), weight);
    const V root = hn::Sqrt(hn::Max(hn::MulAdd(curve, depth, square), zero));
    return hn::Div(depth, hn::Max(hn::Add(share, root), hn::Set(d, 1e-30f)));
  };
  const V outer = hn::Add(at(0.11270167f), at(0.88729833f));
  return hn::Mul(hn::MulAdd(hn::Set(d, 5.0f), outer, hn::Mul(hn::Set(d, 8.0f), at(0.5f))), hn::Set(d, 1.0f / 18));
}

// The way of rays from one value to another through the stretches of a function, front to back.
template <class D>
class StretchWalk {
 public:
  using V = hwy::HWY_NAMESPACE::Vec<D>;
  using Mask = hwy::HWY_NAMESPACE::Mask<D>;
  using Numbers = hwy::HWY_NAMESPACE::RebindToSigned<D>;
  using Ints = hwy::HWY_NAMESPACE::Vec<Numbers>;

  HWY_INLINE StretchWalk(D d, const StretchTable& table, int steps, V from, V to)
      : d_(d), table_(table), steps_(steps), from_(from), to_(to), first_(stretchOf(from)), last_(stretchOf(to)) {}

  // Tells which rays go through few stretches. Where they are many, each is a small part of the way.
  HWY_INLINE Mask isShort() const {
    constexpr int kMost = 24;
    namespace hn = hwy::HWY_NAMESPACE;
    return hn::RebindMask(d_, hn::Lt(hn::Abs(hn::Sub(last_, first_)), hn::Set(Numbers(), kMost)));
  }

  // Takes the rays of `mask` along their way.
  // @param opacityOf  of optical depths, without cancellation
  // @param add        is given each piece, whose lanes beside the mask are empty; returns whether all rays are full
  template <class OpacityOf, class Add>
  HWY_INLINE void along(V length, Mask mask, const OpacityOf& opacityOf, const Add& add) const {
    namespace hn = hwy::HWY_NAMESPACE;
    const D d = d_;
    const Numbers di;
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Ints oneMore = hn::Set(di, 1);
    const auto up = hn::Gt(last_, first_);
    const Ints towards = hn::IfThenElse(up, oneMore, hn::Neg(oneMore));
    const auto upwards = hn::RebindMask(d, up);
    const V change = hn::Sub(to_, from_);
    const V perValue = hn::Div(one, hn::IfThenElse(hn::Eq(change, zero), one, change));
    Ints number = first_;
    V value = from_, done = zero;
    while (true) {
      const Ints entry = entryOf(number);
      const auto read = [&](int i) HWY_ATTR { return hn::GatherIndex(d, table_.numbers() + i, entry); };
      const V lower = read(0), upper = read(1), low = read(2), high = read(3);
      const auto isLast = hn::RebindMask(d, hn::Eq(number, last_));
      const V end = hn::IfThenElse(isLast, to_, hn::IfThenElse(upwards, upper, lower));
      const V share = hn::Min(hn::Max(hn::Mul(hn::Sub(end, from_), perValue), done), one);
      const V until = hn::IfThenElse(isLast, one, share), part = hn::Sub(until, done);
      // Where the value lies between the ends of the stretch, at the front and at the back of the piece.
      const V perStretch = hn::Div(one, hn::Max(hn::Sub(upper, lower), hn::Set(d, 1e-37f)));
      const auto placeOf = [&](V at) HWY_ATTR {
        return hn::Min(hn::Max(hn::Mul(hn::Sub(at, lower), perStretch), zero), one);
      };
      const V a = placeOf(value), b = placeOf(end), span = hn::Sub(high, low);
      const V front = hn::MulAdd(a, span, low), back = hn::MulAdd(b, span, low);
      StretchPiece<V> piece;
      const V ray = hn::IfThenElseZero(mask, hn::Mul(part, length));
      piece.tau = hn::Mul(hn::Mul(hn::Set(d, 0.5f), hn::Add(front, back)), ray);
      piece.alpha = opacityOf(piece.tau);
      const V centroid = centroidOf(d, front, back, piece.tau, piece.alpha);
      piece.place = hn::MulAdd(centroid, part, done);
      const V lit = hn::MulAdd(centroid, hn::Sub(b, a), a);
      const auto albedo = [&](int c) HWY_ATTR {
        const V at = read(4 + c);
        return hn::MulAdd(lit, hn::Sub(read(7 + c), at), at);
      };
      piece.red = albedo(0);
      piece.green = albedo(1);
      piece.blue = albedo(2);
      const bool full = add(piece);
      mask = hn::AndNot(isLast, mask);
      if (full || hn::AllFalse(d, mask)) return;
      number = hn::IfThenElse(hn::RebindMask(di, mask), hn::Add(number, towards), number);
      value = end;
      done = until;
    }
  }

 private:
  static HWY_INLINE Ints entryOf(Ints number) {
    namespace hn = hwy::HWY_NAMESPACE;
    static_assert(StretchTable::kNumbers == 12);
    return hn::Add(hn::ShiftLeft<3>(number), hn::ShiftLeft<2>(number));
  }

  HWY_INLINE Ints stretchOf(V value) const {
    namespace hn = hwy::HWY_NAMESPACE;
    const Numbers di;
    const V within = hn::Min(hn::Max(value, hn::Zero(d_)), hn::Set(d_, static_cast<float>(steps_)));
    Ints number = hn::GatherIndex(di, table_.stretchAt(), hn::ConvertTo(di, within));
    // Several stretches may end within a step. The last one ends nowhere.
    while (true) {
      const auto beyond = hn::Ge(value, hn::GatherIndex(d_, table_.numbers() + 1, entryOf(number)));
      if (hn::AllFalse(d_, beyond)) return number;
      number = hn::IfThenElse(hn::RebindMask(di, beyond), hn::Add(number, hn::Set(di, 1)), number);
    }
  }

  D d_;
  const StretchTable& table_;
  int steps_;
  V from_, to_;
  Ints first_, last_;
};

}  // namespace
}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
