// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/job.h"
#include "promin/instances.h"
#include "promin/load_scene.h"
#include "promin/math.h"

// Parts that the specifications of pictures (render_spec.h) and of rays (cast_spec.h) have in common.
namespace promin::work {

/// The largest time of a pose in seconds.
inline constexpr double kMaxTime = 1e9;

/// The user's choice of the scene's pose.
struct MotionOptions {
  /// Words that replace the names of animations: all of them, or none, for the pose of the nodes.
  static constexpr const char* kAll = "all";
  static constexpr const char* kNone = "none";

  /// Names or numbers of animations, or one of the words above; if empty, the first animation.
  std::vector<std::string> animations = {};
  /// The time in seconds; if empty, 0.
  std::optional<double> time_s = std::nullopt;
  /// True if animations start again after their end.
  bool loops = false;

  /// Returns whether the user chose a pose. Otherwise the scene has the pose of its nodes.
  bool any() const { return !animations.empty() || time_s; }
  bool chooses_all() const { return animations == std::vector<std::string>{kAll}; }
  bool chooses_none() const { return animations == std::vector<std::string>{kNone}; }

  bool operator==(const MotionOptions&) const = default;
};

/// The scene, its pose, its tree, and the options for tracing it.
struct TracingOptions {
  std::filesystem::path scene;
  LoadOptions load;
  MotionOptions motion;
  std::optional<std::string> builder;
  std::optional<std::filesystem::path> bvh;
  Instancing instances = Instancing::kAuto;

  // Each process chooses the following members, so they are not in a specification's file.

  std::optional<std::filesystem::path> stats;
  /// Name or index of the device.
  std::optional<std::string> device;
  /// True if no compiled kernels are kept on the disk or read from it.
  bool has_no_cache = false;
  /// Number of threads of the program and of a CPU device; if empty, each uses one thread per core.
  std::optional<uint32_t> threads;
  uint32_t repeat_count = 1;
  bool is_quiet = false;
  bool is_verbose = false;
};

/// Returns the input files. An output must not be one of them.
std::vector<std::filesystem::path> input_files(const TracingOptions& options);

/// Copies the choice of the tree to RendererOptions or CasterOptions.
template <typename Options>
void choose_tree(const TracingOptions& from, Options& to) {
  if (from.builder) to.builder = *from.builder;
  to.bvh = from.bvh;
  to.instances = from.instances;
}

/// The default for the smallest number of pieces of a job with enough work. If a process is killed, one piece is lost,
/// which is at most about an eighth of the work even if the piece costs twice the mean.
inline constexpr uint64_t kUsualPieces = 16;

/// The pieces into which work is divided, and the folder that stores them.
struct JobOptions {
  /// For pictures, the number of bands of rows of each picture, or the columns and rows of tiles; for rays, the number
  /// of pieces. Empty for the default.
  std::optional<uint32_t> pieces;
  std::optional<uvec2> tiles;

  // Each process chooses the following members.

  std::optional<std::filesystem::path> folder;
  /// The share of the pieces to make. If empty, all pieces are made, and then the output files.
  std::optional<jobs::Share> share;
};

/// Returns the file of the scene's tree from this builder. All processes of a job share the file, and the first of them
/// writes it (pack_scene_sharing).
std::filesystem::path shared_tree_file(const JobOptions& job, const std::string& builder);

}  // namespace promin::work
