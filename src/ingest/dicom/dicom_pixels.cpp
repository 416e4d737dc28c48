// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_pixels.h"

#include <gdcmBitmap.h>
#include <gdcmJPEGCodec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "ingest/dicom/dicom_colours.h"
#include "ingest/dicom/dicom_rle.h"
#include "ingest/dicom/jpeg_check.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

using Bytes = std::vector<std::byte>;

std::string where(const DicomFile& file, std::size_t image) {
  return file.path.string() + ": PixelData: " +
         (file.pixels.images > 1 && file.pixels.single() ? "frame " + std::to_string(image + 1) + ": " : std::string());
}

Bytes readBytes(const DicomFile& file, std::int64_t offset, std::int64_t count) {
  Bytes bytes(static_cast<std::size_t>(count));
  const auto stream = openDicomBytes(file.path, file.pixels.deflated, file.pixels.dataOffset, offset);
  if (const std::size_t got = stream->read(bytes); got < bytes.size())
    throw IoError(file.path.string() + ": PixelData: expected " + std::to_string(bytes.size()) + " bytes, found " +
                  std::to_string(got));
  return bytes;
}

bool isJpeg(const DicomPixelData& pixels) {
  // JPEG and JPEG-LS, 1.2.840.10008.1.2.4.50 to 81; 90 and beyond are JPEG 2000.
  const std::string_view family = "1.2.840.10008.1.2.4.";
  const std::string& syntax = pixels.transferSyntax;
  return syntax.starts_with(family) && syntax.size() == family.size() + 2 && syntax[family.size()] < '9';
}

// The frame header of a JPEG: what it says must be what the tags say, since GDCM's decoders trust one or the other.
// JPEG-LS has the same header.
void checkJpegHeader(const DicomFile& file, std::size_t image, const Bytes& stream) {
  const auto byte = [&](std::size_t at) { return std::to_integer<unsigned>(stream[at]); };
  if (stream.size() < 2 || byte(0) != 0xff || byte(1) != 0xd8) {
    if (isJpeg(file.pixels)) throw IoError(where(file, image) + "expected a JPEG, found other bytes");
    return;
  }
  for (std::size_t at = 2; at + 9 < stream.size();) {
    if (byte(at) != 0xff) break;
    const unsigned marker = byte(at + 1);
    if (marker == 0xff) {  // filling
      ++at;
      continue;
    }
    const bool frame =
        marker == 0xf7 || (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc);
    if (!frame) {
      if (marker == 0xda || marker == 0xd9) break;
      at += 2 + (byte(at + 2) << 8 | byte(at + 3));
      continue;
    }
    const unsigned bits = byte(at + 4), rows = byte(at + 5) << 8 | byte(at + 6),
                   columns = byte(at + 7) << 8 | byte(at + 8), components = byte(at + 9);
    const DicomPixelData& pixels = file.pixels;
    if (bits >= 2 && bits <= 16 && bits <= static_cast<unsigned>(pixels.bitsAllocated) && components == 1 &&
        rows == pixels.rows && columns == pixels.columns)
      return;
    throw IoError(where(file, image) + "expected a JPEG of " + std::to_string(pixels.columns) + " x " +
                  std::to_string(pixels.rows) + " pixels of at most " + std::to_string(pixels.bitsAllocated) +
                  " bits and one component, found " + std::to_string(columns) + " x " + std::to_string(rows) + " of " +
                  std::to_string(bits) + " bits and " + std::to_string(components));
  }
  throw IoError(where(file, image) + "expected the frame header of a JPEG, found none");
}

// The same of JPEG 2000: its SIZ segment. GDCM writes as many pixels as that says.
void checkJpeg2000(const DicomFile& file, std::size_t image, const Bytes& stream) {
  const DicomPixelData& pixels = file.pixels;
  if (!pixels.transferSyntax.starts_with("1.2.840.10008.1.2.4.9")) return;
  constexpr std::byte kBegin[] = {std::byte(0xff), std::byte(0x4f), std::byte(0xff), std::byte(0x51)};
  const auto found = std::search(stream.begin(), stream.end(), std::begin(kBegin), std::end(kBegin));
  if (stream.end() - found < 45) throw IoError(where(file, image) + "expected the header of JPEG 2000, found none");
  const auto number = [&](std::ptrdiff_t at, int bytes) {
    std::int64_t out = 0;
    for (int i = 0; i < bytes; ++i) out = out << 8 | std::to_integer<std::int64_t>(found[at + i]);
    return out;
  };
  const std::int64_t columns = number(8, 4) - number(16, 4), rows = number(12, 4) - number(20, 4),
                     components = number(40, 2), bits = (number(42, 1) & 0x7f) + 1;
  if (columns == pixels.columns && rows == pixels.rows && components == 1 && bits <= pixels.bitsAllocated &&
      number(43, 2) == 0x0101)
    return;
  throw IoError(where(file, image) + "expected JPEG 2000 of " + std::to_string(pixels.columns) + " x " +
                std::to_string(pixels.rows) + " pixels of at most " + std::to_string(pixels.bitsAllocated) +
                " bits and one component, found " + std::to_string(columns) + " x " + std::to_string(rows) + " of " +
                std::to_string(bits) + " bits and " + std::to_string(components));
}

// The fragments together are the JPEG of one picture.
void checkJpeg(const DicomFile& file, std::size_t image, const std::vector<Bytes>& fragments) {
  Bytes joined;
  const Bytes* stream = &fragments.front();
  if (fragments.size() > 1) {
    for (const Bytes& each : fragments) joined.insert(joined.end(), each.begin(), each.end());
    stream = &joined;
  }
  checkJpeg2000(file, image, *stream);
  checkJpegHeader(file, image, *stream);
  if (stream->size() < 2 || (*stream)[0] != std::byte(0xff) || (*stream)[1] != std::byte(0xd8)) return;
  if (const auto damage = jpegDamage(*stream))
    throw IoError(file.path.string() + ": PixelData: frame " + std::to_string(image + 1) +
                  ": expected a whole JPEG, found: " + *damage);
}

void silenceGdcm() {
  static std::once_flag once;
  std::call_once(once, [] {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
  });
}

gdcm::Bitmap bitmapOf(const DicomPixelData& pixels, std::size_t images) {
  const bool isSigned = pixels.layout.type == VoxelType::i8 || pixels.layout.type == VoxelType::i16 ||
                        pixels.layout.type == VoxelType::i32;
  const auto stored = static_cast<unsigned short>(pixels.layout.bitsStored);
  gdcm::Bitmap bitmap;
  bitmap.SetNumberOfDimensions(images > 1 ? 3 : 2);
  bitmap.SetDimension(0, static_cast<unsigned>(pixels.columns));
  bitmap.SetDimension(1, static_cast<unsigned>(pixels.rows));
  if (images > 1) bitmap.SetDimension(2, static_cast<unsigned>(images));
  bitmap.SetPixelFormat(gdcm::PixelFormat(1, static_cast<unsigned short>(pixels.bitsAllocated), stored,
                                          static_cast<unsigned short>(stored - 1), isSigned ? 1 : 0));
  bitmap.SetPhotometricInterpretation(
      gdcm::PhotometricInterpretation(gdcm::PhotometricInterpretation::GetPIType(pixels.photometric.c_str())));
  bitmap.SetTransferSyntax(gdcm::TransferSyntax(gdcm::TransferSyntax::GetTSType(pixels.transferSyntax.c_str())));
  return bitmap;
}

gdcm::DataElement elementOf(const std::vector<Bytes>& fragments, bool packed) {
  const gdcm::Tag tag(0x7fe0, 0x0010);
  const auto length = [](const Bytes& bytes) { return gdcm::VL(static_cast<std::uint32_t>(bytes.size())); };
  gdcm::DataElement element(tag, 0, gdcm::VR::OW);
  if (!packed) {
    element.SetByteValue(reinterpret_cast<const char*>(fragments.front().data()), length(fragments.front()));
    return element;
  }
  gdcm::SmartPointer<gdcm::SequenceOfFragments> sequence = new gdcm::SequenceOfFragments;
  for (const Bytes& bytes : fragments) {
    gdcm::Fragment fragment;
    fragment.SetByteValue(reinterpret_cast<const char*>(bytes.data()), length(bytes));
    sequence->AddFragment(fragment);
  }
  element.SetVR(gdcm::VR::OB);
  element.SetValue(*sequence);
  return element;
}

// A bitmap gives a JPEG that it cannot read to another program, so that JPEG goes to the decoder itself.
bool decoded(const gdcm::Bitmap& bitmap, const DicomPixelData& pixels, Bytes& out) {
  gdcm::JPEGCodec jpeg;
  if (!isJpeg(pixels) || !jpeg.CanDecode(bitmap.GetTransferSyntax()))
    return bitmap.GetBuffer(reinterpret_cast<char*>(out.data()));
  jpeg.SetNumberOfDimensions(bitmap.GetNumberOfDimensions());
  jpeg.SetDimensions(bitmap.GetDimensions());
  jpeg.SetPhotometricInterpretation(bitmap.GetPhotometricInterpretation());
  jpeg.SetPixelFormat(bitmap.GetPixelFormat());
  gdcm::DataElement unpacked;
  if (!jpeg.Decode(bitmap.GetDataElement(), unpacked)) return false;
  const gdcm::ByteValue* bytes = unpacked.GetByteValue();
  if (!bytes || std::size_t(bytes->GetLength()) < out.size()) return false;
  std::memcpy(out.data(), bytes->GetPointer(), out.size());
  return true;
}

// Lets GDCM unpack `images` pictures.
Bytes unpack(const DicomFile& file, std::size_t image, const std::vector<Bytes>& fragments, std::size_t images) {
  const DicomPixelData& pixels = file.pixels;
  const auto expected =
      pixels.columns * pixels.rows * voxelBytes(pixels.layout.type) * static_cast<std::int64_t>(images);
  const auto refused = [&](const std::string& found) {
    return IoError(where(file, image) + "expected " + std::to_string(expected) + " bytes of pixels, found " + found);
  };
  silenceGdcm();
  gdcm::Bitmap bitmap = bitmapOf(pixels, images);
  if (bitmap.GetTransferSyntax() == gdcm::TransferSyntax::TS_END)
    throw refused("those of a transfer syntax that is not read: " + transferSyntaxName(pixels.transferSyntax));
  bitmap.SetDataElement(elementOf(fragments, pixels.offset < 0));
  const auto length = static_cast<std::int64_t>(bitmap.GetBufferLength());
  if (length != expected) throw refused(std::to_string(length));
  Bytes out(static_cast<std::size_t>(expected));
  if (!decoded(bitmap, pixels, out))
    throw refused("none that can be unpacked: truncated, corrupt or of an unknown kind of " +
                  transferSyntaxName(pixels.transferSyntax));
  return out;
}

// Pixels of one bit follow each other without a gap, also from frame to frame; the first is in the lowest bit of a byte
// (PS3.5 8.1.1).
Bytes readBits(const DicomFile& file, std::size_t image) {
  const std::int64_t pixels = file.pixels.columns * file.pixels.rows, first = pixels * static_cast<std::int64_t>(image);
  const std::int64_t begin = first / 8, end = (first + pixels + 7) / 8;
  const Bytes packed = readBytes(file, file.pixels.offset + begin, end - begin);
  Bytes out(static_cast<std::size_t>(pixels));
  for (std::int64_t i = 0; i < pixels; ++i) {
    const std::int64_t bit = first + i - 8 * begin;
    out[static_cast<std::size_t>(i)] = packed[static_cast<std::size_t>(bit / 8)] >> (bit % 8) & std::byte(1);
  }
  return out;
}

}  // namespace

Bytes readDicomPixels(const DicomFile& file, std::size_t image) try {
  const DicomPixelData& pixels = file.pixels;
  if (pixels.offset >= 0 && pixels.bitsAllocated == 1) return readBits(file, image);
  if (pixels.offset >= 0 && pixels.single()) {
    const std::int64_t bytes = pixels.columns * pixels.rows * pixels.samples * voxelBytes(pixels.layout.type);
    Bytes stored = readBytes(file, pixels.offset + bytes * static_cast<std::int64_t>(image), bytes);
    return pixels.planes ? withoutPlanes(stored, static_cast<std::size_t>(voxelBytes(pixels.layout.type))) : stored;
  }
  if (pixels.offset >= 0) return unpack(file, 0, {readBytes(file, pixels.offset, pixels.bytes)}, pixels.images);
  const std::vector<DicomFragment>& parts = pixels.fragments[pixels.single() ? image : 0];
  if (parts.empty()) throw IoError(where(file, image) + "expected packed pixels, found none");
  std::vector<Bytes> fragments;
  for (const DicomFragment& part : parts) fragments.push_back(readBytes(file, part.offset, part.bytes));
  if (pixels.transferSyntax == "1.2.840.10008.1.2.5") {
    if (!pixels.single()) throw IoError(where(file, 0) + "expected a fragment of RLE data for each frame");
    Bytes packed;
    for (const Bytes& each : fragments) packed.insert(packed.end(), each.begin(), each.end());
    // Samples have a segment each, as the bytes of a number have.
    const auto pixelBytes = static_cast<std::size_t>(pixels.samples * voxelBytes(pixels.layout.type));
    Bytes out(static_cast<std::size_t>(pixels.columns * pixels.rows) * pixelBytes);
    const std::string damage = unpackDicomRle(packed, pixelBytes, out);
    if (!damage.empty()) throw IoError(where(file, image) + "expected " + damage);
    // The first segment is the highest byte of a number, and red of a colour.
    if (pixels.samples == 3 && std::endian::native == std::endian::little)
      for (std::size_t i = 0; i + 2 < out.size(); i += 3) std::swap(out[i], out[i + 2]);
    return out;
  }
  if (pixels.single()) checkJpeg(file, image, fragments);
  return unpack(file, image, fragments, pixels.single() ? 1 : pixels.images);
} catch (const Error&) {
  throw;
} catch (const std::exception&) {
  throw IoError(where(file, image) + "expected pixels that can be unpacked, found truncated or corrupt ones");
}

}  // namespace umbrick
