// SPDX-License-Identifier: Apache-2.0
#include "scene_keywords.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numbers>
#include <regex>

#include "umbrick/core/error.h"
#include "umbrick/scene/scene_fields.h"

namespace umbrick::python {
namespace {
namespace py = pybind11;

std::string withUnderscores(std::string_view option) {
  std::string text(option);
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

// Values as the JSON of a scene has them; arrays and numbers of NumPy become plain ones.
std::string jsonOf(const std::string& keyword, const py::handle& value) {
  try {
    return py::module_::import("umbrick._json").attr("dumps")(value).cast<std::string>();
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
    throw InvalidArgument(keyword + ": expected what JSON can hold, found " + py::repr(value).cast<std::string>());
  }
}

// Reads text of no file. Lines and columns in it mean nothing to the user, who has not written it.
template <class Read>
auto readText(const std::string& source, const Read& read) {
  try {
    return read();
  } catch (const IoError& error) {
    const std::string message = error.what();
    static const std::regex place(":[0-9]+:[0-9]+: ");
    std::smatch found;
    if (!message.starts_with(source) || !std::regex_search(message, found, place) ||
        found.position() != static_cast<std::ptrdiff_t>(source.size()))
      throw;
    throw InvalidArgument(source + ": " + found.suffix().str());
  }
}

std::string found(const py::handle& value) {
  std::string text = py::repr(value).cast<std::string>();
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

[[noreturn]] void expected(const std::string& keyword, const std::string& what, const py::handle& value) {
  throw InvalidArgument(keyword + ": expected " + what + ", found " + found(value));
}

double numberOf(const std::string& keyword, const py::handle& value) {
  try {
    if (py::isinstance<py::bool_>(value) || py::isinstance<py::str>(value)) expected(keyword, "a number", value);
    return py::float_(py::reinterpret_borrow<py::object>(value));
  } catch (const py::error_already_set&) {
    expected(keyword, "a number", value);
  }
}

// @param count  0: any
std::vector<double> numbersOf(const std::string& keyword, const py::handle& value, std::size_t count) {
  const std::string what = count == 0 ? "numbers" : std::to_string(count) + " numbers";
  std::vector<double> numbers;
  try {
    if (py::isinstance<py::str>(value)) expected(keyword, what, value);
    for (const py::handle& one : py::iter(value)) numbers.push_back(numberOf(keyword, one));
  } catch (const py::error_already_set&) {
    expected(keyword, what, value);
  }
  if (count > 0 && numbers.size() != count) expected(keyword, what, value);
  return numbers;
}

std::vector<std::vector<double>> rowsOf(const std::string& keyword, const py::handle& value, std::size_t count) {
  std::vector<std::vector<double>> rows;
  try {
    for (const py::handle& row : py::iter(value)) rows.push_back(numbersOf(keyword, row, count));
  } catch (const py::error_already_set&) {
    expected(keyword, "a list of rows of " + std::to_string(count) + " numbers", value);
  }
  return rows;
}

// One number or several.
std::vector<double> oneOrMore(const std::string& keyword, const py::handle& value) {
  if (py::hasattr(value, "__iter__") && !py::isinstance<py::str>(value)) return numbersOf(keyword, value, 0);
  return {numberOf(keyword, value)};
}

std::string textOf(const std::string& keyword, const py::handle& value) {
  if (py::hasattr(value, "__fspath__")) return py::module_::import("os").attr("fspath")(value).cast<std::string>();
  if (!py::isinstance<py::str>(value)) expected(keyword, "a string", value);
  return value.cast<std::string>();
}

bool truthOf(const std::string& keyword, const py::handle& value) {
  if (!py::isinstance<py::bool_>(value) && Py_TYPE(value.ptr())->tp_name != std::string_view("numpy.bool_"))
    expected(keyword, "True or False", value);
  return PyObject_IsTrue(value.ptr()) == 1;
}

void setTransfer(const std::string& keyword, const py::handle& value, ScenePlea& asked) {
  if (py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__")) {
    asked.transfer = textOf(keyword, value);
    return;
  }
  const std::string json = jsonOf(keyword, value);
  asked.function = readText(keyword, [&] { return parseTransferFunction(json, keyword); });
}

void setUp(const std::string& keyword, const py::handle& value, ScenePlea& asked) {
  if (py::isinstance<py::str>(value)) {
    asked.up = value.cast<std::string>();
    return;
  }
  asked.upward = numbersOf(keyword, value, 3);
  asked.up = found(value);
}

void setClipBox(const std::string& keyword, const py::handle& value, ScenePlea& asked) {
  if (value.is_none()) {
    asked.given.clipBox.reset();
    return;
  }
  const bool corners = py::isinstance<py::sequence>(value) && py::len(value) == 2;
  if (!corners) {
    asked.clipBox = numbersOf(keyword, value, 6);
    return;
  }
  const auto rows = rowsOf(keyword, value, 3);
  asked.clipBox = rows[0];
  asked.clipBox->insert(asked.clipBox->end(), rows[1].begin(), rows[1].end());
}

// What is no field of the table, or more than one.
using SetKeyword = void (*)(const std::string& keyword, const py::handle& value, ScenePlea& asked);
const std::map<std::string, SetKeyword>& otherKeywords() {
  static const std::map<std::string, SetKeyword> table{
      {"tf", setTransfer},
      {"up", setUp},
      {"emission_tf", [](const auto& k, const auto& v, ScenePlea& a) { a.emissionTransfer = textOf(k, v); }},
      {"clip_box", setClipBox},
      {"window", [](const auto& k, const auto& v, ScenePlea& a) { a.window = numbersOf(k, v, 2); }},
      {"sigma_scale", [](const auto& k, const auto& v, ScenePlea& a) { a.sigmaScale = numberOf(k, v); }},
      {"quality", [](const auto& k, const auto& v, ScenePlea& a) { a.quality = textOf(k, v); }},
      {"view", [](const auto& k, const auto& v, ScenePlea& a) { a.view = textOf(k, v); }},
      {"orthographic", [](const auto& k, const auto& v, ScenePlea& a) { a.orthographic = truthOf(k, v); }},
      {"iso", [](const auto& k, const auto& v, ScenePlea& a) { a.isoValues = oneOrMore(k, v); }},
      {"iso_colours", [](const auto& k, const auto& v, ScenePlea& a) { a.isoColours = rowsOf(k, v, 3); }},
      {"iso_opacity", [](const auto& k, const auto& v, ScenePlea& a) { a.isoOpacities = oneOrMore(k, v); }},
      {"clip_planes",
       [](const auto& k, const auto& v, ScenePlea& a) {
         a.given.clipPlanes.clear();
         a.clipPlanes = rowsOf(k, v, 4);
       }},
  };
  return table;
}

// Sets a field of the table to a value, which is checked by setting that of a scene that has the field.
void setField(const SceneField& field, const std::string& keyword, const py::handle& value, ScenePlea& asked) {
  std::function<void(Scene&)> set;
  Scene orbited, placed;
  placed.orbit.reset();
  const bool ofOrbit = !std::holds_alternative<std::monostate>(field.place(orbited));
  const FieldPlace place = ofOrbit ? field.place(orbited) : field.place(placed);
  if (std::holds_alternative<Angle>(place)) {
    // As the command line does it, to the last bit.
    const double radians = numberOf(keyword, value) * (std::numbers::pi / 180);
    set = [&field, radians](Scene& scene) { *std::get<Angle>(field.place(scene)).radians = radians; };
  } else if (const auto usual = std::get_if<bool*>(&place)) {
    const bool wanted = truthOf(keyword, value) ? !**usual : **usual;
    set = [&field, wanted](Scene& scene) { *std::get<bool*>(field.place(scene)) = wanted; };
  } else {
    std::string json = jsonOf(keyword, value);
    if (std::holds_alternative<std::optional<glm::dvec3>*>(place)) {
      if (json == "\"white\"") json = "[1, 1, 1]";
      if (json == "\"black\"") json = "[0, 0, 0]";
      if (value.is_none()) {
        asked.fields[std::string(field.option)] = [&field](Scene& scene) {
          std::get<std::optional<glm::dvec3>*>(field.place(scene))->reset();
        };
        return;
      }
    }
    readText(keyword, [&] { readSceneField(field, json, keyword, ofOrbit ? orbited : placed); });
    set = [&field, json, keyword](Scene& scene) { readSceneField(field, json, keyword, scene); };
  }
  asked.fields[std::string(field.option)] = std::move(set);
}

void readKeywords(const py::dict& keywords, ScenePlea& asked) {
  for (const auto& [key, value] : keywords) {
    const auto keyword = key.cast<std::string>();
    if (const auto other = otherKeywords().find(keyword); other != otherKeywords().end()) {
      other->second(keyword, value, asked);
      continue;
    }
    std::string option = keyword;
    std::replace(option.begin(), option.end(), '_', '-');
    const SceneField* field = findSceneField(option);
    if (!field || field->option != option)
      throw InvalidArgument(keyword + ": expected a keyword of a scene, see umbrick.scene_keywords()");
    setField(*field, keyword, value, asked);
  }
}

}  // namespace

std::string ScenePlea::nameOf(std::string_view option) const { return withUnderscores(option); }

std::vector<std::string> sceneKeywords() {
  std::vector<std::string> names;
  for (const auto& [name, set] : otherKeywords()) names.push_back(name);
  for (const SceneField& field : sceneFields())
    if (!field.option.empty()) names.push_back(withUnderscores(field.option));
  std::sort(names.begin(), names.end());
  return names;
}

ScenePlea readScenePlea(const py::object& scene, const py::dict& keywords) {
  ScenePlea plea;
  plea.whole = !scene.is_none();
  if (py::isinstance<py::str>(scene))
    plea.given = readText("scene", [&] { return parseScene(scene.cast<std::string>(), "scene"); });
  else if (plea.whole)
    plea.given = readScene(textOf("scene", scene));
  readKeywords(keywords, plea);
  return plea;
}

ScenePlea changePlea(const Scene& scene, const py::dict& keywords) {
  ScenePlea plea;
  plea.whole = true;
  plea.given = scene;
  readKeywords(keywords, plea);
  return plea;
}

}  // namespace umbrick::python
