// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <stdexcept>
#include <string_view>

namespace promin::python {

/// Text that may quote a file's bytes or name, which need not be UTF-8: what is not is shown as \xNN.
nanobind::object to_text(std::string_view text);

/// What belongs to a process was used in a fork of it; a RuntimeError in Python.
struct ForkError : std::runtime_error {
  ForkError();
};

/// Has what the library throws raised as the class of the same name in promin._errors, with the same problems.
void register_errors();

}  // namespace promin::python
