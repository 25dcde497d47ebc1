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

/// A job has so many pieces or more where nothing is asked for and its work is worth them: a kill loses one piece, and
/// that is about an eighth of the work or less, even where a piece costs twice the mean.
inline constexpr uint64_t kUsualPieces = 16;

/// How the work of a command is kept in pieces in a folder.
struct JobOptions {
  std::optional<std::filesystem::path> folder;
  /// Of pictures: bands of rows that each is cut into, or columns and rows of tiles. Of rays: pieces of all rays.
  /// Empty: as suits it.
  std::optional<uint32_t> pieces;
  std::optional<uvec2> tiles;
  /// What of the pieces is to be made; without it all, and then the files that are made of them.
  std::optional<jobs::Share> share;
};

/// Adds the rows of --job, --pieces and --piece with this help for --pieces, of which there are at most so many. `job`
/// must outlive the parsing.
void add_job_options(OptionTable& table, JobOptions& job, const std::string& pieces_help, uint32_t most_pieces);

/// Throws UsageError where one of --pieces, --tiles and --piece has no job to cut.
void check_has_job(const JobOptions& job);

/// Where all who work on a job find the tree of its scene by this builder, which the first of them puts there
/// (pack_scene_sharing).
std::filesystem::path shared_tree_file(const JobOptions& job, const std::string& builder);

}  // namespace promin::app
