// SPDX-License-Identifier: Apache-2.0
#include "ingest/hdf5_axes.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "ingest/hdf5_attributes.h"
#include "ingest/hdf5_handle.h"
#include "ingest/header_text.h"

namespace umbrick {
namespace {

constexpr std::size_t kMostNameBytes = 256;
constexpr hsize_t kMostComponents = 4;  // of an axis that is taken for one of components without a name

struct Axis {
  hsize_t length = 1;
  std::string name;  // in lower case; empty where the file has none
  bool time = false, unlimited = false;
  VolumeTimes times = {};
};

template <std::size_t n>
bool isOneOf(const std::string& name, const std::string_view (&names)[n]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

bool namesTime(const std::string& name) {
  static constexpr std::string_view kNames[]{"t",         "time",       "times", "timestep", "time_step",
                                             "timepoint", "timepoints", "frame", "frames"};
  return isOneOf(name, kNames);
}

bool namesColour(const std::string& name) {
  static constexpr std::string_view kNames[]{"rgb", "rgba", "color", "colour", "colors", "colours"};
  return isOneOf(name, kNames);
}

bool namesVector(const std::string& name) {
  static constexpr std::string_view kNames[]{"component", "components", "vector", "vec"};
  return isOneOf(name, kNames);
}

bool namesComponents(const std::string& name) {
  static constexpr std::string_view kNames[]{"c", "channel", "channels", "band", "bands"};
  return isOneOf(name, kNames) || namesColour(name) || namesVector(name);
}

bool namesSpace(const std::string& name) {
  static constexpr std::string_view kNames[]{"x",      "y",     "z",     "lat",   "latitude", "lon",    "longitude",
                                             "lev",    "level", "depth", "row",   "rows",     "column", "columns",
                                             "height", "width", "plane", "slice", "slices"};
  return isOneOf(name, kNames);
}

std::string baseName(std::string path) {
  if (const std::size_t slash = path.rfind('/'); slash != path.npos) path.erase(0, slash + 1);
  return lower(path);
}

// Reads the numbers of a scale that counts times.
VolumeTimes scaleTimes(hid_t scale, hsize_t length, const Hdf5Attributes& says) {
  constexpr hsize_t kMostTimes = 10'000'000;
  const Hdf5Handle space(H5Dget_space(scale), H5Sclose), type(H5Dget_type(scale), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  if (length > kMostTimes || (kind != H5T_FLOAT && kind != H5T_INTEGER) ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(length))
    return {};
  VolumeTimes times{.each = std::vector<double>(length), .unit = says.string("units")};
  if (H5Dread(scale, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, times.each.data()) < 0) return {};
  return times;
}

// The attribute holds the references of the scales of each axis, of which netCDF has one.
void readScales(hid_t dataset, std::vector<Axis>& axes) {
  if (H5Aexists(dataset, "DIMENSION_LIST") <= 0) return;
  const Hdf5Handle attribute(H5Aopen(dataset, "DIMENSION_LIST", H5P_DEFAULT), H5Aclose);
  const Hdf5Handle stored(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(stored.get()) != H5T_VLEN ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(axes.size()))
    return;
  const Hdf5Handle element(H5Tget_super(stored.get()), H5Tclose);
  if (H5Tequal(element.get(), H5T_STD_REF_OBJ) <= 0) return;
  const Hdf5Handle type(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
  std::vector<hvl_t> lists(axes.size());
  if (H5Aread(attribute.get(), type.get(), lists.data()) < 0) return;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (lists[i].len == 0 || !lists[i].p) continue;
    const Hdf5Handle scale(H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, lists[i].p), H5Oclose);
    char name[kMostNameBytes] = "";
    if (!scale.good() || H5Iget_name(scale.get(), name, sizeof name) <= 0) continue;
    axes[i].name = baseName(name);
    const Hdf5Attributes says(scale.get(), name);
    axes[i].time = lower(says.string("axis")) == "t" || lower(says.string("standard_name")) == "time" ||
                   lower(says.string("units")).find(" since ") != std::string::npos;
    if ((axes[i].time || namesTime(axes[i].name)) && H5Iget_type(scale.get()) == H5I_DATASET)
      axes[i].times = scaleTimes(scale.get(), axes[i].length, says);
  }
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, lists.data());
}

// Labels name axes that have no scale.
void readLabels(hid_t dataset, std::vector<Axis>& axes) {
  if (H5Aexists(dataset, "DIMENSION_LABELS") <= 0) return;
  const Hdf5Handle attribute(H5Aopen(dataset, "DIMENSION_LABELS", H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose), space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) <= 0 ||
      H5Sget_simple_extent_npoints(space.get()) != static_cast<hssize_t>(axes.size()))
    return;
  std::vector<char*> labels(axes.size());
  if (H5Aread(attribute.get(), type.get(), labels.data()) < 0) return;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (labels[i] && axes[i].name.empty())
      axes[i].name = lower(std::string(labels[i], strnlen(labels[i], kMostNameBytes)));
  H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, labels.data());
}

std::vector<Axis> readAxes(hid_t dataset, const std::vector<hsize_t>& shape) {
  std::vector<Axis> axes(shape.size());
  if (axes.empty()) return axes;
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<hsize_t> most(shape.size());
  H5Sget_simple_extent_dims(space.get(), nullptr, most.data());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].length = shape[i];
    axes[i].unlimited = most[i] == H5S_UNLIMITED;
  }
  readScales(dataset, axes);
  readLabels(dataset, axes);
  for (Axis& axis : axes) axis.time = axis.time || namesTime(axis.name);
  return axes;
}

// Tells the axes of one dataset apart, one kind after the other.
class Sorting {
 public:
  explicit Sorting(hid_t dataset) : shape_(hdf5Shape(dataset)), axes_(readAxes(dataset, shape_)) {
    for (std::size_t i = 0; i < axes_.size(); ++i) left_.push_back(i);
  }

  Hdf5Axes sorted() {
    takeComponents();
    takeFrames();
    dropSpare();
    out_.space = left_;
    return std::move(out_);
  }

 private:
  std::size_t longOnes() const {
    return static_cast<std::size_t>(
        std::count_if(left_.begin(), left_.end(), [&](std::size_t i) { return axes_[i].length > 1; }));
  }
  void take(std::size_t axis) { std::erase(left_, axis); }

  // "axis 1 of 5 x 4 x 3 x 6, "time","
  std::string axisText(std::size_t axis) const {
    return "axis " + std::to_string(axis + 1) + " of " + hdf5ShapeText(shape_) + ',' +
           (axes_[axis].name.empty() ? "" : " \"" + axes_[axis].name + "\",");
  }

  void takeComponents() {
    std::string why = "by its name";
    for (const std::size_t i : left_)
      if (left_.size() > 2 && axes_[i].length > 1 && namesComponents(axes_[i].name)) out_.components = i;
    const std::size_t last = axes_.size() - 1;
    if (!out_.components && longOnes() > 3) {
      const Axis& axis = axes_[last];
      if (axis.length > 1 && axis.length <= kMostComponents && !axis.time && !namesSpace(axis.name)) {
        out_.components = last;
        why = "since it is the last one and has a length of 2 to 4";
      }
    }
    if (!out_.components) return;
    const std::size_t taken = *out_.components;
    take(taken);
    out_.meaning = namesColour(axes_[taken].name)   ? VoxelMeaning::colour
                   : namesVector(axes_[taken].name) ? VoxelMeaning::vector
                                                    : VoxelMeaning::scalar;
    out_.notes.push_back(axisText(taken) + " is taken for components, " + why);
  }

  void takeFrames() {
    const auto timed = std::find_if(left_.begin(), left_.end(), [&](std::size_t i) { return axes_[i].time; });
    if (timed != left_.end() && (left_.size() > 3 || axes_[*timed].length == 1)) out_.times = axes_[*timed].times;
    if (timed != left_.end() && left_.size() <= 3) {
      if (left_.size() == 3 && axes_[*timed].length > 1)
        out_.notes.push_back(axisText(*timed) + " is taken for one of space, since there are three axes");
      return;
    }
    if (left_.size() <= 3) return;
    std::string why = "by its name or unit";
    if (timed != left_.end()) {
      out_.frames = *timed;
    } else if (longOnes() > 3) {
      std::vector<std::size_t> growing;
      std::copy_if(left_.begin(), left_.end(), std::back_inserter(growing),
                   [&](std::size_t i) { return axes_[i].unlimited && axes_[i].length > 1; });
      if (growing.size() == 1) {
        out_.frames = growing.front();
        why = "since it alone is unlimited";
      } else {
        out_.frames = *std::find_if(left_.begin(), left_.end(), [&](std::size_t i) { return axes_[i].length > 1; });
        why = "since it is the first one";
      }
    }
    if (!out_.frames) return;
    const std::size_t taken = *out_.frames;
    take(taken);
    if (axes_[taken].length == 1)
      out_.frames.reset();
    else
      out_.notes.push_back(axisText(taken) + " is taken for frames, " + why);
  }

  void dropSpare() {
    for (std::size_t i = 0; i < left_.size() && left_.size() > 3;)
      if (axes_[left_[i]].length == 1)
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
      else
        ++i;
  }

  std::vector<hsize_t> shape_;
  std::vector<Axis> axes_;
  std::vector<std::size_t> left_;  // that are nothing yet, in ascending order
  Hdf5Axes out_;
};

}  // namespace

std::vector<hsize_t> hdf5Shape(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  return shape;
}

std::string hdf5ShapeText(const std::vector<hsize_t>& shape) {
  std::string text;
  for (const hsize_t length : shape) text += (text.empty() ? "" : " x ") + std::to_string(length);
  return text;
}

Hdf5Axes hdf5Axes(hid_t dataset) { return Sorting(dataset).sorted(); }

}  // namespace umbrick
