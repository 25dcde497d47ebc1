// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace promin::python {

/// What belongs to a process was used in a fork of it; a RuntimeError in Python.
struct ForkError : std::runtime_error {
  ForkError();
};

/// Has what the library throws raised as the class of the same name in promin._errors, with the same sentences.
void register_errors();

}  // namespace promin::python
