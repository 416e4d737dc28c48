// SPDX-License-Identifier: Apache-2.0
#include "compare_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"

namespace umbrick::tools {

const std::array<Measure, 7> kMeasures{
    {{"rmse", "RMSE", "--max-rmse", "root of the mean square difference of all channels, alpha too", false,
      [](const ImageDifference& d) { return std::optional(d.rmse); }},
     {"rmse_rgb", "RMSE RGB", "--max-rmse-rgb", "the same of R, G and B", false,
      [](const ImageDifference& d) { return d.rmseRgb; }},
     {"max_error", "maximum", "--max-error", "largest difference of any channel", false,
      [](const ImageDifference& d) { return std::optional(d.maxError); }},
     {"p999", "99.9 %", "--max-p999", "99.9th percentile of the largest difference of each pixel", false,
      [](const ImageDifference& d) { return std::optional(d.p999); }},
     {"rel_mse", "relMSE", "--max-relmse", "mean of (a - b)^2 / (b^2 + 0.01), b the reference, without alpha", false,
      [](const ImageDifference& d) { return std::optional(d.relMse); }},
     {"ssim", "SSIM", "--min-ssim", "structural similarity, 1 for equal pictures", true,
      [](const ImageDifference& d) { return d.ssim; }},
     {"flip", "FLIP", "--max-flip", "difference to a viewer's eye, 0 to 1", false,
      [](const ImageDifference& d) { return d.flip; }}}};

namespace {

std::string digits(const char* format, double number) {
  char text[40];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

bool isKept(const Measure& measure, double value, double limit) {
  return measure.higherIsBetter ? value >= limit : value <= limit;
}

std::string pixels(std::uint64_t count) { return std::to_string(count) + (count == 1 ? " pixel" : " pixels"); }

// Returns the pixel of the largest error as viewers count it: from the top left.
glm::ivec2 fromTopLeft(const LayerDifference& layer, const Comparison& comparison) {
  const glm::ivec2 pixel = layer.difference.maxPixel;
  return {pixel.x, comparison.size.y - 1 - pixel.y};
}

std::string finiteInOneOnly(const LayerDifference& layer) {
  return layer.name + ": " + pixels(layer.difference.nonFiniteDiffering) + " with NaN or infinity in one picture only";
}

using Row = std::vector<std::string>;

Row rowOf(const LayerDifference& layer, const Comparison& comparison) {
  Row row{layer.name};
  for (const Measure& measure : kMeasures) {
    const std::optional<double> value = measure.of(layer.difference);
    row.push_back(value ? digits("%.4g", *value) : "-");
  }
  const glm::ivec2 at = fromTopLeft(layer, comparison);
  row.push_back(layer.difference.maxError > 0 ? std::to_string(at.x) + ", " + std::to_string(at.y) : "-");
  return row;
}

void printAligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  for (const Row& row : rows) {
    std::string line = row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) line += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    std::cout << line << '\n';
  }
}

// A number that is not finite has no place in JSON.
nlohmann::ordered_json numberOrText(double number) {
  return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json("inf");
}

}  // namespace

std::vector<Verdict> judge(const std::vector<LayerDifference>& layers, const Limits& limits) {
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < kMeasures.size(); ++i) {
    if (!limits[i]) continue;
    const Measure& measure = kMeasures[i];
    const double limit = *limits[i];
    const std::size_t before = verdicts.size();
    for (const LayerDifference& layer : layers)
      if (const std::optional<double> value = measure.of(layer.difference)) {
        const bool passed = isKept(measure, *value, limit) && layer.difference.nonFiniteDiffering == 0;
        verdicts.push_back({layer.name, &measure, *value, limit, passed});
      }
    if (verdicts.size() == before)
      throw InvalidArgument(std::string(measure.option) + ": no layer that is compared has " + measure.title +
                            ", which needs 3 or 4 channels" +
                            (std::string(measure.key) == "ssim" ? " and at least 11 x 11 pixels" : ""));
  }
  return verdicts;
}

void printTable(const Comparison& comparison) {
  std::cout << "test       " << printable(comparison.test) << "\nreference  " << printable(comparison.reference)
            << "\npixels     " << comparison.size.x << " x " << comparison.size.y << "\n\n";
  Row head{"layer"};
  for (const Measure& measure : kMeasures) head.push_back(measure.title);
  head.push_back("maximum at x, y");
  std::vector<Row> rows{head};
  for (const LayerDifference& layer : comparison.layers) rows.push_back(rowOf(layer, comparison));
  printAligned(rows);
  for (const LayerDifference& layer : comparison.layers) {
    if (layer.difference.nonFiniteDiffering > 0) std::cout << finiteInOneOnly(layer) << '\n';
    if (layer.difference.nonFiniteEqual > 0)
      std::cout << layer.name << ": " << pixels(layer.difference.nonFiniteEqual)
                << " with the same NaN or infinity in both pictures, counted as equal\n";
  }
}

void printJson(const Comparison& comparison) {
  nlohmann::ordered_json json;
  json["test"] = asUtf8(comparison.test);
  json["reference"] = asUtf8(comparison.reference);
  json["size"] = {comparison.size.x, comparison.size.y};
  const glm::dvec3& background = comparison.options.background;
  json["background"] = {background.r, background.g, background.b};
  json["pixels_per_degree"] = comparison.options.pixelsPerDegree;
  for (const LayerDifference& layer : comparison.layers) {
    nlohmann::ordered_json entry{{"name", layer.name}, {"channels", layer.channels}};
    for (const Measure& measure : kMeasures) {
      const std::optional<double> value = measure.of(layer.difference);
      entry[measure.key] = value ? numberOrText(*value) : nlohmann::ordered_json();
    }
    const glm::ivec2 at = fromTopLeft(layer, comparison);
    entry["max_error_pixel"] = {at.x, at.y};
    entry["non_finite_differing"] = layer.difference.nonFiniteDiffering;
    entry["non_finite_equal"] = layer.difference.nonFiniteEqual;
    json["layers"].push_back(entry);
  }
  json["limits"] = nlohmann::ordered_json::array();
  bool passed = true;
  for (const Verdict& verdict : comparison.verdicts) {
    json["limits"].push_back({{"layer", verdict.layer},
                              {"measure", verdict.measure->key},
                              {"value", numberOrText(verdict.value)},
                              {"limit", verdict.limit},
                              {"passed", verdict.passed}});
    passed = passed && verdict.passed;
  }
  json["passed"] = passed;
  std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

void complain(const Comparison& comparison) {
  for (const LayerDifference& layer : comparison.layers) {
    const bool judged = std::any_of(comparison.verdicts.begin(), comparison.verdicts.end(),
                                    [&](const Verdict& verdict) { return verdict.layer == layer.name; });
    if (judged && layer.difference.nonFiniteDiffering > 0) std::cerr << "umbrick: " << finiteInOneOnly(layer) << '\n';
  }
  for (const Verdict& verdict : comparison.verdicts)
    if (!isKept(*verdict.measure, verdict.value, verdict.limit))
      std::cerr << "umbrick: " << verdict.layer << ": " << verdict.measure->title << " is "
                << digits("%.9g", verdict.value) << ", " << verdict.measure->option << " is "
                << digits("%.9g", verdict.limit) << '\n';
}

}  // namespace umbrick::tools
