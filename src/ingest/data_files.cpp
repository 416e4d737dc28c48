// SPDX-License-Identifier: Apache-2.0
#include "ingest/data_files.h"

#include <algorithm>
#include <utility>

#include "core/input_file.h"
#include "ingest/header_text.h"
#include "ingest/parts.h"
#include "ingest/streams/dense_source.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// Does something with a data file. Whoever reads what went wrong knows the header, which names the file.
template <class Action>
auto ofHeader(const fs::path& header, const Action& action) {
  try {
    return action();
  } catch (const IoError& error) {
    const std::string what = error.what();
    if (what.starts_with(header.string() + ":")) throw;
    throw IoError(header.string() + ": " + what);
  }
}

// The voxels of a data file, which are neither more nor fewer than its share.
class ShareOfHeader : public ByteStream {
 public:
  ShareOfHeader(std::unique_ptr<ByteStream> stream, fs::path header, fs::path file, std::int64_t bytes)
      : stream_(std::move(stream)), header_(std::move(header)), file_(std::move(file)), bytes_(bytes) {}
  std::size_t read(std::span<std::byte> out) override {
    const std::size_t got = ofHeader(header_, [&] { return stream_->read(out); });
    count(static_cast<std::int64_t>(got), got < out.size());
    return got;
  }
  std::int64_t skip(std::int64_t most) override {
    const std::int64_t got = ofHeader(header_, [&] { return stream_->skip(most); });
    count(got, got < most);
    return got;
  }
  bool skipsFast() override { return stream_->skipsFast(); }

 private:
  void count(std::int64_t got, bool ended) {
    done_ += got;
    if (done_ > bytes_ || (ended && done_ < bytes_))
      throw IoError(header_.string() + ": " + file_.string() + ": expected " + std::to_string(bytes_) +
                    " bytes of voxels, found " + (done_ > bytes_ ? "more" : std::to_string(done_)));
  }

  std::unique_ptr<ByteStream> stream_;
  fs::path header_, file_;
  std::int64_t bytes_, done_ = 0;
};

}  // namespace

bool announcesList(std::string_view value) {
  const std::vector<std::string> parts = words(value);
  return !parts.empty() && lower(parts[0]) == "list";
}

std::vector<fs::path> dataFiles(const HeaderFields& fields, const DataFileField& field,
                                const std::vector<std::string>& list) {
  const std::string value = fields.value(field.key);
  const std::vector<std::string> parts = words(value);
  std::vector<std::string> names{value};
  if (announcesList(value)) {
    names = list;
  } else if (parts.size() >= (field.stepMayBeMissing ? 3 : 4) && parts[0].find('%') != std::string::npos) {
    names = numberedNames(parts[0], parts[1], parts[2], parts.size() > 3 ? parts[3] : "1");
    if (names.empty()) fields.fail(field.title, "a pattern with one %d or %03d, then first, last and step", value);
  }
  if (!names.empty() && names.front().empty()) names.clear();
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(fields.path().parent_path() / name);
  return files;
}

std::unique_ptr<ByteStream> openDataFiles(VolumeInfo& info, const std::string& fieldTitle, const fs::path& header,
                                          std::int64_t headerBytes, const std::vector<fs::path>& files,
                                          const OpenShare& open) {
  const std::int64_t total = *arrayBytes(info);
  const auto count = static_cast<std::int64_t>(std::max<std::size_t>(files.size(), 1));
  if (total / voxelBytes(info.type) % count != 0)
    throw IoError(info.name + ": " + fieldTitle + ": expected files of equal size, found " + std::to_string(count) +
                  " files for " + describeBytes(info));
  std::vector<std::function<std::unique_ptr<ByteStream>()>> shares;
  const auto add = [&](const fs::path& file, std::int64_t offset) {
    shares.push_back([open, header, file, offset, bytes = total / count]() -> std::unique_ptr<ByteStream> {
      return ofHeader(header, [&]() -> std::unique_ptr<ByteStream> {
        auto share = open(file, offset, bytes);
        if (file == header) return share;
        return std::make_unique<ShareOfHeader>(std::move(share), header, file, bytes);
      });
    });
    shares.back()();
  };
  if (files.empty()) add(header, headerBytes);
  for (const fs::path& file : files) {
    add(file, 0);
    info.fileBytes += dataFileSize(file);
  }
  return joinStreams(std::move(shares));
}

std::function<std::unique_ptr<ByteStream>()> openDataOften(VolumeInfo& info, const std::string& fieldTitle,
                                                           const fs::path& header, std::int64_t headerBytes,
                                                           const std::vector<fs::path>& files, bool strict,
                                                           const OpenNotedShare& open) {
  const auto longer = strict ? nullptr : std::make_shared<std::vector<std::string>>();
  const auto openAll = [=, ownBytes = info.fileBytes](VolumeInfo& of) {
    of.fileBytes = ownBytes;
    return openDataFiles(of, fieldTitle, header, headerBytes, files,
                         [open, longer](const fs::path& file, std::int64_t offset, std::int64_t share) {
                           return open(file, offset, share, longer.get());
                         });
  };
  auto first = openAll(info);
  if (longer) info.notes.insert(info.notes.end(), longer->begin(), longer->end());
  return openOnceMore(std::move(first), [openAll, of = info]() mutable { return openAll(of); });
}

void requireDataBeside(const std::vector<fs::path>& files, const fs::path& header) {
  requireBeside(header, header);
  for (const fs::path& file : files) requireBeside(file, header);
}

std::int64_t dataFileSize(const fs::path& path) {
  const std::int64_t size = checkedFileSize(path);
  if (size < 0) throw IoError(path.string() + ": expected a file, found a pipe or device");
  return ordinaryFileSize(path);
}

std::unique_ptr<ByteStream> openPlainShare(const fs::path& path, std::int64_t offset, std::int64_t skip,
                                           std::int64_t bytes, VoxelType type, std::vector<std::string>* longer) {
  const std::int64_t size = dataFileSize(path);
  offset = skip < 0 ? std::max(offset, size - bytes) : offset + std::min(skip, size);
  if (longer && size - offset > bytes) {
    const std::string note = path.filename().string() + " has " + std::to_string(size - offset - bytes) +
                             " bytes behind its voxels, which are left out";
    if (std::find(longer->begin(), longer->end(), note) == longer->end()) longer->push_back(note);
    return firstBytes(openPlain(path, offset), bytes);
  }
  if (size - offset != bytes)
    throw IoError(path.string() + ": expected " + std::to_string(bytes) + " bytes of " +
                  std::string(voxelTypeName(type)) + " voxels, found " +
                  std::to_string(std::max<std::int64_t>(size - offset, 0)));
  return openPlain(path, offset);
}

}  // namespace umbrick
