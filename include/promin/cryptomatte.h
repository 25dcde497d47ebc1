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

/// The channels and the metadata of an EXR from which compositing programs make mattes of objects and materials
/// (Cryptomatte specification 1.2, Psyop). The channels hold ids and coverages; the metadata hold the names of the ids.
struct Cryptomatte {
  /// CryptoObject00.R to 02.A and CryptoMaterial00.R to 02.A. Each group of R, G, B and A holds two ranks: id,
  /// coverage, id, coverage.
  std::vector<Channel> channels;
  /// Name, hash, conversion and manifest of each of the two sets (objects, materials).
  Metadata metadata;
};

/// Returns the id of a name: the bits of a float that MurmurHash3 computes from the name. The float's exponent is
/// neither 0 nor 255, so every id is a normal float.
PROMIN_EXPORT uint32_t cryptomatte_id(std::string_view name);

/// Returns the Cryptomatte of a picture that was rendered with AovSet::cryptomatte. Objects and materials without a
/// name are called "object N" and "material N". Objects (or materials) with the same name form one matte.
PROMIN_EXPORT Cryptomatte make_cryptomatte(const Scene& scene, const Aovs& aovs);

}  // namespace promin
