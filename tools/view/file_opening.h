// Opens another volume or scene for pages, in a thread of its own, while they look at the one before.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "umbrick/render/volume.h"
#include "umbrick/scene/scene.h"
#include "view/latest_job.h"
#include "view/open_folder.h"
#include "view/uploaded_file.h"
#include "view/view_sequence.h"

namespace umbrick::view {

/// A volume with a scene that shows it.
struct OpenedVolume {
  Scene scene;  // with a transfer function
  std::shared_ptr<const Volume> volume;
  std::string chosen;                                 // a line on what was chosen for it, or nothing
  std::shared_ptr<const ViewSequence> sequence = {};  // of which it is a frame; null: it is alone
};

/// Opens a volume or a scene. It reads no file outside of the folder of that one.
/// @param progress  is told the share that is done; the job ends with what it throws
using OpenVolume =
    std::function<OpenedVolume(const std::filesystem::path& file, const std::function<void(double)>& progress)>;

class FileOpening {
 public:
  /// What becomes of files; is called by the thread that opens, with the number of the job.
  struct Sink {
    /// {"state": "running", "name", "share"}, or {"state": "none", "name", "text"} where it cannot be opened
    std::function<void(std::uint64_t, const nlohmann::ordered_json&)> news;
    std::function<void(std::uint64_t, OpenedVolume, const std::string& name)> opened;
  };
  FileOpening(const std::filesystem::path& folder, OpenVolume open, Sink sink);

  const std::filesystem::path& folder() const { return folder_.path(); }
  /// Returns {"path", "entries": [{"name", "kind", "bytes"}], "dicomFiles", "left", "links"}; see OpenFolder::list().
  nlohmann::ordered_json list(const std::string& path) const;
  /// Opens a file of the folder; what was being opened is given up. @throw InvalidArgument, IoError  see OpenFolder
  void open(const std::string& path);
  /// Opens a file that a page has sent, which goes away afterwards.
  void open(std::shared_ptr<UploadedFile> file);
  void drop() { job_.drop(); }
  bool isCurrent(std::uint64_t number) const { return job_.isCurrent(number); }

 private:
  void start(const std::string& name, std::function<OpenedVolume(const std::function<void(double)>&)> open);

  OpenFolder folder_;
  OpenVolume open_;
  Sink sink_;
  LatestJob job_;  // last: it uses all of the above
};

}  // namespace umbrick::view
