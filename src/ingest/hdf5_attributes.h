// The attributes of an object of an HDF5 file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace umbrick {

class Hdf5Attributes {
 public:
  /// @param object  must stay open  @param name  of the object, for messages
  Hdf5Attributes(hid_t object, std::string name) : object_(object), name_(std::move(name)) {}

  bool has(const char* key) const { return H5Aexists(object_, key) > 0; }
  /// All numbers of an attribute; none where it is not there.
  /// @param count  how many there must be; 0: any  @throw IoError  others, or no numbers
  std::vector<double> numbers(const char* key, std::size_t count) const;
  /// Whether there is a number for each axis that counts, or for each of the dataset.
  bool isForAxes(const char* key, std::size_t axes, std::size_t rank) const;
  /// @throw IoError  the attribute is there and is no finite number
  std::optional<double> number(const char* key) const;
  /// A text of fixed or of its own length; empty where there is none, or several.
  std::string string(const char* key) const;

 private:
  hid_t object_;
  std::string name_;
};

}  // namespace umbrick
