// Whether the tests are built with the address sanitizer, which reserves terabytes of address space.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace umbrick
