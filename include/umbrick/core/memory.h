// How much memory there is, told before a step asks for more: what it would get may be taken away by the system, which
// ends the program, or refused in the middle of a foreign library.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "umbrick/core/error.h"

namespace umbrick {

/// There is not enough memory for a step, or no further thread.
struct MemoryError : Error {
  using Error::Error;
};

/// What can still be asked for, and what sets the limit.
struct AvailableMemory {
  std::uint64_t bytes = 0;
  std::string limit;  // "free in this machine", as a message goes on behind the number
};

/// The least of what is free in the machine (swap included), in the process's control group, and below the limits on
/// the address space and on data that `ulimit -v` and `ulimit -d` set. It is found in some 50 microseconds.
AvailableMemory availableMemory();

/// @param step   names the step and its file, and says how much there is to be done
/// @param bytes  that the step is going to ask for besides what is in use
/// @throw MemoryError  "<step>: needs 3.1 GiB of memory, there is 1.2 GiB (free in this machine)"
void requireMemory(const std::string& step, double bytes);

/// The same of address space, of which libraries and threads reserve much more than they use. Looks at `ulimit -v`
/// alone.
/// @throw MemoryError
void requireAddressSpace(const std::string& step, double bytes);

/// Remembers the size of an allocation that failed, for the next outOfMemory().
void noteRefusedMemory(std::uint64_t bytes) noexcept;

/// What to say of an allocation that failed in a step.
MemoryError outOfMemory(const std::string& step);

/// What to say of an error that stands for memory or a thread that the system refused, where it is one: std::bad_alloc,
/// std::system_error, and what TBB throws.
std::optional<MemoryError> refusalOf(const std::exception& error, const std::string& step);

/// Does a step. Memory or threads that are refused in it become an error that names it.
/// @param step  returns what the step and its file are called
/// @throw MemoryError
template <class Step, class Action>
auto withinMemory(const Step& step, const Action& action) {
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    if (const auto refusal = refusalOf(error, step())) throw *refusal;
    throw;
  }
}

/// "1.5 GiB", "320 MiB" or "12 KiB".
std::string memoryText(double bytes);

}  // namespace umbrick
