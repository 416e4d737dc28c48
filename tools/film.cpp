// SPDX-License-Identifier: Apache-2.0
#include "film.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "umbrick/core/error.h"
#include "umbrick/core/output.h"
#include "umbrick/core/short_number.h"
#include "umbrick/core/srgb.h"

namespace umbrick::tools {
namespace fs = std::filesystem;
namespace {

constexpr const char* kEncoder = "ffmpeg";

struct Codec {
  const char* name;
  int usualQuality;                  // looks like the pictures
  int worstQuality;                  // of the encoder's scale, whose best is 0
  std::vector<std::string> options;  // of the encoder and of the container
};

Codec codecOf(const fs::path& path) {
  if (path.extension() == ".webm") return {"libvpx-vp9", 24, 63, {"-b:v", "0", "-row-mt", "1", "-f", "webm"}};
  return {"libx264", 16, 51, {"-movflags", "+faststart", "-f", "mp4"}};
}

// What ffmpeg is told, but for its own name.
std::vector<std::string> argumentsOf(const fs::path& path, const fs::path& written, int width, int height,
                                     const FilmOptions& options) {
  const Codec codec = codecOf(path);
  const int quality = options.quality.value_or(codec.usualQuality);
  if (quality > codec.worstQuality)
    throw InvalidArgument(path.string() + ": quality: expected 0 to " + std::to_string(codec.worstQuality) +
                          ", found " + std::to_string(quality));
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::vector<std::string> words{
      "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", size,
      "-framerate", shortNumber(options.fps, 9), "-i", "-", "-an",
      // Colours are converted by the matrix that the film states, which players would else guess from its size.
      "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p",
      "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv", "-c:v",
      codec.name, "-crf", std::to_string(quality)};
  words.insert(words.end(), codec.options.begin(), codec.options.end());
  words.push_back(written.string());
  return words;
}

bool isInstalled(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((fs::path(folder.empty() ? "." : folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

[[noreturn]] void fail(const fs::path& path, int error) {
  throw IoError(path.string() + ": cannot write: " + kEncoder + ": " + std::strerror(error));
}

char byteOf(float linear) {
  const double share = std::isfinite(linear) ? std::clamp<double>(linear, 0, 1) : 0;
  return static_cast<char>(static_cast<std::uint8_t>(std::lround(255 * std::clamp(linearToSrgb(share), 0.0, 1.0))));
}

}  // namespace

bool isFilm(const fs::path& path) { return path.extension() == ".mp4" || path.extension() == ".webm"; }

void requireFilmEncoder(const fs::path& film) {
  if (isInstalled(kEncoder)) return;
  throw Error(film.string() +
              ": a film needs ffmpeg, which is not installed (Debian: apt install ffmpeg); numbered pictures, as -o "
              "out_%04d.png, need no other program");
}

std::string filmPixels(const Image& shown) {
  std::string bytes;
  bytes.reserve(shown.pixels.size());
  for (int y = shown.height - 1; y >= 0; --y)
    for (int x = 0; x < shown.width; ++x)
      for (int channel = 0; channel < 3; ++channel) bytes += byteOf(shown.at(x, y)[channel]);
  return bytes;
}

Film::Film(const fs::path& path, int width, int height, const FilmOptions& options)
    : path_(path), file_(path, PendingFile::Naming::named) {
  if (width < 2 || height < 2)
    throw InvalidArgument(path.string() + ": expected a film of at least 2 x 2 pixels, found " + std::to_string(width) +
                          " x " + std::to_string(height));
  if (outputAt(path).isStream())
    throw InvalidArgument(path.string() + ": expected a file for the film, found a pipe or device");
  start(argumentsOf(path, file_.path(), width, height, options));
}

Film::~Film() {
  if (encoder_ < 0) return;
  ::kill(encoder_, SIGKILL);
  wait();
}

void Film::start(const std::vector<std::string>& arguments) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail(path_, errno);
  const Descriptor reading(ends[0]);
  pictures_ = Descriptor(ends[1]);
  std::string name = (fs::temp_directory_path() / "umbrick.XXXXXX").string();
  messages_ = Descriptor(mkostemp(name.data(), O_CLOEXEC));
  if (!messages_) fail(path_, errno);
  unlink(name.c_str());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, reading.number(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, messages_.number(), STDERR_FILENO);
  // Ctrl-C is for this program, which ends the encoder by itself: a group of its own does not get it.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<char*> words{const_cast<char*>(kEncoder)};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const int error = posix_spawnp(&encoder_, kEncoder, &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    encoder_ = -1;
    fail(path_, error);
  }
}

int Film::wait() {
  int status = 0;
  while (waitpid(encoder_, &status, 0) < 0 && errno == EINTR) {
  }
  encoder_ = -1;
  return status;
}

std::string Film::complaint() const {
  char text[400];
  const ssize_t count = pread(messages_.number(), text, sizeof text, 0);
  std::string line(text, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  line = line.substr(0, line.find_last_not_of(" \n") + 1);
  std::replace(line.begin(), line.end(), '\n', ';');
  return line.empty() ? "it ended early" : line;
}

void Film::add(std::string_view pixels) {
  try {
    writeAll(pictures_.number(), pixels.data(), pixels.size(), path_.string());
  } catch (const PipeClosed&) {
    wait();
    throw IoError(path_.string() + ": ffmpeg: " + complaint());
  }
}

void Film::finish() {
  pictures_.close();
  if (const int status = wait(); status != 0) throw IoError(path_.string() + ": ffmpeg: " + complaint());
  file_.commit();
}

}  // namespace umbrick::tools
