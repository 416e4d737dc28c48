// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/kit_verdict.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "check/kit_hints.h"
#include "check/kit_reader.h"
#include "check/steps.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "umbrick/core/short_number.h"

namespace umbrick {
namespace {
namespace fs = std::filesystem;

// Errors at brick borders are called a seam where they are so many times larger than elsewhere.
constexpr double kSeamTimes = 4;
// Two answers of one renderer may be stored as half floats; in a PNG they may be off by one level.
constexpr double kSameHalf = 1e-3, kSameLevel = 1e-2;
constexpr const char* kNoSeam = "no seam at brick borders";
constexpr const char* kReadable = "the answer can be read";
constexpr const char* kUnbricked = ".unbricked";

std::string digits(double number) { return shortNumber(number, 4); }
std::string point(const glm::dvec3& p) {
  return "(" + shortNumber(p.x, 9) + ", " + shortNumber(p.y, 9) + ", " + shortNumber(p.z, 9) + ")";
}
std::string brickWords(const AskedCase& asked, int brick) {
  if (brick < 0) return "no brick";
  return "brick " + std::to_string(brick) + " at " + point(glm::dvec3(asked.origins[static_cast<std::size_t>(brick)]));
}

// The root of a mean square and the largest of errors that are added one by one.
class ErrorSum {
 public:
  void add(double error, std::size_t place) {
    sum_ += error * error;
    ++count_;
    if (count_ > 1 && !(error > worst_)) return;
    worst_ = error;
    place_ = place;
  }
  std::size_t count() const { return count_; }
  double worst() const { return worst_; }
  std::size_t place() const { return place_; }
  double rmse() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0; }

 private:
  double sum_ = 0, worst_ = 0;
  std::size_t count_ = 0, place_ = 0;
};

// How far a channel of a PNG may be off by its rounding: the sRGB curve rises by at most 2.28 a unit, colour is
// multiplied by alpha, and both are rounded by half a level.
double levelRounding(double alpha, bool colour) {
  constexpr double kHalfLevel = 0.5 / 255;
  return kHalfLevel * (colour ? 2.28 * alpha + 1 : 1);
}

class CaseJudge {
 public:
  CaseJudge(const KitFiles& files, AskedCase asked, const KitTolerance& tolerance, KitJudgement& judgement,
            std::set<fs::path>& known)
      : asked_(std::move(asked)),
        folder_(files.answers(asked_.name)),
        tolerance_(tolerance),
        judgement_(judgement),
        known_(known),
        voxel_(voxelsOf(asked_.grid)),
        background_(voxel_(glm::i64vec3(asked_.box.min))) {}

  void judgeSamples() {
    const auto bricked = sampleAnswer("samples"), unbricked = sampleAnswer(std::string("samples") + kUnbricked);
    if (!bricked) return;
    if (!areFinite("samples", *bricked, [&](std::size_t i) { return sampleWords(i); })) return;
    compareSamples(*bricked);
    if (!unbricked || !areFinite("samples", *unbricked, [&](std::size_t i) { return sampleWords(i); })) return;
    KitVerdict verdict = begin("samples", "bricked equals unbricked");
    verdict.limit = sampleLimit();
    ErrorSum errors;
    for (std::size_t i = 0; i < bricked->size(); ++i) {
      const double error = std::abs((*bricked)[i] - (*unbricked)[i]);
      errors.add(error, i);
      verdict.wrong += !(error <= verdict.limit);
    }
    verdict.where = sampleWords(errors.place());
    finish(std::move(verdict), errors);
  }

  void judgePicture(const AskedPicture& picture) {
    const std::optional<Image> bricked = pictureAnswer(picture, picture.name);
    const std::optional<Image> unbricked = pictureAnswer(picture, picture.name + kUnbricked);
    const bool png = lastWasPng_;
    if (!bricked) return;
    const auto words = [&](std::size_t i) { return pixelWords(picture, i); };
    if (!areFinite(picture.name, bricked->pixels, words)) return;
    comparePicture(picture, *bricked, brickedIsPng_);
    if (!unbricked || !areFinite(picture.name, unbricked->pixels, words)) return;
    KitVerdict verdict = begin(picture.name, "bricked equals unbricked");
    verdict.limit = png || brickedIsPng_ ? kSameLevel : kSameHalf;
    ErrorSum errors;
    std::vector<double> pixelErrors(bricked->pixels.size() / 4, 0);
    for (std::size_t i = 0; i < bricked->pixels.size(); ++i) {
      const double error = std::abs(static_cast<double>(bricked->pixels[i]) - unbricked->pixels[i]);
      errors.add(error, i);
      pixelErrors[i / 4] = std::max(pixelErrors[i / 4], error);
    }
    countPixels(pixelErrors, verdict);
    verdict.where = words(errors.place());
    finish(std::move(verdict), errors);
  }

  const std::vector<AskedPicture>& pictures() const { return asked_.pictures; }

 private:
  KitVerdict begin(const std::string& what, const std::string& invariant) const {
    KitVerdict verdict;
    verdict.kitCase = asked_.name;
    verdict.asked = what;
    verdict.invariant = invariant;
    return verdict;
  }
  void finish(KitVerdict verdict, const ErrorSum& errors) {
    verdict.worst = errors.worst();
    verdict.rmse = errors.rmse();
    if (verdict.compared == 0) verdict.compared = errors.count();
    const bool passed = verdict.worst <= verdict.limit && (verdict.rmseLimit == 0 || verdict.rmse <= verdict.rmseLimit);
    verdict.outcome = passed ? KitOutcome::passed : KitOutcome::failed;
    judgement_.verdicts.push_back(std::move(verdict));
  }
  void fail(const std::string& what, const std::string& invariant, const std::string& where,
            const std::string& hint = {}) {
    KitVerdict verdict = begin(what, invariant);
    verdict.outcome = KitOutcome::failed;
    verdict.where = where;
    verdict.hint = hint;
    judgement_.verdicts.push_back(std::move(verdict));
  }

  // Reads an answer; one that is missing or broken gets its verdict.
  template <class Read>
  auto readAnswer(const std::string& what, const std::string& stem, const std::vector<std::string>& extensions,
                  const Read& read) -> std::optional<decltype(read(fs::path()))> {
    const std::optional<fs::path> path = findAnswer(folder_, stem, extensions);
    if (!path) {
      if (!stem.ends_with(kUnbricked)) judgement_.verdicts.push_back(begin(what, {}));
      return std::nullopt;
    }
    known_.insert(*path);
    try {
      return read(*path);
    } catch (const Error& error) {
      fail(what, kReadable, error.what());
      return std::nullopt;
    }
  }

  template <class Numbers, class Words>
  bool areFinite(const std::string& what, const Numbers& numbers, const Words& words) {
    const auto wrong = [](auto number) { return !std::isfinite(number); };
    const auto first = std::find_if(numbers.begin(), numbers.end(), wrong);
    if (first == numbers.end()) return true;
    KitVerdict verdict = begin(what, "all numbers are finite");
    verdict.outcome = KitOutcome::failed;
    verdict.compared = numbers.size();
    verdict.wrong = static_cast<std::size_t>(std::count_if(numbers.begin(), numbers.end(), wrong));
    verdict.where =
        words(static_cast<std::size_t>(first - numbers.begin())) + ": found " + digits(static_cast<double>(*first));
    judgement_.verdicts.push_back(std::move(verdict));
    return false;
  }

  // --- samples ---

  double sampleLimit() const { return tolerance_.rounding * asked_.valueRange; }

  std::optional<std::vector<double>> sampleAnswer(const std::string& stem) {
    return readAnswer("samples", stem, kSampleExtensions,
                      [&](const fs::path& path) { return readSampleAnswer(path, asked_.samples.size()); });
  }

  std::string sampleWords(std::size_t i) const {
    const KitSample& sample = asked_.samples[i];
    const glm::dvec3 world(asked_.grid.indexToWorld() * glm::dvec4(sample.index, 1));
    return "sample " + std::to_string(i) + " at index " + point(sample.index) + ", world " + point(world) + ", in " +
           brickWords(asked_, sample.brick);
  }

  void compareSamples(const std::vector<double>& answer) {
    constexpr std::pair<SamplePlace, const char*> kRows[]{{SamplePlace::inside, "samples inside bricks are exact"},
                                                          {SamplePlace::border, "samples at brick borders are exact"},
                                                          {SamplePlace::outside, "samples outside are background"}};
    // One mistake explains the samples of all places, or none.
    std::string hint;
    bool tried = false;
    double inside = 0;
    for (const auto& [place, invariant] : kRows) {
      KitVerdict verdict = begin("samples", invariant);
      verdict.limit = sampleLimit();
      ErrorSum errors;
      std::map<int, std::size_t> wrongByBrick;
      for (std::size_t i = 0; i < answer.size(); ++i) {
        const KitSample& sample = asked_.samples[i];
        if (sample.place != place) continue;
        const double error = std::abs(answer[i] - sample.value);
        errors.add(error, i);
        if (error <= verdict.limit) continue;
        ++verdict.wrong;
        ++wrongByBrick[sample.brick];
      }
      if (errors.count() == 0) continue;
      if (place == SamplePlace::inside) inside = errors.rmse();
      if (verdict.wrong > 0) {
        if (place == SamplePlace::border && errors.rmse() > kSeamTimes * inside) verdict.invariant = kNoSeam;
        const KitSample& worst = asked_.samples[errors.place()];
        verdict.where = sampleWords(errors.place()) + ": found " + digits(answer[errors.place()]) + ", expected " +
                        digits(worst.value);
        if (wrongByBrick.size() == 1 && verdict.wrong > 1 && worst.brick >= 0)
          verdict.where += "; all of the wrong ones are in this brick";
        if (!std::exchange(tried, true)) hint = explainSamples(asked_, answer, verdict.limit);
        verdict.hint = hint;
      }
      finish(std::move(verdict), errors);
    }
  }

  // --- pictures ---

  std::optional<Image> pictureAnswer(const AskedPicture& picture, const std::string& stem) {
    bool png = false;
    const auto answer = readAnswer(picture.name, stem, kPictureExtensions, [&](const fs::path& path) {
      png = path.extension() == ".png";
      return readPictureAnswer(path, picture.colour.width, picture.colour.height);
    });
    (stem == picture.name ? brickedIsPng_ : lastWasPng_) = png;
    if (!answer) return std::nullopt;
    if (answer->width == picture.colour.width && answer->height == picture.colour.height) return answer;
    fail(picture.name, kReadable,
         findAnswer(folder_, stem, kPictureExtensions)->string() + ": expected " +
             std::to_string(picture.colour.width) + " x " + std::to_string(picture.colour.height) + " pixels, found " +
             std::to_string(answer->width) + " x " + std::to_string(answer->height),
         explainSize(picture, *answer));
    return std::nullopt;
  }

  static void countPixels(const std::vector<double>& errors, KitVerdict& verdict) {
    verdict.compared = errors.size();
    verdict.wrong = static_cast<std::size_t>(
        std::count_if(errors.begin(), errors.end(), [&](double error) { return !(error <= verdict.limit); }));
  }

  // Returns the place at the mean depth of a pixel, index coordinates; none where nothing is seen.
  std::optional<glm::dvec3> seenAt(const AskedPicture& picture, int x, int y) const {
    const double depth = *picture.depth.at(x, y);
    if (!std::isfinite(depth)) return std::nullopt;
    const Camera& camera = picture.scene.camera;
    const CameraFrame frame = cameraFrame(camera);
    const ScreenPlane screen = screenPlane(camera);
    const glm::dvec2 p = (glm::dvec2(x, y) + 0.5) * screen.pixelSize - screen.halfExtent;
    const glm::dvec3 across = p.x * frame.right + p.y * frame.up;
    const glm::dvec3 world = camera.projection == Projection::perspective
                                 ? camera.eye + depth * (frame.forward + across)
                                 : camera.eye + across + depth * frame.forward;
    return glm::dvec3(glm::inverse(asked_.grid.indexToWorld()) * glm::dvec4(world, 1));
  }

  // @param i  of a channel, in the order of Image
  std::string pixelWords(const AskedPicture& picture, std::size_t i) const {
    const int width = picture.colour.width, pixel = static_cast<int>(i / 4);
    const int x = pixel % width, y = pixel / width;
    std::string words = "pixel (" + std::to_string(x) + ", " + std::to_string(picture.colour.height - 1 - y) +
                        ") from the top left, channel " + "RGBA"[i % 4];
    if (const auto index = seenAt(picture, x, y))
      words += ", which sees " + point(glm::dvec3(asked_.grid.indexToWorld() * glm::dvec4(*index, 1))) + " in " +
               brickWords(asked_, asked_.bricks.at(*index));
    return words;
  }

  // Where a pixel looks: at the border of two bricks that both hold something there, at the rim of the medium where
  // that is a border, too, or neither. A face that is seen from the front is no border.
  enum class Look { inside, border, rim };
  Look lookOf(const AskedPicture& picture, const glm::dvec3& index, const glm::dvec3& forwardIndex) const {
    constexpr double kNear = 0.75, kAlong = 0.9;  // voxels
    const glm::dvec3 origin = asked_.bricks.originAt(index), inBrick = index + 0.5 - origin;
    const bool parallel = picture.scene.camera.projection == Projection::orthographic;
    Look look = Look::inside;
    for (int axis = 0; axis < 3; ++axis) {
      const double edge = asked_.bricks.interior()[axis];
      const bool low = inBrick[axis] < kNear, high = edge - inBrick[axis] < kNear;
      if ((!low && !high) || (parallel && std::abs(forwardIndex[axis]) > kAlong)) continue;
      glm::i64vec3 first(glm::round(index));
      first[axis] = static_cast<std::int64_t>(origin[axis] + (low ? 0 : edge)) - 1;  // the last one before the face
      glm::i64vec3 second = first;
      ++second[axis];
      if (voxel_(first) == background_ || voxel_(second) == background_) return Look::rim;
      look = Look::border;
    }
    return look;
  }

  bool isSeam(const AskedPicture& picture, const std::vector<double>& pixelErrors) const {
    const glm::dvec3 forward =
        glm::inverse(glm::dmat3(asked_.grid.indexToWorld())) * cameraFrame(picture.scene.camera).forward;
    const glm::dvec3 direction = glm::normalize(forward);
    double near = 0, far = 0;
    std::size_t nearCount = 0, farCount = 0;
    for (std::size_t pixel = 0; pixel < pixelErrors.size(); ++pixel) {
      const int x = static_cast<int>(pixel) % picture.colour.width, y = static_cast<int>(pixel) / picture.colour.width;
      const auto index = seenAt(picture, x, y);
      if (!index || asked_.bricks.at(*index) < 0) continue;
      const Look look = lookOf(picture, *index, direction);
      if (look == Look::rim) continue;
      const bool border = look == Look::border;
      (border ? near : far) += pixelErrors[pixel];
      ++(border ? nearCount : farCount);
    }
    constexpr std::size_t kLeast = 16;
    if (nearCount < kLeast || farCount < kLeast) return false;
    return near / static_cast<double>(nearCount) > kSeamTimes * far / static_cast<double>(farCount);
  }

  void comparePicture(const AskedPicture& picture, const Image& answer, bool png) {
    KitVerdict verdict = begin(picture.name, "the picture agrees with the reference");
    verdict.limit = tolerance_.picture;
    verdict.rmseLimit = tolerance_.picture / 4;
    ErrorSum errors;
    std::vector<double> pixelErrors(answer.pixels.size() / 4, 0);
    for (std::size_t i = 0; i < answer.pixels.size(); ++i) {
      const double expected = picture.colour.pixels[i];
      double allowed = picture.errorBar.pixels[i];
      if (png) allowed += levelRounding(picture.colour.pixels[i | 3], i % 4 != 3);
      const double error = std::max(0.0, std::abs(answer.pixels[i] - expected) - allowed);
      errors.add(error, i);
      pixelErrors[i / 4] = std::max(pixelErrors[i / 4], error);
    }
    countPixels(pixelErrors, verdict);
    if (!(errors.worst() <= verdict.limit && errors.rmse() <= verdict.rmseLimit)) {
      const std::size_t i = errors.place();
      verdict.where = pixelWords(picture, i) + ": found " + digits(answer.pixels[i]) + ", expected " +
                      digits(picture.colour.pixels[i]);
      verdict.hint = explainPicture(asked_, picture, answer);
      if (verdict.hint.empty() && isSeam(picture, pixelErrors)) verdict.invariant = kNoSeam;
    }
    finish(std::move(verdict), errors);
  }

  AskedCase asked_;
  fs::path folder_;
  const KitTolerance& tolerance_;
  KitJudgement& judgement_;
  std::set<fs::path>& known_;
  VoxelAt voxel_;
  double background_;
  bool brickedIsPng_ = false, lastWasPng_ = false;
};

// Lists files among the answers that no case asks for, such as those with a name that is misspelt.
std::vector<std::string> unknownFiles(const KitFiles& files, const std::set<fs::path>& known) {
  std::vector<std::string> unknown;
  std::error_code error;
  for (auto at = fs::recursive_directory_iterator(files.answers(), error); !error && at != fs::end(at);
       at.increment(error)) {
    if (at->is_directory(error) || known.contains(at->path())) continue;
    if (at->path().filename().string().starts_with('.')) continue;
    unknown.push_back(printable(at->path().lexically_relative(files.root).string()));
  }
  std::sort(unknown.begin(), unknown.end());
  return unknown;
}

void checkTolerance(const char* field, double value) {
  if (!(value > 0 && value <= 1))
    throw InvalidArgument(std::string(field) + ": is " + shortNumber(value, 6) + ", must be above 0 and at most 1");
}

}  // namespace

bool KitJudgement::passed() const {
  const auto has = [&](KitOutcome outcome) {
    return std::any_of(verdicts.begin(), verdicts.end(),
                       [&](const auto& verdict) { return verdict.outcome == outcome; });
  };
  return complete && has(KitOutcome::passed) && !has(KitOutcome::failed);
}

KitJudgement judgeKit(const fs::path& folder, const KitTolerance& tolerance,
                      const std::function<bool(const std::string& step, double done)>& progress) {
  checkTolerance("tolerance", tolerance.picture);
  checkTolerance("rounding", tolerance.rounding);
  const KitFiles files{folder};
  const std::vector<std::string> names = readKit(files);
  KitJudgement judgement;
  std::set<fs::path> known;
  CheckSteps steps(progress);
  steps.expect(static_cast<double>(names.size()));
  try {
    for (const std::string& name : names) {
      steps.begin("case " + name, 1);
      CaseJudge judge(files, readCase(files, name), tolerance, judgement, known);
      judge.judgeSamples();
      for (const AskedPicture& picture : judge.pictures()) {
        steps.within(0.5);
        judge.judgePicture(picture);
      }
    }
  } catch (const CheckStopped&) {
    judgement.complete = false;
  }
  judgement.unknown = unknownFiles(files, known);
  return judgement;
}

}  // namespace umbrick
