// SPDX-License-Identifier: Apache-2.0
#include "umbrick/scene/scene_fields.h"

#include <algorithm>
#include <cmath>

#include "core/json_writer.h"
#include "scene/field_text.h"
#include "umbrick/scene/capabilities.h"

namespace umbrick {
namespace {

// Returns the table. Its help texts say what a field is; helpText() adds range and default.
// "emission (no occlusion), cone (...) or lights (...); cone-ray and ambient only in the reference"
std::string modelHelp() {
  std::string list, others;
  for (const ModelTraits& traits : modelTraits()) {
    const bool last = &traits == &modelTraits().back();
    const std::string between = list.empty() ? "" : last ? " or " : ", ";
    list += between + modelName(traits.model) + " (" + std::string(traits.meaning) + ")";
    if (!supports(Method::lightVolume, traits.model))
      others += (others.empty() ? "" : " and ") + modelName(traits.model);
  }
  return list + "; " + others +
         " only in the reference; surfaces are occluded by one another and by the medium of the transfer function, "
         "beside a 2D one by that alone";
}

// "integrate (a medium ...), mip (the largest value along each ray), ... or isosurface (...)"
std::string modeHelp() {
  std::string list;
  for (const ModeTraits& traits : modeTraits()) {
    const bool last = &traits == &modeTraits().back();
    list += list.empty() ? "what is seen: " : last ? " or " : ", ";
    list += modeName(traits.mode) + " (" + std::string(traits.meaning) + ")";
  }
  return list + "; all but integrate by rays";
}

const std::vector<SceneField>& table() {
  static const std::string models = modelHelp(), modes = modeHelp();
  static const std::vector<SceneField> fields{
      {"camera.projection", "", "Camera", "perspective or orthographic",
       [](Scene& s) -> FieldPlace { return Choice(s.camera.projection, kProjections); }},
      {"camera.azimuth", "azimuth", "Camera", "of the eye around the volume, degrees",
       [](Scene& s) -> FieldPlace { return s.orbit ? FieldPlace(Angle{&s.orbit->azimuth}) : FieldPlace(); }},
      {"camera.elevation", "elevation", "Camera", "of the eye above the volume, degrees",
       [](Scene& s) -> FieldPlace { return s.orbit ? FieldPlace(Angle{&s.orbit->elevation}) : FieldPlace(); }},
      {"camera.upAxis", "", "Camera", "which way is up around the volume: x, y, z, -x, -y, -z or auto",
       [](Scene& s) { return s.orbit ? FieldPlace(Choice(s.orbit->up, kAxes)) : FieldPlace(); }},
      {"camera.frontAxis", "front", "Camera",
       "which way the volume faces, where the eye is at azimuth 0: x, y, z, -x, -y, -z or auto",
       [](Scene& s) { return s.orbit ? FieldPlace(Choice(s.orbit->front, kAxes)) : FieldPlace(); }},
      {"camera.zoom",
       "zoom",
       "Camera",
       "so many times larger around the volume",
       [](Scene& s) { return s.orbit ? FieldPlace(&s.orbit->zoom) : FieldPlace(); },
       {.low = 0, .lowOpen = true},
       {},
       "; of a volume without a scene and without an angle: so that it fills the picture"},
      {"camera.pan", "pan", "Camera", "moves the volume to the right and up, heights of the picture",
       [](Scene& s) { return s.orbit ? FieldPlace(&s.orbit->pan) : FieldPlace(); }},
      {"camera.eye", "eye", "Camera", "where the camera stands, world",
       [](Scene& s) { return s.orbit ? FieldPlace() : FieldPlace(&s.camera.eye); }},
      {"camera.lookAt", "look-at", "Camera", "where it looks, world",
       [](Scene& s) { return s.orbit ? FieldPlace() : FieldPlace(&s.camera.lookAt); }},
      {"camera.up", "", "Camera", "what is up in the picture",
       [](Scene& s) { return s.orbit ? FieldPlace() : FieldPlace(&s.camera.up); }},
      {"camera.viewHeight",
       "view-height",
       "Camera",
       "of a parallel view that is placed by its eye, world units",
       [](Scene& s) { return s.orbit ? FieldPlace() : FieldPlace(&s.camera.viewHeight); },
       {.low = 0, .lowOpen = true},
       {},
       "1"},
      {"camera.fov",
       "fov",
       "Camera",
       "full vertical angle of view, degrees",
       [](Scene& s) -> FieldPlace { return Angle{&s.camera.fov}; },
       {.low = 0, .high = 180, .lowOpen = true, .highOpen = true}},
      {"camera.near",
       "near",
       "Camera",
       "nothing nearer than this is seen, world units",
       [](Scene& s) -> FieldPlace { return &s.camera.nearDistance; },
       {.low = 0}},
      {"camera.size",
       "size",
       "Camera",
       "of the picture, pixels",
       [](Scene& s) -> FieldPlace {
         return PixelSize{&s.camera.width, &s.camera.height};
       },
       {.low = 1}},

      {"gradientOpacity",
       "gradient-opacity",
       "Medium",
       "LO HI: the medium appears where values change: not at all up to a gradient of LO, in full from HI on; of a "
       "transfer function of the value alone, in --gradient-unit; 0 0: everywhere",
       [](Scene& s) -> FieldPlace { return &s.gradientOpacity; },
       {.low = 0}},
      {"gradientUnit", "gradient-unit", "Medium",
       "of --gradient-opacity: grid (value per world unit, as of 2D transfer functions) or percent (of the volume's "
       "largest gradient)",
       [](Scene& s) -> FieldPlace { return Choice(s.gradientUnit, kGradientUnits); }},
      {"gradients", "gradients", "Medium",
       "of --gradient-opacity, 2D transfer functions and Phong's model: central (differences of the voxels beside) or "
       "bspline (of a tricubic B-spline: smoother, less noise, softer edges)",
       [](Scene& s) -> FieldPlace { return Choice(s.gradients, kGradientFilters); }},

      {"mode", "mode", "Mode", modes, [](Scene& s) -> FieldPlace { return Choice(s.mode, kModes); }},
      {"shading.kind", "shading", "Mode",
       "none, phong (ambient, diffuse and specular light on the gradient), or auto: phong on isosurfaces, else none",
       [](Scene& s) -> FieldPlace { return Choice(s.shading.kind, kShadings); }},
      {"shading.light", "shading-light", "Mode",
       "that Phong's model reflects: headlight (from the eye), sources (the scene's directional ones), or auto: "
       "sources "
       "with the model lights, else headlight",
       [](Scene& s) -> FieldPlace { return Choice(s.shading.light, kShadingLights); }},
      {"shading.ambient",
       "ambient-k",
       "Mode",
       "of Phong's model: share that is there without a light",
       [](Scene& s) -> FieldPlace { return &s.shading.ambient; },
       {.low = 0}},
      {"shading.diffuse",
       "diffuse-k",
       "Mode",
       "of Phong's model: share that is scattered to all sides",
       [](Scene& s) -> FieldPlace { return &s.shading.diffuse; },
       {.low = 0}},
      {"shading.specular",
       "specular-k",
       "Mode",
       "of Phong's model: share that is mirrored, in the colour of the light",
       [](Scene& s) -> FieldPlace { return &s.shading.specular; },
       {.low = 0}},
      {"shading.shininess",
       "shininess",
       "Mode",
       "of Phong's model: exponent, the larger the smaller are highlights",
       [](Scene& s) -> FieldPlace { return &s.shading.shininess; },
       {.low = 0, .lowOpen = true}},

      {"mesh.colour",
       "mesh-colour",
       "Mesh",
       "of the mesh: r g b, linear",
       [](Scene& s) -> FieldPlace { return &s.mesh.colour; },
       {.low = 0, .high = 1}},

      {"emission.kind", "emission-kind", "Emission",
       "what values of --emission-grid are: blackbody (temperatures) or table (looked up in --emission-tf)",
       [](Scene& s) -> FieldPlace { return Choice(s.emission.kind, kEmissionKinds); }},
      {"emission.scale",
       "emission-scale",
       "Emission",
       "kelvin per unit of the grid's values; of a table: what values are multiplied by before they are looked up",
       [](Scene& s) -> FieldPlace { return &s.emission.scale; },
       {.low = 0, .lowOpen = true}},
      {"emission.offset", "emission-offset", "Emission", "kelvin where the value is 0; of a table: added to values",
       [](Scene& s) -> FieldPlace { return &s.emission.offset; }},
      {"emission.brightness", "emission-brightness", "Emission",
       "of a black body: stefan-boltzmann (by the fourth power of the temperature), planck (its luminance, which grows "
       "faster) or constant (its colour alone)",
       [](Scene& s) -> FieldPlace { return Choice(s.emission.brightness, kEmissionBrightnesses); }},
      {"emission.intensity",
       "emission-intensity",
       "Emission",
       "radiance per world unit of a black body of 1500 K; of a table: a factor",
       [](Scene& s) -> FieldPlace { return &s.emission.intensity; },
       {.low = 0}},
      {"emission.lightsMedium", "no-emission-light", "Emission",
       "what is emitted does not light the medium around it; else it does, scattered once, in the models cone, ambient "
       "and lights by --method light-volume and in the reference, not with Phong's model",
       [](Scene& s) -> FieldPlace { return &s.emission.lightsMedium; }},

      {"model", "model", "Light", models, [](Scene& s) -> FieldPlace { return Choice(s.model, kModels); }},
      {"method", "method", "Light",
       "of the models cone (dos, ordinates or light-volume), lights (ordinates or light-volume) and ambient "
       "(light-volume); or cone-rays of all three: rays towards the light from each sample, by rays, slow, to compare "
       "the others with",
       [](Scene& s) -> FieldPlace { return Choice(s.method, kMethods); }},
      {"technique", "technique", "Sampling",
       "how the picture is computed: slices (across the view, on OpenGL), stacks (across the axes of the volume, on "
       "OpenGL), rays (through each pixel, on OpenGL or the "
       "CPU), shear-warp (rays in rows of voxels, on the CPU: quicker and coarser) or auto",
       [](Scene& s) -> FieldPlace { return Choice(s.technique, kTechniques); }},

      {"light.ambient",
       "ambient",
       "Light",
       "radiance from every direction, linear RGB",
       [](Scene& s) -> FieldPlace { return &s.ambient; },
       {.low = 0}},
      {"light.background",
       "background",
       "Light",
       "radiance behind the volume, linear RGB; makes the picture opaque",
       [](Scene& s) -> FieldPlace { return &s.background; },
       {.low = 0}},

      {"sampling.spacing",
       "spacing",
       "Sampling",
       "distance of slices",
       [](Scene& s) -> FieldPlace { return &s.sampling.spacing; },
       {.low = 0, .lowOpen = true},
       {},
       "; cone and lights of a volume without a scene: as the quality says"},
      {"sampling.unit", "spacing-unit", "Sampling", "voxel (its shortest edge) or world",
       [](Scene& s) -> FieldPlace { return Choice(s.spacingUnit, kSpacingUnits); }},
      {"sampling.quadrature", "quadrature", "Sampling", "of a slab: preintegrated or midpoint",
       [](Scene& s) -> FieldPlace { return Choice(s.sampling.quadrature, kQuadratures); }},
      {"sampling.classification", "classification", "Sampling",
       "post: values are interpolated; pre: the media of voxels, as a comparison, without occlusion, on the CPU",
       [](Scene& s) -> FieldPlace { return Choice(s.sampling.classification, kClassifications); }},
      {"sampling.stackInterpolation", "stack-interpolation", "Sampling",
       "of stacks: linear, slices at --spacing along the view, between voxels; none, on the voxels' own slices alone",
       [](Scene& s) -> FieldPlace { return Choice(s.sampling.stackInterpolation, kStackInterpolations); }},
      {"sampling.segments",
       "segments",
       "Sampling",
       "of a slab, integrated one by one along the ray",
       [](Scene& s) -> FieldPlace { return &s.sampling.segments; },
       {.low = 1, .high = kMostSegments},
       {},
       "; with a quality: no longer than 0.625 voxels"},
      {"sampling.bits",
       "eye-bits",
       "Sampling",
       "of the eye buffer: 32 (float) or 16 (fixed point, off by up to 2.3e-5 per slice; slabs of less opacity than "
       "8e-6 "
       "are lost)",
       [](Scene& s) -> FieldPlace { return &s.sampling.bits; },
       {.low = 16, .high = 32, .endsOnly = true}},
      {"sampling.saturation",
       "saturation",
       "Sampling",
       "transmittance below which a pixel is done; 0: never",
       [](Scene& s) -> FieldPlace { return &s.sampling.saturation; },
       {.low = 0, .high = 1, .highOpen = true}},
      {"sampling.pixelSamples",
       "samples",
       "Sampling",
       "a pixel: the mean over so many places in its area (box filter), at so many times the cost; 1: its centre",
       [](Scene& s) -> FieldPlace { return &s.sampling.pixelSamples; },
       {.low = 1, .high = kMostPixelSamples}},

      {"occlusion.theta",
       "theta",
       "Light",
       "half-angle of the cone, degrees",
       [](Scene& s) -> FieldPlace { return Angle{&s.occlusion.aperture}; },
       {.low = 0, .high = 90, .highOpen = true}},
      {"occlusion.footprint",
       "footprint",
       "Light",
       "of dos, n: n x n samples over the cone's footprint",
       [](Scene& s) -> FieldPlace { return &s.occlusion.dos.footprint; },
       {.low = 1, .high = 16},
       {Method::dos}},
      {"occlusion.passes",
       "passes",
       "Light",
       "of dos, 2: two passes per slice, 1: multiple render targets",
       [](Scene& s) -> FieldPlace { return &s.occlusion.dos.passes; },
       {.low = 1, .high = 2, .endsOnly = true},
       {Method::dos}},
      {"occlusion.algorithm",
       "algorithm",
       "Light",
       "of dos, 2: exact distance per sample, 3: slice distance",
       [](Scene& s) -> FieldPlace { return &s.occlusion.dos.algorithm; },
       {.low = 2, .high = 3, .endsOnly = true},
       {Method::dos}},
      {"occlusion.perspectiveCorrection",
       "no-perspective-correction",
       "Light",
       "of dos: footprint as in a parallel view",
       [](Scene& s) -> FieldPlace { return &s.occlusion.dos.perspectiveCorrection; },
       {},
       {Method::dos}},
      {"occlusion.bits",
       "occlusion-bits",
       "Light",
       "of the occlusion buffer or the windows: 32 (float) or 16 (fixed point, as the eye buffer)",
       [](Scene& s) -> FieldPlace { return &s.occlusion.bits; },
       {.low = 16, .high = 32, .endsOnly = true}},
      {"occlusion.directions",
       "directions",
       "Light",
       "of ordinates, light-volume and cone-rays, K: about so many over the cone or the lights",
       [](Scene& s) -> FieldPlace { return &s.occlusion.ordinates.directions; },
       {.low = 1, .high = 1024},
       {Method::ordinates, Method::lightVolume, Method::coneRays}},
      {"occlusion.scale",
       "occlusion-scale",
       "Light",
       "of ordinates: window texels per voxel edge",
       [](Scene& s) -> FieldPlace { return &s.occlusion.ordinates.scale; },
       {.low = 0},
       {Method::ordinates},
       ": a texel is as large as the larger of slab and voxel, in huge volumes 1/2048 of the diagonal"},

      {"occlusion.lightSpacing",
       "light-spacing",
       "Light",
       "of light-volume: voxels between places of light",
       [](Scene& s) -> FieldPlace { return &s.occlusion.ordinates.lightSpacing; },
       {.low = 0, .high = 2},
       {Method::lightVolume},
       ": 1, or 2 where there is no memory for light at every voxel"},

      {"bricks.bricked", "unbricked", "Bricks", "the whole volume as one texture",
       [](Scene& s) -> FieldPlace { return &s.bricks.bricked; }},
      {"bricks.interior",
       "brick-edge",
       "Bricks",
       "owned voxels along an edge",
       [](Scene& s) -> FieldPlace { return &s.bricks.interior; },
       {.low = 8, .high = kMostInterior, .multipleOf = 8, .orElse = 0},
       {},
       ": from the sizes of slabs and pixels"},
      {"bricks.culling", "no-culling", "Bricks", "draw bricks that the transfer function makes invisible, too",
       [](Scene& s) -> FieldPlace { return &s.bricks.culling; }},
      {"bricks.format",
       "texel-format",
       "Bricks",
       "auto, unorm8, unorm16, half or float32",
       [](Scene& s) -> FieldPlace { return Choice(s.bricks.format, kTexelFormats); },
       {},
       {},
       ": the smallest exact one"},
      {"bricks.budgetMiB",
       "memory-budget",
       "Bricks",
       "of the bricks' textures, MiB",
       [](Scene& s) -> FieldPlace { return &s.bricks.budgetMiB; },
       {.low = 1, .high = 0x1p40}},
  };
  return fields;
}

}  // namespace

std::vector<std::string> Choice::names() const {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < count_; ++i) list.emplace_back(nameAt_(names_, i));
  return list;
}

std::string_view Choice::get() const {
  for (std::size_t i = 0; i < count_; ++i)
    if (isAt_(names_, i, target_)) return nameAt_(names_, i);
  return {};
}

bool Choice::set(std::string_view name) const {
  for (std::size_t i = 0; i < count_; ++i)
    if (nameAt_(names_, i) == name) {
      assign_(names_, i, target_);
      return true;
    }
  return false;
}

std::string_view SceneField::section() const {
  const std::size_t dot = path.find('.');
  return dot == std::string_view::npos ? std::string_view() : path.substr(0, dot);
}

std::string_view SceneField::key() const {
  const std::size_t dot = path.find('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

std::span<const SceneField> sceneFields() { return table(); }

const SceneField* findSceneField(std::string_view optionOrPath) {
  for (const SceneField& field : table())
    if (field.path == optionOrPath || (!field.option.empty() && field.option == optionOrPath)) return &field;
  return nullptr;
}

}  // namespace umbrick
