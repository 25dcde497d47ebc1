// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::work {}

namespace promin::app {

// The programs turn options into the specifications of engine/work and use its functions by their own names.
using namespace work;

}  // namespace promin::app
