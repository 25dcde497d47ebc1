// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <stdexcept>
#include <string_view>

namespace promin::python {

/// Returns a text that may quote a file's name or bytes, which need not be UTF-8. Bytes that are not UTF-8 become \xNN.
nanobind::object to_text(std::string_view text);

/// Thrown if an object of one process is used in a fork of the process. In Python it is a RuntimeError.
struct ForkError : std::runtime_error {
  ForkError();
};

/// Registers a translation of exceptions: an exception of the library becomes the class of the same name in
/// promin._errors, with the same problems.
void register_errors();

}  // namespace promin::python
