// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/load_scene.h"

namespace promin {

/// Reads a glTF 2.0 file, text or GLB. Arguments, result and errors are as for load_scene().
Scene load_gltf(const LoadOptions& options, LoadReport& report);

}  // namespace promin
