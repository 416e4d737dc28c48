// SPDX-License-Identifier: Apache-2.0
#include "sweep/projection_kernels.h"

// See row_kernels.cpp.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sweep/projection_kernels.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sweep/voxel_gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace umbrick::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using ProjectionLanes = hn::CappedTag<float, kRayGroup>;
using ProjectionNumbers = hn::Rebind<std::int32_t, ProjectionLanes>;
using ProjectionFloats = hn::Vec<ProjectionLanes>;
using ProjectionInts = hn::Vec<ProjectionNumbers>;

// As a + share (b - a): a share of 0 gives the voxel itself.
HWY_INLINE ProjectionFloats projectionMix(ProjectionFloats a, ProjectionFloats b, ProjectionFloats share) {
  return hn::MulAdd(share, hn::Sub(b, a), a);
}

template <class Code>
HWY_INLINE ProjectionFloats valueOnSlice(ProjectionLanes d, const Code* from, const ProjectionBrick& brick,
                                         ProjectionInts index, ProjectionFloats u, ProjectionFloats v) {
  const auto near = gatherPair(d, from, index, brick.strideU);
  const auto far = gatherPair(d, from + brick.strideV, index, brick.strideU);
  return projectionMix(projectionMix(near.a, near.b, u), projectionMix(far.a, far.b, u), v);
}

// Adds one slice's samples to what the rays have.
template <ProjectionKind kKind>
HWY_INLINE void addSamples(ProjectionLanes d, ProjectionFloats value, ProjectionFloats n, float step,
                           ProjectionFloats low, ProjectionFloats high, hn::Mask<ProjectionLanes> mine, float* result) {
  const ProjectionFloats before = hn::LoadU(d, result);
  if constexpr (kKind == ProjectionKind::largest) {
    hn::StoreU(hn::IfThenElse(mine, hn::Max(before, value), before), d, result);
  } else if constexpr (kKind == ProjectionKind::smallest) {
    hn::StoreU(hn::IfThenElse(mine, hn::Min(before, value), before), d, result);
  } else {
    // A sample stands for half of the way to each neighbour, or to the ray's end.
    const ProjectionFloats reach = hn::Set(d, step);
    const ProjectionFloats way = hn::Sub(hn::Min(hn::Add(n, reach), high), hn::Max(hn::Sub(n, reach), low));
    const ProjectionFloats weight = hn::Mul(hn::Set(d, 0.5f), hn::Max(way, hn::Zero(d)));
    hn::StoreU(hn::IfThenElse(mine, hn::MulAdd(weight, value, before), before), d, result);
  }
}

template <ProjectionKind kKind, class Code>
void project(const ProjectionPath& path, const ProjectionBrick& brick, int per, int begin, int end, float* result) {
  const ProjectionLanes d;
  const ProjectionNumbers di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const float step = 1 / static_cast<float>(per);
  const auto* const voxels = static_cast<const Code*>(brick.voxels);
  const ProjectionFloats offset =
      hn::Set(d, kKind == ProjectionKind::sum ? brick.offset - brick.background : brick.offset);
  const ProjectionFloats uniform =
      hn::Set(d, kKind == ProjectionKind::sum ? brick.value - brick.background : brick.value);
  for (int at = 0; at < kRayGroup; at += lanes) {
    const ProjectionFloats u0 = hn::LoadU(d, path.u.data() + at), v0 = hn::LoadU(d, path.v.data() + at);
    const ProjectionFloats slopeU = hn::LoadU(d, path.slopeU.data() + at),
                           slopeV = hn::LoadU(d, path.slopeV.data() + at);
    const ProjectionFloats low = hn::LoadU(d, path.low.data() + at), high = hn::LoadU(d, path.high.data() + at);
    const ProjectionFloats first = hn::LoadU(d, path.first.data() + at), last = hn::LoadU(d, path.last.data() + at);
    for (int slice = begin; slice < end; ++slice) {
      const ProjectionFloats number = hn::Set(d, static_cast<float>(slice)), n = hn::Mul(number, hn::Set(d, step));
      const ProjectionFloats u = hn::MulAdd(slopeU, n, u0), v = hn::MulAdd(slopeV, n, v0);
      const ProjectionFloats wholeU = hn::Floor(u), wholeV = hn::Floor(v);
      const ProjectionInts cellU = hn::ConvertTo(di, wholeU), cellV = hn::ConvertTo(di, wholeV);
      const auto inU = hn::And(hn::Gt(cellU, hn::Set(di, brick.firstU - 1)), hn::Lt(cellU, hn::Set(di, brick.endU)));
      const auto inV = hn::And(hn::Gt(cellV, hn::Set(di, brick.firstV - 1)), hn::Lt(cellV, hn::Set(di, brick.endV)));
      const auto within = hn::And(inU, inV);
      const auto mine = hn::And(hn::RebindMask(d, within), hn::And(hn::Ge(number, first), hn::Le(number, last)));
      if (hn::AllFalse(d, mine)) continue;
      if (!voxels) {
        addSamples<kKind>(d, uniform, n, step, low, high, mine, result + at);
        continue;
      }
      // Other rays read the first voxel, for nothing.
      const ProjectionInts place = hn::Add(
          hn::Mul(hn::Sub(cellV, hn::Set(di, brick.firstV)), hn::Set(di, static_cast<std::int32_t>(brick.strideV))),
          hn::Mul(hn::Sub(cellU, hn::Set(di, brick.firstU)), hn::Set(di, static_cast<std::int32_t>(brick.strideU))));
      const ProjectionInts index = hn::IfThenElseZero(hn::RebindMask(di, mine), place);
      const ProjectionFloats shareU = hn::Sub(u, wholeU), shareV = hn::Sub(v, wholeV);
      const Code* const from = voxels + brick.first + (slice / per) * brick.strideN;
      ProjectionFloats value = valueOnSlice(d, from, brick, index, shareU, shareV);
      if (slice % per != 0)
        value = projectionMix(value, valueOnSlice(d, from + brick.strideN, brick, index, shareU, shareV),
                              hn::Set(d, static_cast<float>(slice % per) * step));
      addSamples<kKind>(d, hn::Add(value, offset), n, step, low, high, mine, result + at);
    }
  }
}

template <ProjectionKind kKind>
void projectOf(const ProjectionPath& path, const ProjectionBrick& brick, int per, int begin, int end, float* result) {
  if (brick.code == VoxelCode::u8)
    project<kKind, std::uint8_t>(path, brick, per, begin, end, result);
  else if (brick.code == VoxelCode::u16)
    project<kKind, std::uint16_t>(path, brick, per, begin, end, result);
  else
    project<kKind, float>(path, brick, per, begin, end, result);
}

void projectBrickOf(ProjectionKind kind, const ProjectionPath& path, const ProjectionBrick& brick, int per, int begin,
                    int end, float* result) {
  if (kind == ProjectionKind::largest)
    projectOf<ProjectionKind::largest>(path, brick, per, begin, end, result);
  else if (kind == ProjectionKind::smallest)
    projectOf<ProjectionKind::smallest>(path, brick, per, begin, end, result);
  else
    projectOf<ProjectionKind::sum>(path, brick, per, begin, end, result);
}

}  // namespace
}  // namespace umbrick::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace umbrick {
HWY_EXPORT(projectBrickOf);

void projectBrick(ProjectionKind kind, const ProjectionPath& path, const ProjectionBrick& brick, int per, int begin,
                  int end, float* result) {
  HWY_DYNAMIC_DISPATCH(projectBrickOf)(kind, path, brick, per, begin, end, result);
}

}  // namespace umbrick
#endif
