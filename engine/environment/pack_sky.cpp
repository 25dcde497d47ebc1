// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/pack_sky.h"

namespace promin {

PackedSky pack_sky(const Environment&) {
  return {};
}

}  // namespace promin
