// A volume in memory: loaded once, then looked at by any number of scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "umbrick/brick/bricks.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/scalar_grid.h"
#include "umbrick/render/orientation.h"
#include "umbrick/scene/resolve.h"

namespace umbrick {

struct KeptStream;   // see ingest/volume_parts.h
struct OpenOptions;  // see ingest/open_volume.h
struct VolumeFile;   // of the room alone

/// A volume holds nothing that could be shown, which a frame of a sequence may.
struct EmptyVolume : InvalidArgument {
  using InvalidArgument::InvalidArgument;
};

/// Returns the names by which grids that emit light are found where VolumeReference::emissionGrid is kAutomaticGrid, in
/// the order in which they are tried, in lower case: those of OpenVDB, Houdini ("temperature", "heat", "flame",
/// "burn"), Blender ("temperature", "heat", "flame") and EmberGen ("temperature", "flames").
std::span<const std::string_view> emissionGridNames();

/// A grid that holds something, with its place in the world.
class Volume {
 public:
  /// Reads a grid of a .vdb or .nvdb file, or any volume that can be converted (the same formats, by the same rules,
  /// see loadVolume), or the first frame of a numbered sequence. Of a file with several grids and no name given it
  /// takes "density", or else the first scalar one that holds something. A grid that emits light is read beside it
  /// where the reference names one, or finds one (emissionGridNames()).
  /// @throw IoError          as readScalarGrid and openVolume
  /// @throw InvalidArgument  as readScalarGrid and loadVolume
  /// @throw EmptyVolume      the grid has no active voxel, or all voxels of the volume are 0
  /// @param progress  as for readScalarGrid
  /// @param kept      of frames of one file that are loaded one after the other, see keepStream(); may be null
  explicit Volume(const VolumeReference& file, const std::function<void(double share)>& progress = {},
                  const std::shared_ptr<KeptStream>& kept = {});
  /// Takes voxels in memory, by the rules for a file of them.
  /// @param name  what messages call them
  /// @param open  OpenOptions::array and where it lies in the world
  /// @throw InvalidArgument, EmptyVolume  as above
  Volume(const std::string& name, const OpenOptions& open, const std::function<void(double share)>& progress = {});
  /// Takes a grid.
  /// @param name     what messages call it
  /// @param foreign  it comes from a file of grids, and maybe from another program, which its metadata tell
  /// @throw InvalidArgument  the transform is not affine
  /// @throw EmptyVolume      the grid has no active voxel
  Volume(ScalarGrid grid, std::string name, bool foreign = false);

  const std::string& name() const { return name_; }
  const ScalarGrid& grid() const { return grid_; }
  const glm::dmat4& indexToWorld() const { return indexToWorld_; }
  /// Returns the box around the active voxels' centres, also of those that emit.
  const Box& worldBounds() const { return worldBounds_; }
  double loadMs() const { return loadMs_; }  // 0 where it was not read from a file
  const Orientation& orientation() const { return orientation_; }
  /// What the values are: the unit that the file states ("HU"), empty where it states none.
  const std::string& valueUnit() const { return valueUnit_; }
  /// Whether the grid comes from a file of grids that another program wrote, so that nothing is known of its source.
  bool foreign() const { return foreign_; }
  /// Returns what was chosen or guessed while the file was opened, a short sentence each.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns the same reference with what was chosen: the name of the grid, the file of the first frame.
  const VolumeReference& source() const { return source_; }

  /// Returns the box of what a transfer function shows: voxels that weaken light by more than a hundredth along the
  /// diagonal of the volume. Where it shows nothing, the box of all active voxels. Faces of voxels count, not centres.
  /// Of a second grid that emits light, voxels with more than a fifth of its largest value are shown.
  Box visibleBounds(const TransferFunction& transfer) const;

  /// Returns the largest gradient magnitude of active voxels, grid units per world unit. It is looked for once.
  double largestGradient() const;

  /// Returns the scene with everything that depends on the volume written out: a transfer function (suggestTransfer()
  /// where there is none; one that is made for another unit of CT values is shifted), a camera that sees what the
  /// transfer function shows, the edge of its bricks, gradients that were in percent.
  /// @throw InvalidArgument  as resolveScene and brickInterior
  ResolvedScene resolve(const Scene& scene) const;
  /// The same, with an orbit around a box, so that the camera stays where the transfer function changes.
  /// @param seen  world units, see visibleBounds()
  ResolvedScene resolve(const Scene& scene, const Box& seen) const;

  /// Cuts the bricks that a scene needs, see requiredBricks(). @throw InvalidArgument, IoError  as brickGrid
  std::unique_ptr<Bricks> cut(const ResolvedScene& scene) const;
  /// Cuts the bricks that techniques on the CPU need: with an apron of one voxel. @throw InvalidArgument, IoError
  std::unique_ptr<Bricks> cutForCpu(const ResolvedScene& scene) const;
  /// Cuts the bricks for a picture that is refined: with the apron of coarserScene() where bricks are large
  /// enough for it.
  std::unique_ptr<Bricks> cutForRefinement(const ResolvedScene& scene) const;

 private:
  struct LazyGradient;
  Volume(VolumeFile&& read, std::string name);

  ScalarGrid grid_;
  std::string name_;
  glm::dmat4 indexToWorld_{1};
  Box worldBounds_;
  double loadMs_ = 0;
  Orientation orientation_;
  std::string valueUnit_;
  bool foreign_ = false;
  std::vector<std::string> notes_;
  VolumeReference source_;
  std::shared_ptr<LazyGradient> largestGradient_;  // shared by copies, which have the same voxels
};

/// Unit names of CT values, in a transfer function and in the metadata "value_unit".
inline constexpr std::string_view kHounsfield = "HU";
inline constexpr std::string_view kShiftedHounsfield = "HU + 1000";

/// Returns a transfer function for values of another unit, where both are units of CT; else the function as it is.
TransferFunction inUnit(const TransferFunction& transfer, std::string_view unit);

}  // namespace umbrick
