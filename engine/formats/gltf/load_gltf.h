// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/load_scene.h"

namespace promin {

/// Reads glTF 2.0, as text or GLB whichever the file holds. See load_scene for what is promised.
Scene load_gltf(const LoadOptions& options, LoadReport& report);

}  // namespace promin
