// Pictures: render, Renderer and reference.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

namespace umbrick::python {

void addDrawing(pybind11::module_& module);

}  // namespace umbrick::python
