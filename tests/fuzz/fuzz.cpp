// A libFuzzer program: UMBRICK_FUZZ_TARGET names what it feeds, of the map that UMBRICK_FUZZ_TARGETS returns.
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "fuzz/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace umbrick::fuzz;
  static const NamedTarget target = UMBRICK_FUZZ_TARGETS().at(UMBRICK_FUZZ_TARGET);
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("umbrick-fuzz-" + std::to_string(getpid()) + target.extension);
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(content.data(), static_cast<std::streamsize>(size));
  runTarget(target.run, path, content);
  return 0;
}
