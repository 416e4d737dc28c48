// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/techniques.h"

#include <string>
#include <vector>

#include "umbrick/core/error.h"
#include "umbrick/core/names.h"
#include "umbrick/shade/slice_renderer.h"

namespace umbrick {
namespace {

template <class Kind>
std::unique_ptr<Renderer> make(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options) {
  return std::make_unique<Kind>(volume, scene, options);
}

// A new technique is a new row of this table.
constexpr Technique kTechniques[]{
    {"slices", "proxy slices across the view, nearest first", make<SliceRenderer>},
};

}  // namespace

std::span<const Technique> techniques() { return kTechniques; }

std::unique_ptr<Renderer> makeRenderer(ResidentVolume& volume, const ResolvedScene& scene, const RenderOptions& options,
                                       std::string_view technique) {
  std::vector<std::string> known;
  for (const Technique& one : kTechniques) {
    if (technique.empty() || one.name == technique) return one.make(volume, scene, options);
    known.emplace_back(one.name);
  }
  throw InvalidArgument("technique: expected one of " + joined(known) + ", found '" + std::string(technique) + "'");
}

}  // namespace umbrick
