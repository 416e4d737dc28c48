// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/capabilities.h"

#include <catch2/catch.hpp>
#include <set>
#include <string_view>
#include <utility>

using namespace umbrick;

TEST_CASE("Every model and every method has the traits that it is asked for", "[scene]") {
  std::set<std::string_view> meanings;
  for (const auto& [name, model] : kModels) {
    CAPTURE(name);
    const ModelTraits& traits = traitsOf(model);
    CHECK(traits.model == model);
    CHECK_FALSE(traits.meaning.empty());
    CHECK(meanings.insert(traits.meaning).second);
    // Traits of occluded light need occlusion, and a cone's axis needs a cone.
    if (traits.cone || traits.sphere || traits.directions || traits.sources || traits.behindEye)
      CHECK(traits.occlusion);
    if (traits.aroundRay) CHECK(traits.cone);
    // A set of directions in front of the viewer meets nothing behind the eye, one of the whole sphere does.
    if (traits.directions) CHECK(traits.behindEye == traits.sphere);
  }
  CHECK(modelTraits().size() == std::size(kModels));
  for (const auto& [name, method] : kMethods) {
    CAPTURE(name);
    CHECK(traitsOf(method).method == method);
    CHECK_FALSE(traitsOf(method).meaning.empty());
    CHECK(meanings.insert(traitsOf(method).meaning).second);
  }
}

TEST_CASE("Light from everywhere is for light volumes and cone rays", "[scene]") {
  for (const auto& [name, method] : kMethods) {
    CAPTURE(name);
    const bool allAround = method == Method::lightVolume || method == Method::coneRays;
    CHECK(supports(method, Model::ambient) == allAround);
    CHECK_FALSE(supports(method, Model::coneRay));
    SceneSettings scene;
    scene.method = method;
    for (const Model model : {Model::emission, Model::cone}) {
      scene.model = model;
      CHECK_FALSE(lightComesFromBehind(scene));
    }
    scene.model = Model::lights;
    CHECK(lightComesFromBehind(scene) == allAround);
    scene.model = Model::ambient;
    CHECK(lightComesFromBehind(scene));
  }
}

TEST_CASE("Light sources are for methods of directions", "[scene]") {
  CHECK_FALSE(traitsOf(Method::dos).sources);
  CHECK_FALSE(traitsOf(Method::dos).directions);
  CHECK(traitsOf(Method::ordinates).sources);
  CHECK(traitsOf(Method::ordinates).directions);
  CHECK(traitsOf(Method::lightVolume).sources);
  CHECK(traitsOf(Method::lightVolume).directions);
  for (const auto& [name, model] : kModels) {
    CAPTURE(name);
    CHECK(traitsOf(model).sources == (model == Model::lights));
  }
}

TEST_CASE("A method supports the models that its renderers accept with it", "[scene]") {
  const std::set<std::pair<Method, Model>> accepted{
      {Method::dos, Model::emission},      {Method::dos, Model::cone},           {Method::ordinates, Model::emission},
      {Method::ordinates, Model::cone},    {Method::ordinates, Model::lights},   {Method::lightVolume, Model::emission},
      {Method::lightVolume, Model::cone},  {Method::lightVolume, Model::lights}, {Method::lightVolume, Model::ambient},
      {Method::coneRays, Model::emission}, {Method::coneRays, Model::cone},      {Method::coneRays, Model::lights},
      {Method::coneRays, Model::ambient}};
  for (const auto& [methodName, method] : kMethods)
    for (const auto& [modelName, model] : kModels) {
      CAPTURE(methodName, modelName);
      CHECK(supports(method, model) == accepted.contains({method, model}));
    }
}

TEST_CASE("Without occlusion no method computes it", "[scene]") {
  for (const auto& [methodName, method] : kMethods)
    for (const auto& [modelName, model] : kModels) {
      CAPTURE(methodName, modelName);
      Scene scene;
      scene.model = model;
      scene.method = method;
      if (model == Model::emission)
        CHECK_FALSE(occlusionMethod(scene));
      else
        CHECK(occlusionMethod(scene) == method);
    }
}

TEST_CASE("Every mode has traits, and a technique that renders it", "[scene][modes]") {
  std::set<std::string_view> meanings;
  CHECK(modeTraits().size() == std::size(kModes));
  for (const auto& [name, mode] : kModes) {
    CAPTURE(name);
    const ModeTraits& traits = traitsOf(mode);
    CHECK(traits.mode == mode);
    CHECK(meanings.insert(traits.meaning).second);
    if (traits.ofValues) CHECK(traits.projection);
    CHECK_FALSE((traits.projection && traits.surfaces));
    CHECK((traits.ofValues || traits.surfaces || traits.medium));
    CHECK(supports(Technique::rays, mode));
    SceneSettings scene;
    scene.mode = mode;
    CHECK_NOTHROW(requireMode(scene, Technique::rays));
    if (mode == Mode::integrate)
      CHECK_NOTHROW(requireMode(scene, Technique::slices));
    else
      CHECK_THROWS_WITH(requireMode(scene, Technique::slices),
                        "mode: " + std::string(name) + " is not rendered by the technique slices but by rays");
    CHECK(isShaded(scene) == traits.surfaces);
  }
}
