// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin thumbnail`, which writes a thumbnail for file managers.
Command add_thumbnail_command(CLI::App& program);

/// Adds `promin contact-sheet`, which writes one picture of many files, each with its name.
Command add_contact_sheet_command(CLI::App& program);

}  // namespace promin::app
