// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks a symbol that promin's shared libraries export; all other symbols are hidden. Exception classes are marked
/// because a program can catch an exception only if it shares the symbol of its type with the library.
#define PROMIN_EXPORT __attribute__((visibility("default")))
