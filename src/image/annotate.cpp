// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/annotate.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "image/canvas.h"
#include "umbrick/core/error.h"
#include "umbrick/core/srgb.h"
#include "umbrick/image/text.h"

namespace umbrick {
namespace {

const glm::dvec3 kLight(0.92), kDark(0.008);  // of letters and lines and of their rims, linear

// Colours that stand out from what is behind them.
struct Ink {
  glm::dvec3 letters, rim;
  double shade = 1;  // of colours that mean something
};

// Pixels [low, high) on both axes.
struct Area {
  glm::dvec2 low, high;
  bool inside(const Image& picture) const {
    return low.x >= 0 && low.y >= 0 && high.x <= picture.width && high.y <= picture.height;
  }
  bool meets(const Area& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y && other.low.y < high.y;
  }
};

// Draws the parts one after another into the picture and keeps account of the room that is left.
class Annotator {
 public:
  explicit Annotator(Image& picture)
      : picture_(picture),
        em_(annotationEm(picture.width, picture.height)),
        line_(std::max(1.4, 0.1 * em_)),
        rim_(std::max(1.2, 0.09 * em_)),
        margin_(std::round(0.7 * em_)) {}

  void triad(const std::vector<TriadAxis>& axes) {
    const double arm = 2.3 * em_, reach = arm + 1.1 * em_;  // with a letter beyond the end of the arm
    const glm::dvec2 centre(margin_ + reach);
    if (!take("triad", {centre - reach, centre + reach})) return;
    const Ink ink = inkOver({centre - reach, centre + reach});
    Canvas canvas = canvasOf({centre - reach, centre + reach});
    // What is farther away is drawn first.
    std::vector<const TriadAxis*> order;
    for (const TriadAxis& axis : axes) order.push_back(&axis);
    std::stable_sort(order.begin(), order.end(),
                     [](const TriadAxis* a, const TriadAxis* b) { return a->depth > b->depth; });
    for (const TriadAxis* axis : order) {
      const glm::dvec2 end = centre + arm * axis->end;
      const glm::dvec3 colour = ink.shade * axis->colour;
      canvas.line(centre, end, (axis->depth > 0.05 ? 1 : 1.6) * line_, colour);
      const double length = glm::length(axis->end);
      const glm::dvec2 aside = length > 0.05 ? axis->end / length : glm::dvec2(std::sqrt(0.5));
      centred(canvas, end + 0.75 * em_ * aside, axis->label, colour);
      if (!axis->opposite.empty()) centred(canvas, centre - 0.75 * em_ * aside, axis->opposite, colour);
    }
    canvas.line(centre, centre, 2 * line_, ink.letters);
    canvas.over(picture_, rim_, ink.rim);
  }

  void scale(const ScaleBar& bar) {
    const double width = std::max(bar.pixels + line_, textMask(bar.label, em_).width), tick = 0.45 * em_;
    const glm::dvec2 low(std::floor(picture_.width - margin_ - width), margin_);
    const Area area{low, {picture_.width - margin_, margin_ + 1.7 * em_}};
    if (!take("scale", area)) return;
    const Ink ink = inkOver(area);
    Canvas canvas = canvasOf(area);
    // The line lies on the middle of a row of pixels, where it is sharp.
    const double middle = 0.5 * (low.x + picture_.width - margin_), y = std::floor(low.y + 0.5 * tick) + 0.5;
    const glm::dvec2 left(middle - 0.5 * bar.pixels, y), right(middle + 0.5 * bar.pixels, y), up(0, 0.5 * tick);
    canvas.line(left, right, line_, ink.letters);
    canvas.line(left - up, left + up, line_, ink.letters);
    canvas.line(right - up, right + up, line_, ink.letters);
    centred(canvas, {middle, low.y + tick + 0.65 * em_}, bar.label, ink.letters);
    canvas.over(picture_, rim_, ink.rim);
  }

  void colours(const ColourBar& bar) {
    const double strip = std::round(0.9 * em_), plot = std::round(1.6 * em_), label = 1.4 * em_;
    const double width = std::max({strip + plot, textMask(bar.low, em_).width, textMask(bar.high, em_).width});
    // Between the scale bar and the upper edge, in the middle of the picture where there is room for it.
    const double lowest = margin_ + 3 * em_ + label, highest = picture_.height - margin_ - label;
    const double height = std::min(highest - lowest, 0.5 * picture_.height);
    const double middle = std::clamp(0.5 * picture_.height, lowest + 0.5 * height,
                                     std::max(lowest + 0.5 * height, highest - 0.5 * height));
    const double right = picture_.width - margin_, bottom = std::round(middle - 0.5 * height);
    const Area area{{std::floor(right - width), bottom - label}, {right, bottom + height + label}};
    if (height < 4 * em_) return leaveOut("colours");
    if (!take("colours", area)) return;
    const Ink ink = inkOver(area);
    Canvas canvas = canvasOf(area);
    const double left = right - strip - plot;
    canvas.box({left, bottom}, {right, bottom + height}, glm::dvec3(0.02), 0.9);
    // Rows lie between the colours of the bar, which are as many as it happens to have.
    const auto rows = static_cast<int>(std::lround(height));
    const std::size_t last = bar.colours.size() - 1;
    for (int row = 0; row < rows; ++row) {
      const double place = std::clamp((row + 0.5) / rows * static_cast<double>(last + 1) - 0.5, 0.0, double(last));
      const auto i = static_cast<std::size_t>(place);
      const std::size_t next = std::min(i + 1, last);
      const double part = place - static_cast<double>(i);
      const glm::dvec3 colour = glm::mix(bar.colours[i], bar.colours[next], part);
      const double opacity = glm::mix(bar.opacities[i], bar.opacities[next], part), y = bottom + row;
      canvas.box({left, y}, {left + strip + plot * opacity, y + 1}, colour);
    }
    const auto atRight = [&](double y, const std::string& text) {
      canvas.text({right - textMask(text, em_).width, y}, text, em_, ink.letters);
    };
    atRight(bottom - 1.1 * em_, bar.low);
    atRight(bottom + height + 0.45 * em_, bar.high);
    canvas.over(picture_, rim_, ink.rim);
  }

  std::vector<std::string> leftOut() const { return leftOut_; }

 private:
  // Takes an area of the picture, if it is free.
  bool take(const std::string& name, const Area& area) {
    const bool free = area.inside(picture_) &&
                      std::none_of(taken_.begin(), taken_.end(), [&](const Area& other) { return area.meets(other); });
    if (free)
      taken_.push_back(area);
    else
      leaveOut(name);
    return free;
  }
  // Letters are dark over what is light, and light over what is dark. Behind what is transparent there may be anything,
  // so that a dark plate is put there.
  Ink inkOver(const Area& area) const {
    double light = 0, opaque = 0, pixels = 0;
    for (int y = static_cast<int>(area.low.y); y < static_cast<int>(area.high.y); ++y)
      for (int x = static_cast<int>(area.low.x); x < static_cast<int>(area.high.x); ++x) {
        const float* p = picture_.at(x, y);
        light += linearToSrgb(std::clamp(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2], 0.0, 1.0));
        opaque += p[3];
        ++pixels;
      }
    if (light > 0.65 * pixels) return {kDark, kLight, 0.25};
    if (opaque < 0.9 * pixels) {
      const glm::dvec2 room(0.4 * em_);
      Canvas plate = canvasOf(area);
      plate.box(area.low - room, area.high + room, glm::dvec3(0.015), 0.75);
      plate.over(picture_);
    }
    return {kLight, kDark};
  }
  void leaveOut(const std::string& name) { leftOut_.push_back(name); }

  // Returns a canvas with room for the rim and for what letters reach beyond their line.
  Canvas canvasOf(const Area& area) const {
    const double room = std::ceil(rim_ + line_ + 0.3 * em_);
    return {glm::ivec2(glm::floor(area.low - room)), glm::ivec2(glm::ceil(area.high + room))};
  }

  void centred(Canvas& canvas, const glm::dvec2& centre, const std::string& text, const glm::dvec3& colour) const {
    const double height = text.size() == 1 && text[0] >= 'a' ? 0.55 : 0.73;  // of x and of a capital, in em
    canvas.text(centre - glm::dvec2(0.5 * textMask(text, em_).width, 0.5 * height * em_), text, em_, colour);
  }

  Image& picture_;
  double em_, line_, rim_, margin_;
  std::vector<Area> taken_;
  std::vector<std::string> leftOut_;
};

}  // namespace

double annotationEm(int width, int height) { return std::max(11.0, std::round(0.025 * std::min(width, height))); }

std::vector<std::string> annotate(Image& picture, const Annotations& annotations) {
  if (picture.channels != 4)
    throw InvalidArgument("annotations: expected 4 channels, found " + std::to_string(picture.channels));
  if (annotations.colours && (annotations.colours->colours.empty() ||
                              annotations.colours->colours.size() != annotations.colours->opacities.size()))
    throw InvalidArgument("annotations: " + std::to_string(annotations.colours->colours.size()) + " colours and " +
                          std::to_string(annotations.colours->opacities.size()) + " opacities");
  Annotator annotator(picture);
  if (!annotations.triad.empty()) annotator.triad(annotations.triad);
  if (annotations.scale) annotator.scale(*annotations.scale);
  if (annotations.colours) annotator.colours(*annotations.colours);
  return annotator.leftOut();
}

}  // namespace umbrick
