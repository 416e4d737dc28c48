#include "scene/names.h"

#include "umbrick/core/error.h"

namespace umbrick {

std::string modelName(Model model) { return std::string(nameOf(kModels, model)); }

Model parseModel(std::string_view name) {
  std::string known;
  for (const auto& [text, model] : kModels) {
    if (text == name) return model;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw InvalidArgument("model: expected one of " + known + ", found '" + std::string(name) + "'");
}

}  // namespace umbrick
