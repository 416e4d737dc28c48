// Gathers voxels for the lanes of a register. Highway compiles this for each set of instructions, so that it stands in
// the target's namespace and has no guard of the usual kind.
// SPDX-License-Identifier: Apache-2.0
#if defined(UMBRICK_VOXEL_GATHER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMBRICK_VOXEL_GATHER_INL_H
#undef UMBRICK_VOXEL_GATHER_INL_H
#else
#define UMBRICK_VOXEL_GATHER_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {

/// Two voxels that are neighbours, as floats.
template <class D>
struct GatheredPair {
  hwy::HWY_NAMESPACE::Vec<D> a, b;
};

/// Gathers voxels and the ones `stride` behind them. Narrow neighbours in memory come with one read of four bytes, of
/// which the first ones count; arrays of voxels end with some more bytes for that (BrickVoxels::kPadding).
template <class D, class N>
HWY_INLINE GatheredPair<D> gatherPair(D d, const std::uint8_t* from, N index, std::ptrdiff_t stride) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::RebindToSigned<D> di;
  const auto mask = hn::Set(di, 0xff);
  const auto near = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), index);
  const auto next = stride == 1 ? hn::ShiftRight<8>(near)
                                : hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from + stride), index);
  return {hn::ConvertTo(d, hn::And(near, mask)), hn::ConvertTo(d, hn::And(next, mask))};
}
template <class D, class N>
HWY_INLINE GatheredPair<D> gatherPair(D d, const std::uint16_t* from, N index, std::ptrdiff_t stride) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::RebindToSigned<D> di;
  const auto mask = hn::Set(di, 0xffff);
  const auto bytes = hn::ShiftLeft<1>(index);
  const auto near = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), bytes);
  const auto next = stride == 1 ? hn::ShiftRight<16>(near)
                                : hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from + stride), bytes);
  return {hn::ConvertTo(d, hn::And(near, mask)), hn::ConvertTo(d, hn::And(next, mask))};
}
template <class D, class N>
HWY_INLINE GatheredPair<D> gatherPair(D d, const float* from, N index, std::ptrdiff_t stride) {
  namespace hn = hwy::HWY_NAMESPACE;
  return {hn::GatherIndex(d, from, index), hn::GatherIndex(d, from + stride, index)};
}

}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
