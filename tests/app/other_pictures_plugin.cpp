// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// This plugin has the interface number of a future version and no functions. A program that called a function would
// crash.
#include "image/plugin/pictures.h"

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE + 1;
}
