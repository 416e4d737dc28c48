// Tables of numbers as text, with commas between them and names above (CSV), as kits for other renderers have them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace umbrick {

/// Returns the shortest text that reads back as the same number; "nan", "inf" and "-inf" for what is not finite.
std::string tableNumber(double number);

class KitTable {
 public:
  /// Reads a table. Blanks around fields, empty lines and a carriage return at the end of a line do not matter.
  /// @throw IoError  the file cannot be read, has no names above, or a line has another number of fields
  explicit KitTable(const std::filesystem::path& path);
  KitTable(const KitTable&) = delete;
  KitTable& operator=(const KitTable&) = delete;

  std::size_t rows() const { return lines_.size(); }
  /// Returns the numbers below a name. @throw IoError  there is no such name, or a field is no number: names the line
  std::vector<double> column(std::string_view name) const;
  /// The same, of whole numbers. @throw IoError  also where one is not whole
  std::vector<long> wholeColumn(std::string_view name) const;

 private:
  std::filesystem::path path_;
  std::string text_;
  std::vector<std::string_view> names_;
  std::vector<std::vector<std::string_view>> lines_;
  std::vector<std::size_t> numbers_;  // of the lines, from 1
};

}  // namespace umbrick
