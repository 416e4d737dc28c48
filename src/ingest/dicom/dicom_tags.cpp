// SPDX-License-Identifier: Apache-2.0
#include "ingest/dicom/dicom_tags.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "ingest/header_text.h"

namespace umbrick {

std::string DicomTags::text(std::uint32_t tag) const {
  const DicomElement* element = findElement(elements_, tag);
  return element ? elementText(*element) : std::string();
}

std::optional<std::vector<double>> DicomTags::numbers(std::uint32_t tag, const char* name, std::size_t count) const {
  const std::string all = text(tag);
  if (all.empty()) return std::nullopt;
  std::vector<double> out;
  std::string_view rest = all;
  for (bool more = true; more;) {
    const std::size_t end = std::min(rest.find('\\'), rest.size());
    const auto parsed = umbrick::number(trimmed(rest.substr(0, end)));
    if (!parsed || !std::isfinite(*parsed)) break;
    out.push_back(*parsed);
    more = end < rest.size();
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (!rest.empty() || (count > 0 && out.size() != count))
    failField(path_, name, (count > 0 ? std::to_string(count) + " " : std::string()) + "finite numbers", all);
  return out;
}

double DicomTags::number(std::uint32_t tag, const char* name, double otherwise) const {
  const auto found = numbers(tag, name, 1);
  return found ? (*found)[0] : otherwise;
}

std::int64_t DicomTags::unsignedShort(std::uint32_t tag, std::int64_t otherwise) const {
  const DicomElement* element = findElement(elements_, tag);
  if (!element || element->value.size() < 2) return otherwise;
  const auto low = static_cast<unsigned char>(element->value[element->big ? 1 : 0]),
             high = static_cast<unsigned char>(element->value[element->big ? 0 : 1]);
  return low | high << 8;
}

const std::vector<DicomElements>& DicomTags::items(std::uint32_t tag) const {
  static const std::vector<DicomElements> kNone;
  const DicomElement* element = findElement(elements_, tag);
  return element ? element->items : kNone;
}

}  // namespace umbrick
