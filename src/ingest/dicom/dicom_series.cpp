// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_series.h"

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
    if (each->is_regular_file(ignored)) paths.push_back(each->path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string listing(const std::vector<DicomSeriesFiles>& all) {
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i)
    out += (i ? "; " : "") + std::to_string(i + 1) + ": " + all[i].series.modality + " \"" + all[i].series.description +
           "\", " + std::to_string(all[i].files.size()) + " files, " + all[i].series.uid;
  return out;
}

}  // namespace

std::optional<std::vector<DicomSeriesFiles>> readDicomSeries(const fs::path& path) {
  bool found = false;
  std::map<std::string, DicomSeriesFiles> byUid;
  const auto add = [&](DicomFile file) {
    found = true;
    if (file.rows == 0) return;  // no image: a directory, a report
    DicomSeriesFiles& each = byUid[file.seriesUid];
    if (each.files.empty())
      each.series = {file.seriesUid, file.seriesDescription, file.modality, file.seriesNumber, {}};
    each.series.files.push_back(file.path);
    each.files.push_back(std::move(file));
  };
  if (fs::is_directory(path)) {
    for (const fs::path& each : filesIn(path))
      if (auto file = readDicomTagsIfAny(each)) add(std::move(*file));
  } else {
    add(readDicomTags(path));
  }
  if (!found) return std::nullopt;
  std::vector<DicomSeriesFiles> out;
  for (auto& [uid, series] : byUid) out.push_back(std::move(series));
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.series.number < b.series.number; });
  return out;
}

std::vector<DicomSeries> listDicomSeries(const fs::path& path) {
  std::vector<DicomSeries> out;
  for (DicomSeriesFiles& each : readDicomSeries(path).value_or(std::vector<DicomSeriesFiles>()))
    out.push_back(std::move(each.series));
  return out;
}

DicomSeriesFiles pickSeries(const fs::path& path, std::vector<DicomSeriesFiles> all, const std::string& series) {
  if (all.empty()) throw IoError(path.string() + ": expected DICOM images, found none");
  if (series.empty()) {
    if (all.size() == 1) return std::move(all.front());
    throw SeveralSeries(path.string() + ": " + std::to_string(all.size()) +
                        " series, pick one by number or UID: " + listing(all));
  }
  const auto number = integer(series);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].series.uid == series || (number && *number == static_cast<std::int64_t>(i) + 1))
      return std::move(all[i]);
  throw InvalidArgument(path.string() + ": no series \"" + series + "\": there are " + listing(all));
}

}  // namespace umbrick
