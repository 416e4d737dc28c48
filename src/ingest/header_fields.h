// The fields of a header written as text: a value by the name of its field.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/header_text.h"

namespace umbrick {

class HeaderFields {
 public:
  /// @param path  of the file, for messages
  explicit HeaderFields(std::filesystem::path path) : path_(std::move(path)) {}

  /// The later of two fields of one name counts.
  void set(const std::string& field, std::string_view value) { values_[field] = value; }
  bool has(const std::string& field) const { return values_.contains(field); }
  /// Empty for a field that is not there.
  std::string value(const std::string& field) const;
  /// @throw IoError  the field is not there
  std::string required(const std::string& field) const;
  /// The words of the value, of which there must be `count`. @throw IoError
  std::vector<std::string> list(const std::string& field, std::size_t count) const;

  const std::filesystem::path& path() const { return path_; }
  /// @throw IoError  "path: field: expected ..., found ..."
  [[noreturn]] void fail(const std::string& field, const std::string& expected, std::string_view found) const {
    failField(path_, field, expected, found);
  }

 private:
  std::filesystem::path path_;
  std::map<std::string, std::string> values_;
};

}  // namespace umbrick
