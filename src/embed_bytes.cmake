# Writes OUTPUT, a C++ file that holds the bytes of the file INPUT; see build_rules.cmake.
# SPDX-License-Identifier: Apache-2.0
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,){24})" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "// Generated from ${INPUT}.
#include <span>

namespace umbrick {
namespace {
constexpr unsigned char kBytes[] = {
${bytes}};
}  // namespace

std::span<const unsigned char> ${FUNCTION}();
std::span<const unsigned char> ${FUNCTION}() { return kBytes; }
}  // namespace umbrick
")
