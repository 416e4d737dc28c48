// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/json_reader.h"
#include "core/json_writer.h"
#include "study/json_difference.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {
using Json = nlohmann::ordered_json;

constexpr int kFormat = 2;  // of study.json

// --- what is written ---

// Returns degrees as a person writes them: 60, not 59.99999999999999.
Json degrees(double radians) { return Json::parse(jsonDegrees(radians)); }
// Returns null for an infinite error, for which JSON has no number.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json toJson(const BufferBits& bits) { return {{"eye", bits.eye}, {"occlusion", bits.occlusion}}; }

Json settingsOf(const StudyPlan& plan) {
  const StudySettings& settings = plan.settings;
  Json json;
  json["methods"] = settings.methods;
  if (settings.slices.empty())
    for (const std::string& name : settings.methods) json["slices"][name] = plan.slices.at(name);
  else
    json["slices"] = settings.slices;
  for (const auto& [name, values] : settings.details) json[name] = values;
  json["bits"] = Json::array();
  for (const BufferBits& bits : settings.bits) json["bits"].push_back(toJson(bits));
  json["segments"] = settings.segments;
  json["scales"] = settings.scales.value_or(kUsualScales);
  json["sizes"] = settings.sizes;
  json["thetas"] = Json::array();
  for (const double theta : settings.thetas) json["thetas"].push_back(degrees(theta));
  json["repeats"] = settings.repeats;
  json["reference"] = {{"directions", settings.directions}, {"tolerance", settings.tolerance}};
  return json;
}

Json toJson(const ErrorMeasures& error) {
  return {{"rmse", number(error.rmse)},      {"max", number(error.maxError)}, {"p99_9", number(error.p999)},
          {"rel_mse", number(error.relMse)}, {"ssim", number(error.ssim)},    {"flip", number(error.flip)}};
}

Json toJson(const Spread& spread) {
  return {{"median", spread.median},
          {"lower_quartile", spread.lowerQuartile},
          {"upper_quartile", spread.upperQuartile},
          {"min", spread.least},
          {"max", spread.most}};
}

void addCase(Json& json, const CaseResult& result) {
  const StudyCase& what = result.what;
  const StudyMethod& method = studyMethod(what.method);
  json["id"] = what.id();
  json["method"] = what.method;
  json["slices"] = what.slices;
  json["segments"] = result.segments;
  if (!method.detail.name.empty()) json[method.detail.name] = what.detail;
  json["bits"] = toJson(what.bits);
  json["size"] = what.size;
  if (traitsOf(method.model).occlusion) json["theta"] = degrees(what.theta);
  if (method.windows) json["window_scale"] = what.scale;
  if (method.look != StudyLook::medium) json["look"] = lookName(method.look);
}

Json toJson(const CaseResult& result) {
  Json json;
  addCase(json, result);
  json["spacing_world"] = result.spacing;
  json["slices_drawn"] = result.slicesDrawn;
  json["time_ratio"] = toJson(result.timeRatio);
  json["pairs"] = result.pairs;
  json["case_ms"] = result.caseMs;
  json["baseline_ms"] = result.baselineMs;
  if (result.lightMs > 0) json["light_ms"] = result.lightMs;
  json["load"] = result.load;
  json["bytes"] = {{"buffers", result.bufferBytes}, {"brick_textures", result.textureBytes}};
  json["fragments"] = result.fragments;
  json["pass_ms"] = {
      {"extinction", result.passes.extinctionMs}, {"windows", result.passes.windowsMs}, {"eye", result.passes.eyeMs}};
  if (studyMethod(result.what.method).windows)
    json["windows"] = {{"directions", result.directions},
                       {"texel_world", result.windowTexel},
                       {"bytes", result.windowBytes},
                       {"updates", result.windowUpdates}};
  json["error"] = toJson(result.error);
  return json;
}

Json toJson(const ReferenceResult& result) {
  Json json{{"id", result.what.id()},
            {"model", modelName(result.what.model)},
            {"size", result.what.size},
            {"theta", degrees(result.what.theta)},
            {"time_ratio", result.timeRatio},
            {"integrate_ms", result.integrateMs},
            {"difference_to_coarser", toJson(result.coarser)}};
  if (result.what.look != StudyLook::medium) json["look"] = lookName(result.what.look);
  return json;
}

Json toJson(const Machine& machine) {
  return {{"cpu", machine.cpu},           {"cores", machine.cores},     {"renderer", machine.renderer},
          {"software", machine.software}, {"version", machine.version}, {"compiler", machine.compiler},
          {"gnuplot", machine.plotter}};
}

// Returns what two machines must have in common, so that times of one may be divided by times of the other.
Json timingIdentity(const Machine& machine) {
  return {{"cpu", machine.cpu}, {"cores", machine.cores}, {"renderer", machine.renderer}, {"version", machine.version}};
}

Json toJson(const VolumeIdentity& volume) {
  return {{"file", volume.file}, {"bytes", volume.bytes}, {"crc32", volume.crc32}};
}

// --- what is read back ---

double readNumber(const JsonValue& parent, std::string_view key) {
  const JsonValue value = parent.at(key);
  return value.isNull() ? std::numeric_limits<double>::infinity() : value.number();
}
std::optional<double> readOptional(const JsonValue& parent, std::string_view key) {
  const JsonValue value = parent.at(key);
  return value.isNull() ? std::nullopt : std::optional(value.number());
}

ErrorMeasures readError(const JsonValue& value) {
  return {readNumber(value, "rmse"),    readNumber(value, "max"),    readNumber(value, "p99_9"),
          readNumber(value, "rel_mse"), readOptional(value, "ssim"), readOptional(value, "flip")};
}

Spread readSpread(const JsonValue& value) {
  return {value.at("min").number(), value.at("lower_quartile").number(), value.at("median").number(),
          value.at("upper_quartile").number(), value.at("max").number()};
}

StudyReference readReference(const JsonValue& value) {
  return {value.at("model").choice<Model>(kModels), value.at("size").integer(), value.at("theta").degrees(),
          value.find("look") ? value.at("look").choice<StudyLook>(kLooks) : StudyLook::medium};
}

CaseResult readCase(const JsonValue& value, const StudyPlan& plan) {
  const std::string& id = value.at("id").string();
  const auto planned =
      std::find_if(plan.cases.begin(), plan.cases.end(), [&](const StudyCase& one) { return one.id() == id; });
  if (planned == plan.cases.end()) value.at("id").fail("no case of this study: '" + id + "'");
  CaseResult result;
  result.what = *planned;
  result.spacing = value.at("spacing_world").number();
  result.segments = value.at("segments").integer();
  result.slicesDrawn = value.at("slices_drawn").integer();
  result.timeRatio = readSpread(value.at("time_ratio"));
  result.pairs = value.at("pairs").integer();
  result.caseMs = value.at("case_ms").number();
  result.baselineMs = value.at("baseline_ms").number();
  if (value.find("light_ms")) result.lightMs = value.at("light_ms").number();
  result.load = value.at("load").number();
  const JsonValue bytes = value.at("bytes");
  result.bufferBytes = bytes.at("buffers").unsignedInteger();
  result.textureBytes = bytes.at("brick_textures").unsignedInteger();
  result.fragments = value.at("fragments").unsignedInteger();
  const JsonValue passes = value.at("pass_ms");
  result.passes = {passes.at("extinction").number(), passes.at("windows").number(), passes.at("eye").number()};
  if (studyMethod(result.what.method).windows) {
    const JsonValue windows = value.at("windows");
    result.directions = windows.at("directions").integer();
    result.windowTexel = windows.at("texel_world").number();
    result.windowBytes = windows.at("bytes").unsignedInteger();
    result.windowUpdates = windows.at("updates").unsignedInteger();
  }
  result.error = readError(value.at("error"));
  return result;
}

ReferenceResult readReferenceResult(const JsonValue& value) {
  return {readReference(value), value.at("integrate_ms").number(), value.at("time_ratio").number(),
          readError(value.at("difference_to_coarser"))};
}

Machine readMachine(const JsonValue& value) {
  return {value.at("cpu").string(),       value.at("cores").integer(),  value.at("renderer").string(),
          value.at("software").boolean(), value.at("version").string(), value.at("compiler").string(),
          value.at("gnuplot").string()};
}

// --- is it the same study? ---

// Returns the scene without the name of the volume's file, which may move.
Json withoutFile(Json scene) {
  if (const auto volume = scene.find("volume"); volume != scene.end() && volume->is_object()) {
    volume->erase("file");
    if (volume->empty()) scene.erase(volume);
  }
  return scene;
}

void refuseOther(const std::string& what, const std::string& difference, const std::string& source) {
  if (difference.empty()) return;
  throw InvalidArgument(source + ": a study " + what + ": " + difference + "; give another folder");
}

void checkSame(const StudyRecord& record, const Json& stored, const std::string& source) {
  const Json volume = toJson(record.volume);
  for (const char* key : {"bytes", "crc32"})
    refuseOther("of another volume",
                firstDifference("volume." + std::string(key), stored.at("volume").at(key), volume.at(key)), source);
  // The settings come first, since the scene has the base size.
  refuseOther("with other settings", firstDifference("", stored.at("settings"), settingsOf(record.plan)), source);
  refuseOther("of another scene",
              firstDifference("", withoutFile(stored.at("scene")), withoutFile(Json::parse(printScene(record.scene)))),
              source);
}

}  // namespace

double timeWithLight(const CaseResult& result) {
  return result.timeRatio.median + (result.baselineMs > 0 ? result.lightMs / result.baselineMs : 0);
}

std::array<double, 3> passShares(const PassTimes& passes) {
  const double all = passes.extinctionMs + passes.windowsMs + passes.eyeMs;
  if (!(all > 0)) return {0, 0, 1};
  return {passes.extinctionMs / all, passes.windowsMs / all, passes.eyeMs / all};
}

const CaseResult* StudyRecord::find(const StudyCase& what) const {
  const auto at = std::find_if(cases.begin(), cases.end(), [&](const CaseResult& r) { return r.what == what; });
  return at == cases.end() ? nullptr : &*at;
}

const ReferenceResult* StudyRecord::find(const StudyReference& what) const {
  const auto at =
      std::find_if(references.begin(), references.end(), [&](const ReferenceResult& r) { return r.what == what; });
  return at == references.end() ? nullptr : &*at;
}

const ModelError* StudyRecord::findModelError(const StudyReference& cone) const {
  const auto at =
      std::find_if(modelErrors.begin(), modelErrors.end(), [&](const ModelError& e) { return e.cone == cone; });
  return at == modelErrors.end() ? nullptr : &*at;
}

bool StudyRecord::complete() const {
  const auto measured = [this](const auto& what) { return find(what) != nullptr; };
  return std::all_of(plan.cases.begin(), plan.cases.end(), measured) &&
         std::all_of(plan.references.begin(), plan.references.end(), measured);
}

std::string printRecord(const StudyRecord& record) {
  Json json;
  json["umbrick_study"] = kFormat;
  json["complete"] = record.complete();
  json["settings"] = settingsOf(record.plan);
  json["base"] = Json::object();
  for (const auto& [name, base] : record.plan.bases) json["base"][name] = base.id();
  json["machine"] = toJson(record.machine);
  json["volume"] = toJson(record.volume);
  json["extent_world"] = record.geometry.extent;
  json["voxel_edge_world"] = record.geometry.voxelEdge;
  json["references"] = Json::array();
  for (const ReferenceResult& result : record.references) json["references"].push_back(toJson(result));
  json["model_errors"] = Json::array();
  for (const ModelError& error : record.modelErrors)
    json["model_errors"].push_back(
        {{"size", error.cone.size}, {"theta", degrees(error.cone.theta)}, {"error", toJson(error.error)}});
  json["cases"] = Json::array();
  for (const CaseResult& result : record.cases) json["cases"].push_back(toJson(result));
  json["scene"] = Json::parse(printScene(record.scene));
  return json.dump(2) + "\n";
}

void restoreRecord(StudyRecord& record, std::string_view text, const std::string& source) {
  const JsonDocument document(text, source);
  const JsonValue root = document.root();
  if (!root.isObject() || !root.find("umbrick_study")) throw IoError(source + ": not the record of a study");
  checkDepth(document, source);
  if (root.at("umbrick_study").integer() != kFormat) root.at("umbrick_study").failExpected(std::to_string(kFormat));
  for (const char* field : {"settings", "scene", "volume", "machine"})
    if (!root.at(field).isObject()) root.at(field).failExpected("an object");
  for (const char* field : {"bytes", "crc32"}) root.at("volume").at(field).number();
  checkSame(record, Json::parse(text), source);
  StudyRecord restored = record;
  restored.machine = readMachine(root.at("machine"));
  restored.geometry.extent = root.at("extent_world").number();
  for (const JsonValue& value : root.at("references").items())
    restored.references.push_back(readReferenceResult(value));
  for (const JsonValue& value : root.at("model_errors").items())
    restored.modelErrors.push_back(
        {{Model::cone, value.at("size").integer(), value.at("theta").degrees(), StudyLook::medium},
         readError(value.at("error"))});
  for (const JsonValue& value : root.at("cases").items()) restored.cases.push_back(readCase(value, record.plan));
  if (!restored.complete())
    refuseOther("unfinished on another machine",
                firstDifference("machine", timingIdentity(restored.machine), timingIdentity(record.machine)), source);
  record = std::move(restored);
}

}  // namespace umbrick
