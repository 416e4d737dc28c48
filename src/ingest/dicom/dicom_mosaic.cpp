// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_mosaic.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <string_view>

#include "ingest/dicom/dicom_frames.h"
#include "ingest/header_text.h"

namespace umbrick {
namespace {

// The element `offset` of the private block that `creator` has reserved in a group (PS3.5 7.8), or null.
const DicomElement* privateElement(const DicomElements& elements, std::uint32_t group, std::string_view creator,
                                   std::uint32_t offset) {
  for (std::uint32_t block = 0x10; block <= 0xff; ++block) {
    const DicomElement* reserved = findElement(elements, group << 16 | block);
    if (reserved && trimmed(elementText(*reserved)) == creator)
      return findElement(elements, group << 16 | block << 8 | offset);
  }
  return nullptr;
}

std::uint32_t little(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 4; i-- > 0;) out = out << 8 | static_cast<unsigned char>(bytes[at + i]);
  return out;
}

// The numbers of a field in Siemens' own header, which is a list of named fields, each with a list of texts:
//   "SV10", 4 bytes, number of fields, 77; then per field: name (64 bytes), vm, vr, type, number of items, 77 or 205;
//   then per item: its length in the second of four numbers, and the text, filled up to a multiple of 4.
std::vector<double> siemensNumbers(std::string_view header, std::string_view wanted) {
  std::vector<double> out;
  if (!header.starts_with("SV10") || header.size() < 16) return out;
  std::size_t at = 16;
  for (std::uint32_t field = little(header, 8); field > 0 && at + 84 <= header.size(); --field) {
    const std::string_view name = header.substr(at, std::min<std::size_t>(64, header.substr(at, 64).find('\0')));
    std::uint32_t items = little(header, at + 76);
    at += 84;
    for (; items > 0 && at + 16 <= header.size(); --items) {
      const std::size_t length = little(header, at + 4);
      at += 16;
      if (length > header.size() - at) return out;
      const std::string_view text = header.substr(at, std::min(length, header.substr(at, length).find('\0')));
      if (const auto parsed = number(trimmed(text)); parsed && name == wanted) out.push_back(*parsed);
      at += std::min((length + 3) / 4 * 4, header.size() - at);
    }
    if (name == wanted) return out;
  }
  return out;
}

bool saysMosaic(const DicomTags& tags) {
  const std::string kind = "\\" + tags.text(0x00080008) + "\\";
  return kind.find("\\MOSAIC\\") != std::string::npos;
}

// A mosaic of one slice is a picture like any other.
std::int64_t slicesOf(const DicomElements& elements, std::string_view siemens) {
  if (const DicomElement* count = privateElement(elements, 0x0019, "SIEMENS MR HEADER", 0x0a)) {
    // Where the kind was lost on the way, the number is what its two bytes say.
    const std::string& raw = count->value;
    if (count->kind == std::array<char, 2>{'U', 'N'} && raw.size() == 2)
      return static_cast<unsigned char>(raw[0]) | static_cast<unsigned char>(raw[1]) << 8;
    return integer(elementText(*count)).value_or(0);
  }
  const std::vector<double> count = siemensNumbers(siemens, "NumberOfImagesInMosaic");
  return count.empty() || !(count[0] >= 0) || count[0] > 1e6 ? 0 : static_cast<std::int64_t>(count[0]);
}

}  // namespace

void unfoldMosaic(const DicomElements& elements, const DicomTags& tags, DicomFile& file) {
  if (!saysMosaic(tags) || file.frames.size() != 1) return;
  const DicomElement* own = privateElement(elements, 0x0029, "SIEMENS CSA HEADER", 0x10);
  const std::string_view siemens = own ? std::string_view(own->value) : std::string_view();
  const std::int64_t count = slicesOf(elements, siemens);
  if (count < 1)
    failField(file.path, "ImageType",
              "one slice, or a mosaic that says of how many slices in (0019,100a) or its header",
              "a mosaic that does not");
  const auto side = static_cast<std::int64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  if (file.columns % side != 0 || file.rows % side != 0)
    failField(file.path, "ImageType",
              "a mosaic of " + std::to_string(side) + " x " + std::to_string(side) + " tiles for " +
                  std::to_string(count) + " slices",
              std::to_string(file.columns) + " x " + std::to_string(file.rows) + " pixels");
  file.columns /= side;
  file.rows /= side;
  DicomFrame first = file.frames.front();
  if (first.position && first.alongRow && first.spacing)
    *first.position +=
        0.5 * (*first.alongRow * (first.spacing->x * static_cast<double>(file.pixels.columns - file.columns)) +
               *first.alongColumn * (first.spacing->y * static_cast<double>(file.pixels.rows - file.rows)));
  // Siemens says which way slices follow each other, which may be against the normal of rows and columns.
  const std::vector<double> up = siemensNumbers(siemens, "SliceNormalVector");
  const glm::dvec3 normal = first.alongRow ? sliceNormal(first) : glm::dvec3(0, 0, 1);
  const bool against = up.size() == 3 && glm::dot(glm::dvec3(up[0], up[1], up[2]), normal) < 0;
  const double step = (against ? -1 : 1) * (file.sliceDistance > 0 ? file.sliceDistance : 1);
  file.framesApartUnknown = count > 1 && !(file.sliceDistance > 0);
  file.frames.assign(static_cast<std::size_t>(count), first);
  for (std::int64_t i = 0; i < count; ++i) {
    DicomFrame& frame = file.frames[static_cast<std::size_t>(i)];
    frame.corner = {i % side * file.columns, i / side * file.rows};
    if (frame.position) *frame.position += static_cast<double>(i) * step * normal;
    frame.lastDigit = 0;
  }
  if (count > 1)
    file.notes.push_back(
        {"a Siemens mosaic, unfolded",
         std::to_string(count) + " slices of " + std::to_string(file.columns) + " x " + std::to_string(file.rows)});
}

}  // namespace umbrick
