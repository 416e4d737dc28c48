// A film, which ffmpeg makes of pictures as they come.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/descriptor.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/image/image.h"

namespace umbrick::tools {

struct FilmOptions {
  double fps = 25;
  std::optional<int> quality;  // constant rate factor of the encoder; none: kUsualQuality
};

/// Tells whether a name ends in .mp4 or .webm.
bool isFilm(const std::filesystem::path& path);

/// Checks that ffmpeg is installed, before pictures are made for it. @throw Error  names the film and what to do
void requireFilmEncoder(const std::filesystem::path& film);

/// Returns what a film gets of a picture: 8-bit sRGB, from the top row on.
/// @param shown  linear display values, premultiplied: what is transparent is black
std::string filmPixels(const Image& shown);

/// Pipes pictures to ffmpeg, as raw 8-bit sRGB. The film appears whole or not at all: it takes its name by finish(),
/// and without that what was encoded goes with this object.
class Film {
 public:
  /// Starts ffmpeg. An edge of an odd number of pixels loses one, since the encoders take even ones alone.
  /// @param width,height  pixels, at least 2 each
  /// @throw Error, IoError, InvalidArgument
  Film(const std::filesystem::path& path, int width, int height, const FilmOptions& options);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Adds a picture. @param pixels  as filmPixels() makes them, of the film's size
  /// @throw IoError  ffmpeg has ended; the message has what it says
  void add(std::string_view pixels);
  /// Waits for ffmpeg and puts the film in its place. @throw IoError
  void finish();

 private:
  void start(const std::vector<std::string>& arguments);
  int wait();
  std::string complaint() const;

  std::filesystem::path path_;
  PendingFile file_;
  pid_t encoder_ = -1;
  Descriptor pictures_, messages_;
};

}  // namespace umbrick::tools
