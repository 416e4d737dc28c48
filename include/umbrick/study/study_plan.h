// Plans what a study measures: the methods, the values that are swept, and the list of cases that follows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/core/names.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

/// What pictures show: a medium, or one that reflects light by Phong's model, or what another mode shows. Pictures of
/// one look are comparable.
enum class StudyLook { medium, phong, mip, minip, average, xray, isosurface, hybrid };
inline constexpr Name<StudyLook> kLooks[]{
    {"medium", StudyLook::medium},         {"phong", StudyLook::phong},     {"mip", StudyLook::mip},
    {"minip", StudyLook::minip},           {"average", StudyLook::average}, {"xray", StudyLook::xray},
    {"isosurface", StudyLook::isosurface}, {"hybrid", StudyLook::hybrid}};
inline std::string lookName(StudyLook look) { return std::string(nameOf(kLooks, look)); }
/// Makes a scene of the medium one of a look. All looks but `medium` are without occlusion.
void showAs(StudyLook look, SceneSettings& scene);
/// Tells whether a look needs the scene's surfaces.
bool needsSurfaces(StudyLook look);

/// A way to compute a picture. Its entry in studyMethods() is all that a study needs to know of it.
struct StudyMethod {
  std::string name;   // name in settings and records: "dos"
  std::string title;  // for readers: "dos, Algorithm 3"
  Model model;        // emission or cone, which the method approximates; the reference of this model is the truth
  /// What makes the method finer besides the number of slices; without a name nothing does.
  struct Detail {
    std::string name;     // "footprint": field and column name
    std::string plural;   // "footprints": what messages call the list
    std::string symbol;   // "n": in plots and names of cases
    std::string meaning;  // "n x n samples over the cone's footprint": for readers
    int least = 1, most = 1;
    std::vector<int> full, quick;  // values that are swept unless the user says others
  } detail;
  void (*apply)(int detail, ResolvedScene& scene);  // makes a scene of the model one of this method
  double (*work)(int detail);                       // work of a slice, as a multiple of that of emission
  std::vector<int> slices, quickSlices;             // worth using; swept unless the user gives others
  bool usual = true;                                // whether it is part of a study unless the user says otherwise
  bool quick = false;                               // whether it is also part of a quick study
  bool fineSegments = false;           // at the base: kAutomaticSegments per slab, else the fewest that are swept
  bool windows = false;                // whether it carries light in light windows, whose scale is swept
  bool onCpu = false;                  // where it is drawn; else on OpenGL
  bool compared = false;               // whether it is part of a comparison of techniques
  StudyLook look = StudyLook::medium;  // the reference of this look is the truth
};

/// Stands for as many segments as segmentsOf() says.
inline constexpr int kAutomaticSegments = 0;

/// Returns the methods:
///   emission       slices; pixels that are opaque are shaded no more (as the scene says)
///   emission-full  the same without that shortcut, the reference point of convergence
///   dos            directional occlusion shading, Algorithm 3 of Schott et al. 2009
///   dos-2          the same, Algorithm 2
///   dos-two-pass   Algorithm 3 in two passes per slice
///   ordinates      a set of directions, each with a transmittance of its own, in slabs of several segments
///   light-volume   the same directions, taken through the voxels before the picture is drawn
///   stacks, stacks-light-volume                   slices along the volume's axes, as far apart as the others
///   rays, shear-warp                              emission by techniques on the CPU; the number of slices stands for
///   rays-light-volume, shear-warp-light-volume    how densely they sample, and the last two have light volumes
///   rays-midpoint  rays with the medium at the middle of each segment, not the integral over its values
///   rays-pre       rays through media that were interpolated between classified voxels
///   rays-gl, rays-gl-light-volume                 rays on OpenGL, of the slices' segments
///   cone-rays, cone-rays-gl                       rays towards the light from each sample of rays
///   rays-gl-box    rays on OpenGL by the simple set-up: through the box of the volume, one texture, without skipping
///   LOOK-TECHNIQUE  each other look by each technique that has it: mip-rays, mip-rays-gl, phong-shear-warp, ...; how
///                   finely isosurfaces are drawn depends on no slices
const std::vector<StudyMethod>& studyMethods();
/// Returns the method of a name. @throw InvalidArgument  there is no such method; the message lists those there are
const StudyMethod& studyMethod(std::string_view name);

/// Bits of the eye buffer and of the occlusion buffer, 16 or 32 each.
struct BufferBits {
  int eye = 32, occlusion = 32;
  bool operator==(const BufferBits&) const = default;
};

/// The values that are swept. The order within a list makes no difference.
struct StudySettings {
  std::vector<std::string> methods;  // empty: the usual ones
  std::vector<int> slices;  // through the visible extent of the volume along the view axis; empty: as each method says
  std::map<std::string, std::vector<int>> details;  // by name of the detail; left out: as the method says
  std::vector<BufferBits> bits{{32, 32}, {32, 16}, {16, 32}, {16, 16}};
  std::vector<int> segments{1, 2, 4};         // of a slab along the ray
  std::optional<std::vector<double>> scales;  // window texels per voxel edge, of methods that have windows; empty: none
  std::vector<int> sizes{128,
                         256};  // height of picture, eye and occlusion buffer, pixels; the width follows the scene's
  std::vector<double> thetas;   // rad; empty: the scene's and 80 degrees
  int repeats = 7;              // timed pairs of baseline and case, at least
  int directions = 256;         // of the references
  double tolerance = 1e-3;      // of the references
  bool quick = false;           // where a method says what is swept, it says less
  bool operator==(const StudySettings&) const = default;
};

/// These scales are swept unless the user gives others.
inline const std::vector<double> kUsualScales{0.25, 0.5, 1, 2};

/// Returns the settings of a small study, of minutes.
StudySettings quickStudySettings();

/// Returns the settings of a comparison of all techniques, each in a few numbers of slices at one size and theta: where
/// it is quick, at a smaller size against coarser references.
/// @param surfaces  whether the scene has surfaces, without which there are no pictures of them
StudySettings techniqueSettings(bool quick, bool surfaces);

/// One picture that is timed and compared.
struct StudyCase {
  std::string method;
  int slices = 0, segments = 1;  // segments can be kAutomaticSegments
  int detail = 0;                // footprint n, directions K, ...; 0 when the method has none
  BufferBits bits;               // occlusion equals eye where there is no occlusion buffer
  int size = 0;
  double theta = 0;  // rad; 0 for emission
  double scale = 0;  // window texels per voxel edge; 0: automatic, or no windows
  /// Returns "dos-n3-N256-k1-e32o32-s256-t60", "ordinates-K16-N64-ka-e32o32-s256-t60-w0.5"; also the name of its files.
  std::string id() const;
  bool operator==(const StudyCase&) const = default;
};

/// A picture that the reference integrates.
struct StudyReference {
  Model model = Model::emission;
  int size = 0;
  double theta = 0;  // rad; 0 for emission and ambient
  StudyLook look = StudyLook::medium;
  /// Returns "cone-s256-t60", of other looks "mip-s256"; also the name of its file.
  std::string id() const;
  bool operator==(const StudyReference&) const = default;
};

struct StudyPlan {
  StudySettings settings;  // complete: every default written out, lists sorted
  std::vector<StudyCase> cases;
  std::vector<StudyReference> references;          // cases need them, or the model error at the base size
  std::map<std::string, std::vector<int>> slices;  // by method
  std::map<std::string, StudyCase> bases;          // by method
  int baseSize = 0;                                // the same for every method, and the next two
  BufferBits baseBits;
  double baseTheta = 0;

  StudyReference referenceOf(const StudyCase& one) const;
};

/// Plans the cases of a study: not all combinations, which would be thousands, but around a base point
///   slices x detail, slices x theta     at the base of everything else
///   bits, segments, sizes, scales       each alone, at the base of everything else
/// for every method. The base is the middle of the slices and of the detail (the upper one of two), the most bits, the
/// fewest segments or automatic ones, the largest size, automatic windows, and the scene's theta if it is swept, else
/// the smallest.
/// @param aperture     theta of the scene, rad
/// @param leastSlices  fewer slices cannot be drawn: the methods' own lists begin there
/// @throw InvalidArgument  a method is unknown, a list empty, a value out of range or given twice
StudyPlan planStudy(const StudySettings& settings, double aperture, int leastSlices = 1);

}  // namespace umbrick
