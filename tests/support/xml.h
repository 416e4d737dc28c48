// Is a text well-formed?
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace umbrick {

/// What is wrong with the nesting of tags, the quotes of attributes or their identifiers (which must be unique); empty:
/// nothing. Knows elements, attributes, comments, <!...>, and takes what is between <script> or <style> and its end as
/// text.
inline std::string xmlFault(std::string_view text) {
  std::vector<std::string> open;
  std::set<std::string> ids;
  std::size_t at = 0;
  const auto fault = [&](const std::string& what) { return what + " at byte " + std::to_string(at); };
  while ((at = text.find('<', at)) != std::string_view::npos) {
    if (text.substr(at, 4) == "<!--") {
      at = text.find("-->", at);
      if (at == std::string_view::npos) return "a comment without an end";
      continue;
    }
    if (text.substr(at, 2) == "<!" || text.substr(at, 2) == "<?") {
      at = text.find('>', at);
      continue;
    }
    const bool closes = text.substr(at, 2) == "</";
    std::size_t place = at + (closes ? 2 : 1);
    std::string name;
    while (place < text.size() && (std::isalnum(static_cast<unsigned char>(text[place])) || text[place] == ':'))
      name += text[place++];
    if (name.empty()) return fault("a '<' that begins no tag");
    std::string attribute;
    while (place < text.size() && text[place] != '>') {
      const char c = text[place];
      if (c == '<') return fault("a tag in a tag");
      if (c == '"' || c == '\'') {
        const std::size_t end = text.find(c, place + 1);
        if (end == std::string_view::npos) return fault("a quote without an end");
        const std::string value(text.substr(place + 1, end - place - 1));
        if (value.find('<') != std::string::npos) return fault("a '<' in an attribute");
        if (attribute == "id=" && !ids.insert(value).second) return fault("the identifier " + value + " twice");
        place = end + 1;
        attribute.clear();
        continue;
      }
      if (std::isspace(static_cast<unsigned char>(c)))
        attribute.clear();
      else
        attribute += c;
      ++place;
    }
    if (place == text.size()) return fault("a tag without an end");
    const bool alone = text[place - 1] == '/';
    if (closes) {
      if (open.empty() || open.back() != name)
        return fault("</" + name + "> closes " + (open.empty() ? "nothing" : open.back()));
      open.pop_back();
    } else if (!alone) {
      open.push_back(name);
      if (name == "script" || name == "style") place = text.find("</" + name, place) - 1;
    }
    at = place + 1;
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

}  // namespace umbrick
