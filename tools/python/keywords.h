// Keywords of a function: values of a dictionary, read with the line that says what is wrong with one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick::python {

class [[gnu::visibility("hidden")]] Keywords {
 public:
  explicit Keywords(pybind11::dict values) : values_(std::move(values)) {}

  bool has(const char* name) const { return values_.contains(name); }
  /// Returns the value of a keyword, or nothing where it is not given.
  /// @param expected  what it may be: "a number"
  /// @throw InvalidArgument  names keyword, what is expected and what was found
  template <class T>
  std::optional<T> get(const char* name, const char* expected) const {
    if (!has(name)) return std::nullopt;
    const pybind11::object value = values_[name];
    try {
      return value.cast<T>();
    } catch (const pybind11::cast_error&) {
      throw InvalidArgument(std::string(name) + ": expected " + expected + ", found " + shown(value));
    }
  }
  template <class T>
  void set(const char* name, const char* expected, T& target) const {
    if (auto value = get<T>(name, expected)) target = *std::move(value);
  }
  template <class T>
  void set(const char* name, const char* expected, std::optional<T>& target) const {
    if (auto value = get<T>(name, expected)) target = std::move(value);
  }
  /// Returns the value as it is, or None.
  pybind11::object raw(const char* name) const {
    return has(name) ? pybind11::object(values_[name]) : pybind11::object(pybind11::none());
  }
  /// Returns what a message says of a value.
  static std::string shown(const pybind11::handle& value);

 private:
  pybind11::dict values_;
};

/// What messages say that keywords may be.
inline constexpr const char *kNumber = "a number", *kWhole = "a whole number", *kText = "a string",
                            *kTruth = "True or False", *kThree = "three numbers";

}  // namespace umbrick::python
