// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// A plugin of a version to come, which has nothing but its number: whoever called more would crash.
#include "image/plugin/pictures.h"

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE + 1;
}
