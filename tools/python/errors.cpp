// SPDX-License-Identifier: Apache-2.0
#include "errors.h"

#include <regex>

#include "option_words.h"
#include "umbrick/core/error.h"
#include "umbrick/core/memory.h"

namespace umbrick::python {
namespace {
namespace py = pybind11;

// The exceptions live as long as the interpreter, as the translator does that raises them.
struct Exceptions {
  PyObject *error, *invalid, *io, *gl, *memory;
};

PyObject* newException(py::module_& module, const char* name, const char* doc, py::tuple bases) {
  const std::string full = "umbrick." + std::string(name);
  PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (!made) throw py::error_already_set();
  module.add_object(name, made);
  return made;
}

void raise(PyObject* type, const std::string& line) { PyErr_SetString(type, inKeywords(line).c_str()); }

}  // namespace

std::string inKeywords(const std::string& line) {
  static const std::regex option("--([a-z]+(-[a-z]+)*)");
  std::string out;
  auto from = line.cbegin();
  for (std::sregex_iterator match(line.begin(), line.end(), option), end; match != end; ++match) {
    out.append(from, (*match)[0].first);
    for (const char c : (*match)[1].str()) out += c == '-' ? '_' : c;
    from = (*match)[0].second;
  }
  return out.append(from, line.cend());
}

void addErrors(py::module_& module) {
  Exceptions made{};
  const auto builtin = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  made.error = newException(module, "Error", "Any error of Umbrick; the message is one line that names what is wrong.",
                            py::make_tuple(builtin(PyExc_Exception)));
  const py::object error = builtin(made.error);
  made.invalid = newException(module, "InvalidArgument", "The caller asked for the impossible.",
                              py::make_tuple(error, builtin(PyExc_ValueError)));
  made.io = newException(module, "IoError", "A file is missing, short, unwritable or not what it claims to be.",
                         py::make_tuple(error, builtin(PyExc_OSError)));
  made.gl = newException(module, "GlError", "There is no OpenGL context, or it failed.",
                         py::make_tuple(error, builtin(PyExc_RuntimeError)));
  made.memory = newException(module, "OutOfMemory", "A step would need more memory than there is.",
                             py::make_tuple(error, builtin(PyExc_MemoryError)));
  static const Exceptions exceptions = made;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const OptionsError& e) {
      raise(exceptions.invalid, tools::inOptionWords(e));
    } catch (const InvalidArgument& e) {
      raise(exceptions.invalid, tools::inOptionWords(e));
    } catch (const IoError& e) {
      raise(exceptions.io, tools::inOptionWords(e));
    } catch (const GlError& e) {
      raise(exceptions.gl, e.what());
    } catch (const MemoryError& e) {
      raise(exceptions.memory, e.what());
    } catch (const Error& e) {
      raise(exceptions.error, tools::inOptionWords(e));
    }
  });
}

}  // namespace umbrick::python
