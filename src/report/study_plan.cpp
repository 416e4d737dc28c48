#include "umbrick/report/study_plan.h"

#include <algorithm>
#include <cmath>

#include "core/json_writer.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {
constexpr double kRightAngle = 1.5707963267948966;
constexpr double kEightyDegrees = 80 * 3.14159265358979323846 / 180;

std::string printed(int value) { return std::to_string(value); }
std::string printed(double theta) { return jsonDegrees(theta); }
std::string printed(const std::string& name) { return name; }
std::string printed(const BufferBits& bits) { return std::to_string(bits.eye) + "/" + std::to_string(bits.occlusion); }

// From the smallest to the largest; bits of the eye count first.
bool less(const BufferBits& a, const BufferBits& b) {
  return a.eye != b.eye ? a.eye < b.eye : a.occlusion < b.occlusion;
}
template <class T>
bool less(const T& a, const T& b) {
  return a < b;
}

template <class T>
void sortList(const std::string& name, std::vector<T>& list) {
  if (list.empty()) throw InvalidArgument(name + ": nothing to sweep, expected at least one");
  std::sort(list.begin(), list.end(), [](const T& a, const T& b) { return less(a, b); });
  const auto twice = std::adjacent_find(list.begin(), list.end());
  if (twice != list.end()) throw InvalidArgument(name + ": " + printed(*twice) + " is given twice");
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
  // In the order of the registry, so that the order of the command line does not matter.
  std::vector<std::string> complete;
  for (const StudyMethod& method : studyMethods())
    if (std::find(names.begin(), names.end(), method.name) != names.end()) complete.push_back(method.name);
  return complete;
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
    if (!complete.contains(name)) throw InvalidArgument("no method of this study has a " + name + " to sweep");
  return complete;
}

// Of angles that were read from degrees in different ways.
bool sameAngle(double a, double b) { return std::abs(a - b) < 1e-9; }

StudySettings completed(StudySettings settings, double aperture) {
  settings.methods = completeMethods(settings.methods);
  settings.details = completeDetails(settings);
  sortList("slices", settings.slices);
  checkRange("slices", settings.slices, 1, 100'000);
  sortList("bits", settings.bits);
  for (const BufferBits& bits : settings.bits)
    for (const int buffer : {bits.eye, bits.occlusion})
      if (buffer != 16 && buffer != 32)
        throw InvalidArgument("bits: is " + std::to_string(buffer) + ", must be 16 or 32");
  sortList("segments", settings.segments);
  checkRange("segments", settings.segments, 1, 8);
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

int middleOf(const std::vector<int>& sorted) { return sorted[sorted.size() / 2]; }

// Everything that a method is swept over, each value once.
class CaseList {
 public:
  CaseList(const StudyPlan& plan, const StudyMethod& method, std::vector<StudyCase>& cases)
      : plan_(plan), method_(method), cases_(cases) {}

  StudyCase base() const {
    StudyCase one;
    one.method = method_.name;
    one.slices = plan_.baseSlices;
    one.segments = plan_.baseSegments;
    one.detail = method_.detail.name.empty() ? 0 : plan_.baseDetails.at(method_.detail.name);
    one.bits = plan_.baseBits;
    one.size = plan_.baseSize;
    one.theta = plan_.baseTheta;
    return one;
  }
  void add(StudyCase one) {
    if (method_.model == Model::emission) {
      one.theta = 0;
      one.bits.occlusion = one.bits.eye;
    }
    if (std::find(cases_.begin(), cases_.end(), one) == cases_.end()) cases_.push_back(one);
  }
  template <class T>
  void sweep(T StudyCase::*field, const std::vector<T>& values) {
    for (const T& value : values) {
      StudyCase one = base();
      one.*field = value;
      add(one);
    }
  }

 private:
  const StudyPlan& plan_;
  const StudyMethod& method_;
  std::vector<StudyCase>& cases_;
};

void appendCases(StudyPlan& plan, const StudyMethod& method) {
  const StudySettings& settings = plan.settings;
  CaseList list(plan, method, plan.cases);
  const std::vector<int> none{0};
  const std::vector<int>& details = method.detail.name.empty() ? none : settings.details.at(method.detail.name);
  for (const int detail : details)
    for (const int slices : settings.slices) {
      StudyCase one = list.base();
      one.detail = detail;
      one.slices = slices;
      list.add(one);
    }
  list.sweep(&StudyCase::segments, settings.segments);
  list.sweep(&StudyCase::bits, settings.bits);
  list.sweep(&StudyCase::size, settings.sizes);
  list.sweep(&StudyCase::theta, settings.thetas);
}

void appendReference(StudyPlan& plan, const StudyReference& reference) {
  auto& all = plan.references;
  if (std::find(all.begin(), all.end(), reference) == all.end()) all.push_back(reference);
}

}  // namespace

StudySettings quickStudySettings() {
  StudySettings quick;
  for (const StudyMethod& method : studyMethods()) {
    if (!method.quick) continue;
    quick.methods.push_back(method.name);
    if (!method.detail.name.empty()) quick.details[method.detail.name] = method.detail.quick;
  }
  quick.slices = {32, 64, 128, 256, 512};
  quick.bits = {{32, 32}, {16, 16}};
  quick.segments = {1, 4};
  quick.sizes = {64, 128};
  quick.repeats = 3;
  quick.directions = 48;
  quick.tolerance = 4e-3;
  return quick;
}

std::string StudyCase::id() const {
  const StudyMethod& known = studyMethod(method);
  std::string text = method;
  if (!known.detail.name.empty()) text += "-" + known.detail.symbol + std::to_string(detail);
  text += "-N" + std::to_string(slices) + "-k" + std::to_string(segments) + "-e" + std::to_string(bits.eye);
  if (known.model != Model::emission) text += "o" + std::to_string(bits.occlusion);
  text += "-s" + std::to_string(size);
  if (known.model != Model::emission) text += "-t" + jsonDegrees(theta);
  return text;
}

std::string StudyReference::id() const {
  std::string text = modelName(model) + "-s" + std::to_string(size);
  if (model == Model::cone) text += "-t" + jsonDegrees(theta);
  return text;
}

StudyReference StudyPlan::referenceOf(const StudyCase& one) const {
  const Model model = studyMethod(one.method).model;
  return {model, one.size, model == Model::emission ? 0 : one.theta};
}

StudyPlan planStudy(const StudySettings& settings, double aperture) {
  StudyPlan plan;
  plan.settings = completed(settings, aperture);
  const StudySettings& complete = plan.settings;
  plan.baseSlices = middleOf(complete.slices);
  plan.baseSegments = complete.segments.front();
  plan.baseSize = complete.sizes.back();
  plan.baseBits = complete.bits.back();
  const auto& thetas = complete.thetas;
  const auto own = std::find_if(thetas.begin(), thetas.end(), [&](double theta) { return sameAngle(theta, aperture); });
  plan.baseTheta = own != thetas.end() ? *own : thetas.front();
  for (const auto& [name, values] : complete.details) plan.baseDetails[name] = middleOf(values);
  for (const std::string& name : complete.methods) appendCases(plan, studyMethod(name));
  for (const StudyCase& one : plan.cases) appendReference(plan, plan.referenceOf(one));
  // The model error: the cone beside the whole sphere, at the base size.
  const bool occlusion = std::any_of(plan.references.begin(), plan.references.end(),
                                     [](const StudyReference& r) { return r.model == Model::cone; });
  if (occlusion) appendReference(plan, {Model::ambient, plan.baseSize, 0});
  return plan;
}

}  // namespace umbrick
