// SPDX-License-Identifier: Apache-2.0
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "ingest/header_text.h"
#include "ingest/slice_image.h"
#include "ingest/streams/byte_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

// The first complaint of libtiff, instead of printing it.
struct Complaint {
  std::string text;
};
int onError(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  auto& complaint = *static_cast<Complaint*>(user);
  std::array<char, 256> line{};
  std::vsnprintf(line.data(), line.size(), format, arguments);
  if (complaint.text.empty()) complaint.text = line.data();
  return 1;
}
int onWarning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

template <class T>
T field(TIFF* tiff, std::uint32_t tag, T otherwise) {
  T value{};
  return TIFFGetFieldDefaulted(tiff, tag, &value) ? value : otherwise;
}

std::string photometricName(std::uint16_t photometric) {
  static constexpr std::array<const char*, 9> kNames{"white is zero", "black is zero", "RGB",  "a palette", "a mask",
                                                     "CMYK",          "YCbCr",         "code", "CIE L*a*b*"};
  return photometric < kNames.size() && photometric != 7 ? kNames[photometric] : "code " + std::to_string(photometric);
}

class TiffImages : public SliceImages {
 public:
  explicit TiffImages(const std::filesystem::path& path) : path_(path) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, onError, &complaint_);
    TIFFOpenOptionsSetWarningHandlerExtR(options, onWarning, nullptr);
    tiff_.reset(TIFFOpenExt(path.c_str(), "rm", options));
    TIFFOpenOptionsFree(options);
    if (!tiff_) fail("a TIFF image");
    // Thumbnails and masks are no slices. Directories are counted without reading their pixels.
    pages_.clear();
    do {
      if (!(field<std::uint32_t>(tiff_.get(), TIFFTAG_SUBFILETYPE, 0) & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)))
        pages_.push_back(TIFFCurrentDirOffset(tiff_.get()));
    } while (TIFFReadDirectory(tiff_.get()));
    if (!complaint_.text.empty() || pages_.empty()) fail("pages of a TIFF image");
    pages = std::ssize(pages_);
    select(0);
    width = field<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGEWIDTH, 0);
    height = field<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGELENGTH, 0);
    layout = layoutHere();
    components = samplesHere();
    bits_ = bitsHere();
    whiteIsZero =
        field<std::uint16_t>(tiff_.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE;
    resolutionUnit = field<std::uint16_t>(tiff_.get(), TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
    if (std::uint16_t unit = 0; !TIFFGetField(tiff_.get(), TIFFTAG_RESOLUTIONUNIT, &unit)) resolutionUnit = 0;
    char* text = nullptr;
    if (TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &text) && text) description = text;
    for (const std::uint32_t axis : {0u, 1u}) {
      float resolution = 0;
      if (TIFFGetField(tiff_.get(), axis == 0 ? TIFFTAG_XRESOLUTION : TIFFTAG_YRESOLUTION, &resolution) &&
          resolution > 0)
        pixelsPerUnit[axis] = resolution;
    }
  }

  void promise(std::int64_t count) override {
    const std::int64_t rowBytes = width * components * voxelBytes(layout.type), bytes = rowBytes * height;
    const std::string expected = "one directory for " + std::to_string(count) + " slices";
    if (pages != 1 || bits_ < 8 || isConverted() || planes() > 1 || TIFFIsTiled(tiff_.get()) ||
        field<std::uint16_t>(tiff_.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE)
      failField(path_, "slices", expected + ", unpacked and in strips", "a packed one, or tiles");
    const auto start = static_cast<std::int64_t>(TIFFGetStrileOffset(tiff_.get(), 0));
    const auto rows = static_cast<std::int64_t>(field<std::uint32_t>(tiff_.get(), TIFFTAG_ROWSPERSTRIP, 1));
    for (std::uint32_t strip = 0; strip < TIFFNumberOfStrips(tiff_.get()); ++strip)
      if (static_cast<std::int64_t>(TIFFGetStrileOffset(tiff_.get(), strip)) != start + strip * rows * rowBytes)
        failField(path_, "slices", expected + ", its strips behind each other", "strips elsewhere");
    std::int64_t all = 0;
    const std::int64_t left = checkedFileSize(path_) - start;
    if (__builtin_mul_overflow(bytes, count, &all) || all > left)
      failField(path_, "slices", std::to_string(count) + " of " + std::to_string(bytes) + " bytes behind each other",
                std::to_string(std::max<std::int64_t>(left, 0)) + " bytes");
    behind_ = openPlain(path_, start);
    pages = count;
  }

  void read(std::int64_t page, std::span<std::byte> out) override {
    if (behind_) return readBehind(page, out);
    select(page);
    const auto here = layoutHere();
    if (field<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGEWIDTH, 0) != width ||
        field<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGELENGTH, 0) != height || here.type != layout.type ||
        bitsHere() != bits_ || samplesHere() != components)
      failField(path_, "page " + std::to_string(page + 1), sizeText(width, height, layout.type) + " as on the first",
                sizeText(field<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGEWIDTH, 0),
                         field<std::uint32_t>(tiff_.get(), TIFFTAG_IMAGELENGTH, 0), here.type));
    if (isConverted()) return readConverted(page, out);
    if (bits_ >= 8) return readPixels(page, rowBytes(), out);
    packed_.resize(static_cast<std::size_t>(rowBytes() * height));
    readPixels(page, rowBytes(), packed_);
    unpack(out);
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throw IoError(path_.string() + ": expected " + expected + ", found " +
                  (complaint_.text.empty() ? std::string("none") : complaint_.text));
  }
  static std::string sizeText(std::int64_t w, std::int64_t h, VoxelType type) {
    return std::to_string(w) + " x " + std::to_string(h) + " " + std::string(voxelTypeName(type));
  }

  // Of the pixels as they lie in a row: several to a byte where they are small.
  std::int64_t rowBytes() const { return (width * samplesAtOnce() * bits_ + 7) / 8; }

  // The samples of a pixel lie side by side, or each has a plane of its own.
  std::int64_t planes() const {
    return field<std::uint16_t>(tiff_.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE
               ? components
               : 1;
  }
  std::int64_t samplesAtOnce() const { return planes() > 1 ? 1 : components; }

  // Whether libtiff makes RGB of the pixels: those of a palette, and YCbCr, whose colours may be coarser than its
  // pixels.
  bool isConverted() const {
    const auto photometric = field<std::uint16_t>(tiff_.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    const auto samples = field<std::uint16_t>(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto bits = field<std::uint16_t>(tiff_.get(), TIFFTAG_BITSPERSAMPLE, 1);
    return (photometric == PHOTOMETRIC_PALETTE && samples == 1 && bits <= 8) ||
           (photometric == PHOTOMETRIC_YCBCR && samples == 3 && bits == 8);
  }

  int bitsHere() const { return isConverted() ? 8 : field<std::uint16_t>(tiff_.get(), TIFFTAG_BITSPERSAMPLE, 1); }

  std::int64_t samplesHere() const {
    if (isConverted()) return 3;
    return std::max<std::int64_t>(field<std::uint16_t>(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, 1), 1);
  }

  void readConverted(std::int64_t page, std::span<std::byte> out) {
    std::array<char, 1024> why{};
    if (!TIFFRGBAImageOK(tiff_.get(), why.data())) fail("colours that libtiff converts: " + std::string(why.data()));
    raster_.resize(static_cast<std::size_t>(width * height));
    // The orientation of the file itself, so that rows and columns stay as they are stored, as those of other pixels
    // do.
    const int orientation = field<std::uint16_t>(tiff_.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (!TIFFReadRGBAImageOriented(tiff_.get(), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                                   raster_.data(), orientation, /*stopOnError=*/1))
      fail("the pixels of page " + std::to_string(page + 1));
    for (std::size_t i = 0; i < raster_.size(); ++i) {
      out[3 * i] = static_cast<std::byte>(TIFFGetR(raster_[i]));
      out[3 * i + 1] = static_cast<std::byte>(TIFFGetG(raster_[i]));
      out[3 * i + 2] = static_cast<std::byte>(TIFFGetB(raster_[i]));
    }
  }

  void readPixels(std::int64_t page, std::int64_t row, std::span<std::byte> out) {
    if (planes() == 1) return readPlane(page, 0, row, out);
    const auto bytes = static_cast<std::size_t>(bits_ / 8);
    const auto several = static_cast<std::size_t>(components);
    plane_.resize(out.size() / several);
    for (std::size_t k = 0; k < several; ++k) {
      readPlane(page, static_cast<std::uint16_t>(k), row, plane_);
      for (std::size_t i = 0; i < plane_.size() / bytes; ++i)
        std::memcpy(&out[(i * several + k) * bytes], &plane_[i * bytes], bytes);
    }
  }

  void readPlane(std::int64_t page, std::uint16_t plane, std::int64_t row, std::span<std::byte> out) {
    TIFFIsTiled(tiff_.get()) ? readTiles(page, plane, row, out) : readStrips(page, plane, row, out);
  }

  void readBehind(std::int64_t page, std::span<std::byte> out) {
    const auto bytes = static_cast<std::int64_t>(out.size());
    if (behind_->skip((page - behindPage_) * bytes) < (page - behindPage_) * bytes || behind_->read(out) < out.size())
      fail("the pixels of slice " + std::to_string(page + 1));
    behindPage_ = page + 1;
    const auto width1 = static_cast<std::size_t>(voxelBytes(layout.type));
    if (TIFFIsByteSwapped(tiff_.get()))
      for (std::size_t i = 0; i < out.size(); i += width1) std::reverse(&out[i], &out[i] + width1);
  }

  // Each row begins with a byte of its own, and the first pixel is in its highest bits.
  void unpack(std::span<std::byte> out) const {
    const unsigned mask = (1u << bits_) - 1;
    for (std::int64_t y = 0; y < height; ++y)
      for (std::int64_t x = 0; x < width; ++x) {
        const auto byte = std::to_integer<unsigned>(packed_[static_cast<std::size_t>(y * rowBytes() + x * bits_ / 8)]);
        out[static_cast<std::size_t>(y * width + x)] =
            static_cast<std::byte>(byte >> (8 - bits_ - x * bits_ % 8) & mask);
      }
  }

  void select(std::int64_t page) {
    if (!TIFFSetSubDirectory(tiff_.get(), pages_[static_cast<std::size_t>(page)]))
      fail("page " + std::to_string(page + 1));
  }

  VoxelLayout layoutHere() const {
    const auto samples = field<std::uint16_t>(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto photometric = field<std::uint16_t>(tiff_.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    const auto bits = field<std::uint16_t>(tiff_.get(), TIFFTAG_BITSPERSAMPLE, 1);
    const bool grey = photometric <= PHOTOMETRIC_MINISBLACK && (samples == 1 || samples == 2);
    const bool colour = photometric == PHOTOMETRIC_RGB && (samples == 3 || samples == 4);
    VoxelLayout out;
    out.endian = std::endian::native;  // libtiff swaps
    if (isConverted()) return out;
    if ((!grey && !colour) || (samples > 1 && bits < 8))
      failField(
          path_, "photometric interpretation",
          "grey of 1 or 2 samples per pixel, RGB of 3 or 4 of 8 bits or more, YCbCr of 8 bits, or a palette of up "
          "to 8 bits",
          photometricName(photometric) + " with " + std::to_string(samples));
    const auto format = field<std::uint16_t>(tiff_.get(), TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    using enum VoxelType;
    const bool integer = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_VOID;
    const bool isSigned = format == SAMPLEFORMAT_INT;
    if (integer && !isSigned && (bits == 1 || bits == 2 || bits == 4))
      out.type = u8;  // each pixel becomes a byte
    else if (integer && bits == 8)
      out.type = isSigned ? i8 : u8;
    else if (integer && bits == 16)
      out.type = isSigned ? i16 : u16;
    else if (integer && bits == 32)
      out.type = isSigned ? i32 : u32;
    else if (integer && bits == 64)
      out.type = isSigned ? i64 : u64;
    else if (format == SAMPLEFORMAT_IEEEFP && (bits == 16 || bits == 32 || bits == 64))
      out.type = bits == 16 ? f16 : bits == 32 ? f32 : f64;
    else
      failField(path_, "bits per sample", "1, 2, 4, 8, 16, 32 or 64 of integers, 16, 32 or 64 of floats",
                std::to_string(bits));
    return out;
  }

  void readStrips(std::int64_t page, std::uint16_t plane, std::int64_t row, std::span<std::byte> out) {
    const auto rowBytes = static_cast<std::size_t>(row);
    const std::size_t rows = std::min<std::size_t>(field<std::uint32_t>(tiff_.get(), TIFFTAG_ROWSPERSTRIP, 1),
                                                   static_cast<std::size_t>(height));
    const std::uint32_t first = plane * (TIFFNumberOfStrips(tiff_.get()) / static_cast<std::uint32_t>(planes()));
    for (std::uint32_t strip = first; !out.empty(); ++strip) {
      const std::size_t want = std::min(std::max<std::size_t>(rows, 1) * rowBytes, out.size());
      const tmsize_t got = TIFFReadEncodedStrip(tiff_.get(), strip, out.data(), static_cast<tmsize_t>(want));
      if (got != static_cast<tmsize_t>(want))
        fail("the pixels of page " + std::to_string(page + 1) + ", " + std::to_string(want) + " bytes of strip " +
             std::to_string(strip));
      out = out.subspan(want);
    }
  }

  void readTiles(std::int64_t page, std::uint16_t plane, std::int64_t row, std::span<std::byte> out) {
    const std::int64_t tileWidth = field<std::uint32_t>(tiff_.get(), TIFFTAG_TILEWIDTH, 0);
    const std::int64_t tileHeight = field<std::uint32_t>(tiff_.get(), TIFFTAG_TILELENGTH, 0);
    const tmsize_t tileBytes = TIFFTileSize(tiff_.get());
    const std::int64_t pixelBits = bits_ * samplesAtOnce(), tileRow = (tileWidth * pixelBits + 7) / 8;
    // A tile is no larger than what it covers, but for the rest of its own edge. Its width is a multiple of 16, so that
    // it begins at a byte.
    if (tileWidth < 1 || tileHeight < 1 || tileBytes != tileRow * tileHeight || tileWidth > width + 65536 ||
        tileHeight > height + 65536 || tileWidth * pixelBits % 8 != 0)
      fail("tiles of the size of the image");
    std::vector<std::byte> tile(static_cast<std::size_t>(tileBytes));
    for (std::int64_t y = 0; y < height; y += tileHeight)
      for (std::int64_t x = 0; x < width; x += tileWidth) {
        if (TIFFReadTile(tiff_.get(), tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0,
                         plane) < 0)
          fail("the pixels of page " + std::to_string(page + 1));
        const std::int64_t begin = x * pixelBits / 8, bytes = std::min(tileRow, row - begin);
        for (std::int64_t line = 0; line < std::min(tileHeight, height - y); ++line)
          std::memcpy(out.data() + (y + line) * row + begin, tile.data() + line * tileRow,
                      static_cast<std::size_t>(bytes));
      }
  }

  std::filesystem::path path_;
  Complaint complaint_;
  std::unique_ptr<TIFF, CloseTiff> tiff_;
  int bits_ = 8;                        // of a pixel in the file
  std::vector<std::byte> packed_;       // pixels of less than a byte
  std::vector<std::byte> plane_;        // one sample of each pixel
  std::vector<std::uint32_t> raster_;   // a page that libtiff has made RGB of
  std::unique_ptr<ByteStream> behind_;  // slices without directories, from the first on
  std::int64_t behindPage_ = 0;         // that comes next there
  std::vector<std::uint64_t> pages_;    // offsets of their directories, so that each is found at once
};

}  // namespace

std::unique_ptr<SliceImages> openTiff(const std::filesystem::path& path) { return std::make_unique<TiffImages>(path); }

}  // namespace umbrick
