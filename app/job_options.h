// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "arguments.h"
#include "jobs/job.h"
#include "promin/math.h"

namespace promin::app {

/// The default for the smallest number of pieces of a job that has enough work. A kill loses one piece, which is at
/// most about an eighth of the work even if that piece costs twice the mean.
inline constexpr uint64_t kUsualPieces = 16;

/// How a command divides its work into pieces and saves them in a folder.
struct JobOptions {
  std::optional<std::filesystem::path> folder;
  /// For pictures the number of bands of rows of each, or the columns and rows of tiles; for rays the number of pieces.
  /// Empty for the default.
  std::optional<uint32_t> pieces;
  std::optional<uvec2> tiles;
  /// The share of the pieces to make. Without it all pieces are made, and then the files.
  std::optional<jobs::Share> share;
};

/// Adds the rows of --job, --pieces and --piece, with this help for --pieces and this largest value. `job` must outlive
/// the parsing.
void add_job_options(OptionTable& table, JobOptions& job, const std::string& pieces_help, uint32_t most_pieces);

/// Throws UsageError if --pieces, --tiles or --piece is given without a job.
void check_has_job(const JobOptions& job);

/// Returns the file of the scene's tree by this builder that all processes of a job share; the first of them writes it
/// (pack_scene_sharing).
std::filesystem::path shared_tree_file(const JobOptions& job, const std::string& builder);

}  // namespace promin::app
