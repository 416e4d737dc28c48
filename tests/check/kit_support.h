// A kit in a temporary folder, read as another renderer would read it: from raw numbers, CSV and JSON alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "umbrick/check/kit_cases.h"
#include "umbrick/check/kit_export.h"
#include "umbrick/check/kit_verdict.h"
#include "umbrick/image/exr.h"
#include "umbrick/render/render.h"

namespace umbrick {

inline KitCase hardCase(const std::string& name) {
  std::vector<KitCase> cases = hardCases();
  const auto found = std::find_if(cases.begin(), cases.end(), [&](const auto& each) { return each.name == name; });
  if (found == cases.end()) throw std::runtime_error("no case " + name);
  return *found;
}

inline std::vector<float> readFloats(const std::filesystem::path& path) {
  const std::string bytes = readBytes(path);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

/// The columns of a table by their names, as text.
inline std::map<std::string, std::vector<std::string>> readColumns(const std::filesystem::path& path) {
  std::istringstream in(readBytes(path));
  const auto fieldsOf = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream text(line);
    for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
    return fields;
  };
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = fieldsOf(line);
  std::map<std::string, std::vector<std::string>> columns;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = fieldsOf(line);
    for (std::size_t i = 0; i < names.size(); ++i) columns[names[i]].push_back(fields.at(i));
  }
  return columns;
}

inline std::vector<double> numbersOf(const std::vector<std::string>& texts) {
  std::vector<double> numbers;
  for (const std::string& text : texts) numbers.push_back(std::stod(text));
  return numbers;
}

/// A case of a kit, as its README says that it is to be read.
class KitInput {
 public:
  explicit KitInput(std::filesystem::path folder)
      : folder_(std::move(folder)),
        json(nlohmann::json::parse(readBytes(folder_ / "case.json"))),
        voxels(readFloats(folder_ / "volume.raw")) {
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = json["volume"]["first_voxel"][static_cast<std::size_t>(axis)];
      dims[axis] = json["volume"]["dims"][static_cast<std::size_t>(axis)];
    }
    background = json["volume"]["background"];
    const auto columns = readColumns(folder_ / "transfer.csv");
    transfer = {numbersOf(columns.at("value")), numbersOf(columns.at("albedo_r")), numbersOf(columns.at("albedo_g")),
                numbersOf(columns.at("albedo_b")), numbersOf(columns.at("sigma_t"))};
  }

  static glm::dmat4 matrix(const nlohmann::json& rows) {
    glm::dmat4 m;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        m[column][row] = rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    return m;
  }
  double voxel(glm::dvec3 at) const {
    at -= first;
    if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= dims.x || at.y >= dims.y || at.z >= dims.z) return background;
    return voxels[static_cast<std::size_t>((at.z * dims.y + at.y) * dims.x + at.x)];
  }
  /// Interpolates by three linear steps, which is not how the library does it.
  double value(const glm::dvec3& p) const {
    const glm::dvec3 c = glm::floor(p), t = p - c;
    const auto alongX = [&](double y, double z) {
      const double a = voxel(c + glm::dvec3(0, y, z)), b = voxel(c + glm::dvec3(1, y, z));
      return a + t.x * (b - a);
    };
    const auto alongY = [&](double z) { return alongX(0, z) + t.y * (alongX(1, z) - alongX(0, z)); };
    return alongY(0) + t.z * (alongY(1) - alongY(0));
  }
  /// Returns albedo and sigma_t.
  glm::dvec4 medium(double v) const {
    const std::vector<double>& points = transfer[0];
    const auto next = static_cast<std::size_t>(std::upper_bound(points.begin(), points.end(), v) - points.begin());
    const std::size_t high = std::min(next, points.size() - 1), low = next == 0 ? 0 : next - 1;
    const double share = high == low ? 0 : (v - points[low]) / (points[high] - points[low]);
    glm::dvec4 result;
    for (int c = 0; c < 4; ++c) {
      const std::vector<double>& column = transfer[static_cast<std::size_t>(c) + 1];
      result[c] = column[low] + share * (column[high] - column[low]);
    }
    return result;
  }

 private:
  std::filesystem::path folder_;

 public:
  nlohmann::json json;
  std::vector<float> voxels;
  glm::dvec3 first{0}, dims{0};
  double background = 0;
  std::vector<std::vector<double>> transfer;
};

/// A kit of some of the built-in cases, and answers to it.
class KitFolder {
 public:
  explicit KitFolder(const std::vector<KitCase>& cases, const KitOptions& options = {}) {
    summary = exportKit(root(), cases, options);
  }

  std::filesystem::path root() const { return folder_.path() / "kit"; }
  std::filesystem::path caseFolder(const std::string& name) const { return root() / "cases" / name; }
  std::filesystem::path answer(const std::string& name, const std::string& file) const {
    const std::filesystem::path folder = root() / "answers" / name;
    std::filesystem::create_directories(folder);
    return folder / file;
  }
  KitInput input(const std::string& name) const { return KitInput(caseFolder(name)); }

  Image reference(const std::string& name, const std::string& view) const {
    return readExr(caseFolder(name) / (view + ".exr")).layers.front().image;
  }
  void answerPicture(const std::string& name, const std::string& file, const Image& image) const {
    writeExr(answer(name, file), {{"", image}}, {ExrPixel::float32, {}});
  }
  /// Answers each sample by its index coordinates and the value that is exact. @param value  what is answered
  void answerSamples(const std::string& name,
                     const std::function<double(std::size_t id, const glm::dvec3& index, double exact)>& value,
                     const std::string& file = "samples.csv") const {
    const auto columns = readColumns(caseFolder(name) / "samples.csv");
    const std::vector<double> i = numbersOf(columns.at("i")), j = numbersOf(columns.at("j")),
                              k = numbersOf(columns.at("k")), exact = numbersOf(columns.at("value"));
    std::ostringstream out;
    out.precision(17);
    out << "id,value\n";
    for (std::size_t id = 0; id < i.size(); ++id)
      out << id << ',' << value(id, glm::dvec3(i[id], j[id], k[id]), exact[id]) << '\n';
    writeBytes(answer(name, file), out.str());
  }
  KitJudgement judge(const KitTolerance& tolerance = {}) const { return judgeKit(root(), tolerance); }

  KitSummary summary;

 private:
  TemporaryFolder folder_;
};

/// The verdicts that failed, a line each, for messages of tests.
inline std::string failuresOf(const KitJudgement& judgement) {
  std::ostringstream text;
  for (const KitVerdict& v : judgement.verdicts)
    if (v.outcome == KitOutcome::failed)
      text << v.kitCase << ' ' << v.asked << ": " << v.invariant << ": " << v.worst << " of " << v.limit << ", RMSE "
           << v.rmse << " of " << v.rmseLimit << ", " << v.where << "; hint: " << v.hint << '\n';
  return text.str();
}

}  // namespace umbrick
