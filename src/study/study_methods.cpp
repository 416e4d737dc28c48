// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/study_plan.h"

namespace umbrick {
namespace {

const StudyMethod::Detail kFootprint{"footprint", "footprints", "n",       "n x n samples over the cone's footprint",
                                     1,           16,           {2, 3, 5}, {3}};

template <int Algorithm, int Passes>
void applyDos(int footprint, ResolvedScene& scene) {
  scene.method = Method::dos;
  scene.occlusion.dos.algorithm = Algorithm;
  scene.occlusion.dos.passes = Passes;
  scene.occlusion.dos.footprint = footprint;
}

const StudyMethod::Detail kDirections{
    "directions", "directions",   "K",    "directions over the cone, each with a window of its own", 1,
    1024,         {4, 8, 16, 32}, {4, 16}};

double emissionWork(int) { return 1; }
double dosWork(int footprint) { return 1 + 0.25 * footprint * footprint; }
double ordinatesWork(int directions) { return 2 + 0.15 * directions; }

void applyOrdinates(int directions, ResolvedScene& scene) {
  scene.method = Method::ordinates;
  scene.occlusion.ordinates.directions = directions;
}

// Light costs the same whatever the slices; each of them costs little more than one of emission.
double lightVolumeWork(int directions) { return 1.5 + 0.03 * directions; }

void applyLightVolume(int directions, ResolvedScene& scene) {
  scene.method = Method::lightVolume;
  scene.occlusion.ordinates.directions = directions;
}

// Techniques on the CPU take a small part of the time of slices in software.
double cpuWork(int) { return 0.2; }
double litCpuWork(int directions) { return 0.3 + 0.03 * directions; }

template <Technique Way>
void applyTechnique(int, ResolvedScene& scene) {
  scene.technique = Way;
}

template <Technique Way>
void applyLitTechnique(int directions, ResolvedScene& scene) {
  scene.technique = Way;
  applyLightVolume(directions, scene);
}

// Rays from each sample cost as many times a sample of a light volume as a ray has steps.
double coneRaysWork(int directions) { return 1 + 2.0 * directions; }

void applyConeRays(int directions, ResolvedScene& scene) {
  scene.technique = Technique::rays;
  scene.method = Method::coneRays;
  scene.occlusion.ordinates.directions = directions;
}

// The set-up of a simple ray caster: rays go from where they enter the volume's box to where they leave it, through one
// texture, and skip nothing.
void rayBox(int, ResolvedScene& scene) {
  scene.technique = Technique::rays;
  scene.bricks.bricked = false;
  scene.bricks.culling = false;
}

// How many slices a look is drawn in: none count for surfaces, whose crossings are found whatever they are.
struct LookRow {
  StudyLook look;
  const char* title;
  std::vector<int> slices, quickSlices;
};

// Adds each look but that of the medium, by each technique that has it.
void addLooks(std::vector<StudyMethod>& methods) {
  const std::vector<int> some{128, 256, 512}, few{128, 256}, one{256};
  const LookRow looks[]{{StudyLook::phong, "Phong", some, few},   {StudyLook::mip, "maximum", some, few},
                        {StudyLook::minip, "minimum", some, few}, {StudyLook::average, "mean", some, few},
                        {StudyLook::xray, "X-ray", some, few},    {StudyLook::isosurface, "isosurface", one, one},
                        {StudyLook::hybrid, "hybrid", some, few}};
  struct Way {
    const char *suffix, *title;
    Technique technique;
    decltype(StudyMethod::apply) apply;
    bool onCpu;
  };
  static constexpr Way kWays[]{
      {"rays", " by rays on the CPU", Technique::rays, applyTechnique<Technique::rays>, true},
      {"shear-warp", " by shear-warp on the CPU", Technique::shearWarp, applyTechnique<Technique::shearWarp>, true},
      {"rays-gl", " by rays on OpenGL", Technique::rays, applyTechnique<Technique::rays>, false}};
  for (const LookRow& row : looks)
    for (const Way& way : kWays) {
      SceneSettings scene;
      showAs(row.look, scene);
      if (!supportsMode(scene, way.technique)) continue;
      methods.push_back({.name = lookName(row.look) + "-" + way.suffix,
                         .title = std::string(row.title) + way.title,
                         .model = Model::emission,
                         .detail = {},
                         .apply = way.apply,
                         .work = way.onCpu ? cpuWork : emissionWork,
                         .slices = row.slices,
                         .quickSlices = row.quickSlices,
                         .usual = false,
                         .onCpu = way.onCpu,
                         .compared = true,
                         .look = row.look});
    }
}

}  // namespace

const std::vector<StudyMethod>& studyMethods() {
  // Emission and dos need many slices; ordinates needs only few, of several segments each.
  static const std::vector<int> kMany{64, 128, 256, 512, 1024}, kManyQuick{64, 128, 256, 512};
  static const std::vector<int> kFew{16, 32, 64, 128, 256, 512}, kFewQuick{16, 64, 128};
  using Apply = decltype(StudyMethod::apply);
  using Work = decltype(StudyMethod::work);
  // Techniques other than slices, and light volumes, are compared where somebody names them or compares techniques.
  const auto unlit = [](const char* name, const char* title, Apply apply, Work work, bool onCpu) {
    return StudyMethod{.name = name,
                       .title = title,
                       .model = Model::emission,
                       .detail = {},
                       .apply = apply,
                       .work = work,
                       .slices = kMany,
                       .quickSlices = kManyQuick,
                       .usual = false,
                       .onCpu = onCpu,
                       .compared = true};
  };
  const auto variant = [&](const char* name, const char* title, Apply apply, Work work = cpuWork, bool onCpu = true) {
    StudyMethod method = unlit(name, title, apply, work, onCpu);
    method.compared = false;
    return method;
  };
  const auto lit = [](const char* name, const char* title, Apply apply, Work work, bool onCpu) {
    return StudyMethod{.name = name,
                       .title = title,
                       .model = Model::cone,
                       .detail = kDirections,
                       .apply = apply,
                       .work = work,
                       .slices = kFew,
                       .quickSlices = kFewQuick,
                       .usual = false,
                       .fineSegments = true,
                       .onCpu = onCpu,
                       .compared = true};
  };
  // Each takes so long that they are few, and drawn where they are named.
  const auto coneRays = [&](const char* name, const char* title, bool onCpu) {
    StudyMethod rays = lit(name, title, applyConeRays, coneRaysWork, onCpu);
    rays.slices = {64, 256};
    rays.quickSlices = {64};
    rays.compared = false;
    return rays;
  };
  static const std::vector<StudyMethod> methods = [&] {
    std::vector<StudyMethod> all{
        {.name = "emission",
         .title = "emission",
         .model = Model::emission,
         .detail = {},
         .apply = [](int, ResolvedScene&) {},
         .work = emissionWork,
         .slices = kMany,
         .quickSlices = kManyQuick,
         .quick = true,
         .compared = true},
        {.name = "emission-full",
         .title = "emission, no early rejection",
         .model = Model::emission,
         .detail = {},
         .apply = [](int, ResolvedScene& scene) { scene.sampling.saturation = 0; },
         .work = emissionWork,
         .slices = kMany,
         .quickSlices = kManyQuick},
        {.name = "dos",
         .title = "dos, Algorithm 3",
         .model = Model::cone,
         .detail = kFootprint,
         .apply = applyDos<3, 1>,
         .work = dosWork,
         .slices = kMany,
         .quickSlices = kManyQuick,
         .quick = true,
         .compared = true},
        {.name = "dos-2",
         .title = "dos, Algorithm 2",
         .model = Model::cone,
         .detail = kFootprint,
         .apply = applyDos<2, 1>,
         .work = dosWork,
         .slices = kMany,
         .quickSlices = kManyQuick},
        {.name = "dos-two-pass",
         .title = "dos, Algorithm 3, two passes",
         .model = Model::cone,
         .detail = kFootprint,
         .apply = applyDos<3, 2>,
         .work = dosWork,
         .slices = kMany,
         .quickSlices = kManyQuick,
         .usual = false},
        {.name = "ordinates",
         .title = "ordinates",
         .model = Model::cone,
         .detail = kDirections,
         .apply = applyOrdinates,
         .work = ordinatesWork,
         .slices = kFew,
         .quickSlices = kFewQuick,
         .quick = true,
         .fineSegments = true,
         .windows = true,
         .compared = true},
        lit("light-volume", "light volume", applyLightVolume, lightVolumeWork, false),
        unlit("stacks", "stacks", applyTechnique<Technique::stacks>, emissionWork, false),
        lit("stacks-light-volume", "light volume by stacks", applyLitTechnique<Technique::stacks>, lightVolumeWork,
            false),
        unlit("rays", "rays on the CPU", applyTechnique<Technique::rays>, cpuWork, true),
        variant("rays-midpoint", "rays on the CPU, classified at points",
                [](int, ResolvedScene& scene) {
                  scene.technique = Technique::rays;
                  scene.sampling.quadrature = Quadrature::midpoint;
                }),
        variant("rays-pre", "rays on the CPU, classified before interpolation",
                [](int, ResolvedScene& scene) {
                  scene.technique = Technique::rays;
                  scene.sampling.classification = Classification::pre;
                }),
        unlit("shear-warp", "shear-warp on the CPU", applyTechnique<Technique::shearWarp>, cpuWork, true),
        lit("rays-light-volume", "light volume by rays on the CPU", applyLitTechnique<Technique::rays>, litCpuWork,
            true),
        lit("shear-warp-light-volume", "light volume by shear-warp on the CPU", applyLitTechnique<Technique::shearWarp>,
            litCpuWork, true),
        unlit("rays-gl", "rays on OpenGL", applyTechnique<Technique::rays>, emissionWork, false),
        variant("rays-gl-box", "rays on OpenGL through the box of the volume", rayBox, emissionWork, false),
        coneRays("cone-rays", "cone rays by rays on the CPU", true),
        coneRays("cone-rays-gl", "cone rays by rays on OpenGL", false),
        lit("rays-gl-light-volume", "light volume by rays on OpenGL", applyLitTechnique<Technique::rays>,
            lightVolumeWork, false),
    };
    addLooks(all);
    return all;
  }();
  return methods;
}

const StudyMethod& studyMethod(std::string_view name) {
  std::string known;
  for (const StudyMethod& method : studyMethods()) {
    if (method.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.name;
  }
  throw InvalidArgument("methods: no method '" + std::string(name) + "': there are " + known);
}

}  // namespace umbrick
