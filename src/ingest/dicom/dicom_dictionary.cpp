// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_dictionary.h"

#include <gdcmDict.h>
#include <gdcmDicts.h>
#include <gdcmGlobal.h>

#include <cctype>
#include <cstdio>
#include <map>
#include <utility>

#include "ingest/header_text.h"

namespace umbrick {
namespace {

struct Entry {
  std::array<char, 2> kind{'U', 'N'};
  std::string keyword;
};

// The kinds whose values are numbers, bytes or items; all others are texts. GDCM's own names of them end the program
// where a tag may be of two kinds, "US or SS", which is the first of them here.
std::array<char, 2> kindOf(gdcm::VR::VRType type) {
  using gdcm::VR;
  constexpr std::pair<VR::VRType, const char*> kKinds[] = {
      {VR::SQ, "SQ"}, {VR::US, "US"}, {VR::SS, "SS"}, {VR::UL, "UL"}, {VR::SL, "SL"}, {VR::FL, "FL"},
      {VR::FD, "FD"}, {VR::AT, "AT"}, {VR::OB, "OB"}, {VR::OW, "OW"}, {VR::OF, "OF"}, {VR::UN, "UN"}};
  for (const auto& [kind, name] : kKinds)
    if (type & kind) return {name[0], name[1]};
  return {'L', 'O'};
}

// GDCM's own search by keyword goes through all entries.
struct Dictionary {
  std::map<std::uint32_t, Entry> byTag;
  std::map<std::string, std::uint32_t> byKeyword;  // in lower case

  Dictionary() {
    const gdcm::Dict& dict = gdcm::Global::GetInstance().GetDicts().GetPublicDict();
    for (auto entry = dict.Begin(); entry != dict.End(); ++entry) {
      const std::uint32_t tag = entry->first.GetElementTag();
      const std::string keyword = entry->second.GetKeyword();
      byTag[tag] = {kindOf(entry->second.GetVR()), keyword};
      if (!keyword.empty()) byKeyword.emplace(lower(keyword), tag);
    }
  }
};

const Dictionary& dictionary() {
  static const Dictionary kDictionary;
  return kDictionary;
}

}  // namespace

std::array<char, 2> dicomKind(std::uint32_t tag) {
  const auto found = dictionary().byTag.find(tag);
  return found == dictionary().byTag.end() ? std::array<char, 2>{'U', 'N'} : found->second.kind;
}

std::string dicomKeyword(std::uint32_t tag) {
  const auto found = dictionary().byTag.find(tag);
  if (found != dictionary().byTag.end() && !found->second.keyword.empty()) return found->second.keyword;
  char text[16];
  std::snprintf(text, sizeof text, "(%04x,%04x)", tag >> 16, tag & 0xffffu);
  return text;
}

std::optional<std::uint32_t> dicomTag(const std::string& name) {
  std::string text = lower(trimmed(name));
  const auto found = dictionary().byKeyword.find(text);
  if (found != dictionary().byKeyword.end()) return found->second;
  if (text.size() == 11 && text.front() == '(' && text.back() == ')') text = text.substr(1, 9);
  if (text.size() != 9 || text[4] != ',') return std::nullopt;
  std::uint32_t tag = 0;
  for (const char c : text) {
    if (c == ',') continue;
    if (!std::isxdigit(static_cast<unsigned char>(c))) return std::nullopt;
    tag = tag << 4 | static_cast<std::uint32_t>(c <= '9' ? c - '0' : c - 'a' + 10);
  }
  return tag;
}

}  // namespace umbrick
