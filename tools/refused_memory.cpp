// Tells core how much memory was refused, which std::bad_alloc does not say. The program replaces the allocation
// function of C++ for that, as ISO C++ [new.delete.single] allows; a library must not.
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <new>

#include "umbrick/core/memory.h"

#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer has functions of its own

void* operator new(std::size_t bytes) {
  for (;;) {
    if (void* const memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) break;
    handler();
  }
  umbrick::noteRefusedMemory(bytes);
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#endif
