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

/// The channels and metadata of an EXR from which compositors make mattes of objects and materials (Cryptomatte
/// specification 1.2, Psyop): ranks of ids and coverage, and the names of the ids.
struct Cryptomatte {
  /// CryptoObject00.R to 02.A and CryptoMaterial00.R to 02.A, two ranks each: id and coverage.
  std::vector<Channel> channels;
  /// Name, hash, conversion and manifest of both sets.
  Metadata metadata;
};

/// Returns the id of a name: the bits of a float that is computed by MurmurHash3. Its exponent is neither 0 nor 255, so
/// every id is a normal float.
PROMIN_EXPORT uint32_t cryptomatte_id(std::string_view name);

/// Returns the Cryptomatte of a picture that was rendered with AovSet::cryptomatte. Objects and materials without a
/// name are called "object N" and "material N". Those with the same name form one matte.
PROMIN_EXPORT Cryptomatte make_cryptomatte(const Scene& scene, const Aovs& aovs);

}  // namespace promin
