// SPDX-License-Identifier: Apache-2.0
#include "ingest/header_fields.h"

namespace umbrick {

std::string HeaderFields::value(const std::string& field) const {
  const auto found = values_.find(field);
  return found == values_.end() ? std::string() : found->second;
}

std::string HeaderFields::required(const std::string& field) const {
  if (!has(field)) fail(field, "the field", "");
  return value(field);
}

std::vector<std::string> HeaderFields::list(const std::string& field, std::size_t count) const {
  std::vector<std::string> values = words(value(field));
  if (values.size() != count) fail(field, std::to_string(count) + " values", value(field));
  return values;
}

}  // namespace umbrick
