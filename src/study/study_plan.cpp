// SPDX-License-Identifier: Apache-2.0
#include "umbrick/study/study_plan.h"

#include <algorithm>
#include <cmath>

#include "core/json_writer.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {
constexpr double kRightAngle = 1.5707963267948966;
constexpr double kEightyDegrees = 80 * 3.14159265358979323846 / 180;

std::string printed(int value) { return std::to_string(value); }
std::string printed(double theta) { return jsonDegrees(theta); }
std::string printed(const std::string& name) { return name; }
std::string printed(const BufferBits& bits) { return std::to_string(bits.eye) + "/" + std::to_string(bits.occlusion); }

// Orders bits from the smallest to the largest; those of the eye count first.
bool less(const BufferBits& a, const BufferBits& b) {
  return a.eye != b.eye ? a.eye < b.eye : a.occlusion < b.occlusion;
}
template <class T>
bool less(const T& a, const T& b) {
  return a < b;
}

template <class T>
void sortList(const std::string& name, std::vector<T>& list, std::string (*print)(const T&)) {
  if (list.empty()) throw InvalidArgument(name + ": nothing to sweep, expected at least one");
  std::sort(list.begin(), list.end(), [](const T& a, const T& b) { return less(a, b); });
  const auto twice = std::adjacent_find(list.begin(), list.end());
  if (twice != list.end()) throw InvalidArgument(name + ": " + print(*twice) + " is given twice");
}
template <class T>
void sortList(const std::string& name, std::vector<T>& list) {
  sortList<T>(name, list, [](const T& value) { return printed(value); });
}

void checkRange(const std::string& name, const std::vector<int>& list, int least, int most) {
  for (const int value : list)
    if (value < least || value > most)
      throw InvalidArgument(name + ": is " + std::to_string(value) + ", must be in [" + std::to_string(least) + ", " +
                            std::to_string(most) + "]");
}

std::vector<std::string> completeMethods(std::vector<std::string> names) {
  if (names.empty())
    for (const StudyMethod& method : studyMethods())
      if (method.usual) names.push_back(method.name);
  std::vector<std::string> sorted = names;
  sortList("methods", sorted);
  for (const std::string& name : names) studyMethod(name);
  // The methods are in the order of the registry, so that the order in which they are given makes no difference.
  std::vector<std::string> complete;
  for (const StudyMethod& method : studyMethods())
    if (std::find(names.begin(), names.end(), method.name) != names.end()) complete.push_back(method.name);
  return complete;
}

std::string pluralOf(const std::string& detail) {
  for (const StudyMethod& method : studyMethods())
    if (method.detail.name == detail) return method.detail.plural;
  return "a " + detail;
}

std::map<std::string, std::vector<int>> completeDetails(const StudySettings& settings) {
  std::map<std::string, std::vector<int>> complete;
  for (const std::string& name : settings.methods) {
    const StudyMethod::Detail& detail = studyMethod(name).detail;
    if (detail.name.empty()) continue;
    const auto given = settings.details.find(detail.name);
    std::vector<int> values = given != settings.details.end() ? given->second : detail.full;
    sortList(detail.plural, values);
    checkRange(detail.plural, values, detail.least, detail.most);
    complete[detail.name] = values;
  }
  for (const auto& [name, values] : settings.details)
    if (!complete.contains(name)) throw InvalidArgument("no method of this study has " + pluralOf(name) + " to sweep");
  return complete;
}

std::vector<double> completeScales(const StudySettings& settings) {
  const bool windows = std::any_of(settings.methods.begin(), settings.methods.end(),
                                   [](const std::string& name) { return studyMethod(name).windows; });
  if (!windows && settings.scales && !settings.scales->empty())
    throw InvalidArgument("no method of this study has windows whose scales could be swept");
  std::vector<double> scales = settings.scales.value_or(windows ? kUsualScales : std::vector<double>());
  if (!scales.empty()) sortList<double>("scales", scales, [](const double& scale) { return jsonNumber(scale); });
  for (const double scale : scales)
    if (!(scale >= 1.0 / 64 && scale <= 64))
      throw InvalidArgument("scales: is " + (std::isfinite(scale) ? jsonNumber(scale) : std::to_string(scale)) +
                            ", must be in [0.015625, 64]");
  return scales;
}

// Tells whether two angles are the same that were read from degrees in different ways.
bool sameAngle(double a, double b) { return std::abs(a - b) < 1e-9; }

StudySettings completed(StudySettings settings, double aperture) {
  settings.methods = completeMethods(settings.methods);
  settings.details = completeDetails(settings);
  if (!settings.slices.empty()) sortList("slices", settings.slices);
  checkRange("slices", settings.slices, 1, 100'000);
  sortList("bits", settings.bits);
  for (const BufferBits& bits : settings.bits)
    for (const int buffer : {bits.eye, bits.occlusion})
      if (buffer != 16 && buffer != 32)
        throw InvalidArgument("bits: is " + std::to_string(buffer) + ", must be 16 or 32");
  sortList("segments", settings.segments);
  checkRange("segments", settings.segments, 1, 8);
  settings.scales = completeScales(settings);
  sortList("sizes", settings.sizes);
  checkRange("sizes", settings.sizes, 1, 65'536);
  if (settings.thetas.empty()) {
    settings.thetas = {aperture};
    if (!sameAngle(aperture, kEightyDegrees)) settings.thetas.push_back(kEightyDegrees);
  }
  for (const double theta : settings.thetas)
    if (!(theta >= 0 && theta < kRightAngle))
      throw InvalidArgument("thetas: is " + (std::isfinite(theta) ? jsonDegrees(theta) : std::to_string(theta)) +
                            " degrees, must be in [0, 90)");
  sortList("thetas", settings.thetas);
  checkRange("repeats", {settings.repeats}, 1, 1000);
  checkRange("reference directions", {settings.directions}, 2, 1'000'000);
  if (!(settings.tolerance >= 1e-9 && settings.tolerance <= 1))
    throw InvalidArgument("reference tolerance: is " + jsonNumber(settings.tolerance) + ", must be in [1e-9, 1]");
  return settings;
}

template <class T>
T middleOf(const std::vector<T>& sorted) {
  return sorted[sorted.size() / 2];
}

std::vector<int> slicesOf(const StudyMethod& method, const StudySettings& settings, int leastSlices) {
  if (!settings.slices.empty()) return settings.slices;
  std::vector<int> slices = settings.quick ? method.quickSlices : method.slices;
  std::erase_if(slices, [&](int count) { return count < leastSlices; });
  if (slices.empty())
    throw InvalidArgument("slices: fewer than " + std::to_string(leastSlices) + " cannot be drawn, and " + method.name +
                          " has no more to sweep; give others");
  return slices;
}

std::vector<int> detailsOf(const StudyMethod& method, const StudySettings& settings) {
  return method.detail.name.empty() ? std::vector<int>{0} : settings.details.at(method.detail.name);
}

StudyCase baseOf(const StudyPlan& plan, const StudyMethod& method) {
  StudyCase base;
  base.method = method.name;
  base.slices = middleOf(plan.slices.at(method.name));
  base.segments = method.fineSegments ? kAutomaticSegments : plan.settings.segments.front();
  base.detail = middleOf(detailsOf(method, plan.settings));
  base.bits = plan.baseBits;
  base.size = plan.baseSize;
  base.theta = plan.baseTheta;
  return base;
}

// Collects the cases of a method, each of them once.
class CaseList {
 public:
  CaseList(const StudyCase& base, std::vector<StudyCase>& cases) : base_(base), cases_(cases) {}

  void add(StudyCase one) {
    if (!traitsOf(studyMethod(one.method).model).occlusion) {
      one.theta = 0;
      one.bits.occlusion = one.bits.eye;
    }
    if (std::find(cases_.begin(), cases_.end(), one) == cases_.end()) cases_.push_back(one);
  }
  template <class T>
  void sweep(T StudyCase::*field, const std::vector<T>& values) {
    for (const T& value : values) {
      StudyCase one = base_;
      one.*field = value;
      add(one);
    }
  }
  // Adds all slices for each value.
  template <class T>
  void sweep(T StudyCase::*field, const std::vector<T>& values, const std::vector<int>& slices) {
    for (const T& value : values)
      for (const int count : slices) {
        StudyCase one = base_;
        one.*field = value;
        one.slices = count;
        add(one);
      }
  }

 private:
  const StudyCase& base_;
  std::vector<StudyCase>& cases_;
};

void appendCases(StudyPlan& plan, const StudyMethod& method) {
  const StudySettings& settings = plan.settings;
  const std::vector<int>& slices = plan.slices.at(method.name);
  CaseList list(plan.bases.at(method.name), plan.cases);
  list.sweep(&StudyCase::detail, detailsOf(method, settings), slices);
  list.sweep(&StudyCase::segments, settings.segments);
  list.sweep(&StudyCase::bits, settings.bits);
  list.sweep(&StudyCase::size, settings.sizes);
  if (method.windows) list.sweep(&StudyCase::scale, *settings.scales);
  list.sweep(&StudyCase::theta, settings.thetas, slices);
}

void appendReference(StudyPlan& plan, const StudyReference& reference) {
  auto& all = plan.references;
  if (std::find(all.begin(), all.end(), reference) == all.end()) all.push_back(reference);
}

}  // namespace

StudySettings quickStudySettings() {
  StudySettings quick;
  quick.quick = true;
  for (const StudyMethod& method : studyMethods()) {
    if (!method.quick) continue;
    quick.methods.push_back(method.name);
    if (!method.detail.name.empty()) quick.details[method.detail.name] = method.detail.quick;
  }
  quick.bits = {{32, 32}, {16, 16}};
  quick.segments = {1};
  quick.scales = std::vector<double>();
  quick.sizes = {64, 128};
  quick.repeats = 3;
  quick.directions = 48;
  quick.tolerance = 4e-3;
  return quick;
}

void showAs(StudyLook look, SceneSettings& scene) {
  static constexpr Mode kModesOfLooks[]{Mode::integrate, Mode::integrate, Mode::mip,        Mode::minip,
                                        Mode::average,   Mode::xray,      Mode::isosurface, Mode::hybrid};
  scene.mode = kModesOfLooks[static_cast<std::size_t>(look)];
  scene.shading.kind = look == StudyLook::phong ? Shading::phong : Shading::automatic;
}

bool needsSurfaces(StudyLook look) { return look == StudyLook::isosurface || look == StudyLook::hybrid; }

StudySettings techniqueSettings(bool quick, bool surfaces) {
  StudySettings settings = quick ? quickStudySettings() : StudySettings{};
  settings.methods.clear();
  settings.details.clear();
  for (const StudyMethod& method : studyMethods()) {
    if (!method.compared || (needsSurfaces(method.look) && !surfaces)) continue;
    settings.methods.push_back(method.name);
    if (!method.detail.name.empty()) settings.details[method.detail.name] = {middleOf(method.detail.full)};
  }
  settings.bits = {{32, 32}};
  settings.segments = {1};
  settings.scales = std::vector<double>();
  settings.sizes = {settings.sizes.back()};
  return settings;
}

std::string StudyCase::id() const {
  const StudyMethod& known = studyMethod(method);
  std::string text = method;
  if (!known.detail.name.empty()) text += "-" + known.detail.symbol + std::to_string(detail);
  text += "-N" + std::to_string(slices) + "-k" + (segments == kAutomaticSegments ? "a" : std::to_string(segments)) +
          "-e" + std::to_string(bits.eye);
  if (traitsOf(known.model).occlusion) text += "o" + std::to_string(bits.occlusion);
  text += "-s" + std::to_string(size);
  if (traitsOf(known.model).occlusion) text += "-t" + jsonDegrees(theta);
  if (scale > 0) text += "-w" + jsonNumber(scale);
  return text;
}

std::string StudyReference::id() const {
  std::string text = (look == StudyLook::medium ? modelName(model) : lookName(look)) + "-s" + std::to_string(size);
  if (traitsOf(model).cone) text += "-t" + jsonDegrees(theta);
  return text;
}

StudyReference StudyPlan::referenceOf(const StudyCase& one) const {
  const StudyMethod& method = studyMethod(one.method);
  return {method.model, one.size, !traitsOf(method.model).occlusion ? 0 : one.theta, method.look};
}

StudyPlan planStudy(const StudySettings& settings, double aperture, int leastSlices) {
  StudyPlan plan;
  plan.settings = completed(settings, aperture);
  const StudySettings& complete = plan.settings;
  plan.baseSize = complete.sizes.back();
  plan.baseBits = complete.bits.back();
  const auto& thetas = complete.thetas;
  const auto own = std::find_if(thetas.begin(), thetas.end(), [&](double theta) { return sameAngle(theta, aperture); });
  plan.baseTheta = own != thetas.end() ? *own : thetas.front();
  for (const std::string& name : complete.methods) {
    const StudyMethod& method = studyMethod(name);
    plan.slices[name] = slicesOf(method, complete, leastSlices);
    plan.bases[name] = baseOf(plan, method);
    appendCases(plan, method);
  }
  for (const StudyCase& one : plan.cases) appendReference(plan, plan.referenceOf(one));
  // The model error compares the cone with the whole sphere, at the base size.
  const bool occlusion = std::any_of(plan.references.begin(), plan.references.end(),
                                     [](const StudyReference& r) { return traitsOf(r.model).cone; });
  if (occlusion) appendReference(plan, {Model::ambient, plan.baseSize, 0, StudyLook::medium});
  return plan;
}

}  // namespace umbrick
