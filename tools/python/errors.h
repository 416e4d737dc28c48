// The library's errors as Python exceptions, in the words of Python's keywords.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <exception>
#include <string>

namespace umbrick::python {

/// Makes the exceptions part of the module and translates what the library throws to them:
///   Error            every error of the library
///   InvalidArgument  (also a ValueError) the caller asked for the impossible
///   IoError          (also an OSError) a file is missing, unwritable or not what it claims to be
///   GlError          (also a RuntimeError) there is no OpenGL context, or it failed
///   OutOfMemory      (also a MemoryError) a step would need more memory than there is
void addErrors(pybind11::module_& module);

/// Returns a line in which options are keywords: "max_error" of "--max-error".
std::string inKeywords(const std::string& line);

}  // namespace umbrick::python
