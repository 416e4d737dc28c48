// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_series.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "ingest/header_text.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

std::vector<fs::path> filesIn(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  auto each = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
  if (error) throw IoError(folder.string() + ": cannot read: " + error.message());
  for (; each != fs::recursive_directory_iterator(); each.increment(error)) {
    if (error) throw IoError(folder.string() + ": cannot read: " + error.message());
    std::error_code ignored;
    // .DS_Store and the ._IM0001 of macOS on other disks are no slices.
    const bool hidden = each->path().filename().string().starts_with('.');
    if (each->is_regular_file(ignored) && !hidden) paths.push_back(each->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<std::optional<DicomFile>> readAll(const std::vector<fs::path>& paths) {
  std::vector<std::optional<DicomFile>> files(paths.size());
  tbb::parallel_for(std::size_t(0), paths.size(), [&](std::size_t i) { files[i] = readDicomTagsIfAny(paths[i]); });
  return files;
}

// A folder of what is named DICOM and is none would else be one of an unknown format.
void checkNamed(const fs::path& folder, const std::vector<fs::path>& paths) {
  std::size_t count = 0;
  const fs::path* first = nullptr;
  for (const fs::path& path : paths) {
    const std::string extension = lower(path.extension().string());
    if (extension != ".dcm" && extension != ".ima") continue;
    ++count;
    if (!first) first = &path;
  }
  if (first)
    throw IoError(folder.string() + ": expected DICOM files, found " + std::to_string(count) +
                  " that are named so and have no DICOM header, such as " + first->filename().string());
}

// Puts files in order of series. Damaged files of series that have a whole file stay with them.
DicomFolder sorted(std::vector<DicomFile> files) {
  std::map<std::string, DicomSeriesFiles> byUid;
  for (const DicomFile& file : files)
    if (!file.damaged) byUid[file.seriesUid].series.uid = file.seriesUid;
  DicomFolder folder;
  for (DicomFile& file : files) {
    const auto found = byUid.find(file.seriesUid);
    if (found == byUid.end()) {
      folder.damaged.push_back(std::move(file));
      continue;
    }
    DicomSeriesFiles& each = found->second;
    if (each.files.empty())
      each.series = {file.seriesUid, file.seriesDescription, file.modality, file.seriesNumber, {}};
    each.series.files.push_back(file.path);
    each.files.push_back(std::move(file));
  }
  for (auto& [uid, series] : byUid) folder.series.push_back(std::move(series));
  std::stable_sort(folder.series.begin(), folder.series.end(),
                   [](const auto& a, const auto& b) { return a.series.number < b.series.number; });
  return folder;
}

}  // namespace

std::optional<DicomFolder> readDicomFolder(const fs::path& path) {
  std::vector<DicomFile> images;
  if (fs::is_directory(path)) {
    const std::vector<fs::path> paths = filesIn(path);
    bool found = false;
    for (std::optional<DicomFile>& file : readAll(paths)) {
      found = found || file;
      if (file && file->rows > 0) images.push_back(std::move(*file));  // others: a directory, a report
    }
    if (!found) checkNamed(path, paths);
    if (!found) return std::nullopt;
  } else {
    DicomFile file = readDicomTags(path);
    if (file.rows > 0) images.push_back(std::move(file));
  }
  return sorted(std::move(images));
}

std::vector<DicomSeries> listDicomSeries(const fs::path& path) {
  std::vector<DicomSeries> out;
  for (DicomSeriesFiles& each : readDicomFolder(path).value_or(DicomFolder()).series)
    out.push_back(std::move(each.series));
  return out;
}

}  // namespace umbrick
