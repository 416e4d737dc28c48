// SPDX-License-Identifier: Apache-2.0
#include "scene/environment.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <string>

#include "umbrick/core/error.h"
#include "umbrick/image/exr.h"

namespace umbrick {
namespace {
constexpr int kRows = 256, kColumns = 512;  // approximate number of cells

glm::dvec3 radianceAt(const Image& image, int x, int y) {
  const float* pixel = image.at(x, y);
  return image.channels < 3 ? glm::dvec3(pixel[0]) : glm::dvec3(pixel[0], pixel[1], pixel[2]);
}

// Returns what is wrong with a map; empty where nothing is.
std::string flawOf(const Image& image) {
  if (image.channels != 1 && image.channels != 3 && image.channels != 4)
    return "has " + std::to_string(image.channels) + " channels, must have 1, 3 or 4";
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 light = radianceAt(image, x, y);
      if (!(light.r >= 0 && light.g >= 0 && light.b >= 0 && std::isfinite(powerOf(light))))
        return "pixel " + std::to_string(x) + ", " + std::to_string(image.height - 1 - y) + " from the top left is [" +
               std::to_string(light.r) + ", " + std::to_string(light.g) + ", " + std::to_string(light.b) +
               "], must be finite and 0 or more";
    }
  return "";
}

glm::dmat3 axesOf(const EnvironmentLight& light) {
  const glm::dvec3 up = glm::normalize(light.up);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::normalize(light.front), up));
  return {glm::cross(up, right), right, up};
}

// A part of the hemisphere in equal-area coordinates.
struct Piece {
  glm::dvec2 place;
  double power;
  std::size_t cell;
};
using Pieces = std::vector<Piece>;

// Returns where to cut pieces so that about `power` lies in front of the cut and at least one piece on each side. It
// sorts the pieces only as far as needed, by halves.
Pieces::iterator cut(Pieces::iterator begin, Pieces::iterator end, int axis, double power) {
  Pieces::iterator low = begin, high = end;
  while (high - low > 1) {
    const auto middle = low + (high - low) / 2;
    std::nth_element(low, middle, high,
                     [axis](const Piece& a, const Piece& b) { return a.place[axis] < b.place[axis]; });
    double sum = 0;
    for (auto piece = low; piece != middle; ++piece) sum += piece->power;
    if (sum > power) {
      high = middle;
    } else {
      power -= sum;
      low = middle;
    }
  }
  // The place of the cut is in the piece at `low`, which goes to the side that most of it is on.
  if (power > 0.5 * low->power) ++low;
  return std::clamp(low, begin + 1, end - 1);
}

// Calls emit(begin, end) for parts of equal power, `count` of them or, where a piece holds several shares, fewer.
template <class Emit>
void medianCut(Pieces::iterator begin, Pieces::iterator end, int count, const Emit& emit) {
  if (count <= 1 || end - begin <= 1) return emit(begin, end);
  glm::dvec2 low = begin->place, high = low;
  double power = 0;
  for (auto piece = begin; piece != end; ++piece) {
    low = glm::min(low, piece->place);
    high = glm::max(high, piece->place);
    power += piece->power;
  }
  const int axis = high.x - low.x >= high.y - low.y ? 0 : 1, first = count / 2;
  const auto middle = cut(begin, end, axis, power * first / count);
  medianCut(begin, middle, first, emit);
  medianCut(middle, end, count - first, emit);
}

}  // namespace

bool EnvironmentLight::operator==(const EnvironmentLight& other) const {
  if (file != other.file || up != other.up || front != other.front || scale != other.scale) return false;
  if (image == other.image || !image || !other.image) return image == other.image;
  return image->width == other.image->width && image->height == other.image->height &&
         image->channels == other.image->channels && image->pixels == other.image->pixels;
}

EnvironmentLight loadEnvironment(const std::filesystem::path& file) {
  ExrFile exr = readExr(file);
  if (!exr.layers.front().name.empty()) throw IoError(file.string() + ": has no channels R, G, B and no Y");
  const std::string flaw = flawOf(exr.layers.front().image);
  if (!flaw.empty()) throw IoError(file.string() + ": " + flaw);
  EnvironmentLight light;
  light.file = file;
  light.image = std::make_shared<const Image>(std::move(exr.layers.front().image));
  return light;
}

Environment::Environment(const EnvironmentLight& light, const glm::dmat3& toWorld, const glm::dvec3& viewer, bool whole)
    : image_(light.image),
      width_(image_->width),
      subRows_((kRows + image_->height - 1) / image_->height),
      subColumns_((kColumns + width_ - 1) / width_),
      blockColumns_((width_ * subColumns_ + kColumns - 1) / kColumns),
      scale_(light.scale / (4 * std::numbers::pi)),
      axes_(toWorld * axesOf(light)),
      viewer_(viewer),
      viewerInMap_(glm::transpose(axes_) * viewer),
      whole_(whole) {
  const std::string flaw = flawOf(*image_);
  if (!flaw.empty()) throw InvalidArgument("environment " + light.file.string() + ": " + flaw);
  rows_ = image_->height * subRows_;
  sumAlongRows();
  setSize(scale_ * rowsUpTo_.back(), solidAngleOfLight());
}

// Returns the solid angle of an even light with the same power and the same integral of its square; that of all that
// may light if there is no light.
double Environment::solidAngleOfLight() const {
  const double most = (whole_ ? 4 : 2) * std::numbers::pi;
  double squares = 0;
  for (int y = 0; y < image_->height; ++y) {
    const double low = sineOf(y * subRows_), high = sineOf((y + 1) * subRows_);
    const Interval part = front(0.5 * (low + high));
    double sum = 0;
    for (int x = static_cast<int>(std::floor(part.begin)); x < part.end; ++x) {
      const double share = std::min(part.end, x + 1.0) - std::max(part.begin, static_cast<double>(x));
      const double power = powerOf(radianceAt(*image_, (x % width_ + width_) % width_, y));
      sum += share * power * power;
    }
    squares += (high - low) * sum * 2 * std::numbers::pi / width_;
  }
  const double power = rowsUpTo_.back();
  return squares > 0 && power > 0 ? std::min(power * power / squares, most) : most;
}

// Returns the sine of the latitude of a row's lower edge.
double Environment::sineOf(int row) const {
  return std::sin(std::numbers::pi * (static_cast<double>(row) / rows_ - 0.5));
}

glm::dvec3 Environment::pixel(int row, int column) const { return radianceAt(*image_, column, imageRow(row)); }

glm::dvec3 Environment::direction(double s, double x) const {
  const double longitude = 2 * std::numbers::pi * (x / width_ - 0.5),
               cosine = std::sqrt(std::max(0.0, (1 - s) * (1 + s)));
  return glm::normalize(axes_ * glm::dvec3(cosine * std::cos(longitude), cosine * std::sin(longitude), s));
}

// Returns the columns x where cos(latitude) (front cos x + right sin x) + s up > 0, with the viewer's coordinates
// in the map.
Environment::Interval Environment::front(double s) const {
  if (whole_) return {0, static_cast<double>(width_)};
  const double across = std::hypot(viewerInMap_.x, viewerInMap_.y) * std::sqrt(std::max(0.0, (1 - s) * (1 + s)));
  const double below = -s * viewerInMap_.z;
  double half = 0;
  if (below <= -across)
    half = std::numbers::pi;
  else if (below < across)
    half = std::acos(below / across);
  const double middle = std::atan2(viewerInMap_.y, viewerInMap_.x);
  const auto columnOf = [this](double longitude) { return width_ * (longitude / (2 * std::numbers::pi) + 0.5); };
  return {columnOf(middle - half), columnOf(middle + half)};
}

// Returns the power of a circle of latitude from column 0 on; x may be in any period.
double Environment::powerUpTo(int row, double x) const {
  const double* sums = sums_.data() + static_cast<std::size_t>(imageRow(row)) * static_cast<std::size_t>(width_ + 1);
  const double turns = std::floor(x / width_), rest = std::clamp(x - turns * width_, 0.0, static_cast<double>(width_));
  const int column = std::min(static_cast<int>(rest), width_ - 1);
  return turns * sums[width_] + sums[column] + (rest - column) * (sums[column + 1] - sums[column]);
}

// Returns the power of a circle of latitude in front of the viewer, per unit of s.
double Environment::powerOfCircle(int row, double s) const {
  const Interval part = front(s);
  return 2 * std::numbers::pi / width_ * (powerUpTo(row, part.end) - powerUpTo(row, part.begin));
}

// Returns the column at which powerUpTo reaches the power: its inverse.
double Environment::column(int row, double power) const {
  const double* sums = sums_.data() + static_cast<std::size_t>(imageRow(row)) * static_cast<std::size_t>(width_ + 1);
  const double turns = std::floor(power / sums[width_]), rest = power - turns * sums[width_];
  const double* above = std::upper_bound(sums, sums + width_ + 1, rest);
  if (above == sums + width_ + 1) above = std::lower_bound(sums, above, sums[width_]);
  const auto column = std::max<std::ptrdiff_t>(0, above - sums - 1);
  const double own = sums[column + 1] - sums[column];
  return turns * width_ + static_cast<double>(column) +
         (own > 0 ? std::clamp((rest - sums[column]) / own, 0.0, 1.0) : 0);
}

void Environment::sumAlongRows() {
  sums_.reserve(static_cast<std::size_t>(image_->height) * static_cast<std::size_t>(width_ + 1));
  for (int y = 0; y < image_->height; ++y) {
    double sum = 0;
    sums_.push_back(sum);
    for (int x = 0; x < width_; ++x) sums_.push_back(sum += powerOf(radianceAt(*image_, x, y)));
  }
  // This is Simpson's rule. Of nested intervals the longest is at one of a row's edges, so a row that has light
  // has a sum.
  double sum = 0;
  for (int row = 0; row < rows_; ++row) {
    const double low = sineOf(row), high = sineOf(row + 1);
    sum += (high - low) / 6 *
           (powerOfCircle(row, low) + 4 * powerOfCircle(row, 0.5 * (low + high)) + powerOfCircle(row, high));
    rowsUpTo_.push_back(sum);
  }
}

// Adds what lies in front of the viewer in a strip of a row around s.
void Environment::addToBlocks(int row, double s, double height, std::vector<Cell>& blocks) const {
  const int fine = width_ * subColumns_;
  const Interval part = front(s);
  for (int step = static_cast<int>(std::floor(part.begin * subColumns_)); step < part.end * subColumns_; ++step) {
    const double begin = std::max(part.begin, static_cast<double>(step) / subColumns_);
    const double end = std::min(part.end, static_cast<double>(step + 1) / subColumns_);
    if (!(end > begin)) continue;
    const int column = (step % fine + fine) % fine;
    const double solidAngle = height * (end - begin) * 2 * std::numbers::pi / width_;
    const glm::dvec3 light = solidAngle * pixel(row, column / subColumns_);
    Cell& cell = blocks[static_cast<std::size_t>(column / blockColumns_)];
    cell.light += light;
    if (light != glm::dvec3(0)) cell.moment += powerOf(light) * direction(s, 0.5 * (begin + end));
  }
}

std::vector<Environment::Cell> Environment::gatherCells() const {
  const int blockRows = (rows_ + kRows - 1) / kRows;
  const int across = (width_ * subColumns_ + blockColumns_ - 1) / blockColumns_;
  std::vector<Cell> blocks, cells;
  cells.reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>((rows_ + blockRows - 1) / blockRows) / 2);
  for (int row = 0; row < rows_; ++row) {
    if (row % blockRows == 0) blocks.assign(static_cast<std::size_t>(across), Cell{});
    const double low = sineOf(row), high = sineOf(row + 1);
    // A part of a row is as wide as its middle, so parts are finer where the viewer's plane runs along the row.
    const Interval lower = front(low), upper = front(high);
    const double slant = std::abs(upper.end - lower.end) / width_;
    const int parts = std::clamp(static_cast<int>(std::ceil(slant * 600)), 1, 64);
    for (int i = 0; i < parts; ++i)
      addToBlocks(row, low + (high - low) * (i + 0.5) / parts, (high - low) / parts, blocks);
    if ((row + 1) % blockRows == 0 || row + 1 == rows_)
      for (const Cell& cell : blocks)
        if (powerOf(cell.light) > 0) cells.push_back(cell);
  }
  return cells;
}

// Returns where cells lie on a flat map that keeps areas.
std::vector<glm::dvec2> Environment::placesOf(const std::vector<Cell>& cells, double rotation) const {
  std::vector<glm::dvec2> places;
  places.reserve(cells.size());
  if (whole_) {
    for (const Cell& cell : cells) {
      const glm::dvec3 inMap = glm::normalize(glm::transpose(axes_) * cell.moment);
      const double turn = (std::atan2(inMap.y, inMap.x) + rotation) / (2 * std::numbers::pi);
      places.emplace_back(2 * std::numbers::pi * (turn - std::floor(turn)), inMap.z);
    }
    return places;
  }
  // Any two axes across the view are good enough, as `rotation` counts from one of them.
  const glm::dvec3 aside = std::abs(viewer_.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(viewer_, aside)), v = glm::cross(viewer_, u);
  const glm::dvec3 first = std::cos(rotation) * u + std::sin(rotation) * v, second = glm::cross(viewer_, first);
  for (const Cell& cell : cells) {
    const glm::dvec3 w = glm::normalize(cell.moment);
    const double radius = std::sqrt(2 / (1 + glm::dot(w, viewer_)));
    places.emplace_back(radius * glm::dot(w, first), radius * glm::dot(w, second));
  }
  return places;
}

std::vector<LightDirection> Environment::directions(int count, double rotation) const {
  const std::vector<Cell> cells = gatherCells();
  if (cells.empty() || scale_ == 0) return {{viewer_, glm::dvec3(0)}};
  const std::vector<glm::dvec2> places = placesOf(cells, rotation);
  Pieces pieces;
  pieces.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) pieces.push_back({places[i], powerOf(cells[i].light), i});
  std::vector<LightDirection> result;
  medianCut(pieces.begin(), pieces.end(), count, [&](Pieces::iterator begin, Pieces::iterator end) {
    glm::dvec3 light(0), moment(0);
    for (auto piece = begin; piece != end; ++piece) {
      light += cells[piece->cell].light;
      moment += cells[piece->cell].moment;
    }
    // Light from all sides has no middle.
    const bool even = !(glm::length(moment) > 1e-6 * powerOf(light));
    result.push_back({even ? viewer_ : glm::normalize(moment), scale_ * light});
  });
  return result;
}

LightDirection Environment::sample(double u, double v) const {
  const double wanted = u * rowsUpTo_.back();
  const auto found = std::upper_bound(rowsUpTo_.begin(), rowsUpTo_.end(), wanted);
  const auto row = static_cast<int>(std::min<std::ptrdiff_t>(found - rowsUpTo_.begin(), rows_ - 1));
  const auto index = static_cast<std::size_t>(row);
  const double below = row > 0 ? rowsUpTo_[index - 1] : 0, own = rowsUpTo_[index] - below;
  const double low = sineOf(row), high = sineOf(row + 1);
  const double s = low + (high - low) * std::clamp((wanted - below) / own, 0.0, 1.0);
  const Interval part = front(s);
  const double begin = powerUpTo(row, part.begin), end = powerUpTo(row, part.end);
  if (!(end > begin)) return {viewer_, glm::dvec3(0)};
  // The place keeps more than rounding away from the ends of the interval, which lie on the viewer's plane.
  const double margin = 1e-9 * (part.end - part.begin);
  const double x = std::clamp(column(row, begin + v * (end - begin)), part.begin + margin, part.end - margin);
  const auto at = static_cast<int>(std::floor(x)) % width_;
  const glm::dvec3 light = pixel(row, (at + width_) % width_);
  const double power = powerOf(light);
  if (!(power > 0)) return {viewer_, glm::dvec3(0)};
  // The two densities are own / total / (high - low) in s and power / (end - begin) in columns.
  const double area = (high - low) * rowsUpTo_.back() / own * (2 * std::numbers::pi / width_) * (end - begin) / power;
  return {direction(s, x), scale_ * area * light};
}

}  // namespace umbrick
