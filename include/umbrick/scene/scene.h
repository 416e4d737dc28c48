// A scene holds everything that a picture depends on. The same scene drives every renderer.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/core/axis.h"
#include "umbrick/core/camera.h"
#include "umbrick/core/names.h"
#include "umbrick/optics/gradient_filter.h"
#include "umbrick/optics/transfer_function.h"
#include "umbrick/scene/emission.h"
#include "umbrick/scene/light_source.h"
#include "umbrick/scene/mode.h"
#include "umbrick/scene/scene_keys.h"

namespace umbrick {

class Mesh;

/// Which light is scattered at a point. `emission` scatters all of the ambient radiance. The others scatter the
/// share V of it that the medium lets in, as the mean over directions: of a cone around the slice normal (`cone`) or
/// around the ray to the eye (`coneRay`, Eq. 6 of Schott et al. to the letter), or of the whole sphere (`ambient`,
/// their Fig. 2a). `lights` scatters what the medium lets in of the scene's light sources. What follows from a model
/// is in capabilities.h.
enum class Model { emission, cone, coneRay, ambient, lights };
inline constexpr Name<Model> kModels[]{{"emission", Model::emission},
                                       {"cone", Model::cone},
                                       {"cone-ray", Model::coneRay},
                                       {"ambient", Model::ambient},
                                       {"lights", Model::lights}};
inline std::string modelName(Model model) { return std::string(nameOf(kModels, model)); }

/// How the share V is computed. `dos` is directional occlusion shading, Schott et al. 2009,
/// doi:10.1111/j.1467-8659.2009.01464.x. `ordinates` is a set of directions, each with a transmittance of its own that
/// is carried along its paths through the slices. `light-volume` takes the same directions through the voxels instead,
/// before the picture is drawn, so that slices read how much light reaches a voxel. `cone-rays` takes them through the
/// voxels from each sample of each view ray anew: by far the slowest, to compare the others with, for it neither blurs
/// nor interpolates light.
enum class Method { dos, ordinates, lightVolume, coneRays };
inline constexpr Name<Method> kMethods[]{{"dos", Method::dos},
                                         {"ordinates", Method::ordinates},
                                         {"light-volume", Method::lightVolume},
                                         {"cone-rays", Method::coneRays}};
inline std::string methodName(Method method) { return std::string(nameOf(kMethods, method)); }

/// How a slab between two slices is integrated.
enum class Quadrature {
  preintegrated,  // value taken as linear between front and back of the slab
  midpoint,       // the medium at the middle of the slab, for all of it
};
inline constexpr Name<Quadrature> kQuadratures[]{{"preintegrated", Quadrature::preintegrated},
                                                 {"midpoint", Quadrature::midpoint}};

/// What is interpolated between voxels: the value, which the transfer function then turns into a medium; or the media
/// of the voxels. The latter shows what lies between the values of two voxels as a mixture of their media: it is kept
/// as a comparison.
enum class Classification { post, pre };
inline constexpr Name<Classification> kClassifications[]{{"post", Classification::post}, {"pre", Classification::pre}};

/// Where slices of stacks are drawn: linear, at a constant distance along the view, with values interpolated between
/// the two voxel slices around; none, on the voxel slices alone, whose distance along a ray depends on the view.
enum class StackInterpolation { linear, none };
inline constexpr Name<StackInterpolation> kStackInterpolations[]{{"linear", StackInterpolation::linear},
                                                                 {"none", StackInterpolation::none}};

/// How a picture is computed: by slices across the view, on OpenGL; by stacks of slices along the volume's own axes, on
/// OpenGL; by a ray through each pixel, on OpenGL or the CPU;
/// by shear-warp, whose rays lie in rows of voxels and whose picture is warped to the pixels, on the CPU. Automatic:
/// see chooseEngine() in render/engine.h.
enum class Technique { automatic, slices, stacks, rays, shearWarp };
inline constexpr Name<Technique> kTechniques[]{{"auto", Technique::automatic},
                                               {"slices", Technique::slices},
                                               {"stacks", Technique::stacks},
                                               {"rays", Technique::rays},
                                               {"shear-warp", Technique::shearWarp}};
inline std::string techniqueName(Technique technique) { return std::string(nameOf(kTechniques, technique)); }

/// Options of the method `dos`.
struct DosOptions {
  int footprint = 3;  // n: n x n samples over the cone's footprint on the previous slice
  int passes = 1;     // 2: two passes a slice as in Algorithm 1 of the paper; 1: multiple render targets
  int algorithm = 3;  // of the paper; 2: exact distance per sample; 3: slice distance for all
  bool perspectiveCorrection = true;  // Eqs. 12-15 of the paper
  bool operator==(const DosOptions&) const = default;
};

/// Options of the methods `ordinates`, `light-volume` and `cone-rays`.
struct OrdinatesOptions {
  int directions = 16;  // K: about so many over the cone or over the lights
  /// Of ordinates: window texels per voxel edge. 0 stands for texels as large as the larger of slab and voxel, or as
  /// 1/2048 of the volume's diagonal where that is larger.
  double scale = 0;
  /// Of light-volume: voxels between places of light along each axis, 1 or 2. 0: 1, or 2 where there is no memory for
  /// light at every voxel.
  int lightSpacing = 0;
  bool operator==(const OrdinatesOptions&) const = default;
};

/// How light is occluded.
struct OcclusionOptions {
  double aperture = 1.0471975511965976;  // theta: half-angle of the cone, rad, in [0, pi/2)
  int bits = 32;                         // of dos's occlusion buffer or ordinates' light windows, see SamplingOptions
  DosOptions dos;
  OrdinatesOptions ordinates;
  bool operator==(const OcclusionOptions&) const = default;
};

/// Where along a view ray the medium is sampled.
struct SamplingOptions {
  /// The distance d of slices along the view direction, in the scene's spacingUnit; in a ResolvedScene in world units.
  double spacing = 0.5;
  Quadrature quadrature = Quadrature::preintegrated;
  Classification classification = Classification::post;
  StackInterpolation stackInterpolation = StackInterpolation::linear;
  int segments = 1;  // parts of equal length in which a slab is integrated along the ray
  /// Bits of the eye buffer: 32 (float) or 16 (fixed point). A slice rounds 16 bits to steps of 2^-16 and is off by up
  /// to one and a half of them: N slices by at most N 2.3e-5, mostly by much less (an occlusion buffer of 16 bits as
  /// much again). But a pixel of opacity A gains nothing from slabs of opacity below 2^-17 / (1 - A), which is what
  /// thin fog in many slices is made of: such scenes need 32 bits.
  int bits = 32;
  double saturation = 1e-3;  // transmittance below which a pixel is shaded no more; 0: never
  /// Rays a pixel: the picture is the mean over so many places in its area (box filter), see pixelPoints. 1: its
  /// centre.
  int pixelSamples = 1;
  bool operator==(const SamplingOptions&) const = default;
};

/// Where segments are chosen automatically, they are no longer than so many voxels (shortest edge).
inline constexpr double kSegmentVoxels = 0.625;
inline constexpr int kMostSegments = 8;
inline constexpr int kMostPixelSamples = 4096;
/// Returns how many segments of at most kSegmentVoxels a slab needs, at most kMostSegments.
/// @param slabVoxels  the thickness of a slab
int segmentsOf(double slabVoxels);

enum class SpacingUnit {
  voxel,  // the shortest edge of a voxel
  world,
};
inline constexpr Name<SpacingUnit> kSpacingUnits[]{{"voxel", SpacingUnit::voxel}, {"world", SpacingUnit::world}};

/// The unit of gradientOpacity.
enum class GradientUnit {
  grid,     // grid units per world unit, as of 2D transfer functions
  percent,  // of the largest gradient magnitude of the volume's active voxels, by central differences
};
inline constexpr Name<GradientUnit> kGradientUnits[]{{"grid", GradientUnit::grid}, {"percent", GradientUnit::percent}};

inline constexpr std::string_view kTexelFormats[]{"auto", "unorm8", "unorm16", "half", "float32"};

inline constexpr int kMostInterior = 256;

struct BrickSettings {
  bool bricked = true;             // false: the whole volume as one texture
  int interior = 0;                // owned voxels along a brick's edge: 8 to 256, a multiple of 8; 0: see brickInterior
  bool culling = true;             // skip bricks that the transfer function makes invisible
  std::string format = "auto";     // of texels: auto (smallest exact one), unorm8, unorm16, half, float32
  std::uint64_t budgetMiB = 2048;  // of textures that hold voxels; larger volumes stream through a pool of this size
  bool operator==(const BrickSettings&) const = default;
};

/// A clip plane keeps the half-space dot(xyz, point) + w >= 0, world units.
using ClipPlane = glm::dvec4;

/// What the bytes of a file without a header mean.
struct RawLayout {
  glm::i64vec3 dims{0};  // voxels along x (fastest), y, z
  std::string type;      // of a voxel: u8, i8, u16, ... f64
  bool bigEndian = false;
  std::int64_t headerBytes = 0;   // skipped at the start of the unpacked file
  std::optional<int> bitsStored;  // of an integer that hold its value; those above are masked off
  bool operator==(const RawLayout&) const = default;
};

/// Stands for the grid that emits light, if there is one, see emissionGridNames() in render/volume.h.
inline constexpr std::string_view kAutomaticGrid = "auto";

/// Where voxels come from: a grid of a file of grids, or a volume of any format that can be converted.
struct VolumeReference {
  std::filesystem::path file;
  std::string grid;                        // of a file of grids: empty, "name" or "name[1]"
  std::string emissionGrid = {};           // of the same file: the grid that emits light, or "auto"; empty: none
  std::string series = {};                 // of DICOM: the UID of a series, or its number in the list, from 1
  std::vector<std::string> where = {};     // of DICOM: only slices with this "Tag=value"
  std::optional<RawLayout> raw = {};       // of a file without a header
  std::optional<glm::dvec3> spacing = {};  // world units between voxel centres, of formats that state none
  std::optional<glm::dvec3> origin = {};   // world position of the first voxel, of the same formats
  bool besideOnly = false;                 // as OpenOptions::besideOnly; is not written to JSON
  bool operator==(const VolumeReference&) const = default;
};

/// A camera given as angles around what is visible of the volume; see orbitCamera.
struct Orbit {
  double azimuth = 0, elevation = 0;  // rad
  /// Which way is up, and which way the thing faces, where the eye is at azimuth 0. What is automatic follows from the
  /// volume: from the anatomy that its file states, or else from habits of its kind; see orientationOf in
  /// render/volume.h. An up without a front has the usual one: usualFront().
  Axis up = Axis::automatic, front = Axis::automatic;
  double zoom = 1;    // so many times larger
  glm::dvec2 pan{0};  // to the right and up, in heights of the picture
  bool operator==(const Orbit&) const = default;
};

/// An opaque mesh in the volume, such as an implant or an instrument. Each ray ends where it meets the mesh first, so
/// that what a mode shows of the volume is what lies in front of it. Clipping does not cut the mesh. It is shaded by
/// Phong's model unless there is no shading, by the lights that shadingLights() returns. Under models with occlusion it
/// keeps all light from the medium and the surfaces behind it, wherever it is, but nothing keeps light from it.
struct SceneMesh {
  std::filesystem::path file;         // name of the file in a scene file
  std::shared_ptr<const Mesh> shape;  // in the world, world units; none: there is no mesh
  glm::dvec3 colour{0.8};             // linear RGB in [0, 1]
  /// Compares names, colours and triangles.
  bool operator==(const SceneMesh& other) const;
};

/// What a scene has whether or not its volume is known. scene_fields.h has the unit, range and help of each field.
struct SceneSettings {
  VolumeReference volume;
  Camera camera;
  Model model = Model::emission;
  Method method = Method::lightVolume;
  Technique technique = Technique::automatic;
  Mode mode = Mode::integrate;
  std::vector<SceneSurface> surfaces;  // of isosurface and hybrid; none of a level set: where it is 0
  SceneMesh mesh;
  ShadingOptions shading;
  EmissionSettings emission;  // of VolumeReference::emissionGrid
  /// Gradient magnitudes from which and up to which a medium appears: sigma_t is scaled from 0 at the first one to 1 at
  /// the second one. Of a Scene in its gradientUnit, else grid units per world unit. Both 0: the medium stays as it is.
  glm::dvec2 gradientOpacity{0};
  /// Of which Phong's model, gradientOpacity and 2D transfer functions make something.
  GradientFilter gradients = GradientFilter::central;
  glm::dvec3 ambient{1};                 // L_a, radiance from every direction
  std::optional<glm::dvec3> background;  // L_b; when it is set the picture is opaque (alpha 1)
  std::vector<LightSource> lights;       // for the model `lights`, which needs at least one
  SamplingOptions sampling;
  OcclusionOptions occlusion;
  std::vector<ClipPlane> clipPlanes;
  std::optional<Box> clipBox;  // world units
  BrickSettings bricks;
  bool operator==(const SceneSettings&) const = default;
};

/// A scene as a user writes it. resolveScene() makes a ResolvedScene of it, which is what pictures are made from.
struct Scene : SceneSettings {
  /// Window and scale are applied already. None: one that fits the volume is made, see suggestTransfer() in
  /// render/suggest_transfer.h.
  std::optional<TransferFunction> transfer;
  std::optional<Orbit> orbit = Orbit{};          // when set, eye, lookAt, up and viewHeight follow from the volume
  SpacingUnit spacingUnit = SpacingUnit::voxel;  // of sampling.spacing
  GradientUnit gradientUnit = GradientUnit::grid;
  /// What changes over frames: see sceneAt(). All of it has here the value that it has at frame 0.
  std::vector<SceneTrack> tracks = {};
  bool operator==(const Scene&) const = default;
};

/// Reads a scene. A field that the text leaves out keeps its default; an unknown field is an error. File names are
/// relative to the scene's folder. All fields are optional, and angles are in degrees:
///   volume     file, grid, emissionGrid, series, where ["Tag=value", ...], spacing [x, y, z], origin [x, y, z],
///              raw {dims [x, y, z], type ("u8", ...), endian ("little", "big"), headerBytes, bitsStored}
///   camera     projection ("perspective", "orthographic"), size [width, height], fov, near, and either azimuth and
///              elevation around the volume, upAxis, frontAxis ("auto", "x", "-x", ...), zoom and pan [right, up], or
///              eye, lookAt, up and viewHeight
///   transfer   name of a preset, name of a file, the function itself (also ParaView's array), or "auto", as without it
///   window [low, high], sigmaScale    applied to it
///   model      "emission", "cone", "cone-ray", "ambient", "lights"
///   method     "dos", "ordinates", "light-volume", "cone-rays"
///   technique  "auto", "slices", "rays", "shear-warp"
///   gradientOpacity [low, high], gradientUnit ("grid", "percent")    applied to the transfer function
///   gradients  "central", "bspline"
///   mode       "integrate", "mip", "minip", "average", "xray", "isosurface", "hybrid"
///   surfaces   [{value, colour [r, g, b], opacity}, ...]
///   mesh       file (PLY, OBJ, STL), colour [r, g, b]
///   shading    kind ("auto", "none", "phong"), light ("auto", "headlight", "sources"), ambient, diffuse, specular,
///              shininess
///   emission   kind ("blackbody", "table"), scale, offset, brightness ("stefan-boltzmann", "planck", "constant"),
///              intensity, transfer (of a table, as above)
///   light      ambient [r, g, b], background [r, g, b], sources [{type, frame ("view", "world"), ...}, ...]; by type,
///                "cone"         axis, theta, radiance ([r, g, b], or one number)
///                "directional"  direction, softAngle (of theta's kind), radiance: the same, and printed as a cone
///                "directions"   list [{direction, weight, colour}, ...]
///                "environment"  file (EXR), up, front, scale; up and front are [0, 1, 0] and [0, 0, 1] in the view,
///                               [0, 0, 1] and [0, -1, 0] in the world, the same at azimuth 0 and elevation 0
///   sampling   spacing, unit ("voxel", "world"), quadrature ("preintegrated", "midpoint"),
///              classification ("post", "pre"), stackInterpolation ("linear", "none"), segments, bits, saturation,
///              pixelSamples (tableSize, of scenes made by earlier versions, is read and means nothing)
///   occlusion  theta, footprint, passes, algorithm, perspectiveCorrection, bits, directions, scale, lightSpacing
///   clip       planes [[a, b, c, d], ...], box [[x, y, z], [x, y, z]]
///   keys       [{frame, ...}, ...], curve ("smooth", "linear")    in camera, shading, emission, light, occlusion, clip
///   and the
///              scene itself: numbers, vectors, planes, box and surfaces (as many at all keys) at those frames; in
///              transfer {frame, function}. A field that only some keys have runs between these
///   bricks     bricked, interior, culling, format ("auto", "unorm8", "unorm16", "half", "float32"), budgetMiB
/// @param source  what messages call the text, usually its file name
/// @param besideOnly  refuses files outside of `folder` and what is below it, for scenes of others; so does the volume
/// @throw IoError  malformed JSON, or a field of the wrong kind or out of range: names source, line, column and field
Scene parseScene(std::string_view text, const std::string& source, const std::filesystem::path& folder = {},
                 bool besideOnly = false);
/// Reads a scene from a file. @throw IoError  as parseScene; the file cannot be read, or is a pipe or device
Scene readScene(const std::filesystem::path& path, bool besideOnly = false);
/// Returns JSON that parses back to an equal scene, to the last bit, as long as the files that it names are there. With
/// an orbit, what follows from the volume (eye, lookAt, up and viewHeight) is left out.
/// @throw InvalidArgument  a number is not finite, or an environment map comes from no file
std::string printScene(const Scene& scene);

/// How much work is spent on the light of a picture: ordinates for a draft, else light volumes.
enum class Quality { draft, normal, high };
inline constexpr Name<Quality> kQualities[]{
    {"draft", Quality::draft}, {"normal", Quality::normal}, {"high", Quality::high}};
/// Sets method, spacing, segments, directions and the scale of light windows to values that go together. The error of
/// each quality is in tools/benchmark/README.md.
void applyQuality(Quality quality, Scene& scene);

/// Checks every field against its range, however the scene was made.
/// @throw InvalidArgument  names the field as in the JSON, what it is and what it may be
void validateScene(const Scene& scene);

}  // namespace umbrick
