// SPDX-License-Identifier: Apache-2.0
#include "study_page/page_parts.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <regex>
#include <system_error>

#include "core/text_file.h"

namespace umbrick::tools {

std::string escapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else if (c == '\'')
      escaped += "&#39;";
    else
      escaped += c;
  }
  return escaped;
}

std::string printShort(double number) {
  if (!std::isfinite(number)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k)
      triple = triple << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string embeddedPicture(const std::filesystem::path& png, const std::string& alt) {
  std::error_code ignored;
  if (!std::filesystem::exists(png, ignored)) return "<span class=\"quiet\">missing</span>";
  return "<img alt=\"" + escapeHtml(alt) + "\" src=\"data:image/png;base64," + base64(readTextFile(png)) + "\"/>";
}

std::string inlineSvg(std::string_view svg, const std::string& prefix) {
  // The text starts at the element itself. The title would show as a tooltip over the whole plot.
  std::string text(svg.substr(std::min(svg.find("<svg"), svg.size())));
  text = std::regex_replace(text, std::regex("<title>[^<]*</title>|<desc>[^<]*</desc>"), "");
  text = std::regex_replace(text, std::regex("\\bid=(['\"])"), "id=$1" + prefix + "-");
  text = std::regex_replace(text, std::regex("href=(['\"])#"), "href=$1#" + prefix + "-");
  return std::regex_replace(text, std::regex("url\\(#"), "url(#" + prefix + "-");
}

std::string printHtml(const HtmlTable& table) {
  const auto cell = [](const HtmlTable::Cell& c, const char* tag) {
    std::string html = std::string("<") + tag;
    if (c.text) html += " class=\"text\"";
    if (!c.sortKey.empty()) html += " data-sort=\"" + escapeHtml(c.sortKey) + "\"";
    return html + ">" + c.html + "</" + tag + ">";
  };
  std::string html = "<div class=\"scroll\"><table";
  if (table.sortable) html += " class=\"sortable\"";
  html += ">\n";
  if (!table.head.empty()) {
    html += "<thead><tr>";
    for (const HtmlTable::Cell& head : table.head) html += cell(head, "th");
    html += "</tr></thead>\n";
  }
  html += "<tbody>\n";
  for (const HtmlTable::Row& row : table.rows) {
    html += row.kind.empty() ? "<tr>" : "<tr class=\"" + row.kind + "\">";
    for (const HtmlTable::Cell& one : row.cells) html += cell(one, "td");
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace umbrick::tools
