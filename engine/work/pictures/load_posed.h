// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "formats/source_file.h"
#include "promin/load_scene.h"
#include "promin/motion.h"
#include "promin/scene.h"
#include "work/spec/common_spec.h"

namespace promin::work {

/// Returns the pose that the user chose, by the names and numbers of the scene's animations. Without a choice the
/// result has no animations. Throws UsageError if an animation does not exist.
PoseChoice choose_pose(const Scene& scene, const MotionOptions& options);

/// Loads a scene and puts it into the pose that the user chose. Without a choice the scene keeps the pose of its nodes.
/// `sources` receives the scene's files as for load_scene(). Throws InputError, and UsageError if an animation does not
/// exist.
Scene load_posed(const std::filesystem::path& file, const LoadOptions& load, const MotionOptions& motion,
                 std::vector<SourceFile>& sources);

}  // namespace promin::work
