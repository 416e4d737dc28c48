// SPDX-License-Identifier: Apache-2.0
#include "umbrick/image/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <ostream>
#include <vector>

#include "core/input_file.h"
#include "image/finite.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/srgb.h"

namespace umbrick {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::uint8_t byteOf(double share) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }

// Encodes the image with rows from the top and straight alpha.
std::vector<std::uint8_t> encoded(const Image& image, const PngOptions& options) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size());
  const double scale = exposureFactor(options.exposure);
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x) {
      const float* p = image.at(x, y);
      const double alpha = std::min(1.0, finiteOr0(p[3]));
      glm::dvec3 colour{0};
      if (alpha > 0)
        colour = toneMapped(glm::dvec3(finiteOr0(p[0]), finiteOr0(p[1]), finiteOr0(p[2])) * (scale / alpha),
                            options.toneMap);
      for (int c = 0; c < 3; ++c) bytes.push_back(byteOf(linearToSrgb(std::min(1.0, colour[c]))));
      bytes.push_back(byteOf(alpha));
    }
  return bytes;
}

// libpng reports errors by a jump, which must not skip the destructor of anything. So what follows a setjmp below holds
// plain data only.
struct Report {
  std::array<char, 256> message{};
};
void onError(png_structp png, png_const_charp message) {
  auto* report = static_cast<Report*>(png_get_error_ptr(png));
  std::snprintf(report->message.data(), report->message.size(), "%s", message);
  png_longjmp(png, 1);
}
void onWarning(png_structp, png_const_charp) {}

struct Encoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Report report;
  ~Encoder() { png_destroy_write_struct(&png, &info); }
};

// Hands bytes to the stream. No exception may pass through libpng, which is told of it; the stream keeps the reason.
void toStream(png_structp png, png_bytep bytes, png_size_t count) {
  bool written = false;
  try {
    static_cast<std::ostream*>(png_get_io_ptr(png))
        ->write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    written = true;
  } catch (const std::exception&) {
    written = false;
  }
  if (!written) png_error(png, "cannot write");
}
void flushNothing(png_structp) {}

bool writeBytes(Encoder& encoder, std::ostream& out, int width, int height, const std::uint8_t* bytes, png_text* texts,
                int textCount) {
  if (setjmp(png_jmpbuf(encoder.png))) return false;
  png_set_write_fn(encoder.png, &out, toStream, flushNothing);
  png_set_IHDR(encoder.png, encoder.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(encoder.png, encoder.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(encoder.png, encoder.info, texts, textCount);
  png_write_info(encoder.png, encoder.info);
  for (int y = 0; y < height; ++y)
    png_write_row(encoder.png, bytes + static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * 4);
  png_write_end(encoder.png, encoder.info);
  return true;
}

// Text that Latin-1 (tEXt) cannot say goes to iTXt, which is UTF-8.
std::vector<png_text> textsOf(const std::map<std::string, std::string>& metadata) {
  std::vector<png_text> texts;
  for (const auto& [key, text] : metadata) {
    if (key.empty() || key.size() > 79) throw InvalidArgument("PNG: a key has 1 to 79 characters, found '" + key + "'");
    const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return static_cast<signed char>(c) >= 0; });
    png_text entry{};
    entry.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    entry.key = const_cast<char*>(key.c_str());
    entry.text = const_cast<char*>(text.c_str());
    (ascii ? entry.text_length : entry.itxt_length) = text.size();
    texts.push_back(entry);
  }
  return texts;
}

struct Decoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  Report report;
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

bool readHeader(Decoder& decoder, std::FILE* file) {
  if (setjmp(png_jmpbuf(decoder.png))) return false;
  png_init_io(decoder.png, file);
  png_read_info(decoder.png, decoder.info);
  png_set_expand(decoder.png);
  png_set_strip_16(decoder.png);
  png_set_gray_to_rgb(decoder.png);
  png_set_add_alpha(decoder.png, 255, PNG_FILLER_AFTER);
  png_set_interlace_handling(decoder.png);
  png_read_update_info(decoder.png, decoder.info);
  return true;
}

bool readRows(Decoder& decoder, png_bytepp rows) {
  if (setjmp(png_jmpbuf(decoder.png))) return false;
  png_read_image(decoder.png, rows);
  png_read_end(decoder.png, nullptr);
  return true;
}

}  // namespace

void writePng(const std::filesystem::path& path, const Image& image, const PngOptions& options) {
  if (image.channels != 4) throw InvalidArgument("PNG: expected 4 channels, found " + std::to_string(image.channels));
  if (image.width < 1 || image.height < 1)
    throw InvalidArgument("PNG: the image is " + std::to_string(image.width) + " x " + std::to_string(image.height));
  std::vector<png_text> texts = textsOf(options.metadata);
  PendingFile pending(path);
  const std::vector<std::uint8_t> bytes = encoded(image, options);
  const auto fail = [&](const std::string& reason) { throw IoError(path.string() + ": cannot write: " + reason); };
  Encoder encoder;
  encoder.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder.report, onError, onWarning);
  encoder.info = encoder.png ? png_create_info_struct(encoder.png) : nullptr;
  if (!encoder.info) fail("out of memory");
  if (!writeBytes(encoder, pending.stream(), image.width, image.height, bytes.data(), texts.data(),
                  static_cast<int>(texts.size()))) {
    pending.flush();  // says why, if it is the file that could not be written
    fail(encoder.report.message.data());
  }
  pending.commit();
}

Image readPng(const std::filesystem::path& path) {
  ordinaryFileSize(path);
  const auto fail = [&](const std::string& reason) { throw IoError(path.string() + ": cannot read: " + reason); };
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(std::strerror(errno));
  std::array<png_byte, 8> signature{};
  if (std::fread(signature.data(), 1, signature.size(), file.get()) != signature.size() ||
      png_sig_cmp(signature.data(), 0, signature.size()) != 0)
    throw IoError(path.string() + ": not a PNG file");
  std::rewind(file.get());
  Decoder decoder;
  decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder.report, onError, onWarning);
  decoder.info = decoder.png ? png_create_info_struct(decoder.png) : nullptr;
  if (!decoder.info) fail("out of memory");
  if (!readHeader(decoder, file.get())) fail(decoder.report.message.data());

  const auto width = png_get_image_width(decoder.png, decoder.info);
  const auto height = png_get_image_height(decoder.png, decoder.info);
  // A damaged header must not ask for more memory than any picture needs.
  if (width > (1u << 28) / height)
    fail("an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  std::vector<std::uint8_t> bytes(std::size_t(4) * width * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = bytes.data() + y * width * 4;
  if (!readRows(decoder, rows.data())) fail(decoder.report.message.data());

  Image image(static_cast<int>(width), static_cast<int>(height), 4);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* in = rows[height - 1 - static_cast<std::size_t>(y)];
    for (int x = 0; x < image.width; ++x, in += 4) {
      const double alpha = in[3] / 255.0;
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(alpha * srgbToLinear(in[c] / 255.0));
      image.at(x, y)[3] = static_cast<float>(alpha);
    }
  }
  return image;
}

}  // namespace umbrick
