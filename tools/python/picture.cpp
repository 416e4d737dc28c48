// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

#include "job_thread.h"
#include "keywords.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pixel_points.h"
#include "umbrick/image/annotate.h"
#include "umbrick/image/display.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/image_difference.h"
#include "umbrick/image/png.h"

namespace umbrick::python {
namespace {
namespace py = pybind11;
namespace fs = std::filesystem;

bool isPng(const fs::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".png") return true;
  if (extension == ".exr") return false;
  throw InvalidArgument(path.string() + ": expected a picture that ends in .png or .exr");
}

std::vector<Annotation> annotationsIn(const Keywords& keywords) {
  std::vector<Annotation> wanted;
  if (!keywords.has("annotate")) return wanted;
  std::vector<std::string> names;
  if (py::isinstance<py::str>(keywords.raw("annotate")))
    names = {keywords.raw("annotate").cast<std::string>()};
  else
    names = *keywords.get<std::vector<std::string>>("annotate", "names of annotations");
  for (const std::string& name : names) {
    if (name == "all")
      for (const auto& [each, annotation] : kAnnotations) wanted.push_back(annotation);
    else
      wanted.push_back(parseName(kAnnotations, name, "annotate"));
  }
  return wanted;
}

// Writes a PNG as people look at it. @return annotations that the picture has no room for
std::vector<std::string> saveShown(const PictureHandle& picture, const fs::path& path, const Keywords& keywords) {
  Look look;
  look.exposure = keywords.get<double>("exposure", kNumber).value_or(0);
  if (const auto tone = keywords.get<std::string>("tone", kText)) look.toneMap = parseName(kToneMaps, *tone, "tone");
  if (const auto backdrop = keywords.get<std::string>("background", kText)) {
    if (*backdrop != "gradient")
      throw InvalidArgument("background: expected 'gradient' (others are a keyword of render), found '" + *backdrop +
                            "'");
    look.backdrop = Backdrop::gradient;
  }
  const std::vector<Annotation> wanted = annotationsIn(keywords);
  if (!wanted.empty() && !picture.scene)
    throw InvalidArgument("annotate: expected a picture that was rendered, found one from a file");
  PngOptions options;
  if (!picture.sceneText.empty()) options.metadata["umbrick.scene"] = picture.sceneText;
  if (look.backdrop == Backdrop::none && wanted.empty()) {
    options.toneMap = look.toneMap;
    options.exposure = look.exposure;
    writePng(path, picture.colour, options);
    return {};
  }
  Image shown = displayed(picture.colour, look);
  std::vector<std::string> leftOut;
  if (!wanted.empty()) leftOut = annotate(shown, annotationsOf(*picture.scene, wanted, picture.units, look));
  writePng(path, shown, options);
  return leftOut;
}

void saveExr(const PictureHandle& picture, const fs::path& path, const Keywords& keywords) {
  ExrOptions options;
  if (const auto pixel = keywords.get<std::string>("exr_pixel", kText))
    options.pixel = parseName(kExrPixels, *pixel, "exr_pixel");
  options.metadata = picture.metadata;
  if (!picture.sceneText.empty()) options.metadata["umbrick.scene"] = picture.sceneText;
  if (!picture.engine.empty()) options.metadata["umbrick.renderer"] = picture.engine;
  std::vector<ImageLayer> layers{{"", picture.colour}};
  layers.insert(layers.end(), picture.layers.begin(), picture.layers.end());
  writeExr(path, layers, options);
}

std::vector<std::string> savePicture(const PictureHandle& picture, const fs::path& path, const py::dict& values) {
  const Keywords keywords(values);
  if (isPng(path)) {
    if (keywords.has("exr_pixel")) throw InvalidArgument(path.string() + ": exr_pixel is for .exr, not for .png");
    return saveShown(picture, path, keywords);
  }
  for (const char* keyword : {"exposure", "tone", "background", "annotate"})
    if (keywords.has(keyword)) throw InvalidArgument(path.string() + ": " + keyword + " is for .png, not for .exr");
  saveExr(picture, path, keywords);
  return {};
}

PictureHandle openPicture(const fs::path& path) {
  PictureHandle picture;
  if (isPng(path)) {
    picture.colour = readPng(path);
    return picture;
  }
  ExrFile file = readExr(path);
  picture.colour = std::move(file.layers.front().image);
  picture.layers.assign(std::make_move_iterator(file.layers.begin() + 1), std::make_move_iterator(file.layers.end()));
  if (const auto scene = file.metadata.find("umbrick.scene"); scene != file.metadata.end())
    picture.sceneText = scene->second;
  if (const auto engine = file.metadata.find("umbrick.renderer"); engine != file.metadata.end())
    picture.engine = engine->second;
  picture.metadata = std::move(file.metadata);
  return picture;
}

py::dict statsOf(const PictureHandle& picture) {
  const RenderStats& s = picture.stats;
  py::dict out;
  out["engine"] = picture.engine;
  out["ms"] = picture.ms;
  if (picture.scene) out["technique"] = techniqueName(picture.scene->technique);
  out["slices"] = s.slices;
  out["bricks"] = s.bricks;
  out["visible_bricks"] = s.visibleBricks;
  out["uploaded_bricks"] = s.uploadedBricks;
  out["polygons"] = s.polygons;
  out["fragments"] = s.fragments;
  out["texture_bytes"] = s.textureBytes;
  out["buffer_bytes"] = s.bufferBytes;
  out["directions"] = s.directions;
  out["light_ms"] = s.lightMs;
  out["light_spacing"] = s.lightSpacing;
  out["format_error"] = s.formatError;
  out["geometry_ms"] = s.geometryMs;
  out["upload_ms"] = s.uploadMs;
  out["sweep_ms"] = s.sweepMs;
  out["read_ms"] = s.readMs;
  if (picture.progressive) {
    out["passes"] = picture.progressive->passes;
    out["seconds"] = picture.progressive->seconds;
    out["seed"] = picture.progressive->seed;
  }
  return out;
}

py::object errorOf(const PictureHandle& picture) {
  if (!picture.progressive) return py::none();
  const PictureHandle::Progress& made = *picture.progressive;
  py::dict out;
  out["statistical"] = made.error.statistical;
  out["systematic"] = made.error.systematic;
  out["total"] = made.error.total();
  out["reached_target"] = made.reachedTarget;
  return out;
}

// What umbrick compare --json says of a layer.
py::dict compare(const py::object& test, const py::object& reference, const std::array<double, 3>& background,
                 double pixelsPerDegree) {
  DifferenceOptions options;
  options.background = {background[0], background[1], background[2]};
  options.pixelsPerDegree = pixelsPerDegree;
  const Image a = imageOf(test, "test"), b = imageOf(reference, "reference");
  ImageDifference d;
  runJob("compare", py::none(), [&](JobWatch&) { d = differenceOf(a, b, options); });
  py::dict out;
  out["rmse"] = d.rmse;
  out["rmse_rgb"] = d.rmseRgb;
  out["max_error"] = d.maxError;
  out["p999"] = d.p999;
  out["rel_mse"] = d.relMse;
  out["ssim"] = d.ssim;
  out["flip"] = d.flip;
  out["max_error_pixel"] = py::make_tuple(d.maxPixel.x, a.height - 1 - d.maxPixel.y);
  out["non_finite_differing"] = d.nonFiniteDiffering;
  out["non_finite_equal"] = d.nonFiniteEqual;
  return out;
}

}  // namespace

py::object arrayOf(const Image& image, const py::object& owner) {
  constexpr py::ssize_t kFloatBytes = sizeof(float);
  const py::ssize_t pixel = image.channels * kFloatBytes, row = image.width * pixel;
  std::vector<py::ssize_t> shape{image.height, image.width}, strides{-row, pixel};
  if (image.channels > 1) {
    shape.push_back(image.channels);
    strides.push_back(kFloatBytes);
  }
  const float* top = image.height > 0 ? image.at(0, image.height - 1) : image.pixels.data();
  py::array_t<float> array(shape, strides, top, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

Image imageOf(const py::object& array, const std::string& name) {
  const auto pixels = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!pixels) {
    PyErr_Clear();
    throw InvalidArgument(name + ": expected a picture, found " + Keywords::shown(array));
  }
  if (pixels.ndim() < 2 || pixels.ndim() > 3)
    throw InvalidArgument(name + ": expected an array of height x width or height x width x channels, found shape " +
                          py::str(pixels.attr("shape")).cast<std::string>());
  const auto size = [&](py::ssize_t axis) { return static_cast<int>(pixels.shape(axis)); };
  Image image(size(1), size(0), pixels.ndim() == 3 ? size(2) : 1);
  const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  for (int y = 0; y < image.height; ++y)
    std::copy_n(pixels.data() + static_cast<std::size_t>(image.height - 1 - y) * row, row, image.at(0, y));
  return image;
}

void takePicture(Picture picture, const ResolvedScene& scene, PictureHandle& handle) {
  handle.colour = std::move(picture.colour);
  if (!picture.depth.pixels.empty()) {
    handle.layers.push_back({"V", std::move(picture.visibility)});
    handle.layers.push_back({"Z", std::move(picture.depth)});
  }
  for (ImageLayer& layer : picture.layers) handle.layers.push_back(std::move(layer));
  handle.stats = std::move(picture.stats);
  handle.scene = scene;
  handle.sceneText = printScene(scene);
  handle.metadata = {{"umbrick.filter", pixelFilter(scene.sampling.pixelSamples)},
                     {"umbrick.version", UMBRICK_VERSION}};
}

void addPicture(py::module_& module) {
  py::class_<PictureHandle>(module, "Picture", "A picture with what it was made from.")
      .def_property_readonly(
          "colour", [](const py::object& self) { return arrayOf(self.cast<const PictureHandle&>().colour, self); })
      .def_property_readonly("layers",
                             [](const py::object& self) {
                               py::dict out;
                               for (const ImageLayer& layer : self.cast<const PictureHandle&>().layers)
                                 out[py::str(layer.name)] = arrayOf(layer.image, self);
                               return out;
                             })
      .def_property_readonly("scene_text", [](const PictureHandle& self) { return self.sceneText; })
      .def_property_readonly("chosen", [](const PictureHandle& self) { return self.chosen; })
      .def_property_readonly("reasons", [](const PictureHandle& self) { return self.reasons; })
      .def_property_readonly("notes", [](const PictureHandle& self) { return self.notes; })
      .def_property_readonly("stats", statsOf)
      .def_property_readonly("error", errorOf)
      .def("save", savePicture);
  module.def("open_picture", openPicture);
  module.def("compare", compare);
}

}  // namespace umbrick::python
