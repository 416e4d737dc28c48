// What is measured: check and study; and transfer functions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

namespace umbrick::python {

void addMeasures(pybind11::module_& module);

}  // namespace umbrick::python
