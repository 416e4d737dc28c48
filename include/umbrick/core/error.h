// What the library throws. Messages name the file, the field, and the value found beside the value expected.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdexcept>

namespace umbrick {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The caller asked for the impossible: an option out of range, a grid that does not exist.
struct InvalidArgument : Error {
  using Error::Error;
};
/// A file is missing, short, unwritable or not what it claims to be.
struct IoError : Error {
  using Error::Error;
};
/// There is no OpenGL context, or a shader, texture or render target failed.
struct GlError : Error {
  using Error::Error;
};

}  // namespace umbrick
