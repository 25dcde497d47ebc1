// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "promin/aovs.h"
#include "promin/export.h"
#include "promin/image.h"
#include "promin/scene.h"

namespace promin {

/// What an EXR carries for compositors to make mattes of objects and materials (Cryptomatte specification 1.2, Psyop):
/// ranks of ids and coverage, and the names that belong to the ids.
struct Cryptomatte {
  /// CryptoObject00.R to 02.A and CryptoMaterial00.R to 02.A, two ranks each: id and coverage.
  std::vector<Channel> channels;
  /// Name, hash, conversion and manifest of both.
  Metadata metadata;
};

/// The id of a name: the bits of the float that is its number, from MurmurHash3 with an exponent that is neither 0 nor
/// 255, so that every id is a normal float.
PROMIN_EXPORT uint32_t cryptomatte_id(std::string_view name);

/// Of a picture of the scene with AovSet::cryptomatte. Objects and materials without a name are "object N" and
/// "material N"; those of one name are one matte.
PROMIN_EXPORT Cryptomatte make_cryptomatte(const Scene& scene, const Aovs& aovs);

}  // namespace promin
