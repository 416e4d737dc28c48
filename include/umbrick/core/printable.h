// Text of files and their names, as messages and records may hold it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace umbrick {

/// The text as a line of UTF-8 that no terminal obeys: control characters (those of C1, too, and marks that turn the
/// direction of writing) and bytes that are not UTF-8 become \n, \t, \r or \xNN. Other text is as it was, a backslash
/// included.
std::string printable(std::string_view text);

/// The same, but line feeds stay: for text of many lines.
std::string printableLines(std::string_view text);

/// The text with each byte that is no UTF-8 as \xNN, for formats that hold nothing else, JSON and EXR: names of files
/// are bytes. Where such a name is read back, there is no file of it.
std::string asUtf8(std::string_view text);

}  // namespace umbrick
