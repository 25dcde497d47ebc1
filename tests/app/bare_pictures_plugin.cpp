// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// This plugin has the right interface number but none of the functions.
#include "image/plugin/pictures.h"

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE;
}
