// Judges what another renderer has answered to a kit: which invariant fails, by how much, where, and why.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace umbrick {

struct KitTolerance {
  /// Of a picture: how far each channel of a pixel (linear, premultiplied) may be off beyond its error bar. The root of
  /// the mean square over the picture may be a quarter of it, so that what is off everywhere fails sooner.
  double picture = 0.02;
  /// Of a sample: share of the range of the volume's values. 1e-5 is what single precision makes of coordinates near
  /// 0; texture units with weights of 8 bits need 4e-3.
  double rounding = 1e-5;
};

enum class KitOutcome {
  passed,
  failed,
  notAnswered,  // there is no file
};

/// What is asked of an answer:
///   "the answer can be read"               its file is whole, of the right size, with every sample
///   "all numbers are finite"
///   "samples inside bricks are exact"      interpolation, without the apron
///   "samples at brick borders are exact"   interpolation across the border of a brick; called "no seam at brick
///                                          borders" where they are further off than those inside
///   "samples outside are background"
///   "the picture agrees with the reference"   called "no seam at brick borders" where pixels that see the border of
///                                             two bricks are further off than others, and no mistake explains why
///   "bricked equals unbricked"             of both answers, where both are given
struct KitVerdict {
  std::string kitCase;
  std::string asked;      // "samples", or the name of a picture
  std::string invariant;  // see above; empty: not answered
  KitOutcome outcome = KitOutcome::notAnswered;
  double worst = 0, limit = 0;          // largest error, and what it may be; of a picture beyond the error bar
  double rmse = 0, rmseLimit = 0;       // rmseLimit 0: has no limit
  std::size_t compared = 0, wrong = 0;  // samples or pixels; of "all numbers are finite" the numbers of pixels
  std::string where;  // the largest error, with what was found and expected; of a file: what is wrong with it
  std::string hint;   // what would explain the error; empty: nothing that is known
};

struct KitJudgement {
  std::vector<KitVerdict> verdicts;  // in the order of the kit
  std::vector<std::string> unknown;  // files among the answers that nothing asks for
  bool complete = true;              // false: the judgement was stopped
  /// Whether something was answered, and no answer failed.
  bool passed() const;
};

/// Judges the answers in folder/answers. For each case there may be
///   answers/CASE/samples.csv     columns id and value
///   answers/CASE/VIEW.exr        or .png, .npy (height x width x 4, first row on top), .raw (the same as 32-bit
///   floats) answers/CASE/samples.unbricked.csv, VIEW.unbricked.exr   the same, made without bricks
/// A PNG is 8-bit sRGB with straight alpha and may be off by half a level more; the others are linear and
/// premultiplied.
///
/// Where a picture or samples are wrong, the errors that renderers often have are tried one by one (a picture that is
/// flipped, moved by half a pixel, not corrected for the step; voxels read in another order, half a voxel off, aprons
/// that repeat the brick's own voxels, ...), and one that explains nearly all of the difference is named as a hint.
/// @throw IoError, InvalidArgument  the kit itself is not whole; two files answer one question
KitJudgement judgeKit(const std::filesystem::path& folder, const KitTolerance& tolerance = {},
                      const std::function<bool(const std::string& step, double done)>& progress = {});

}  // namespace umbrick
