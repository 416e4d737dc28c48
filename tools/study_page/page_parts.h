// Makes pieces of an HTML page that needs no other file. What these functions return is well-formed as XML, too.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace umbrick::tools {

/// Escapes a text for element text and attribute values.
std::string escapeHtml(std::string_view text);
/// Prints three significant digits; "-" for a number that is not finite.
std::string printShort(double number);

std::string base64(std::string_view bytes);
/// Returns an <img> that holds the PNG, or the word "missing" when there is no such file.
std::string embeddedPicture(const std::filesystem::path& png, const std::string& alt);

/// Returns gnuplot's SVG as an element of a page: without prolog, its identifiers made unique by a prefix.
std::string inlineSvg(std::string_view svg, const std::string& prefix);

struct HtmlTable {
  struct Cell {
    std::string html;
    std::string sortKey = {};  // empty: the text itself
    bool text = false;         // left-aligned
  };
  std::vector<Cell> head;
  struct Row {
    std::vector<Cell> cells;
    std::string kind = {};  // CSS class of the row
  };
  std::vector<Row> rows;
  bool sortable = false;
};
std::string printHtml(const HtmlTable& table);

}  // namespace umbrick::tools
