// SPDX-License-Identifier: Apache-2.0
#include "view/file_opening.h"

#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"
#include "umbrick/core/stopwatch.h"

namespace umbrick::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTellMs = 200;  // between two words on how far it is

// Ends a job that nobody waits for any more.
struct Dropped : Error {
  using Error::Error;
};

const char* nameOf(EntryKind kind) {
  switch (kind) {
    case EntryKind::folder:
      return "folder";
    case EntryKind::scene:
      return "scene";
    case EntryKind::volume:
      break;
  }
  return "volume";
}

}  // namespace

FileOpening::FileOpening(const std::filesystem::path& folder, OpenVolume open, Sink sink)
    : folder_(folder), open_(std::move(open)), sink_(std::move(sink)) {}

Json FileOpening::list(const std::string& path) const {
  const FolderListing listing = folder_.list(path);
  Json entries = Json::array();
  for (const FolderEntry& entry : listing.entries)
    entries.push_back({{"name", entry.name}, {"kind", nameOf(entry.kind)}, {"bytes", entry.bytes}});
  return {{"path", listing.path},
          {"entries", entries},
          {"dicomFiles", listing.dicomFiles},
          {"left", listing.left},
          {"links", listing.links}};
}

void FileOpening::open(const std::string& path) {
  const FoundFile found = folder_.find(path);
  const std::string name = found.path.filename().string();
  if (!found.folder && !kindOfName(name))
    throw InvalidArgument("open: " + printable(name) + " has no ending of a volume or scene that a page can open");
  start(name, [this, path, found](const std::function<void(double)>& progress) {
    OpenedVolume opened = open_(found.path, progress);
    // A link may have taken its place between the look and the opening.
    folder_.requireSame(path, found);
    return opened;
  });
}

void FileOpening::open(std::shared_ptr<UploadedFile> file) {
  start(file->name(), [this, file](const std::function<void(double)>& progress) {
    OpenedVolume opened = open_(file->path(), progress);
    if (opened.sequence) {
      // Its other frames are read from the file later.
      auto sequence = std::make_shared<ViewSequence>(*opened.sequence);
      sequence->whole.file = file->name();
      sequence->keeps = file;
      opened.sequence = std::move(sequence);
    }
    // The file goes away. A scene that is saved names it without its folder: it is to lie beside the scene.
    opened.scene.volume.file = file->name();
    return opened;
  });
}

void FileOpening::start(const std::string& name, std::function<OpenedVolume(const std::function<void(double)>&)> open) {
  job_.start([this, name, open = std::move(open)](std::uint64_t number) {
    const Stopwatch watch;
    double told = 0;
    const auto progress = [&](double share) {
      if (!isCurrent(number)) throw Dropped("dropped");
      if (watch.elapsedMs() - told < kTellMs) return;
      told = watch.elapsedMs();
      sink_.news(number, {{"state", "running"}, {"name", asUtf8(name)}, {"share", share}});
    };
    try {
      sink_.news(number, {{"state", "running"}, {"name", asUtf8(name)}, {"share", 0}});
      sink_.opened(number, open(progress), name);
    } catch (const std::exception& error) {
      sink_.news(number, {{"state", "none"}, {"name", asUtf8(name)}, {"text", asUtf8(error.what())}});
    }
  });
}

}  // namespace umbrick::view
