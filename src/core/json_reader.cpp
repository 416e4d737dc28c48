// SPDX-License-Identifier: Apache-2.0
#include "core/json_reader.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "umbrick/core/error.h"
#include "umbrick/core/names.h"

namespace umbrick {
namespace {

// Counts the letters that must be inserted, removed or replaced to turn a into b; upper and lower case are alike.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const bool same =
          std::tolower(static_cast<unsigned char>(a[i])) == std::tolower(static_cast<unsigned char>(b[j]));
      const std::size_t replaced = diagonal + (same ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;  // bytes: enough to recognise the text
  if (text.size() <= kLongest) return "'" + text + "'";
  std::size_t length = kLongest;
  while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;  // whole characters
  return "'" + text.substr(0, length) + "...'";
}

// Returns nlohmann's message without the place that it names, which is not the one that we report, and without the
// text that it quotes: what is no JSON may be any file, and what stands there is nobody's business.
std::string reason(const std::string& what) {
  std::size_t begin = what.find("] ");
  begin = begin == std::string::npos ? 0 : begin + 2;
  if (what.compare(begin, 14, "parse error at") == 0) {
    const std::size_t colon = what.find(": ", begin);
    if (colon != std::string::npos) begin = colon + 2;
  }
  return what.substr(begin, what.find("; last read: ", begin) - begin);
}

}  // namespace

// Receives nlohmann's events. The parser does not say where a value starts. But it has checked the text up to the end
// of that value, so a walk over separators from the end of the previous value finds the start.
class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit JsonBuilder(JsonDocument& document) : document_(document) {}

  bool null() override {
    add(JsonDocument::Kind::null);
    return true;
  }
  bool boolean(bool value) override {
    document_.nodes_[add(JsonDocument::Kind::boolean)].boolean = value;
    return true;
  }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    document_.nodes_[add(JsonDocument::Kind::string)].text = value;
    return true;
  }
  bool binary(binary_t&) override { return false; }  // JSON as text has no binary values
  bool start_object(std::size_t) override {
    open(JsonDocument::Kind::object);
    return true;
  }
  bool start_array(std::size_t) override {
    open(JsonDocument::Kind::array);
    return true;
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    const std::size_t begin = nextToken();
    if (!open_.back().keys.insert(name).second) throw IoError(document_.where(begin) + ": a field is given twice");
    key_ = name;
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    throw IoError(document_.where(position > 0 ? position - 1 : 0) + ": not JSON: " + reason(error.what()));
  }

 private:
  struct Open {
    std::size_t index;
    std::set<std::string> keys;
  };

  // Returns the start of the next token, and moves end_ behind it.
  std::size_t nextToken() {
    const std::string& text = document_.text_;
    const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n,:", end_), text.size());
    end_ = begin;
    if (begin == text.size()) return begin;
    if (text[begin] == '"') {
      ++end_;
      while (end_ < text.size() && text[end_] != '"') end_ += text[end_] == '\\' ? 2 : 1;
      ++end_;
    } else if (std::string_view("{}[]").find(text[begin]) != std::string_view::npos) {
      ++end_;
    } else {
      end_ = std::min(text.find_first_of(" \t\r\n,:{}[]\"", begin), text.size());
    }
    return begin;
  }

  std::size_t add(JsonDocument::Kind kind) {
    const std::size_t index = document_.nodes_.size();
    JsonDocument::Node node;
    node.kind = kind;
    node.begin = nextToken();
    if (!open_.empty()) {
      node.parent = open_.back().index;
      document_.nodes_[node.parent].children.push_back(index);
      if (document_.nodes_[node.parent].kind == JsonDocument::Kind::object) node.key = std::move(key_);
    }
    document_.nodes_.push_back(std::move(node));
    return index;
  }
  bool number(double value) {
    document_.nodes_[add(JsonDocument::Kind::number)].number = value;
    return true;
  }
  void open(JsonDocument::Kind kind) {
    open_.push_back({add(kind), {}});
    document_.depth_ = std::max(document_.depth_, open_.size());
  }
  bool close() {
    nextToken();
    open_.pop_back();
    return true;
  }

  JsonDocument& document_;
  std::size_t end_ = 0;  // place behind the last token, bytes
  std::vector<Open> open_;
  std::string key_;
};

JsonDocument::JsonDocument(std::string_view text, std::string source) : text_(text), source_(std::move(source)) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);  // a byte-order mark
  JsonBuilder builder(*this);
  nlohmann::json::sax_parse(text_, &builder);
}

JsonValue JsonDocument::root() const { return {*this, 0}; }

JsonValue JsonDocument::closest(std::string_view path) const {
  JsonValue value = root();
  while (!path.empty()) {
    if (path.front() == '.') path.remove_prefix(1);
    if (path.front() == '[') {
      std::size_t index = 0;
      std::from_chars(path.data() + 1, path.data() + path.size(), index);
      if (!value.isArray() || index >= value.node().children.size()) break;
      value = {*this, value.node().children[index]};
      path.remove_prefix(path.find(']') + 1);
    } else {
      const std::string_view key = path.substr(0, path.find_first_of(".["));
      const std::optional<JsonValue> child = value.isObject() ? value.find(key) : std::nullopt;
      if (!child) break;
      value = *child;
      path.remove_prefix(key.size());
    }
  }
  return value;
}

std::string JsonDocument::where(std::size_t offset) const {
  const std::string_view before = std::string_view(text_).substr(0, offset);
  const std::size_t lineStart = before.rfind('\n') + 1;  // npos + 1 is 0, the start of the first line
  std::size_t column = 1;
  for (const char c : before.substr(lineStart))
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) ++column;  // counts characters, not bytes
  return source_ + ":" + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) + ":" +
         std::to_string(column);
}

bool JsonValue::isNull() const { return node().kind == JsonDocument::Kind::null; }
bool JsonValue::isString() const { return node().kind == JsonDocument::Kind::string; }
bool JsonValue::isArray() const { return node().kind == JsonDocument::Kind::array; }
bool JsonValue::isObject() const { return node().kind == JsonDocument::Kind::object; }

double JsonValue::number() const {
  if (node().kind != JsonDocument::Kind::number) failExpected("a number");
  return node().number;
}

std::string_view JsonValue::numberText() const {
  const std::string_view text = std::string_view(document_->text_).substr(node().begin);
  return text.substr(0, text.find_first_not_of("+-0123456789.eE"));
}

double JsonValue::degrees() const {
  number();
  const std::string_view text = numberText();
  long double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return static_cast<double>(value * (3.14159265358979323846 / 180.0L));
}

int JsonValue::integer() const {
  const double value = number();
  if (value != std::floor(value)) failExpected("a whole number");
  if (std::abs(value) > std::numeric_limits<int>::max()) failExpected("a whole number below 2147483648");
  return static_cast<int>(value);
}

std::uint64_t JsonValue::unsignedInteger() const {
  const double value = number();
  if (!(value >= 0 && value <= 9007199254740992.0 && value == std::floor(value)))
    failExpected("a whole number from 0 to 2^53");
  return static_cast<std::uint64_t>(value);
}

bool JsonValue::boolean() const {
  if (node().kind != JsonDocument::Kind::boolean) failExpected("true or false");
  return node().boolean;
}

const std::string& JsonValue::string() const {
  if (!isString()) failExpected("a string");
  return node().text;
}

std::vector<JsonValue> JsonValue::items(std::size_t count) const {
  if (!isArray() || (count > 0 && node().children.size() != count))
    failExpected(count > 0 ? "an array of " + std::to_string(count) : "an array");
  std::vector<JsonValue> values;
  values.reserve(node().children.size());
  for (const std::size_t child : node().children) values.push_back({*document_, child});
  return values;
}

std::vector<double> JsonValue::numbers(std::size_t count) const {
  std::vector<double> values;
  for (const JsonValue& item : items(count)) values.push_back(item.number());
  return values;
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  if (!isObject()) failExpected("an object");
  for (const std::size_t child : node().children)
    if (document_->nodes_[child].key == key) return JsonValue(*document_, child);
  return std::nullopt;
}

JsonValue JsonValue::at(std::string_view key) const {
  const std::optional<JsonValue> value = find(key);
  if (!value) fail("the field '" + std::string(key) + "' is missing");
  return *value;
}

const std::string& JsonValue::oneOf(const std::vector<std::string>& names) const {
  const std::string& text = string();
  if (std::find(names.begin(), names.end(), text) == names.end()) failUnknownChoice({names.begin(), names.end()});
  return text;
}

void JsonValue::allowFields(std::span<const std::string_view> keys) const {
  if (!isObject()) failExpected("an object");
  for (const std::size_t child : node().children)
    if (std::find(keys.begin(), keys.end(), document_->nodes_[child].key) == keys.end())
      JsonValue(*document_, child).failUnknownField({keys.begin(), keys.end()});
}

std::string JsonValue::path() const {
  std::vector<std::string> steps;
  for (std::size_t i = index_; i != 0; i = document_->nodes_[i].parent) {
    const JsonDocument::Node& parent = document_->nodes_[document_->nodes_[i].parent];
    if (parent.kind == JsonDocument::Kind::object) {
      steps.push_back("." + document_->nodes_[i].key);
    } else {
      const auto at = std::lower_bound(parent.children.begin(), parent.children.end(), i);
      steps.push_back("[" + std::to_string(at - parent.children.begin()) + "]");
    }
  }
  // Of a path that is nested beyond reason, the outermost and innermost steps are enough.
  constexpr std::size_t kSteps = 12;
  if (steps.size() > kSteps) {
    steps.erase(steps.begin() + kSteps / 2, steps.end() - kSteps / 2);
    steps.insert(steps.begin() + kSteps / 2, "...");
  }
  std::string path;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) path += *step;
  return path.starts_with('.') ? path.substr(1) : path;
}

std::string JsonValue::found() const {
  switch (node().kind) {
    case JsonDocument::Kind::null:
      return "null";
    case JsonDocument::Kind::boolean:
      return node().boolean ? "true" : "false";
    case JsonDocument::Kind::number:
      return std::string(numberText());
    case JsonDocument::Kind::string:
      return shortened(node().text);
    case JsonDocument::Kind::array:
      return "an array of " + std::to_string(node().children.size());
    case JsonDocument::Kind::object:
      return "an object";
  }
  return {};
}

void JsonValue::fail(const std::string& message) const { failAt(path(), message); }

void JsonValue::failAt(const std::string& at, const std::string& message) const {
  throw IoError(document_->where(node().begin) + ": " + (at.empty() ? "" : at + ": ") + message);
}

void JsonValue::failExpected(std::string_view expected) const {
  fail("expected " + std::string(expected) + ", found " + found());
}

void JsonValue::failUnknownChoice(const std::vector<std::string_view>& known) const {
  failExpected((known.size() > 1 ? "one of " : "") + joined({known.begin(), known.end()}));
}

void JsonValue::failUnknownField(const std::vector<std::string_view>& known) const {
  const std::string& name = node().key;
  const auto nearest = std::min_element(known.begin(), known.end(), [&](std::string_view a, std::string_view b) {
    return editDistance(name, a) < editDistance(name, b);
  });
  const bool near =
      nearest != known.end() && editDistance(name, *nearest) <= std::max<std::size_t>(1, (name.size() + 1) / 3);
  if (near) fail("unknown field; did you mean '" + std::string(*nearest) + "'?");
  // The text may be that of another file, whose fields are nobody's business.
  failAt(JsonValue(*document_, node().parent).path(),
         "unknown field; known are " + joined({known.begin(), known.end()}));
}

}  // namespace umbrick
