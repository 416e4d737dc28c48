// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/earlier_study.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_reader.h"
#include "core/json_writer.h"
#include "study/json_difference.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"
#include "umbrick/study/study_record.h"

namespace umbrick {
namespace {
using Json = nlohmann::ordered_json;

void refuse(const std::string& what, const std::string& difference, const std::string& source) {
  if (!difference.empty())
    throw InvalidArgument(source + ": cannot be compared with, it is a study " + what + ": " + difference);
}

// Returns what decides on the pictures of all cases: neither the file's name nor what cases set themselves.
Json sceneOfAll(Json scene) {
  for (const char* field : {"model", "method", "occlusion"}) scene.erase(field);
  if (const auto volume = scene.find("volume"); volume != scene.end() && volume->is_object()) {
    volume->erase("file");
    if (volume->empty()) scene.erase(volume);
  }
  if (scene.contains("sampling") && scene["sampling"].is_object())
    for (const char* field : {"segments", "bits"}) scene["sampling"].erase(field);
  // Only the shape of the size counts, since each case has a size of its own.
  if (scene.contains("camera") && scene["camera"].is_object()) {
    Json& size = scene["camera"]["size"];
    if (size.is_array() && size.size() == 2 && size[0].is_number() && size[1].is_number())
      size = size[0].get<double>() / size[1].get<double>();
  }
  return scene;
}

void checkComparable(const JsonValue& root, const Json& stored, const std::string& source, const StudyRecord& record) {
  const Json here = Json::parse(printRecord(record));
  // The checksum is not compared: OpenVDB writes a new identifier into every file, so that a volume which is converted
  // again has another one.
  refuse("of another volume", firstDifference("volume.bytes", stored.at("volume").at("bytes"), here["volume"]["bytes"]),
         source);
  refuse("of another scene", firstDifference("", sceneOfAll(stored.at("scene")), sceneOfAll(here["scene"])), source);
  const double extent = root.at("extent_world").number();
  if (!(std::abs(extent - record.geometry.extent) <= 1e-9 * record.geometry.extent))
    refuse("with another baseline",
           "extent_world is " + jsonNumber(extent) + " there and " + jsonNumber(record.geometry.extent) + " here",
           source);
  for (const char* field : {"cpu", "cores", "renderer"})
    refuse("on another machine",
           firstDifference("machine." + std::string(field), stored.at("machine").at(field), here["machine"][field]),
           source);
}

EarlierCase readCase(const JsonValue& value) {
  EarlierCase one;
  one.id = value.at("id").string();
  one.method = value.at("method").string();
  one.size = value.at("size").integer();
  // Only cases of the cone have a theta.
  if (const auto theta = value.find("theta")) {
    one.model = Model::cone;
    one.theta = theta->degrees();
  }
  one.timeRatio = value.at("time_ratio").at("median").number();
  const JsonValue rmse = value.at("error").at("rmse");
  one.rmse = rmse.isNull() ? INFINITY : rmse.number();
  return one;
}

bool sameGroup(const EarlierCase& a, const EarlierCase& b) {
  return a.model == b.model && a.size == b.size && a.theta == b.theta;
}

}  // namespace

std::vector<EarlierCase> EarlierStudy::comparable(const StudyRecord& record, Model model) const {
  const double theta = !traitsOf(model).occlusion ? 0 : record.plan.baseTheta;
  std::vector<EarlierCase> cases;
  for (const EarlierCase& one : front)
    if (one.model == model && one.size == record.plan.baseSize && std::abs(one.theta - theta) < 1e-9)
      cases.push_back(one);
  return cases;
}

EarlierStudy readEarlierStudy(std::string_view text, const std::string& source, const StudyRecord& record) {
  const JsonDocument document(text, source);
  const JsonValue root = document.root();
  if (!root.isObject() || !root.find("umbrick_study")) throw IoError(source + ": not the record of a study");
  checkDepth(document, source);
  for (const char* field : {"scene", "volume", "machine"})
    if (!root.at(field).isObject()) root.at(field).failExpected("an object");
  root.at("volume").at("bytes").number();
  for (const char* field : {"cpu", "cores", "renderer", "version"}) root.at("machine").at(field);
  checkComparable(root, Json::parse(text), source, record);

  EarlierStudy study{source, root.at("machine").at("version").string(), {}};
  std::vector<EarlierCase> left;
  // Fronts are those of the medium.
  for (const JsonValue& value : root.at("cases").items())
    if (!value.find("look")) left.push_back(readCase(value));
  while (!left.empty()) {
    std::vector<EarlierCase> group, rest;
    for (const EarlierCase& one : left) (sameGroup(one, left.front()) ? group : rest).push_back(one);
    std::vector<CostAndError> points;
    for (const EarlierCase& one : group) points.push_back({one.timeRatio, one.rmse});
    for (const std::size_t i : paretoFront(points)) study.front.push_back(group[i]);
    left = std::move(rest);
  }
  return study;
}

}  // namespace umbrick
