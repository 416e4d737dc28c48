// SPDX-License-Identifier: Apache-2.0
#include "umbrick/core/printable.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace umbrick {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;  // 0: the first byte begins no UTF-8
};

// Reads the first character, as The Unicode Standard 15, Table 3-7 lists the well-formed ones.
Character firstOf(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xf0 && lead <= 0xf4  ? 4
                            : lead >= 0xe0 && lead < 0xf0 ? 3
                            : lead >= 0xc2 && lead < 0xe0 ? 2
                                                          : 0;
  if (bytes == 0 || bytes > text.size()) return {};
  std::uint32_t code = lead & (0xffu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  if (code < kLeast[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
  return {code, bytes};
}

bool isObeyed(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || (code >= 0x200e && code <= 0x200f) ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

void escape(char c, std::string& out) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  if (c == '\n')
    out += "\\n";
  else if (c == '\t')
    out += "\\t";
  else if (c == '\r')
    out += "\\r";
  else
    out.append("\\x").append(1, kDigits[byte >> 4]).append(1, kDigits[byte & 15]);
}

enum class Stays { printable, lines, utf8 };

std::string escaped(std::string_view text, Stays what) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character next = firstOf(text);
    const std::size_t bytes = next.bytes == 0 ? 1 : next.bytes;
    const bool stays =
        next.bytes > 0 && (what == Stays::utf8 || !isObeyed(next.code) || (what == Stays::lines && next.code == '\n'));
    if (stays)
      out.append(text.substr(0, bytes));
    else
      for (const char c : text.substr(0, bytes)) escape(c, out);
    text.remove_prefix(bytes);
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, Stays::printable); }

std::string printableLines(std::string_view text) { return escaped(text, Stays::lines); }

std::string asUtf8(std::string_view text) { return escaped(text, Stays::utf8); }

}  // namespace umbrick
