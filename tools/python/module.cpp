// umbrick._core, what the package umbrick is made of: the library in C++ below functions and classes in Python.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>

#include "draw.h"
#include "errors.h"
#include "measure.h"
#include "picture.h"
#include "volume.h"

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = UMBRICK_VERSION;
  umbrick::python::addErrors(module);
  umbrick::python::addVolume(module);
  umbrick::python::addPicture(module);
  umbrick::python::addDrawing(module);
  umbrick::python::addMeasures(module);
}
