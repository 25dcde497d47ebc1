// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/job.h"
#include "promin/load_scene.h"
#include "promin/math.h"

// Parts that the specifications of pictures (render_spec.h) and of rays (cast_spec.h) have in common.
namespace promin::work {

/// The scene, its tree, and the options for tracing it.
struct TracingOptions {
  std::filesystem::path scene;
  LoadOptions load;
  std::optional<std::string> builder;
  std::optional<std::filesystem::path> bvh;

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
