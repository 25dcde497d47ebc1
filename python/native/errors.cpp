// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "errors.h"

#include <nanobind/nanobind.h>

#include <exception>

#include "core/utf8.h"
#include "promin/error.h"

namespace nb = nanobind;

namespace promin::python {

nb::object to_text(std::string_view text) {
  return nb::steal(PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace"));
}

namespace {

void raise(const char* name, const Error& error) {
  nb::list problems;
  const auto to_line = [](const std::string& text) { return to_text(to_one_line(text)); };
  for (const Problem& problem : error.problems()) {
    problems.append(nb::make_tuple(to_text(problem.code.text()), to_line(problem.where), to_line(problem.what),
                                   to_line(problem.cure)));
  }
  const nb::object type = nb::module_::import_("promin._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(to_text(error.what()), problems).ptr());
}

void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const UsageError& error) {
    raise("UsageError", error);
  } catch (const InputError& error) {
    raise("InputError", error);
  } catch (const DeviceError& error) {
    raise("DeviceError", error);
  } catch (const DifferenceError& error) {
    raise("DifferenceError", error);
  } catch (const Cancelled& error) {
    raise("Cancelled", error);
  } catch (const RunError& error) {
    raise("RunError", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace

ForkError::ForkError()
    : std::runtime_error("the device was opened before a fork; open it in the child or start with spawn") {}

void register_errors() {
  nb::register_exception_translator(translate);
}

}  // namespace promin::python
