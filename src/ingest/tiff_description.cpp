// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "ingest/header_text.h"
#include "ingest/length_unit.h"
#include "ingest/stack_place.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

// "\u00B5m" as ImageJ and Java write letters beyond ASCII.
std::string unescaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    unsigned code = 0;
    bool escaped = text.size() >= 6 && text.starts_with("\\u");
    for (std::size_t i = 2; escaped && i < 6; ++i) {
      const char c = lower(text.substr(i, 1))[0];
      escaped = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
      code = 16 * code + static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
    }
    if (escaped && code < 0x800) {
      if (code < 0x80)
        out += static_cast<char>(code);
      else
        (out += static_cast<char>(0xC0 | code >> 6)) += static_cast<char>(0x80 | (code & 0x3F));
      text.remove_prefix(6);
    } else {
      out += text.front();
      text.remove_prefix(1);
    }
  }
  return out;
}

// What ImageJ writes into the description: lines of "key=value".
std::map<std::string, std::string> imageJFields(std::string_view rest) {
  std::map<std::string, std::string> out;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    if (const std::size_t sign = line.find('='); sign != line.npos)
      out[std::string(line.substr(0, sign))] = unescaped(trimmed(line.substr(sign + 1)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return out;
}

std::string unitOfTags(const SliceImages& images) {
  return images.resolutionUnit == 2 ? "inch" : images.resolutionUnit == 3 ? "cm" : "";
}

// Resolutions that scanners, screens and printers have: these say nothing of what is in the picture.
bool isOfPrint(double dotsPerInch) {
  if (dotsPerInch > 2400) return false;
  for (const double unit : {1.0, 72.0, 96.0, 100.0, 150.0, 254.0})
    for (const double times : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 24.0})
      if (std::abs(dotsPerInch - unit * times) <= 0.002 * dotsPerInch) return true;
  return false;
}

std::string text(double number) {
  std::ostringstream out;
  out.precision(6);
  out << number;
  return out.str();
}

// tifffile notes the shape of the array and what its axes are: {"shape": [5, 2, 4, 6], "axes": "ZCYX"}.
void checkShape(const fs::path& path, const std::string& description) {
  const std::size_t key = description.find("\"shape\""), begin = description.find('[', key);
  const std::size_t end = description.find(']', begin);
  if (!description.starts_with('{') || key == description.npos || end == description.npos) return;
  std::string list = description.substr(begin + 1, end - begin - 1);
  for (char& c : list)
    if (c == ',') c = ' ';
  const std::vector<std::string> sizes = words(list);
  std::string axes;
  if (const std::size_t at = description.find("\"axes\""); at != description.npos)
    if (const auto parts = words(description.substr(description.find(':', at) + 1)); !parts.empty()) axes = parts[0];
  std::string found;
  for (const std::string& size : sizes) found += (found.empty() ? "" : " x ") + size;
  std::size_t stacks = 0;
  for (std::size_t i = 0; i + 2 < sizes.size(); ++i) {
    if (sizes[i] == "1") continue;
    ++stacks;
    if (axes.size() == sizes.size() && (axes[i] == 'C' || axes[i] == 'T' || axes[i] == 'S'))
      failField(path, "shape", "slices, which channels and times are not", found + " of axes " + axes);
  }
  if (stacks > 1) failField(path, "shape", "an array of three axes", found + (axes.empty() ? "" : " of axes " + axes));
}

}  // namespace

StackPlace placeByImageJ(const fs::path& path, const SliceImages& images) {
  auto fields = imageJFields(images.description);
  StackPlace place;
  place.writer = "ImageJ";
  for (const char* key : {"channels", "frames"})
    if (fields.contains(key) && fields[key] != "1")
      failField(path, std::string("ImageJ ") + key, "1, a file for each", fields[key]);
  if (fields.contains("images")) {
    const auto count = integer(fields["images"]);
    if (!count || *count < 1 || (*count != images.pages && images.pages != 1))
      failField(path, "ImageJ images", std::to_string(images.pages) + ", one for each page", fields["images"]);
    // Above 4 GB ImageJ writes one directory, and all slices behind each other.
    if (*count != images.pages) place.promisedPages = *count;
  }
  for (std::size_t axis = 0; axis < 2; ++axis)
    if (images.pixelsPerUnit[axis]) place.spacing[axis] = 1 / *images.pixelsPerUnit[axis];
  if (const auto spacing = number(fields["spacing"]); spacing && *spacing != 0)
    place.spacing[2] = std::abs(*spacing);
  else if (images.pages > 1 || place.promisedPages > 1)
    place.spacing[2] = 1;  // which ImageJ does not write
  const std::string unit = fields.contains("unit") ? fields["unit"] : unitOfTags(images);
  place.unit = {unit, fields.contains("yunit") ? fields["yunit"] : unit,
                fields.contains("zunit") ? fields["zunit"] : unit};
  for (std::string& each : place.unit)
    if (each == "pixel" || each == "pixels") each.clear();
  return place;
}

StackPlace placeByTags(const fs::path& path, const SliceImages& images) {
  checkShape(path, images.description);
  StackPlace place;
  if (!images.pixelsPerUnit[0] || !images.pixelsPerUnit[1]) return place;
  const double x = *images.pixelsPerUnit[0], y = *images.pixelsPerUnit[1];
  const std::string unit = unitOfTags(images);
  const double dotsPerInch = unit == "cm" ? 2.54 * x : x;
  if (!unit.empty() && !isOfPrint(dotsPerInch)) {
    place.spacing = {1 / x, 1 / y, std::nullopt};
    place.unit = {unit, unit, unit};
    place.writer = "resolution";
    place.notes.push_back("pixels are " + text(1 / x) + " x " + text(1 / y) + ' ' + unit + ", by the resolution tags");
  } else if (std::abs(x - y) > 1e-6 * x) {
    place.spacing = {1.0, x / y, 1.0};
    place.writer = "resolution";
    place.notes.push_back("pixels are not square by the resolution tags: " + text(x / y) + " times as high as wide");
  }
  return place;
}

StackPlace stackPlace(const fs::path& path, const SliceImages& images) {
  const std::string_view description = images.description;
  if (description.starts_with("ImageJ=")) return placeByImageJ(path, images);
  const std::size_t root = description.find("<OME");
  const std::size_t prefixed = description.find(":OME ");
  if (description.find_first_not_of(" \t\r\n\xEF\xBB\xBF") == description.find('<') &&
      (root != description.npos || prefixed != description.npos))
    return placeByOme(path, images);
  return placeByTags(path, images);
}

}  // namespace umbrick
