// The tags of a data set by their names and types.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dicom/dicom_elements.h"

namespace umbrick {

/// The tags of a data set, or of an item in a sequence of it, which must outlive this.
class DicomTags {
 public:
  /// @param path  for messages
  DicomTags(const std::filesystem::path& path, const DicomElements& elements) : path_(path), elements_(elements) {}

  const std::filesystem::path& path() const { return path_; }
  std::string text(std::uint32_t tag) const;
  bool has(std::uint32_t tag) const { return !text(tag).empty(); }
  /// Numbers that are written as text or binary. @param count  how many there must be; 0: any
  /// @throw IoError  something else, or another count
  std::optional<std::vector<double>> numbers(std::uint32_t tag, const char* name, std::size_t count) const;
  double number(std::uint32_t tag, const char* name, double otherwise) const;
  /// A binary number of 16 bits.
  std::int64_t unsignedShort(std::uint32_t tag, std::int64_t otherwise) const;
  /// The items of a sequence, or none where there is no such sequence.
  const std::vector<DicomElements>& items(std::uint32_t tag) const;

 private:
  const std::filesystem::path& path_;
  const DicomElements& elements_;
};

}  // namespace umbrick
