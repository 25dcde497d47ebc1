// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::work {}

namespace promin::app {

// The programs convert options to the specifications of engine/work. They use its functions without the namespace.
using namespace work;

}  // namespace promin::app
