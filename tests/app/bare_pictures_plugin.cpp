// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// A plugin of the right interface that has lost its functions.
#include "image/plugin/pictures.h"

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE;
}
