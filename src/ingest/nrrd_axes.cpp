// SPDX-License-Identifier: Apache-2.0
#include "ingest/nrrd_axes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <string_view>

#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/place.h"
#include "ingest/streams/dense_source.h"

namespace umbrick {
namespace {

constexpr std::size_t kNrrdMaxAxes = 16;

// What an axis that is not of space counts.
enum class PartAxis { unknown, components, frames };

struct Axis {
  std::int64_t size = 0;
  PartAxis part = PartAxis::unknown;
  VoxelMeaning meaning = VoxelMeaning::scalar;  // of components
  double spacing = 1;
  bool spaced = false;  // the file states the spacing
  std::optional<double> min;
  bool cell = false;                    // cell-centred: `min` is the edge of the first voxel
  std::optional<glm::dvec3> direction;  // of space
  bool spatial = true;
  std::string unit;
};

// "(1, 0, 0) none (0,1,0)": blanks may stand inside the brackets.
std::vector<std::string> vectors(std::string_view text) {
  std::string packed;
  int depth = 0;
  for (const char c : text) {
    depth += (c == '(') - (c == ')');
    if (depth > 0 && (c == ' ' || c == '\t')) continue;
    packed += c;
    if (c == ')') packed += ' ';
  }
  return words(packed);
}

class NrrdAxesReader {
 public:
  NrrdAxesReader(const HeaderFields& fields, NrrdHeader& header) : fields_(fields), header_(header) {}

  void read() {
    const std::vector<Axis> axes = takeParts(readAxes());
    for (std::size_t i = 0; i < axes.size(); ++i) header_.dims[static_cast<int>(i)] = axes[i].size;
    VolumeInfo whole;
    whole.dims = header_.dims;
    whole.type = header_.type;
    whole.components = header_.components;
    whole.frames = header_.frames;
    if (!arrayBytes(whole)) fields_.fail("sizes", "less than 2^63 bytes in all", fields_.value("sizes"));
    if (axes[0].direction)
      placeByDirections(axes);
    else
      placeBySpacings(axes);
    toMillimetres(axes);
    readMeasurementFrame();
  }

 private:
  std::vector<Axis> readAxes() const {
    const auto dimension = integer(fields_.required("dimension"));
    if (!dimension || *dimension < 1 || *dimension > static_cast<std::int64_t>(kNrrdMaxAxes))
      fields_.fail("dimension", "1 to " + std::to_string(kNrrdMaxAxes), fields_.value("dimension"));
    std::vector<Axis> axes(static_cast<std::size_t>(*dimension));
    fields_.required("sizes");
    const std::vector<std::string> sizes = fields_.list("sizes", axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto size = integer(sizes[i]);
      if (!size || *size < 1 || *size > std::numeric_limits<std::int32_t>::max())
        fields_.fail("sizes", "numbers from 1 to 2147483647", fields_.value("sizes"));
      axes[i].size = *size;
    }
    readSpacings(axes);
    readDirections(axes);
    readKinds(axes);
    return volumeAxes(std::move(axes));
  }

  void readKinds(std::vector<Axis>& axes) const {
    if (!fields_.has("kinds")) return;
    const std::vector<std::string> kinds = fields_.list("kinds", axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const std::string kind = lower(kinds[i]);
      if (kind == "domain" || kind == "space" || kind == "???" || kind == "none" || kind == "scalar" || kind == "stub")
        continue;
      axes[i].spatial = false;
      const bool layers = kind == "list" && holdsSegments();
      axes[i].part = (kind == "list" || kind == "time") && !layers ? PartAxis::frames : PartAxis::components;
      if (kind.ends_with("rgb-color") || kind == "rgba-color" || kind == "3-color" || kind == "4-color")
        axes[i].meaning = VoxelMeaning::colour;
      else if (!layers)
        axes[i].meaning = VoxelMeaning::vector;
    }
  }

  // A segmentation of 3D Slicer lists its layers, in which segments overlap.
  bool holdsSegments() const { return header_.metadata.contains("Segment0_LabelValue"); }

  // Axes of size 1 that are not of space, or too many, go.
  std::vector<Axis> volumeAxes(std::vector<Axis> axes) const {
    std::erase_if(axes, [](const Axis& axis) { return !axis.spatial && axis.size == 1; });
    for (std::size_t i = axes.size(); i-- > 0 && axes.size() > 3;)
      if (axes[i].size == 1) axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(i));
    return axes;
  }

  // Takes out the axes of components and frames, so that those of a volume are left. A fourth axis that the file says
  // nothing of holds components where it is short, and else frames.
  std::vector<Axis> takeParts(std::vector<Axis> axes) {
    constexpr std::int64_t kMostGuessed = 4;
    if (axes.size() > 3 && std::all_of(axes.begin(), axes.end(), [](const Axis& axis) { return axis.spatial; })) {
      Axis& part = axes.front().size <= kMostGuessed ? axes.front() : axes.back();
      part.spatial = false;
      header_.notes.push_back("the file does not say what the " +
                              std::string(&part == &axes.front() ? "first" : "last") +
                              " of its axes is: it is taken "
                              "for one of " +
                              (part.size <= kMostGuessed ? "components" : "frames"));
    }
    std::vector<Axis> space;
    bool components = false, frames = false;
    for (const Axis& axis : axes) {
      if (axis.spatial) {
        space.push_back(axis);
        continue;
      }
      PartAxis part = axis.part;
      if (part == PartAxis::unknown) part = axis.size <= kMostGuessed ? PartAxis::components : PartAxis::frames;
      bool& seen = part == PartAxis::frames ? frames : components;
      if (seen) fields_.fail("sizes", "at most one axis of components and one of frames", fields_.value("sizes"));
      seen = true;
      const int place = static_cast<int>(space.size());
      if (part == PartAxis::frames) {
        header_.frames = axis.size;
        header_.times.first = axis.min;
        if (axis.spaced) header_.times.step = axis.spacing;
        header_.times.unit = axis.unit == "none" || axis.unit == "???" ? "" : axis.unit;
        header_.parts.frames = place;
        header_.parts.framesFirst = !components;
      } else {
        header_.components = axis.size;
        header_.parts.components = place;
        header_.meaning = axis.meaning;
      }
    }
    if (space.size() < 2 || space.size() > 3)
      fields_.fail("sizes", "a volume of two or three axes", fields_.value("sizes"));
    // Behind the last axis of a single slice comes its third one.
    for (int* place : {&header_.parts.components, &header_.parts.frames})
      if (space.size() == 2 && *place == 2) *place = 3;
    return space;
  }

  // Its vectors are the axes along which the components of a vector count, in world space.
  void readMeasurementFrame() const {
    if (header_.components != 3 || !fields_.has("measurementframe") || spaceDimension() != 3) return;
    const std::vector<std::string> texts = vectors(fields_.value("measurementframe"));
    if (texts.size() != 3) fields_.fail("measurement frame", "three vectors", fields_.value("measurementframe"));
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto axis = vector("measurement frame", texts[i], 3))
        header_.measurementFrame[static_cast<int>(i)] = *axis;
  }

  void readSpacings(std::vector<Axis>& axes) const {
    eachAxis("units", axes, [](Axis& axis, const std::string& text) { axis.unit = text; });
    eachAxis("spacings", axes, [&](Axis& axis, const std::string& text) {
      const auto spacing = known("spacings", text);
      if (spacing && !(*spacing > 0)) failNumber("spacings");
      axis.spacing = spacing.value_or(1);
      axis.spaced = spacing.has_value();
    });
    eachAxis("axismins", axes, [&](Axis& axis, const std::string& text) { axis.min = known("axismins", text); });
    eachAxis("centers", axes, [](Axis& axis, const std::string& text) { axis.cell = lower(text) == "cell"; });
  }

  template <class Take>
  void eachAxis(const char* field, std::vector<Axis>& axes, const Take& take) const {
    if (!fields_.has(field)) return;
    const std::vector<std::string> values = fields_.list(field, axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) take(axes[i], values[i]);
  }

  // Nothing for nan, which is the format's way to say that a number is not known.
  std::optional<double> known(const std::string& field, const std::string& text) const {
    const auto parsed = number(text);
    if (parsed && std::isnan(*parsed)) return std::nullopt;
    if (!parsed || !std::isfinite(*parsed)) failNumber(field);
    return parsed;
  }

  [[noreturn]] void failNumber(const std::string& field) const {
    fields_.fail(field, field == "spacings" ? "positive finite numbers, or nan where unknown" : "finite numbers",
                 fields_.value(field));
  }

  void readDirections(std::vector<Axis>& axes) const {
    if (!fields_.has("spacedirections")) return;
    const int dimension = spaceDimension();
    if (dimension == 0) fields_.fail("space", "the field, or space dimension, beside space directions", "");
    const std::vector<std::string> texts = vectors(fields_.value("spacedirections"));
    if (texts.size() != axes.size())
      fields_.fail("space directions", std::to_string(axes.size()) + " vectors", fields_.value("spacedirections"));
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i].direction = vector("space directions", texts[i], dimension);
      axes[i].spatial = axes[i].direction.has_value();
    }
  }

  int spaceDimension() const {
    const std::string space = lower(fields_.value("space"));
    if (space.empty()) {
      const auto dimension = fields_.has("spacedimension") ? integer(fields_.value("spacedimension")) : std::nullopt;
      if (!dimension) return 0;
      if (*dimension < 2 || *dimension > 3) fields_.fail("space dimension", "2 or 3", fields_.value("spacedimension"));
      return static_cast<int>(*dimension);
    }
    if (space.find("time") != std::string::npos || (space.size() == 4 && space.ends_with('t')))
      fields_.fail("space", "a space of three dimensions", space);
    return 3;
  }

  // "(a,b,c)" or "none"
  std::optional<glm::dvec3> vector(const std::string& field, std::string_view text, int dimension) const {
    if (text == "none") return std::nullopt;
    glm::dvec3 out(0);
    std::string_view rest = text;
    const bool enclosed = rest.size() >= 2 && rest.front() == '(' && rest.back() == ')';
    if (enclosed) rest = rest.substr(1, rest.size() - 2);
    for (int i = 0; i < dimension; ++i) {
      const std::size_t comma = std::min(rest.find(','), rest.size());
      const auto part = number(trimmed(rest.substr(0, comma)));
      const bool last = i + 1 == dimension;
      if (!enclosed || !part || !std::isfinite(*part) || (comma == rest.size()) != last)
        fields_.fail(field, "a vector of " + std::to_string(dimension) + " finite numbers, like (0,0,1)", text);
      out[i] = *part;
      rest.remove_prefix(last ? comma : comma + 1);
    }
    return out;
  }

  void placeByDirections(const std::vector<Axis>& axes) const {
    glm::dmat4& m = header_.indexToWorld;
    for (std::size_t i = 0; i < axes.size(); ++i) m[static_cast<int>(i)] = glm::dvec4(*axes[i].direction, 0);
    if (axes.size() == 2) {
      // One slice: as thick as its pixels are wide, along the normal.
      const glm::dvec3 normal = glm::cross(*axes[0].direction, *axes[1].direction);
      const double area = glm::length(normal);
      m[2] = glm::dvec4(area > 0 ? normal / std::sqrt(area) : normal, 0);
    }
    if (!spansSpace(m)) fields_.fail("space directions", "independent directions", fields_.value("spacedirections"));
    if (fields_.has("spaceorigin")) {
      const std::vector<std::string> texts = vectors(fields_.value("spaceorigin"));
      const auto origin = texts.size() == 1 ? vector("space origin", texts[0], spaceDimension()) : std::nullopt;
      if (!origin) fields_.fail("space origin", "one vector", fields_.value("spaceorigin"));
      m[3] = glm::dvec4(*origin, 1);
    }
  }

  void placeBySpacings(const std::vector<Axis>& axes) const {
    glm::dmat4& m = header_.indexToWorld;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const int axis = static_cast<int>(i);
      m[axis][axis] = axes[i].spacing;
      if (axes[i].min) m[3][axis] = *axes[i].min + (axes[i].cell ? 0.5 * axes[i].spacing : 0.0);
    }
  }

  // Units of space scale the axes of the world; without a space those of the file's axes do.
  void toMillimetres(const std::vector<Axis>& axes) const {
    std::vector<std::string> units;
    if (axes[0].direction)
      units = words(fields_.value("spaceunits"));
    else
      for (const Axis& axis : axes) units.push_back(axis.unit);
    if (units.empty() || units.size() > 3) return;
    const auto first = millimetresPer(units.front());
    if (!first) return;  // unknown: left as it is
    glm::dvec3 factor(*first);
    for (std::size_t i = 1; i < units.size(); ++i) {
      const auto millimetres = millimetresPer(units[i]);
      if (!millimetres) return;
      factor[static_cast<int>(i)] = *millimetres;
    }
    header_.millimetres = factor;
  }

  const HeaderFields& fields_;
  NrrdHeader& header_;
};

}  // namespace

void readNrrdAxes(const HeaderFields& fields, NrrdHeader& header) { NrrdAxesReader(fields, header).read(); }

}  // namespace umbrick
