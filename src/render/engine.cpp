// SPDX-License-Identifier: Apache-2.0
#include "umbrick/render/engine.h"

#include <tbb/info.h>

#include <algorithm>

#include "umbrick/core/error.h"
#include "umbrick/core/instructions.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

bool runsOnCpu(const TechniqueTraits& traits) { return traits.makeOnCpu != nullptr; }

// Returns the technique of the CPU that renders the scene, or none.
const TechniqueTraits* cpuTechnique(const SceneSettings& scene) {
  for (const TechniqueTraits& traits : techniques())
    if (runsOnCpu(traits) &&
        (scene.technique == Technique::automatic ? traits.supports(scene) : scene.technique == traits.technique))
      return &traits;
  return nullptr;
}

Engine onCpu(Technique technique) {
  const int threads = tbb::info::default_concurrency();
  return {technique, nullptr,
          "CPU: " + std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") + cpuInstructions()};
}

Engine onGl(Technique technique, Backend backend) {
  Engine engine{technique, createGlContext(backend), {}};
  engine.description = engine.context->description();
  return engine;
}

}  // namespace

Engine chooseEngine(const SceneSettings& scene, EngineKind kind) {
  const bool named = scene.technique != Technique::automatic;
  const TechniqueTraits* const onProcessor = cpuTechnique(scene);
  if (named) requireMode(scene, scene.technique);
  if (kind == EngineKind::cpu) {
    if (onProcessor) return onCpu(onProcessor->technique);
    if (named)
      throw InvalidArgument("technique: " + techniqueName(scene.technique) + " does not run on the CPU but on OpenGL");
    return onCpu(Technique::rays);  // which says in its own words what it cannot do
  }
  const Technique onGraphics = named                                    ? scene.technique
                               : supportsMode(scene, Technique::slices) ? Technique::slices
                                                                        : Technique::rays;
  const bool forGl = traitsOf(onGraphics).makeOnGl != nullptr;
  if (kind == EngineKind::automatic) {
    if (forGl && traitsOf(onGraphics).supports(scene) && hasGpu()) {
      try {
        return onGl(onGraphics, Backend::egl);
      } catch (const GlError&) {  // the GPU knows no OpenGL that is new enough
      }
    }
    return onProcessor ? onCpu(onProcessor->technique) : onGl(onGraphics, Backend::automatic);
  }
  if (!forGl)
    throw InvalidArgument("technique: " + techniqueName(scene.technique) + " does not run on OpenGL but on the CPU");
  return onGl(onGraphics, kind == EngineKind::egl ? Backend::egl : Backend::osmesa);
}

}  // namespace umbrick
