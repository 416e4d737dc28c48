// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <array>
#include <cstdio>

#include "ingest/slice_image.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// libpng reports errors by a jump, which must not pass over anything with a destructor: what follows a setjmp below
// holds plain data only.
struct Decoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::array<char, 256> message{};
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
};
void onError(png_structp png, png_const_charp message) {
  auto* decoder = static_cast<Decoder*>(png_get_error_ptr(png));
  std::snprintf(decoder->message.data(), decoder->message.size(), "%s", message);
  png_longjmp(png, 1);
}
void onWarning(png_structp, png_const_charp) {}

bool readHead(Decoder& decoder, std::FILE* file) {
  if (setjmp(png_jmpbuf(decoder.png))) return false;
  png_init_io(decoder.png, file);
  png_read_info(decoder.png, decoder.info);
  return true;
}

bool readRows(Decoder& decoder, png_bytep pixels, std::size_t rowBytes) {
  if (setjmp(png_jmpbuf(decoder.png))) return false;
  if (png_get_color_type(decoder.png, decoder.info) == PNG_COLOR_TYPE_PALETTE)
    png_set_palette_to_rgb(decoder.png);
  else
    png_set_packing(decoder.png);  // 1, 2 and 4 bits become bytes of the same values
  const int passes = png_set_interlace_handling(decoder.png);
  png_read_update_info(decoder.png, decoder.info);
  const png_uint_32 rows = png_get_image_height(decoder.png, decoder.info);
  for (int pass = 0; pass < passes; ++pass)
    for (png_uint_32 row = 0; row < rows; ++row) png_read_row(decoder.png, pixels + row * rowBytes, nullptr);
  png_read_end(decoder.png, nullptr);
  return true;
}

class PngImage : public SliceImages {
 public:
  explicit PngImage(const std::filesystem::path& path) : path_(path) { open(); }

  void read(std::int64_t, std::span<std::byte> out) override {
    if (used_) open();
    used_ = true;
    if (!readRows(*decoder_, reinterpret_cast<png_bytep>(out.data()), out.size() / static_cast<std::size_t>(height)))
      fail("the pixels of a PNG image");
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throw IoError(path_.string() + ": expected " + expected + ", found: " + decoder_->message.data());
  }

  void open() {
    file_.reset(std::fopen(path_.c_str(), "rb"));
    if (!file_) throw IoError(path_.string() + ": cannot read");
    decoder_ = std::make_unique<Decoder>();
    decoder_->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, decoder_.get(), onError, onWarning);
    decoder_->info = decoder_->png ? png_create_info_struct(decoder_->png) : nullptr;
    if (!decoder_->info) throw IoError(path_.string() + ": cannot read: out of memory");
    if (!readHead(*decoder_, file_.get())) fail("a PNG image");
    const int colour = png_get_color_type(decoder_->png, decoder_->info);
    components = colour == PNG_COLOR_TYPE_GRAY ? 1 : colour == PNG_COLOR_TYPE_GRAY_ALPHA ? 2 : 3;
    if (colour == PNG_COLOR_TYPE_RGB_ALPHA) components = 4;
    // A palette may have an opacity for each of its colours, which comes with them.
    if (colour == PNG_COLOR_TYPE_PALETTE && png_get_valid(decoder_->png, decoder_->info, PNG_INFO_tRNS)) components = 4;
    width = png_get_image_width(decoder_->png, decoder_->info);
    height = png_get_image_height(decoder_->png, decoder_->info);
    layout.type = png_get_bit_depth(decoder_->png, decoder_->info) == 16 ? VoxelType::u16 : VoxelType::u8;
    layout.endian = std::endian::big;
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::unique_ptr<Decoder> decoder_;
  bool used_ = false;
};

}  // namespace

std::unique_ptr<SliceImages> openPng(const std::filesystem::path& path) { return std::make_unique<PngImage>(path); }

}  // namespace umbrick
