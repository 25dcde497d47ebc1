// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/error.h"

namespace promin::app {

/// Returns the sentence of a problem or error, with this command line's options in place of the library's settings.
std::string message_of(Problem problem);
std::string message_of(const Error& error);

}  // namespace promin::app
