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

// The common parts of the specifications of pictures (render_spec.h) and of rays (cast_spec.h).
namespace promin::work {

/// The scene, its tree, and how a process traces it.
struct TracingOptions {
  std::filesystem::path scene;
  LoadOptions load;
  std::optional<std::string> builder;
  std::optional<std::filesystem::path> bvh;

  // Each process chooses these; they are no members of a specification's file.

  std::optional<std::filesystem::path> stats;
  /// Name or index of a device.
  std::optional<std::string> device;
  /// Number of threads of the program and of a CPU device; without it each uses one per core.
  std::optional<uint32_t> threads;
  uint32_t repeat_count = 1;
  bool is_quiet = false;
  bool is_verbose = false;
};

/// Returns the input files, none of which may be an output.
std::vector<std::filesystem::path> input_files(const TracingOptions& options);

/// Copies the choice of the tree to RendererOptions or CasterOptions.
template <typename Options>
void choose_tree(const TracingOptions& from, Options& to) {
  if (from.builder) to.builder = *from.builder;
  to.bvh = from.bvh;
}

/// The default for the smallest number of pieces of a job that has enough work. A kill loses one piece, which is at
/// most about an eighth of the work even if that piece costs twice the mean.
inline constexpr uint64_t kUsualPieces = 16;

/// The pieces that work is divided into, and the folder that keeps them.
struct JobOptions {
  /// For pictures the number of bands of rows of each, or the columns and rows of tiles; for rays the number of pieces.
  /// Empty for the default.
  std::optional<uint32_t> pieces;
  std::optional<uvec2> tiles;

  // Each process chooses these.

  std::optional<std::filesystem::path> folder;
  /// The share of the pieces to make. Without it all pieces are made, and then the files.
  std::optional<jobs::Share> share;
};

/// Returns the file of the scene's tree by this builder that all processes of a job share; the first of them writes it
/// (pack_scene_sharing).
std::filesystem::path shared_tree_file(const JobOptions& job, const std::string& builder);

}  // namespace promin::work
