// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks the symbols that promin's shared libraries export; all others are hidden. Exceptions are marked because a
/// program can catch them only if it shares the type's symbol with the library.
#define PROMIN_EXPORT __attribute__((visibility("default")))
