// Bytes as text, for pictures inside of messages.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace umbrick::view {

/// Returns bytes in base 64 (RFC 4648), with its padding.
std::string base64(std::string_view bytes);

}  // namespace umbrick::view
