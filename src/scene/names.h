// What the choices of a scene are called in JSON.
#pragma once
#include <cstddef>
#include <string_view>
#include <utility>

#include "umbrick/scene/scene.h"

namespace umbrick {

template <typename T>
using Name = std::pair<std::string_view, T>;

inline constexpr Name<Projection> kProjections[]{{"perspective", Projection::perspective},
                                                 {"orthographic", Projection::orthographic}};
inline constexpr Name<Model> kModels[]{
    {"emission", Model::emission}, {"cone", Model::cone},     {"cone-ray", Model::coneRay},
    {"ambient", Model::ambient},   {"lights", Model::lights},
};
inline constexpr Name<Method> kMethods[]{{"dos", Method::dos}, {"ordinates", Method::ordinates}};
inline constexpr Name<Quadrature> kQuadratures[]{{"preintegrated", Quadrature::preintegrated},
                                                 {"midpoint", Quadrature::midpoint}};
inline constexpr Name<bool> kSpacingUnits[]{{"voxel", true}, {"world", false}};
inline constexpr std::string_view kTexelFormats[]{"auto", "unorm8", "unorm16", "half", "float32"};

template <typename T, std::size_t N>
std::string_view nameOf(const Name<T> (&names)[N], T wanted) {
  for (const auto& [name, value] : names)
    if (value == wanted) return name;
  return {};
}

}  // namespace umbrick
