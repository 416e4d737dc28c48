// Vectors of many mebibytes that are made and freed again and again, as for each picture of a moving camera.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <new>
#include <vector>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace umbrick {

/// Takes large memory from huge pages where the system offers them on request (Linux: MADV_HUGEPAGE, man 2 madvise).
/// The system hands out and clears memory page by page at its first touch, and with pages of 4 KiB that takes longer
/// than what is then computed in it. Without huge pages it is ordinary memory.
template <class T>
class HugePageAllocator {
 public:
  using value_type = T;

  HugePageAllocator() = default;
  template <class Other>
  explicit HugePageAllocator(const HugePageAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = count * sizeof(T);
    if (!isLarge(count)) return static_cast<T*>(::operator new(bytes));
    void* const memory = ::operator new(bytes, std::align_val_t(kPage));
#ifdef MADV_HUGEPAGE
    // Whole pages only, so that memory does not grow. Advice that is not taken changes nothing.
    madvise(memory, bytes / kPage * kPage, MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (isLarge(count))
      ::operator delete(memory, std::align_val_t(kPage));
    else
      ::operator delete(memory);
  }
  bool operator==(const HugePageAllocator&) const = default;

 private:
  static constexpr std::size_t kPage = std::size_t{2} << 20;  // that of x86-64, and of ARM with small pages of 4 KiB
  static bool isLarge(std::size_t count) { return count * sizeof(T) >= 2 * kPage; }
};

template <class T>
using LargeVector = std::vector<T, HugePageAllocator<T>>;

}  // namespace umbrick
