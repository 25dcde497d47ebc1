// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// This plugin is of a future version and has only its number; a program that called more would crash.
#include "image/plugin/pictures.h"

uint32_t promin_pictures_interface() {
  return PROMIN_PICTURES_INTERFACE + 1;
}
