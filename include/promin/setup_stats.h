// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bvh/builder.h"
#include "scene/features.h"

namespace promin {

/// What setting a scene up on a device cost and made.
struct SetupStats {
  /// Building the tree, or reading and checking its file.
  double bvh_ms = 0.0;
  double upload_ms = 0.0;
  /// Pipeline creation and the first, compiling, dispatch.
  double pipeline_ms = 0.0;
  BvhStats bvh;
  /// Of the scene in device memory.
  uint64_t device_bytes = 0;
  FeatureMask features = 0;
};

}  // namespace promin
