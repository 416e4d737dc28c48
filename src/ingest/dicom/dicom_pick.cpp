// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_pick.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "ingest/dicom/dicom_dictionary.h"
#include "ingest/header_text.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::size_t kMostListed = 8;  // values of one tag in a message
constexpr std::size_t kMostTags = 4;

// Tags that people know their phases and echoes by come first: acquisition, time point, echo, trigger, diffusion,
// contrast, reconstruction, kind of image.
constexpr std::uint32_t kUsual[] = {0x00200012, 0x00200100, 0x00209128, 0x00540070, 0x00540030, 0x00180086, 0x00180081,
                                    0x00189082, 0x00181060, 0x00209153, 0x00189087, 0x00180082, 0x00181314, 0x00180010,
                                    0x00181210, 0x00080008, 0x00080032, 0x00080022, 0x00080033, 0x00080005};

struct Condition {
  std::uint32_t tag = 0;
  std::string name, value;
};

Condition parse(const std::string& name, const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto tag = equals == std::string::npos ? std::nullopt : dicomTag(text.substr(0, equals));
  if (!tag)
    throw InvalidArgument(name + ": where: expected Tag=value, the tag a keyword of DICOM or gggg,eeee, found \"" +
                          text + "\"");
  return {*tag, dicomKeyword(*tag), std::string(trimmed(std::string_view(text).substr(equals + 1)))};
}

bool holds(const std::string& found, const std::string& wanted) {
  if (found == wanted) return true;
  std::string_view rest = found;
  for (bool more = true; more;) {
    const std::size_t end = std::min(rest.find('\\'), rest.size());
    const std::string_view part = trimmed(rest.substr(0, end));
    if (part == wanted) return true;
    const auto a = number(part), b = number(wanted);
    if (a && b && *a == *b) return true;
    more = end < rest.size();
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

template <class Texts>
std::string listed(const Texts& texts) {
  std::string out;
  std::size_t count = 0;
  for (const auto& text : texts) {
    if (count++ == kMostListed) return out + " and " + std::to_string(texts.size() - kMostListed) + " more";
    out += (out.empty() ? "" : ", ") + text;
  }
  return out;
}

// Numbers by size, texts by letters.
struct InOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    const auto x = number(a), y = number(b);
    if (x && y && *x != *y) return *x < *y;
    return a < b;
  }
};
using Values = std::set<std::string, InOrder>;

void keep(const std::string& name, std::vector<DicomFile>& files, const Condition& condition) {
  std::map<std::string, std::size_t, InOrder> all;
  for (const DicomFile& file : files)
    for (const DicomFrame& frame : file.frames)
      if (const std::string* value = valueOf(file, frame, condition.tag)) ++all[*value];
  for (DicomFile& file : files)
    std::erase_if(file.frames, [&](const DicomFrame& frame) {
      const std::string* value = valueOf(file, frame, condition.tag);
      return !value || !holds(*value, condition.value);
    });
  std::erase_if(files, [](const DicomFile& file) { return file.frames.empty(); });
  if (!files.empty()) return;
  std::vector<std::string> there;
  for (const auto& [value, count] : all)
    there.push_back(value + " (" + std::to_string(count) + (count == 1 ? " slice)" : " slices)"));
  throw InvalidArgument(name + ": where: no slice has " + condition.name + " " + condition.value + ": there " +
                        (there.empty() ? "is none that states it" : "are " + listed(there)));
}

// The values of a tag, if each has at most one slice at a position, and every slice has one.
Values telling(const std::vector<DicomSlice>& slices, const std::vector<std::size_t>& places, std::uint32_t tag) {
  std::set<std::pair<std::size_t, std::string>> seen;
  Values values;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const std::string* value = valueOf(*slices[i].file, *slices[i].frame, tag);
    if (!value || !seen.emplace(places[i], *value).second) return {};
    values.insert(*value);
  }
  return values;
}

}  // namespace

void keepWhere(const std::string& name, std::vector<DicomFile>& files, const std::vector<std::string>& where) {
  std::vector<Condition> conditions;
  for (const std::string& text : where) conditions.push_back(parse(name, text));
  if (conditions.empty()) return;
  // A damaged file has no frames to pick.
  std::erase_if(files, [](const DicomFile& file) { return file.frames.empty(); });
  for (const Condition& condition : conditions) keep(name, files, condition);
}

std::string whatDiffers(const std::vector<DicomSlice>& slices, const std::vector<std::size_t>& places) {
  std::vector<std::uint32_t> tags(std::begin(kUsual), std::end(kUsual));
  for (std::size_t i = 0; i < std::min<std::size_t>(slices.size(), 64); ++i)
    for (const DicomValues* values : {&slices[i].frame->values, &slices[i].file->values})
      for (const auto& [tag, value] : *values)
        if (std::find(tags.begin(), tags.end(), tag) == tags.end()) tags.push_back(tag);
  const std::size_t positions = places.empty() ? 0 : *std::max_element(places.begin(), places.end()) + 1;
  std::string out;
  std::size_t count = 0;
  for (const std::uint32_t tag : tags) {
    if (count == kMostTags) break;
    const Values values = telling(slices, places, tag);
    // What numbers the slices tells none apart.
    if (values.size() < 2 || (positions > 1 && values.size() * 2 > slices.size())) continue;
    out += (out.empty() ? "" : ", ") + dicomKeyword(tag) + " (" + listed(values) + ")";
    ++count;
  }
  return out;
}

}  // namespace umbrick
