// SPDX-License-Identifier: Apache-2.0
#include "umbrick/optics/transfer_json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/json_reader.h"
#include "core/json_writer.h"
#include "core/text_file.h"
#include "optics/paraview_colour_map.h"
#include "umbrick/core/error.h"

namespace umbrick {

// The build defines this function: it returns the text of assets/transfer/<name>, empty if there is none.
std::string_view transferPresetText(std::string_view name);
std::vector<std::string> transferPresetTextNames();

namespace {

glm::dvec3 readAlbedo(const JsonValue& value) {
  glm::dvec3 albedo;
  const std::vector<JsonValue> items = value.items(3);
  for (int c = 0; c < 3; ++c)
    albedo[c] =
        items[static_cast<std::size_t>(c)].number([](double a) { return a >= 0 && a <= 1; }, "a number from 0 to 1");
  return albedo;
}

double readSigma(const JsonValue& value) {
  return value.number([](double sigma) { return sigma >= 0; }, "a number >= 0");
}

// Reads the numbers of one axis, in order.
std::vector<double> readAxis(const JsonValue& value) {
  std::vector<double> axis;
  for (const JsonValue& item : value.items()) {
    axis.push_back(item.number());
    if (axis.size() > 1 && axis.back() < axis[axis.size() - 2])
      item.failExpected("a number no smaller than the one before");
  }
  if (axis.empty()) value.fail("at least one number is needed");
  return axis;
}

TransferFunction readPoints(const JsonValue& list) {
  std::vector<TransferFunction::Point> points;
  for (const JsonValue& item : list.items()) {
    item.allowFields({"value", "albedo", "sigma_t"});
    const JsonValue value = item.at("value");
    if (!points.empty() && value.number() < points.back().value)
      value.failExpected("a value no smaller than that of the point before");
    points.push_back({value.number(), {readAlbedo(item.at("albedo")), readSigma(item.at("sigma_t"))}});
  }
  if (points.empty()) list.fail("at least one point is needed");
  return TransferFunction(std::move(points));
}

TransferFunction readLattice(const JsonValue& object) {
  const std::vector<double> values = readAxis(object.at("values")), gradients = readAxis(object.at("gradients"));
  const std::size_t count = values.size() * gradients.size();
  const std::vector<JsonValue> albedo = object.at("albedo").items(count), sigma_t = object.at("sigma_t").items(count);
  std::vector<Medium> media;
  for (std::size_t i = 0; i < count; ++i) media.push_back({readAlbedo(albedo[i]), readSigma(sigma_t[i])});
  return TransferFunction(values, gradients, std::move(media));
}

std::string printed(const glm::dvec3& v) { return jsonNumbers({v.x, v.y, v.z}); }

JsonFields withUnit(JsonFields fields, const TransferFunction& transfer) {
  if (!transfer.unit().empty()) fields.emplace(fields.begin(), "unit", jsonString(transfer.unit()));
  return fields;
}

constexpr std::string_view kExtension = ".json";

}  // namespace

TransferFunction windowedBy(const TransferFunction& transfer, const JsonValue& window) {
  const std::vector<double> ends = window.numbers(2);
  try {
    return transfer.windowed(ends[0], ends[1]);
  } catch (const InvalidArgument&) {
    window.fail("expected two numbers that ascend, found [" + jsonNumber(ends[0]) + ", " + jsonNumber(ends[1]) + "]");
  }
}

TransferFunction scaledBy(const TransferFunction& transfer, const JsonValue& factor) {
  try {
    return transfer.scaled(readSigma(factor));
  } catch (const InvalidArgument& error) {
    factor.fail(error.what());
  }
}

TransferFunction readTransferFunction(const JsonValue& value) {
  if (value.isArray()) return readParaViewColourMap(value);
  if (!value.isObject()) value.failExpected("an object, or the array of a ParaView colour map");
  value.allowFields(
      {"description", "points", "values", "gradients", "albedo", "sigma_t", "unit", "window", "sigmaScale"});
  if (const auto description = value.find("description")) description->string();
  const bool lattice = value.find("values") || value.find("gradients");
  if (const auto points = value.find("points")) {
    for (const char* other : {"values", "gradients", "albedo", "sigma_t"})
      if (const auto field = value.find(other)) field->fail("belongs to a 2D function, but there are also points");
  } else if (!lattice) {
    value.fail("needs 'points', or 'values', 'gradients', 'albedo' and 'sigma_t'");
  }
  TransferFunction transfer = lattice ? readLattice(value) : readPoints(value.at("points"));
  if (const auto unit = value.find("unit")) transfer = transfer.withUnit(unit->string());
  if (const auto window = value.find("window")) transfer = windowedBy(transfer, *window);
  if (const auto factor = value.find("sigmaScale")) transfer = scaledBy(transfer, *factor);
  return transfer;
}

TransferFunction parseTransferFunction(std::string_view text, const std::string& source) {
  const JsonDocument document(text, source);
  return readTransferFunction(document.root());
}

namespace {

// The text of a preset or of a file, and what messages call it.
std::pair<std::string, std::string> transferText(const std::string& nameOrFile) {
  const std::string preset = nameOrFile + std::string(kExtension);
  if (const std::string_view text = transferPresetText(preset); !text.empty())
    return {std::string(text), "preset " + nameOrFile};
  std::error_code ignored;
  if (!std::filesystem::exists(nameOrFile, ignored)) {
    std::string names;
    for (const std::string& name : transferPresets()) names += (names.empty() ? "" : ", ") + name;
    throw IoError(nameOrFile + ": no such transfer function: neither a file nor one of the presets " + names);
  }
  return {readTextFile(nameOrFile), nameOrFile};
}

}  // namespace

TransferFunction loadTransferFunction(const std::string& nameOrFile) {
  const auto [text, source] = transferText(nameOrFile);
  return parseTransferFunction(text, source);
}

std::string describeTransferFunction(const std::string& nameOrFile) {
  const auto [text, source] = transferText(nameOrFile);
  const JsonDocument document(text, source);
  if (!document.root().isObject()) return {};
  const auto description = document.root().find("description");
  return description ? description->string() : std::string();
}

std::vector<std::string> transferPresets() {
  std::vector<std::string> names = transferPresetTextNames();
  for (std::string& name : names) name.resize(name.size() - kExtension.size());
  return names;
}

std::string printTransferFunction(const TransferFunction& transfer) {
  const std::vector<Medium>& media = transfer.media();
  if (!transfer.is2d()) {
    std::vector<std::string> points;
    for (std::size_t i = 0; i < media.size(); ++i)
      points.push_back(jsonObject({{"value", jsonNumber(transfer.values()[i])},
                                   {"albedo", printed(media[i].albedo)},
                                   {"sigma_t", jsonNumber(media[i].sigma_t)}}));
    return jsonObject(withUnit({{"points", jsonArray(points)}}, transfer));
  }
  std::vector<std::string> albedo;
  std::vector<double> sigma_t;
  for (const Medium& medium : media) {
    albedo.push_back(printed(medium.albedo));
    sigma_t.push_back(medium.sigma_t);
  }
  return jsonObject(withUnit({{"values", jsonNumbers(transfer.values())},
                              {"gradients", jsonNumbers(transfer.gradients())},
                              {"albedo", jsonArray(albedo)},
                              {"sigma_t", jsonNumbers(sigma_t)}},
                             transfer));
}

}  // namespace umbrick
