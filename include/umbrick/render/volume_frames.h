// The volumes of a sequence, one after the other: the next one is read while one is drawn.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "umbrick/render/volume.h"

namespace umbrick {

/// A volume of a sequence, and the bricks that it was cut into.
struct VolumeFrame {
  std::shared_ptr<const Volume> volume;  // null: the frame holds nothing
  std::unique_ptr<const Bricks> bricks;  // null with it; ends before the volume
  double brickMs = 0;                    // to cut it
};

/// Reads and cuts volumes in a thread of its own. While the caller draws one, the next one is read, and no other: with
/// the one that is drawn two are in memory, if the caller lets go of a frame before it asks for another.
class VolumeFrames {
 public:
  /// Makes the bricks of a volume, in the thread that reads. What it throws ends the frame.
  /// @param index  of the volume in the list of files
  using Cut = std::function<std::unique_ptr<Bricks>(const Volume&, std::size_t index)>;

  /// Picks the volume that comes next: one that no other has, of the list of files.
  /// @param ahead  it is read while the one before is drawn; false: nothing else is left to do
  /// @return the volume's place in the list; nothing: there is none, at least not ahead
  using Pick = std::function<std::optional<std::size_t>(bool ahead)>;

  /// Begins to read the first one.
  /// @param pick  where several processes share the frames; null: all volumes in their order
  VolumeFrames(std::vector<VolumeReference> files, Cut cut, Pick pick = {});
  /// Ends what is being read.
  ~VolumeFrames();
  VolumeFrames(const VolumeFrames&) = delete;
  VolumeFrames& operator=(const VolumeFrames&) = delete;

  /// Returns the place of the volume that next() brings; nothing: there is none any more.
  std::optional<std::size_t> upcoming();
  /// Tells whether all volumes have been given. @pre no Pick
  bool done() const { return given_ == files_.size(); }
  /// Waits for the next frame and begins to read the one behind it.
  /// @param waiting  is called a few times a second meanwhile; what it throws ends the wait, and next() may be called
  ///                 again
  /// @throw Error    what the frame met; next() then goes on with the one behind it
  /// @pre upcoming()
  VolumeFrame next(const std::function<void()>& waiting = {});

 private:
  void begin(bool ahead);

  std::vector<VolumeReference> files_;
  Cut cut_;
  Pick pick_;
  std::shared_ptr<KeptStream> kept_;  // a packed file of several frames is unpacked once
  std::size_t given_ = 0;
  std::optional<std::size_t> upcoming_;  // is being read
  std::atomic<bool> ends_ = false;
  std::future<VolumeFrame> reading_;
};

}  // namespace umbrick
