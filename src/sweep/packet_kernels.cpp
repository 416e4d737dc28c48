// SPDX-License-Identifier: Apache-2.0
#include "sweep/packet_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/packet_kernels.cpp"
#include "core/simd_targets.h"

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using PacketLanes = hn::CappedTag<float, kRayGroup>;
using PacketNumbers = hn::Rebind<std::int32_t, PacketLanes>;
using PacketFloats = hn::Vec<PacketLanes>;
using PacketInts = hn::Vec<PacketNumbers>;

// Gathers codes of voxels. Narrow ones come four bytes at a time, of which the first ones count.
HWY_INLINE PacketFloats gatherCodes(PacketLanes d, const std::uint8_t* from, PacketInts index) {
  const PacketNumbers di;
  const PacketInts four = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), index);
  return hn::ConvertTo(d, hn::And(four, hn::Set(di, 0xff)));
}
HWY_INLINE PacketFloats gatherCodes(PacketLanes d, const std::uint16_t* from, PacketInts index) {
  const PacketNumbers di;
  const PacketInts two = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), hn::ShiftLeft<1>(index));
  return hn::ConvertTo(d, hn::And(two, hn::Set(di, 0xffff)));
}
// Widens 16-bit floats, the lower half of each number, to floats: exactly, none being infinite.
HWY_INLINE PacketFloats widened(PacketLanes d, PacketInts half) {
  const PacketNumbers di;
  const PacketInts size = hn::And(half, hn::Set(di, 0x7fff));
  const PacketInts sign = hn::ShiftLeft<16>(hn::And(half, hn::Set(di, 0x8000)));
  const PacketFloats normal = hn::BitCast(d, hn::Add(hn::ShiftLeft<13>(size), hn::Set(di, (127 - 15) << 23)));
  const PacketFloats small = hn::Mul(hn::ConvertTo(d, size), hn::Set(d, 0x1p-24f));
  const auto isSmall = hn::RebindMask(d, hn::Lt(size, hn::Set(di, 0x400)));
  return hn::BitCast(d, hn::Or(sign, hn::BitCast(di, hn::IfThenElse(isSmall, small, normal))));
}
HWY_INLINE PacketFloats gatherCodes(PacketLanes d, const HalfCode* from, PacketInts index) {
  const PacketNumbers di;
  return widened(d, hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), hn::ShiftLeft<1>(index)));
}
HWY_INLINE PacketFloats gatherCodes(PacketLanes d, const float* from, PacketInts index) {
  return hn::GatherIndex(d, from, index);
}

// A voxel and the next one in memory.
struct CodePair {
  PacketFloats a, b;
};
HWY_INLINE CodePair gatherPairs(PacketLanes d, const std::uint8_t* from, PacketInts index) {
  const PacketNumbers di;
  const PacketInts four = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), index);
  const PacketInts mask = hn::Set(di, 0xff);
  return {hn::ConvertTo(d, hn::And(four, mask)), hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(four), mask))};
}
HWY_INLINE CodePair gatherPairs(PacketLanes d, const std::uint16_t* from, PacketInts index) {
  const PacketNumbers di;
  const PacketInts two = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), hn::ShiftLeft<1>(index));
  const PacketInts mask = hn::Set(di, 0xffff);
  return {hn::ConvertTo(d, hn::And(two, mask)), hn::ConvertTo(d, hn::And(hn::ShiftRight<16>(two), mask))};
}
HWY_INLINE CodePair gatherPairs(PacketLanes d, const HalfCode* from, PacketInts index) {
  const PacketNumbers di;
  const PacketInts two = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(from), hn::ShiftLeft<1>(index));
  return {widened(d, two), widened(d, hn::ShiftRight<16>(two))};
}
HWY_INLINE CodePair gatherPairs(PacketLanes d, const float* from, PacketInts index) {
  return {hn::GatherIndex(d, from, index), hn::GatherIndex(d, from + 1, index)};
}

// As a + share (b - a): equal voxels give their value to the last bit.
HWY_INLINE PacketFloats mixed(PacketFloats a, PacketFloats b, PacketFloats share) {
  return hn::MulAdd(share, hn::Sub(b, a), a);
}

// Places of rays within the cells of a brick.
struct PacketCells {
  PacketInts index;  // of a cell's first voxel
  PacketFloats u, v;
};

template <class Code>
HWY_INLINE PacketFloats bilinear(PacketLanes d, const Code* from, const PacketSlice& slice, const PacketCells& cells) {
  const Code* const next = from + slice.strideV;
  if (slice.strideU == 1) {
    const CodePair near = gatherPairs(d, from, cells.index), far = gatherPairs(d, next, cells.index);
    return mixed(mixed(near.a, near.b, cells.u), mixed(far.a, far.b, cells.u), cells.v);
  }
  const PacketFloats a = gatherCodes(d, from, cells.index), b = gatherCodes(d, from + slice.strideU, cells.index);
  const PacketFloats c = gatherCodes(d, next, cells.index), e = gatherCodes(d, next + slice.strideU, cells.index);
  return mixed(mixed(a, b, cells.u), mixed(c, e, cells.u), cells.v);
}

template <class Code>
HWY_INLINE PacketFloats interpolated(PacketLanes d, const Code* from, const PacketSlice& slice,
                                     const PacketCells& cells) {
  PacketFloats value = bilinear(d, from, slice, cells);
  if (slice.n > 0) value = mixed(value, bilinear(d, from + slice.strideN, slice, cells), hn::Set(d, slice.n));
  return value;
}

HWY_INLINE PacketFloats valuesIn(PacketLanes d, const PacketBrick& brick, const PacketSlice& slice,
                                 const PacketCells& cells) {
  if (!brick.voxels) return hn::Set(d, brick.value);
  PacketFloats value;
  if (slice.code == VoxelCode::u8)
    value = interpolated(d, static_cast<const std::uint8_t*>(brick.voxels) + brick.first, slice, cells);
  else if (slice.code == VoxelCode::u16)
    value = interpolated(d, static_cast<const std::uint16_t*>(brick.voxels) + brick.first, slice, cells);
  else if (slice.code == VoxelCode::f16)
    value = interpolated(d, static_cast<const HalfCode*>(brick.voxels) + brick.first, slice, cells);
  else
    value = interpolated(d, static_cast<const float*>(brick.voxels) + brick.first, slice, cells);
  return hn::MulAdd(hn::Sub(value, hn::Set(d, slice.bias)), hn::Set(d, slice.factor), hn::Set(d, slice.first));
}

void samplePacketOf(const PacketSlice& slice, std::span<const PacketBrick> bricks, const float* acrossU,
                    const float* acrossV, float* const* fields) {
  const PacketLanes d;
  const PacketNumbers di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const PacketFloats spread = hn::Set(d, slice.spread);
  for (int at = 0; at < kRayGroup; at += lanes) {
    const PacketFloats u = hn::MulAdd(hn::LoadU(d, acrossU + at), spread, hn::Set(d, slice.u));
    const PacketFloats v = hn::MulAdd(hn::LoadU(d, acrossV + at), spread, hn::Set(d, slice.v));
    const PacketFloats wholeU = hn::Floor(u), wholeV = hn::Floor(v);
    const PacketInts cellU = hn::ConvertTo(di, wholeU), cellV = hn::ConvertTo(di, wholeV);
    for (const PacketBrick& brick : bricks) {
      const auto within =
          hn::And(hn::And(hn::Gt(cellU, hn::Set(di, brick.firstU - 1)), hn::Lt(cellU, hn::Set(di, brick.endU))),
                  hn::And(hn::Gt(cellV, hn::Set(di, brick.firstV - 1)), hn::Lt(cellV, hn::Set(di, brick.endV))));
      if (hn::AllFalse(di, within)) continue;
      const auto mine = hn::RebindMask(d, within);
      // Other rays read the first voxel, for nothing.
      const PacketInts inU = hn::Sub(cellU, hn::Set(di, brick.firstU)), inV = hn::Sub(cellV, hn::Set(di, brick.firstV));
      const PacketInts index = hn::Add(hn::Mul(inV, hn::Set(di, static_cast<std::int32_t>(slice.strideV))),
                                       hn::Mul(inU, hn::Set(di, static_cast<std::int32_t>(slice.strideU))));
      const PacketCells cells{hn::IfThenElseZero(within, index), hn::Sub(u, wholeU), hn::Sub(v, wholeV)};
      const auto store = [&](int field, PacketFloats value) HWY_ATTR {
        hn::StoreU(hn::IfThenElse(mine, value, hn::LoadU(d, fields[field] + at)), d, fields[field] + at);
      };
      if (slice.classified) {
        for (int c = 0; c < kMediumNumbers; ++c)
          store(c == 0 ? 0 : kColourFields + c - 1,
                brick.media ? interpolated(d, brick.media + brick.first + c * slice.lightStride, slice, cells)
                            : hn::Zero(d));
        continue;
      }
      store(0, valuesIn(d, brick, slice, cells));
      if (slice.gradients)
        store(1, brick.gradients ? hn::MulAdd(interpolated(d, brick.gradients + brick.first, slice, cells),
                                              hn::Set(d, slice.gradientFactor), hn::Set(d, slice.gradientFirst))
                                 : hn::Set(d, slice.gradientFirst));
      if (slice.emits)
        store(kEmissionField, brick.emission
                                  ? hn::MulAdd(hn::Sub(interpolated(d, brick.emission + brick.first, slice, cells),
                                                       hn::Set(d, slice.emissionBias)),
                                               hn::Set(d, slice.emissionFactor), hn::Set(d, slice.emissionFirst))
                                  : hn::Set(d, brick.emissionValue));
      for (int c = 0; c < slice.lights; ++c)
        store(2 + c, brick.light
                         ? hn::Mul(interpolated(d, brick.light + brick.first + c * slice.lightStride, slice, cells),
                                   hn::Set(d, slice.lightUnit))
                         : hn::LoadU(d, fields[2 + c] + at));
    }
  }
}

}  // namespace
}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace umbrick {
HWY_EXPORT(samplePacketOf);

void samplePacket(const PacketSlice& slice, std::span<const PacketBrick> bricks, const float* acrossU,
                  const float* acrossV, float* const* fields) {
  HWY_DYNAMIC_DISPATCH(samplePacketOf)(slice, bricks, acrossU, acrossV, fields);
}

}  // namespace umbrick
#endif
