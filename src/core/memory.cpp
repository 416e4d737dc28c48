// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>
#include <string_view>
#include <system_error>

#include "umbrick/core/short_number.h"

namespace umbrick {
namespace {

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

constexpr const char* kOfAddressSpace = "left of the address space that ulimit -v allows";

// Is set in the middle of an allocation, where nothing else can be reached.
std::atomic<std::uint64_t> refused = 0;

// Reads a file that holds one number. Is kNone where there is no file or the word "max".
std::uint64_t numberIn(const std::string& path) {
  std::ifstream in(path);
  std::uint64_t number = 0;
  return in >> number ? number : kNone;
}

// Finds the number behind a word, as in "MemAvailable:  1234 kB". Is kNone where there is none.
std::uint64_t numberAfter(const std::string& path, const std::string& name) {
  std::ifstream in(path);
  for (std::string word; in >> word;)
    if (word == name) {
      std::uint64_t number = 0;
      return in >> number ? number : kNone;
    }
  return kNone;
}

std::uint64_t without(std::uint64_t all, std::uint64_t used) {
  return all == kNone ? kNone : used == kNone ? all : all - std::min(all, used);
}

std::uint64_t freeInMachine() {
  constexpr std::uint64_t kKiB = 1024;
  const std::uint64_t free = numberAfter("/proc/meminfo", "MemAvailable:");
  const std::uint64_t swap = numberAfter("/proc/meminfo", "SwapFree:");
  if (free != kNone) return kKiB * (free + (swap == kNone ? 0 : swap));
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// What files have left in memory is given back when it is asked for, so it does not count as used.
std::uint64_t freeInGroup() {
  const std::string second = "/sys/fs/cgroup/", first = "/sys/fs/cgroup/memory/";
  const std::uint64_t most = numberIn(second + "memory.max");
  if (most != kNone)
    return without(most,
                   without(numberIn(second + "memory.current"), numberAfter(second + "memory.stat", "inactive_file")));
  const std::uint64_t older = numberIn(first + "memory.limit_in_bytes");
  return without(older, without(numberIn(first + "memory.usage_in_bytes"),
                                numberAfter(first + "memory.stat", "total_inactive_file")));
}

// What a limit of setrlimit leaves, with the field of /proc/self/status that counts against it.
std::uint64_t freeBelow(int limit, const std::string& field) {
  rlimit found{};
  if (getrlimit(static_cast<__rlimit_resource>(limit), &found) != 0 || found.rlim_cur == RLIM_INFINITY) return kNone;
  const std::uint64_t used = numberAfter("/proc/self/status", field);
  return without(found.rlim_cur, used == kNone ? 0 : 1024 * used);
}

void require(const std::string& step, double bytes, const AvailableMemory& there) {
  if (bytes <= static_cast<double>(there.bytes)) return;
  throw MemoryError(step + ": needs " + memoryText(bytes) + " of memory, there is " +
                    memoryText(static_cast<double>(there.bytes)) + " (" + there.limit + ")");
}

}  // namespace

AvailableMemory availableMemory() {
  AvailableMemory least{freeInMachine(), "free in this machine"};
  const auto consider = [&](std::uint64_t bytes, const char* limit) {
    if (bytes < least.bytes) least = {bytes, limit};
  };
  consider(freeInGroup(), "left of what the control group may use");
  consider(freeBelow(RLIMIT_AS, "VmSize:"), kOfAddressSpace);
  consider(freeBelow(RLIMIT_DATA, "VmData:"), "left of the data that ulimit -d allows");
  return least;
}

void requireMemory(const std::string& step, double bytes) { require(step, bytes, availableMemory()); }

void requireAddressSpace(const std::string& step, double bytes) {
  require(step, bytes, {freeBelow(RLIMIT_AS, "VmSize:"), kOfAddressSpace});
}

void noteRefusedMemory(std::uint64_t bytes) noexcept { refused = bytes; }

MemoryError outOfMemory(const std::string& step) {
  const AvailableMemory there = availableMemory();
  const std::uint64_t asked = refused.exchange(0);
  return MemoryError(step + ": out of memory" +
                     (asked > 0 ? ": asked for " + memoryText(static_cast<double>(asked)) + " more" : "") +
                     ", there is " + memoryText(static_cast<double>(there.bytes)) + " (" + there.limit + ")");
}

std::optional<MemoryError> refusalOf(const std::exception& error, const std::string& step) {
  if (dynamic_cast<const std::bad_alloc*>(&error)) return outOfMemory(step);
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  const bool thread = system && system->code() == std::errc::resource_unavailable_try_again;
  // TBB has no type for it.
  if (!thread && std::string_view(error.what()).find("pthread_create") == std::string_view::npos) return std::nullopt;
  const AvailableMemory there = availableMemory();
  return MemoryError(step + ": the system refuses another thread, there is " +
                     memoryText(static_cast<double>(there.bytes)) + " of memory (" + there.limit +
                     "), and ulimit -u may limit threads");
}

std::string memoryText(double bytes) {
  if (bytes >= 0x1p30) return shortNumber(bytes / 0x1p30, 3) + " GiB";
  if (bytes >= 0x1p20) return shortNumber(bytes / 0x1p20, 3) + " MiB";
  return shortNumber(bytes / 0x1p10, 3) + " KiB";
}

}  // namespace umbrick
