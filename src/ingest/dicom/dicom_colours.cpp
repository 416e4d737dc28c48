// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_colours.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "ingest/header_text.h"

namespace umbrick {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kDescriptors = 0x00281101, kTables = 0x00281201, kSegmented = 0x00281221;
constexpr const char* kPalette[]{"Red", "Green", "Blue"};

// The numbers of 16 bits of an element.
std::vector<std::uint16_t> wordsOf(const DicomElement& element) {
  std::vector<std::uint16_t> out(element.value.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(element.value[2 * i + at]); };
    out[i] = static_cast<std::uint16_t>(element.big ? byte(0) << 8 | byte(1) : byte(1) << 8 | byte(0));
  }
  return out;
}

// The entries of one colour. Tables of 8 bits may have two entries in a word, or one.
std::vector<std::uint16_t> entriesOf(const std::filesystem::path& path, const DicomElement& table, std::size_t count,
                                     int bits, const std::string& name) {
  std::vector<std::uint16_t> out;
  if (bits == 8 && table.value.size() < 2 * count) {
    for (const char each : table.value) out.push_back(static_cast<unsigned char>(each));
  } else {
    out = wordsOf(table);
    if (bits == 8)
      for (std::uint16_t& each : out) each &= 0xff;
  }
  if (out.size() < count)
    failField(path, name + "PaletteColorLookupTableData", std::to_string(count) + " entries",
              std::to_string(out.size()));
  out.resize(count);
  return out;
}

void readPalette(const DicomElements& elements, DicomFile& file) {
  DicomPixelData& pixels = file.pixels;
  auto palette = std::make_shared<DicomPalette>();
  for (std::uint32_t colour = 0; colour < 3; ++colour) {
    const std::string name = kPalette[colour];
    const DicomElement* descriptor = findElement(elements, kDescriptors + colour);
    const DicomElement* table = findElement(elements, kTables + colour);
    if (!table && findElement(elements, kSegmented + colour))
      failField(file.path, name + "PaletteColorLookupTableData", "the table as it is", "a segmented one");
    if (!descriptor || !table) failField(file.path, name + "PaletteColorLookupTableData", "a table", "none");
    const std::vector<std::uint16_t> said = wordsOf(*descriptor);
    if (said.size() != 3 || (said[2] != 8 && said[2] != 16))
      failField(file.path, name + "PaletteColorLookupTableDescriptor",
                "the number of entries, the first one, and 8 or 16 bits", elementText(*descriptor));
    const std::size_t count = said[0] == 0 ? 65536 : said[0];
    if (colour > 0 && (count != palette->count || said[1] != palette->first || said[2] != palette->bits))
      failField(file.path, name + "PaletteColorLookupTableDescriptor", "that of red", elementText(*descriptor));
    palette->count = count;
    palette->first = said[1];
    palette->bits = said[2];
    const std::vector<std::uint16_t> entries = entriesOf(file.path, *table, count, said[2], name);
    palette->entries.insert(palette->entries.end(), entries.begin(), entries.end());
  }
  pixels.palette = std::move(palette);
}

std::byte clamped(double value) { return static_cast<std::byte>(std::lround(std::clamp(value, 0.0, 255.0))); }

// PS3.3 C.7.6.3.1.2: the equations of CCIR 601, solved for red, green and blue.
void toRgb(Bytes& samples) {
  for (std::size_t i = 0; i + 2 < samples.size(); i += 3) {
    const double y = std::to_integer<int>(samples[i]), cb = std::to_integer<int>(samples[i + 1]) - 128,
                 cr = std::to_integer<int>(samples[i + 2]) - 128;
    samples[i] = clamped(y + 1.402 * cr);
    samples[i + 1] = clamped(y - 0.114 * 1.772 / 0.587 * cb - 0.299 * 1.402 / 0.587 * cr);
    samples[i + 2] = clamped(y + 1.772 * cb);
  }
}

template <class Index, class Out>
Bytes lookUp(const DicomPixelData& pixels, const Bytes& stored) {
  const DicomPalette& palette = *pixels.palette;
  Bytes out(stored.size() / sizeof(Index) * 3 * sizeof(Out));
  Bytes indices = stored;
  VoxelLayout layout = pixels.layout;
  normaliseVoxels(layout, indices);
  for (std::size_t i = 0; i < stored.size() / sizeof(Index); ++i) {
    Index index;
    std::memcpy(&index, indices.data() + i * sizeof(Index), sizeof(Index));
    // What lies outside of the table has its first or its last colour.
    const std::size_t at = index < palette.first ? 0 : std::min<std::size_t>(index - palette.first, palette.count - 1);
    for (std::size_t colour = 0; colour < 3; ++colour) {
      const Out value = static_cast<Out>(palette.entries[colour * palette.count + at]);
      std::memcpy(out.data() + (3 * i + colour) * sizeof(Out), &value, sizeof(Out));
    }
  }
  return out;
}

}  // namespace

void readDicomColours(const DicomElements& elements, const DicomTags& tags, DicomFile& file) {
  DicomPixelData& pixels = file.pixels;
  pixels.photometric = tags.text(0x00280004);
  pixels.samples = static_cast<int>(tags.unsignedShort(0x00280002, 1));
  const auto is = [&](const char* name, int samples) {
    return pixels.photometric == name && pixels.samples == samples;
  };
  using enum DicomColours;
  if (is("MONOCHROME1", 1) || is("MONOCHROME2", 1)) return;
  pixels.colours = is("RGB", 3) ? rgb : is("YBR_FULL", 3) ? ybrFull : palette;
  if (pixels.colours == palette && !is("PALETTE COLOR", 1))
    failField(
        file.path, "PhotometricInterpretation",
        "MONOCHROME1, MONOCHROME2 or PALETTE COLOR with one sample per pixel, or RGB or YBR_FULL with three",
        pixels.photometric + ", " + std::to_string(pixels.samples) + (pixels.samples == 1 ? " sample" : " samples"));
  pixels.planes = pixels.samples == 3 && tags.unsignedShort(0x00280006, 0) == 1;
  const auto allocated = tags.unsignedShort(0x00280100, 0), stored = tags.unsignedShort(0x00280101, allocated);
  const bool wide = allocated == 16 && pixels.colours != ybrFull;
  if ((allocated != 8 && !wide) || (pixels.samples == 3 && stored != allocated) ||
      tags.unsignedShort(0x00280103, 0) == 1)
    failField(file.path, "BitsAllocated", "unsigned colours of 8 bits, or of 16 in RGB and palettes",
              std::to_string(stored) + " of " + std::to_string(allocated) + " bits");
  if (pixels.colours == palette) readPalette(elements, file);
}

VoxelType valueType(const DicomPixelData& pixels) {
  if (pixels.colours != DicomColours::palette) return pixels.layout.type;
  return pixels.palette->bits == 8 ? VoxelType::u8 : VoxelType::u16;
}

Bytes withoutPlanes(const Bytes& stored, std::size_t sampleBytes) {
  Bytes out(stored.size());
  const std::size_t pixels = stored.size() / (3 * sampleBytes);
  for (std::size_t colour = 0; colour < 3; ++colour)
    for (std::size_t i = 0; i < pixels; ++i)
      std::memcpy(out.data() + (3 * i + colour) * sampleBytes, stored.data() + (colour * pixels + i) * sampleBytes,
                  sampleBytes);
  return out;
}

Bytes coloursOf(const DicomPixelData& pixels, const Bytes& stored) {
  const bool small = valueType(pixels) == VoxelType::u8;
  switch (pixels.colours) {
    case DicomColours::palette:
      if (pixels.layout.type == VoxelType::u8)
        return small ? lookUp<std::uint8_t, std::uint8_t>(pixels, stored)
                     : lookUp<std::uint8_t, std::uint16_t>(pixels, stored);
      return small ? lookUp<std::uint16_t, std::uint8_t>(pixels, stored)
                   : lookUp<std::uint16_t, std::uint16_t>(pixels, stored);
    case DicomColours::ybrFull: {
      Bytes out = stored;
      toRgb(out);
      return out;
    }
    default: {
      Bytes out = stored;
      VoxelLayout layout = pixels.layout;
      normaliseVoxels(layout, out);
      return out;
    }
  }
}

}  // namespace umbrick
