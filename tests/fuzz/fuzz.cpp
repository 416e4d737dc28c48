// A libFuzzer program: UMBRICK_FUZZ_TARGET names what it feeds, of gridTargets() with UMBRICK_FUZZ_GRIDS.
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "fuzz/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace umbrick::fuzz;
#ifdef UMBRICK_FUZZ_GRIDS
  static const NamedTarget target = gridTargets().at(UMBRICK_FUZZ_TARGET);
#else
  static const NamedTarget target = targets().at(UMBRICK_FUZZ_TARGET);
#endif
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("umbrick-fuzz-" + std::to_string(getpid()) + target.extension);
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(content.data(), static_cast<std::streamsize>(size));
  runTarget(target.run, path, content);
  return 0;
}
