// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what promin's shared libraries show; the rest of them is compiled hidden. Exceptions carry the mark because a
/// program catches what the library throws only where both know the type by one name.
#define PROMIN_EXPORT __attribute__((visibility("default")))
