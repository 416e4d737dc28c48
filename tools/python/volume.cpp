// SPDX-License-Identifier: Apache-2.0
#include "volume.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "convert_report.h"
#include "errors.h"
#include "job_thread.h"
#include "keywords.h"
#include "umbrick/convert/holds_grids.h"
#include "umbrick/convert/load_volume.h"
#include "umbrick/convert/options_error.h"
#include "umbrick/core/memory.h"
#include "umbrick/core/names.h"
#include "umbrick/grid/dense_values.h"
#include "umbrick/ingest/frame_sequence.h"
#include "umbrick/ingest/open_volume.h"
#include "umbrick/vdb/summary.h"

namespace umbrick::python {
namespace {
namespace py = pybind11;
namespace fs = std::filesystem;

using Three = std::array<double, 3>;
constexpr Name<VdbCodec> kCodecs[]{{"blosc", VdbCodec::blosc}, {"zip", VdbCodec::zip}, {"none", VdbCodec::none}};
constexpr Name<NanoValues> kQuantise[]{
    {"4", NanoValues::bits4}, {"8", NanoValues::bits8}, {"16", NanoValues::bits16}, {"n", NanoValues::adaptive}};

glm::dvec3 vectorOf(const Three& v) { return {v[0], v[1], v[2]}; }

// --- what is read ---

VoxelType voxelTypeOf(const py::array& array) {
  const char kind = array.dtype().kind();
  const auto bytes = array.dtype().itemsize();
  constexpr VoxelType kUnsigned[]{VoxelType::u8, VoxelType::u16, VoxelType::u32, VoxelType::u64};
  constexpr VoxelType kSigned[]{VoxelType::i8, VoxelType::i16, VoxelType::i32, VoxelType::i64};
  constexpr VoxelType kFloat[]{VoxelType::f16, VoxelType::f32, VoxelType::f64};
  const int power = bytes == 1 ? 0 : bytes == 2 ? 1 : bytes == 4 ? 2 : bytes == 8 ? 3 : -1;
  if (power >= 0 && (kind == 'u' || (kind == 'b' && power == 0))) return kUnsigned[power];
  if (power >= 0 && kind == 'i') return kSigned[power];
  if (power >= 1 && kind == 'f') return kFloat[power - 1];
  throw InvalidArgument("array: expected a dtype of bool, integers of 8 to 64 bits or floats of 16 to 64, found " +
                        py::str(array.dtype()).cast<std::string>());
}

std::string shapeText(const py::array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

// "array of (64, 32, 16) float32": what messages call an array.
std::string nameOf(const py::array& array) {
  return "array of " + shapeText(array) + ' ' + py::str(array.dtype()).cast<std::string>();
}

glm::dmat4 matrixOf(const py::object& affine) {
  const auto refuse = [&]() -> InvalidArgument {
    return InvalidArgument("affine: expected 4 x 4 numbers, found " + Keywords::shown(affine));
  };
  const auto rows = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(affine);
  if (!rows) {
    PyErr_Clear();
    throw refuse();
  }
  if (rows.ndim() != 2 || rows.shape(0) != 4 || rows.shape(1) != 4) throw refuse();
  glm::dmat4 matrix(1);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = rows.at(row, column);
  return matrix;
}

ArrayVolume arrayVolume(const py::array& array, const Keywords& keywords) {
  const std::string axes = keywords.get<std::string>("axes", kText).value_or("xyz");
  if (axes != "xyz" && axes != "zyx") throw InvalidArgument("axes: expected 'xyz' or 'zyx', found '" + axes + "'");
  constexpr py::ssize_t kMostComponents = 4;
  const py::ssize_t count = array.ndim();
  if (count < 2 || count > 4 || (count == 4 && array.shape(3) > kMostComponents))
    throw InvalidArgument("array: expected two or three axes, and a last one of 1 to 4 components, found shape " +
                          shapeText(array));
  ArrayVolume volume;
  volume.data = static_cast<const std::byte*>(array.data());
  volume.type = voxelTypeOf(array);
  const auto order = array.dtype().attr("byteorder").cast<std::string>();
  volume.endian = order == ">" ? std::endian::big : std::endian::little;
  volume.dims = glm::i64vec3(1);
  const py::ssize_t space = std::min<py::ssize_t>(count, 3);
  for (py::ssize_t i = 0; i < space; ++i) {
    const int axis = static_cast<int>(axes == "xyz" ? i : space - 1 - i);
    volume.dims[axis] = array.shape(i);
    volume.strides[axis] = array.strides(i);
  }
  if (count == 4) {
    volume.components = array.shape(3);
    volume.componentStride = array.strides(3);
  }
  if (keywords.has("affine")) volume.indexToWorld = matrixOf(keywords.raw("affine"));
  return volume;
}

// Sets what a volume of a file or an array is opened with.
void setPlace(const Keywords& keywords, OpenOptions& open) {
  if (const auto spacing = keywords.get<Three>("spacing", kThree)) open.spacing = vectorOf(*spacing);
  if (const auto origin = keywords.get<Three>("origin", kThree)) open.origin = vectorOf(*origin);
}

std::optional<RawLayout> rawLayout(const std::string& name, const Keywords& keywords) {
  if (!keywords.has("dims") && !keywords.has("type")) {
    for (const char* keyword : {"endian", "header_bytes", "bits_stored"})
      if (keywords.has(keyword))
        throw InvalidArgument(name + ": " + keyword + " is for headerless raw, with dims and type");
    return std::nullopt;
  }
  const auto dims = keywords.get<std::array<std::int64_t, 3>>("dims", "three whole numbers");
  const auto type = keywords.get<std::string>("type", kText);
  if (!dims || !type) throw InvalidArgument(name + ": headerless raw needs dims and type");
  if (holdsGrids(name) || formatOfName(name))
    throw InvalidArgument(name + ": dims and type are for headerless raw, not for " +
                          formatOfName(name).value_or(fs::path(name).extension().string()));
  RawLayout raw;
  raw.dims = {(*dims)[0], (*dims)[1], (*dims)[2]};
  raw.type = *type;
  const std::string endian = keywords.get<std::string>("endian", kText).value_or("little");
  if (endian != "little" && endian != "big")
    throw InvalidArgument("endian: expected 'little' or 'big', found '" + endian + "'");
  raw.bigEndian = endian == "big";
  keywords.set("header_bytes", kWhole, raw.headerBytes);
  keywords.set("bits_stored", kWhole, raw.bitsStored);
  return raw;
}

std::optional<std::string> componentOf(const Keywords& keywords) {
  if (!keywords.has("component")) return std::nullopt;
  return py::str(keywords.raw("component")).cast<std::string>();
}

// What a scene's volume is: as the command line says it.
VolumeReference referenceOf(const fs::path& path, const Keywords& keywords) {
  VolumeReference reference;
  reference.file = path;
  keywords.set("grid", kText, reference.grid);
  keywords.set("emission_grid", kText, reference.emissionGrid);
  if (const auto frame = keywords.get<std::int64_t>("frame", kWhole)) {
    if (isFramePattern(path))
      reference.file = framePath(path, *frame);
    else if (holdsGrids(path))
      throw InvalidArgument(path.string() + ": frame is for files of several volumes, and this is one of grids");
    else
      reference.grid += '[' + std::to_string(*frame) + ']';
  }
  if (const auto component = componentOf(keywords)) reference.grid += '.' + *component;
  if (keywords.has("series")) reference.series = py::str(keywords.raw("series")).cast<std::string>();
  keywords.set("where", "a list of strings", reference.where);
  keywords.set("beside_only", kTruth, reference.besideOnly);
  if (const auto spacing = keywords.get<Three>("spacing", kThree)) reference.spacing = vectorOf(*spacing);
  if (const auto origin = keywords.get<Three>("origin", kThree)) reference.origin = vectorOf(*origin);
  reference.raw = rawLayout(path.string(), keywords);
  return reference;
}

// The world in words: of arrays, and of files that do not state theirs.
void setWorld(const Keywords& keywords, OpenOptions& open) {
  keywords.set("length_unit", kText, open.lengthUnit);
  keywords.set("space", kText, open.space);
  for (char& letter : open.space) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  if (open.space == "FILE") open.space = "file";
}

// --- what is converted ---

void setValues(const Keywords& keywords, ConvertOptions& options) {
  BuildOptions& build = options.build;
  if (keywords.has("background")) {
    if (py::isinstance<py::str>(keywords.raw("background"))) {
      if (keywords.get<std::string>("background", kText) != "auto")
        throw InvalidArgument("background: expected a number or 'auto', found " +
                              Keywords::shown(keywords.raw("background")));
      options.source.backgroundFromBorder = true;
    } else {
      keywords.set("background", "a number or 'auto'", build.background);
    }
  }
  keywords.set("tolerance", kNumber, build.tolerance);
  keywords.set("half", kTruth, build.half);
  keywords.set("step", kNumber, build.step);
  keywords.set("max_error", kNumber, build.maxError);
  keywords.set("clip_below", kNumber, build.clipBelow);
  // What lies at the threshold is left out: the smallest value that stays is the next one.
  if (const auto threshold = keywords.get<float>("threshold", kNumber))
    build.clipBelow = std::nextafter(*threshold, std::numeric_limits<float>::infinity());
  if (const auto range = keywords.get<std::array<float, 2>>("range", "two numbers")) {
    if ((*range)[0] > (*range)[1])
      throw InvalidArgument("range: expected the lower limit first, found " + Keywords::shown(keywords.raw("range")));
    build.clipBelow = (*range)[0];
    build.clipAbove = (*range)[1];
  }
  const auto together = [&](std::initializer_list<const char*> names) {
    std::vector<std::string> given;
    for (const char* name : names)
      if (keywords.has(name)) given.emplace_back(name);
    if (given.size() > 1) throw InvalidArgument(given[0] + " and " + given[1] + " exclude each other");
  };
  together({"threshold", "clip_below", "range"});
  for (const char* name : {"tolerance", "half", "step"}) together({"max_error", name});
  for (const char* name : {"tolerance", "threshold", "clip_below", "range", "half", "step", "max_error"})
    together({"isosurface", name});
}

ConvertOptions convertOptions(const Keywords& keywords) {
  ConvertOptions options;
  setValues(keywords, options);
  if (const auto name = keywords.get<std::string>("name", kText)) options.names = {*name};
  if (const auto unit = keywords.get<std::string>("unit", kText)) options.units = {*unit};
  if (const auto grid = keywords.get<std::string>("grid", kText)) options.grids = {*grid};
  keywords.set("mask", "the path of a file", options.source.mask);
  if (const auto crop = keywords.get<std::array<std::array<int, 3>, 2>>(
          "crop", "the first and the last voxel, three whole numbers each"))
    options.source.crop = {{(*crop)[0][0], (*crop)[0][1], (*crop)[0][2]},
                           {(*crop)[1][0], (*crop)[1][1], (*crop)[1][2]}};
  if (keywords.has("resample")) {
    const auto one = keywords.raw("resample");
    options.source.resample = py::isinstance<py::float_>(one) || py::isinstance<py::int_>(one)
                                  ? glm::dvec3(one.cast<double>())
                                  : vectorOf(*keywords.get<Three>("resample", "one number or three"));
    options.source.open.evenSlices = true;
  }
  if (const auto value = keywords.get<float>("isosurface", kNumber))
    options.isosurface = IsosurfaceOptions{*value, keywords.get<float>("half_width", kNumber).value_or(3)};
  else if (keywords.has("half_width"))
    throw InvalidArgument("half_width: needs isosurface");
  return options;
}

py::dict lossesOf(const ConvertedGrid& grid) {
  const BuildReport& build = grid.build;
  py::dict out;
  out["voxels"] = build.voxels;
  out["active_voxels"] = build.activeVoxels;
  out["storage"] = build.storage;
  out["max_error"] = build.maxError + build.conversionError;
  out["rms_error"] = build.rmsError;
  out["conversion_error"] = build.conversionError;
  out["clipped_voxels"] = build.clippedVoxels;
  out["max_clip_change"] = build.maxClipChange;
  out["non_finite"] = build.nonFinite;
  if (grid.background) out["background"] = grid.background->value;
  if (grid.masked) out["masked"] = *grid.masked;
  if (grid.resampled) {
    out["resample_max"] = grid.resampled->max;
    out["resample_rms"] = grid.resampled->rms;
  }
  if (grid.isosurface) {
    out["isosurface_max_error"] = grid.isosurface->maxError;  // voxels
    out["isosurface_rms_error"] = grid.isosurface->rmsError;
  }
  return out;
}

std::vector<std::string> notesOfGrid(const ConvertedGrid& grid) {
  std::vector<std::string> notes = grid.notes;
  for (const std::string& line : {tools::usualLine(grid), tools::keptLine(grid)})
    if (!line.empty()) notes.push_back(inKeywords(line));
  if (grid.build.nonFinite > 0)
    notes.push_back(std::to_string(grid.build.nonFinite) + " voxels are not finite and are stored as background");
  if (grid.build.clippedVoxels > 0)
    notes.push_back(std::to_string(grid.build.clippedVoxels) + " voxels beyond the limits become background");
  return notes;
}

// --- the functions of the module ---

VolumeHandle openFile(const fs::path& path, const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  const VolumeReference reference = referenceOf(path, keywords);
  VolumeHandle handle;
  runJob(path.string(), progress, [&](JobWatch& watch) {
    handle.volume = std::make_shared<const Volume>(reference, [&](double share) { watch.tell(share, "loading"); });
  });
  handle.notes = handle.volume->notes();
  handle.ofFile = true;
  return handle;
}

VolumeHandle openNumbers(const py::array& array, const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  OpenOptions open;
  open.array = arrayVolume(array, keywords);
  setPlace(keywords, open);
  setWorld(keywords, open);
  if (const auto component = componentOf(keywords)) chooseComponent(*component, open.parts);
  const std::string name = nameOf(array);
  VolumeHandle handle;
  runJob(name, progress, [&](JobWatch& watch) {
    handle.volume = std::make_shared<const Volume>(name, open, [&](double share) { watch.tell(share, "loading"); });
  });
  handle.type = open.array->type;
  handle.notes = handle.volume->notes();
  return handle;
}

VolumeHandle convertSource(const fs::path& input, ConvertOptions options, const py::object& progress) {
  LoadedVolume loaded;
  VolumeHandle handle;
  runJob(input.string(), progress, [&](JobWatch& watch) {
    options.progress = [&](const ConvertProgress& at) { watch.tell(at.share, "converting"); };
    loaded = convertInMemory(input, options);
    if (loaded.report.build.activeVoxels > 0 || loaded.report.isosurface)
      handle.volume = std::make_shared<const Volume>(loaded.grid, input.string(), !loaded.report.volumeType);
  });
  if (!handle.volume) throw EmptyVolume(input.string() + ": " + inKeywords(tools::usualLine(loaded.report)));
  handle.type = loaded.report.isosurface ? std::nullopt : loaded.report.volumeType;
  handle.notes = notesOfGrid(loaded.report);
  handle.losses = lossesOf(loaded.report);
  return handle;
}

VolumeHandle convertFile(const fs::path& path, const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  ConvertOptions options = convertOptions(keywords);
  OpenOptions& open = options.source.open;
  setWorld(keywords, open);
  keywords.set("frame", kWhole, open.parts.frame);
  if (const auto component = componentOf(keywords)) chooseComponent(*component, open.parts);
  if (keywords.has("series")) open.series = py::str(keywords.raw("series")).cast<std::string>();
  keywords.set("where", "a list of strings", open.where);
  keywords.set("override", kTruth, open.overridePlace);
  keywords.set("strict", kTruth, open.strict);
  keywords.set("beside_only", kTruth, open.besideOnly);
  setPlace(keywords, open);
  if (const auto layout = rawLayout(path.string(), keywords)) {
    RawOptions raw;
    const auto type = voxelTypeFromName(layout->type);
    if (!type) throw InvalidArgument("type: expected one of u8, i8, u16, ... f64, found '" + layout->type + "'");
    raw.dims = layout->dims;
    raw.type = *type;
    raw.endian = layout->bigEndian ? std::endian::big : std::endian::little;
    raw.headerBytes = layout->headerBytes;
    raw.bitsStored = layout->bitsStored;
    raw.spacing = std::exchange(open.spacing, {}).value_or(raw.spacing);
    raw.origin = std::exchange(open.origin, {}).value_or(raw.origin);
    open.raw = raw;
  }
  return convertSource(path, std::move(options), progress);
}

VolumeHandle convertNumbers(const py::array& array, const py::dict& values, const py::object& progress) {
  const Keywords keywords(values);
  ConvertOptions options = convertOptions(keywords);
  OpenOptions& open = options.source.open;
  open.array = arrayVolume(array, keywords);
  setPlace(keywords, open);
  setWorld(keywords, open);
  if (const auto component = componentOf(keywords)) chooseComponent(*component, open.parts);
  return convertSource(nameOf(array), std::move(options), progress);
}

py::dict saveVolume(const VolumeHandle& handle, const fs::path& path, const py::dict& values,
                    const py::object& progress) {
  const Keywords keywords(values);
  OutputOptions options;
  options.creator = "umbrick " UMBRICK_VERSION;
  if (const auto codec = keywords.get<std::string>("codec", kText)) options.codec = parseName(kCodecs, *codec, "codec");
  if (keywords.has("quantise"))
    options.nano = NanoOptions{parseName(kQuantise, py::str(keywords.raw("quantise")).cast<std::string>(), "quantise"),
                               keywords.get<float>("max_error", kNumber).value_or(0)};
  else if (keywords.has("max_error"))
    throw InvalidArgument(path.string() + ": max_error needs quantise 'n'");
  if (options.nano && (options.nano->values == NanoValues::adaptive) != keywords.has("max_error"))
    throw InvalidArgument(path.string() + ": expected quantise 'n' and max_error together");
  SavedGrid saved;
  runJob(path.string(), progress, [&](JobWatch& watch) {
    watch.tell(0, "saving");
    saved = saveGrid(handle.volume->grid(), path, options, handle.type);
  });
  py::dict out;
  out["bytes"] = saved.bytes;
  out["max_error"] = saved.quantised.max;
  out["notes"] = saved.notes;
  return out;
}

IndexBox boxOf(const VolumeHandle& handle, const py::object& box) {
  if (box.is_none()) return handle.volume->grid().activeBox();
  py::dict values;
  values["box"] = box;
  const auto corners = *Keywords(values).get<std::array<std::array<int, 3>, 2>>(
      "box", "the first and the last voxel, three whole numbers each");
  const IndexBox part{{corners[0][0], corners[0][1], corners[0][2]}, {corners[1][0], corners[1][1], corners[1][2]}};
  if (part.empty()) throw InvalidArgument("box: expected the first voxel first, found " + Keywords::shown(box));
  return part;
}

py::array values(const VolumeHandle& handle, const py::object& box) {
  const IndexBox part = boxOf(handle, box);
  const glm::i64vec3 extent = part.extent();
  const double bytes = double(extent.x) * double(extent.y) * double(extent.z) * sizeof(float);
  requireMemory("box: an array of " + std::to_string(extent.x) + " x " + std::to_string(extent.y) + " x " +
                    std::to_string(extent.z) + " voxels",
                bytes);
  py::array_t<float, py::array::f_style> out({extent.x, extent.y, extent.z});
  const std::span<float> numbers(out.mutable_data(), static_cast<std::size_t>(out.size()));
  runJob("array", py::none(), [&](JobWatch&) { copyValues(handle.volume->grid(), part, numbers); });
  return out;
}

py::array_t<double> affine(const VolumeHandle& handle) {
  py::array_t<double> rows({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      rows.mutable_at(row, column) = handle.volume->indexToWorld()[column][row];
  return rows;
}

py::tuple tupleOf(const glm::ivec3& v) { return py::make_tuple(v.x, v.y, v.z); }
py::tuple tupleOf(const glm::dvec3& v) { return py::make_tuple(v.x, v.y, v.z); }

py::dict info(const VolumeHandle& handle, int bins) {
  GridSummary grid;
  runJob("info", py::none(), [&](JobWatch&) { grid = summariseGrid(handle.volume->grid(), bins); });
  const glm::i64vec3 dims = grid.activeBox.extent();
  py::dict out;
  out["name"] = grid.label;
  out["source"] = handle.volume->name();
  out["class"] = grid.gridClass;
  out["dims"] = py::make_tuple(dims.x, dims.y, dims.z);
  out["box"] = py::make_tuple(tupleOf(grid.activeBox.min), tupleOf(grid.activeBox.max));
  out["active_voxels"] = grid.activeVoxels;
  out["leaves"] = grid.leaves;
  out["background"] = py::float_(py::str(grid.background));
  out["voxel_size"] = tupleOf(grid.voxelSize);
  out["world_bounds"] = py::make_tuple(tupleOf(grid.worldBounds.min), tupleOf(grid.worldBounds.max));
  if (grid.values) {
    out["min"] = grid.values->min;
    out["max"] = grid.values->max;
    out["histogram"] = grid.values->histogram;
    out["non_finite"] = grid.values->nonFinite;
  }
  out["unit"] = handle.volume->valueUnit();
  out["memory_bytes"] = grid.memoryBytes;
  out["metadata"] = grid.metadata;
  return out;
}

}  // namespace

std::string Keywords::shown(const py::handle& value) {
  std::string text = py::repr(value).cast<std::string>();
  for (std::size_t end = 0; (end = text.find('\n')) != std::string::npos;) text.replace(end, 1, " ");
  constexpr std::size_t kLongest = 80;
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

void addVolume(py::module_& module) {
  py::class_<VolumeHandle>(module, "Volume", "A sparse volume in memory.")
      .def_property_readonly("name", [](const VolumeHandle& self) { return self.volume->grid().name; })
      .def_property_readonly("source", [](const VolumeHandle& self) { return self.volume->name(); })
      .def_property_readonly("unit", [](const VolumeHandle& self) { return self.volume->valueUnit(); })
      .def_property_readonly("notes", [](const VolumeHandle& self) { return self.notes; })
      .def_property_readonly("losses", [](const VolumeHandle& self) { return self.losses; })
      .def_property_readonly("box",
                             [](const VolumeHandle& self) {
                               const IndexBox box = self.volume->grid().activeBox();
                               return py::make_tuple(tupleOf(box.min), tupleOf(box.max));
                             })
      .def_property_readonly("affine", affine)
      .def("array", values)
      .def("info", info)
      .def("save", saveVolume);
  module.def("open_file", openFile);
  module.def("open_array", openNumbers);
  module.def("convert_file", convertFile);
  module.def("convert_array", convertNumbers);
}

}  // namespace umbrick::python
