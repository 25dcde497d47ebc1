// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// This file replaces embree.cpp in builds without Embree.
#include "measure/embree.h"

namespace promin::measure {

std::string embree_version() {
  return {};
}

std::unique_ptr<EmbreeCaster> make_embree_caster(const world::Scene&) {
  return nullptr;
}

}  // namespace promin::measure
