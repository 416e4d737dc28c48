// JSON that knows where it stands: a wrong value is reported with file, line, column and path.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace umbrick {
class JsonValue;

/// A parsed text. Its values are kept in one flat list, so nesting of any depth needs no stack.
class JsonDocument {
 public:
  /// @param source  what messages call the text, usually its file name
  /// @throw IoError  the text is not JSON (NaN, Infinity and comments are not), or an object has one key twice
  JsonDocument(std::string_view text, std::string source);
  JsonDocument(const JsonDocument&) = delete;
  JsonDocument& operator=(const JsonDocument&) = delete;

  /// Returns the outermost value. It lives as long as the document, as do the values below it.
  JsonValue root() const;
  /// How many arrays and objects are open at once where it is nested deepest. Who hands the text to a parser that needs
  /// stack for each looks at this before.
  std::size_t depth() const { return depth_; }
  /// Returns the value at a path such as `points[2].sigma_t` or, where the text leaves it out, the closest value that
  /// contains it.
  JsonValue closest(std::string_view path) const;

 private:
  friend class JsonValue;
  friend class JsonBuilder;
  enum class Kind { null, boolean, number, string, array, object };
  struct Node {
    Kind kind = Kind::null;
    std::size_t begin = 0;  // start of the value's text, bytes
    std::size_t parent = 0;
    std::string key;  // name in the parent, if that is an object
    double number = 0;
    bool boolean = false;
    std::string text;
    std::vector<std::size_t> children;
  };
  std::string where(std::size_t offset) const;  // returns "source:line:column"

  std::string text_, source_;
  std::size_t depth_ = 0;
  std::vector<Node> nodes_;  // the root first, and parents before their children
};

/// One value of a document. Each function that reads it throws an IoError that says where the value is, what was
/// expected and what was found.
class JsonValue {
 public:
  bool isNull() const;
  bool isString() const;
  bool isArray() const;
  bool isObject() const;

  double number() const;
  /// Reads a number that `accept` agrees to; `expected` completes the message "expected ..., found ...".
  template <typename Accept>
  double number(Accept accept, std::string_view expected) const {
    const double value = number();
    if (!accept(value)) failExpected(expected);
    return value;
  }
  /// Reads an angle written in degrees and returns it in radians. It is read with more digits than a double has, so
  /// that the text that jsonDegrees() writes for any angle comes back to the last bit.
  double degrees() const;
  int integer() const;
  std::uint64_t unsignedInteger() const;
  bool boolean() const;
  const std::string& string() const;
  /// A string that is one of a few names.
  const std::string& oneOf(const std::vector<std::string>& names) const;
  template <typename T>
  T choice(std::span<const std::pair<std::string_view, T>> names) const {
    const std::string& text = string();
    std::vector<std::string_view> known;
    for (const auto& [name, value] : names) {
      if (name == text) return value;
      known.push_back(name);
    }
    failUnknownChoice(known);
  }
  /// Returns the elements of an array, which must have exactly `count` of them when that is not 0.
  std::vector<JsonValue> items(std::size_t count = 0) const;
  std::vector<double> numbers(std::size_t count = 0) const;

  std::optional<JsonValue> find(std::string_view key) const;
  JsonValue at(std::string_view key) const;
  /// Refuses fields of other names and suggests the nearest one that exists.
  void allowFields(std::span<const std::string_view> keys) const;
  void allowFields(std::initializer_list<std::string_view> keys) const {
    allowFields(std::span(keys.begin(), keys.size()));
  }

  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void failExpected(std::string_view expected) const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument& document, std::size_t index) : document_(&document), index_(index) {}
  const JsonDocument::Node& node() const { return document_->nodes_[index_]; }
  std::string_view numberText() const;
  std::string path() const;
  std::string found() const;
  [[noreturn]] void failAt(const std::string& at, const std::string& message) const;
  [[noreturn]] void failUnknownChoice(const std::vector<std::string_view>& known) const;
  [[noreturn]] void failUnknownField(const std::vector<std::string_view>& known) const;

  const JsonDocument* document_;
  std::size_t index_;
};

}  // namespace umbrick
