// Where a picture is made: on OpenGL or on the CPU, and by which technique.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "umbrick/core/names.h"
#include "umbrick/gl/context.h"
#include "umbrick/render/techniques.h"

namespace umbrick {

/// What may draw. Automatic: a GPU where there is one; else the CPU where a technique of it can render the scene; else
/// OpenGL in software.
enum class EngineKind { automatic, cpu, osmesa, egl };
inline constexpr Name<EngineKind> kEngineKinds[]{{"auto", EngineKind::automatic},
                                                 {"cpu", EngineKind::cpu},
                                                 {"osmesa", EngineKind::osmesa},
                                                 {"egl", EngineKind::egl}};

/// What draws a scene.
struct Engine {
  Technique technique = Technique::slices;  // never automatic
  std::unique_ptr<GlContext> context;       // of a technique on OpenGL, current; null: it runs on the CPU
  std::string description;                  // "CPU: 2 threads, AVX3", or that of the context
};

/// Chooses the technique and where it runs, and makes a context where one is needed.
/// @param scene  its technique and its light count
/// @throw InvalidArgument  the technique does not run there: names both
/// @throw GlError          no context
Engine chooseEngine(const SceneSettings& scene, EngineKind kind = EngineKind::automatic);

}  // namespace umbrick
