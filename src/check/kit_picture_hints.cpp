// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "check/kit_grids.h"
#include "check/kit_hints.h"
#include "check/picture_difference.h"
#include "umbrick/core/short_number.h"
#include "umbrick/core/srgb.h"
#include "umbrick/reference/reference.h"

namespace umbrick {
namespace {

// A mistake has to leave no more than this share of the error; and where it leaves no more than the second one, it is
// the one that was made.
constexpr double kExplains = 0.25, kExplainsAll = 0.02;

// Keeps the candidate that comes nearest to the answer.
class BestGuess {
 public:
  explicit BestGuess(const Image& answer, double error) : answer_(answer), error_(error), least_(kExplains * error) {}

  void offer(const Image& candidate, const std::string& sentence) {
    if (candidate.width != answer_.width || candidate.height != answer_.height) return;
    const double error = rmsDifference(answer_, candidate);
    if (!(error < least_)) return;
    least_ = error;
    sentence_ = sentence + " (RMSE " + shortNumber(error, 2) + " in place of " + shortNumber(error_, 2) + ")";
  }
  /// Returns what explains most of the error; empty: nothing does.
  const std::string& sentence() const { return sentence_; }
  /// Tells whether so little is left that nothing else needs to be tried.
  bool explainsAll() const { return least_ < kExplainsAll * error_; }

 private:
  const Image& answer_;
  double error_, least_;
  std::string sentence_;
};

// --- mistakes about pixels ---

template <class Source>
Image rearranged(const Image& image, int width, int height, const Source& source) {
  Image result(width, height, image.channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::pair<int, int> from = source(x, y);
      std::copy_n(image.at(from.first, from.second), image.channels, result.at(x, y));
    }
  return result;
}

Image transposed(const Image& image) {
  return rearranged(image, image.height, image.width, [](int x, int y) { return std::pair(y, x); });
}

void offerTurned(const Image& truth, BestGuess& best) {
  const int w = truth.width, h = truth.height;
  const std::string when = "the picture agrees when it is ";
  best.offer(rearranged(truth, w, h, [&](int x, int y) { return std::pair(x, h - 1 - y); }),
             when + "flipped vertically: the first row of a file is the top one");
  best.offer(rearranged(truth, w, h, [&](int x, int y) { return std::pair(w - 1 - x, y); }),
             when + "flipped horizontally: is the camera's right the cross product of forward and up?");
  best.offer(rearranged(truth, w, h, [&](int x, int y) { return std::pair(w - 1 - x, h - 1 - y); }),
             when + "turned by 180 degrees");
  if (w == h) best.offer(transposed(truth), when + "transposed: x is fastest in a row");
}

// Returns what is seen so many pixels further, between pixels by the cubic of Catmull and Rom through four of them.
Image movedAlong(const Image& image, double pixels, bool vertical) {
  if (pixels == 0) return image;
  Image result(image.width, image.height, image.channels);
  const int whole = static_cast<int>(std::floor(pixels));
  const double t = pixels - whole;
  const std::array<double, 4> weights{0.5 * t * (-1 + t * (2 - t)), 0.5 * (2 + t * t * (-5 + 3 * t)),
                                      0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (-1 + t)};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int tap = 0; tap < 4; ++tap) {
        const int further = whole - 1 + tap;
        const int sx = vertical ? x : std::clamp(x + further, 0, image.width - 1);
        const int sy = vertical ? std::clamp(y + further, 0, image.height - 1) : y;
        for (int c = 0; c < image.channels; ++c)
          result.at(x, y)[c] += static_cast<float>(weights[static_cast<std::size_t>(tap)]) * image.at(sx, sy)[c];
      }
  return result;
}

// Quarters of pixels, up to a whole one in each direction.
void offerMoved(const Image& truth, BestGuess& best) {
  constexpr int kSteps = 4;
  const auto words = [](int steps, const char* forward, const char* backward) {
    return shortNumber(std::abs(steps) / double(kSteps), 3) + (steps > 0 ? forward : backward);
  };
  for (int dx = -kSteps; dx <= kSteps; ++dx) {
    const Image aside = movedAlong(truth, dx / double(kSteps), false);
    for (int dy = -kSteps; dy <= kSteps; ++dy) {
      if (dx == 0 && dy == 0) continue;
      std::string way = dx != 0 ? words(dx, " to the right", " to the left") : "";
      if (dy != 0) way += (dx != 0 ? " and " : "") + words(dy, " up", " down");
      best.offer(movedAlong(aside, dy / double(kSteps), true),
                 "the picture agrees when it is moved by pixels, " + way +
                     ": rays go through the centres of pixels, at halves");
    }
  }
}

// --- mistakes about colour ---

template <class Change>
Image recoloured(const Image& image, const Change& change) {
  Image result = image;
  for (std::size_t i = 0; i < result.pixels.size(); i += 4) change(&result.pixels[i]);
  return result;
}

void offerRecoloured(const Image& truth, BestGuess& best) {
  const std::string when = "the picture agrees when ";
  best.offer(recoloured(truth, [](float* p) { std::swap(p[0], p[2]); }), when + "red and blue are exchanged");
  const auto encode = [](float c) {
    return static_cast<float>(linearToSrgb(std::clamp(static_cast<double>(c), 0.0, 1.0)));
  };
  best.offer(recoloured(truth,
                        [&](float* p) {
                          for (int c = 0; c < 3; ++c) p[c] = encode(p[c]);
                        }),
             when + "its colours are taken for sRGB: they are to be linear");
  best.offer(recoloured(truth,
                        [&](float* p) {
                          for (int c = 0; c < 3; ++c) p[c] = p[3] > 0 ? encode(p[c] / p[3]) * p[3] : 0;
                        }),
             when + "its colours over their alpha are taken for sRGB: they are to be linear");
  best.offer(recoloured(truth,
                        [](float* p) {
                          for (int c = 0; c < 3; ++c) p[c] = p[3] > 0 ? p[c] / p[3] : 0;
                        }),
             when + "its colours are multiplied by alpha: they are to be premultiplied");
  best.offer(recoloured(truth,
                        [](float* p) {
                          for (int c = 0; c < 3; ++c) p[c] *= p[3];
                        }),
             when + "its colours are divided by alpha: they are multiplied by it twice");
  best.offer(recoloured(truth, [](float* p) { p[3] = 1; }),
             when + "alpha is left out: it is 1 everywhere, as over a black background, and is to be the opacity");
  best.offer(recoloured(truth,
                        [](float* p) {
                          for (int c = 0; c < 3; ++c) p[c] += 1 - p[3];
                          p[3] = 1;
                        }),
             when + "a white background is taken away: there is to be none");
}

// --- mistakes about the medium and the voxels: pictures that are integrated again ---

// Returns by how much the medium of the answer is denser, as the median over pixels that are neither empty nor full.
std::optional<double> densityRatio(const Image& truth, const Image& answer) {
  std::vector<double> ratios;
  for (std::size_t i = 3; i < truth.pixels.size(); i += 4) {
    const double expected = truth.pixels[i], found = answer.pixels[i];
    if (expected > 0.02 && expected < 0.98 && found > 0 && found < 1)
      ratios.push_back(std::log1p(-found) / std::log1p(-expected));
  }
  constexpr std::size_t kLeast = 8;
  if (ratios.size() < kLeast) return std::nullopt;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

void offerIntegrated(const AskedCase& asked, const AskedPicture& picture, const Image& answer, BestGuess& best) {
  const auto offer = [&](const ScalarGrid& grid, const ResolvedScene& scene, const std::string& sentence) {
    best.offer(renderReference(grid, scene).colour, sentence);
  };
  const std::string when = "the picture agrees when ";
  if (const auto ratio = densityRatio(picture.colour, answer)) {
    ResolvedScene scene = picture.scene;
    scene.transfer = scene.transfer.scaled(*ratio);
    offer(asked.grid, scene,
          when + "the medium is " + shortNumber(*ratio, 3) +
              " times as dense: is opacity corrected for the length of a step, in world units?");
  }
  ResolvedScene preclassified = picture.scene;
  preclassified.sampling.classification = Classification::pre;
  offer(asked.grid, preclassified,
        when + "voxels are classified before interpolation: values are to be interpolated, and classified then");
  for (const MisreadGrid& misread : misreadGrids(asked.grid, asked.box))
    offer(misread.grid, picture.scene, when + misread.sentence);
}

}  // namespace

std::string explainSize(const AskedPicture& picture, const Image& answer) {
  const Image& truth = picture.colour;
  if (answer.width != truth.height || answer.height != truth.width) return {};
  return "width and height are exchanged";
}

std::string explainPicture(const AskedCase& asked, const AskedPicture& picture, const Image& answer) {
  const Image& truth = picture.colour;
  BestGuess best(answer, rmsDifference(answer, truth));
  offerTurned(truth, best);
  offerRecoloured(truth, best);
  offerMoved(truth, best);
  // What is done in a moment may explain all; if not, pictures are integrated, which takes longer.
  if (!best.explainsAll()) offerIntegrated(asked, picture, answer, best);
  return best.sentence();
}

}  // namespace umbrick
