#include <algorithm>

#include "umbrick/core/error.h"
#include "umbrick/report/study_plan.h"

namespace umbrick {
namespace {

const StudyMethod::Detail kFootprint{"footprint", "footprints", "n",       "n x n samples over the cone's footprint",
                                     1,           16,           {2, 3, 5}, {2, 3}};

template <int Algorithm, int Passes>
void applyDos(int footprint, Scene& scene) {
  scene.method = Method::dos;
  scene.occlusion.algorithm = Algorithm;
  scene.occlusion.passes = Passes;
  scene.occlusion.footprint = footprint;
}

template <int Algorithm, int Passes>
std::string dosOptions(int footprint) {
  return "--method dos --algorithm " + std::to_string(Algorithm) + " --passes " + std::to_string(Passes) +
         " --footprint " + std::to_string(footprint);
}

}  // namespace

const std::vector<StudyMethod>& studyMethods() {
  static const std::vector<StudyMethod> methods{
      {"emission", "emission", Model::emission, {}, [](int, Scene&) {}, [](int) { return std::string(); }, true, true},
      {"emission-full",
       "emission, no early rejection",
       Model::emission,
       {},
       [](int, Scene& scene) { scene.sampling.saturation = 0; },
       [](int) { return std::string("--saturation 0"); },
       true},
      {"dos", "dos, Algorithm 3", Model::cone, kFootprint, applyDos<3, 1>, dosOptions<3, 1>, true, true},
      {"dos-2", "dos, Algorithm 2", Model::cone, kFootprint, applyDos<2, 1>, dosOptions<2, 1>, true},
      {"dos-two-pass", "dos, Algorithm 3, two passes", Model::cone, kFootprint, applyDos<3, 2>, dosOptions<3, 2>,
       false},
  };
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
