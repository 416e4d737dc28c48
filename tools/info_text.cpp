// SPDX-License-Identifier: Apache-2.0
#include "info_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {

constexpr const char* kUsualSources[] = {
    "source_format", "source_file", "modality", "series_description", "space",     "length_unit", "rescale",
    "value_unit",    "frame",       "time",     "time_step",          "time_unit", "cycle"};

}  // namespace

nlohmann::json jsonMatrix(const glm::dmat4& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row) {
    nlohmann::json entries = nlohmann::json::array();
    for (int column = 0; column < 4; ++column) entries.push_back(matrix[column][row]);
    rows.push_back(entries);
  }
  return rows;
}

void printJson(const nlohmann::json& json) {
  std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

void printHistogram(const std::vector<std::uint64_t>& histogram, double min, double max) {
  const auto most = histogram.empty() ? 0 : *std::max_element(histogram.begin(), histogram.end());
  const double bins = static_cast<double>(histogram.size());
  const auto edge = [&](std::size_t i) {
    const double share = static_cast<double>(i) / bins;
    return (1 - share) * min + share * max;
  };
  for (std::size_t i = 0; i < histogram.size(); ++i) {
    const auto bar = static_cast<std::size_t>(std::lround(40.0 * double(histogram[i]) / double(most)));
    char line[128];
    std::snprintf(line, sizeof line, "    %11.5g to %-11.5g %12llu ", edge(i), edge(i + 1),
                  static_cast<unsigned long long>(histogram[i]));
    std::cout << line << std::string(bar, '#') << '\n';
  }
}

bool isUsualSource(std::string_view key) {
  return std::find(std::begin(kUsualSources), std::end(kUsualSources), key) != std::end(kUsualSources);
}

void printSource(const std::map<std::string, std::string>& metadata) {
  for (const std::string key : kUsualSources) {
    const auto found = metadata.find(key);
    if (found == metadata.end()) continue;
    std::string label = key;
    label.resize(std::max<std::size_t>(label.size() + 1, 15), ' ');
    std::cout << "  " << label << printable(found->second) << '\n';
  }
}

}  // namespace umbrick::tools
