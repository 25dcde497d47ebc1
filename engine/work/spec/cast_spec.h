// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "promin/ray.h"
#include "work/spec/common_spec.h"

namespace promin::work {

/// The default for the largest number of rays of a job's piece: first without --all, then with --all, where a ray may
/// have any number of hits.
inline constexpr uint64_t kPieceRays = uint64_t{1} << 22;
inline constexpr uint64_t kPieceRaysOfAll = uint64_t{1} << 20;
/// The smallest number of rays of a piece if a job is divided into kUsualPieces.
inline constexpr uint64_t kLeastPieceRays = uint64_t{1} << 16;
inline constexpr uint32_t kMostRayPieces = 1'000'000;
/// The number of rays in memory at a time.
inline constexpr uint64_t kChunkRays = uint64_t{1} << 20;

/// A specification of hits of rays with a scene. spec_json.h reads and writes it as JSON.
struct CastSpec {
  TracingOptions tracing;
  std::filesystem::path rays;
  JobOptions job;
  /// The file for hits; with --count the file for counts.
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> offsets;
  bool is_any = false;
  bool is_count = false;
  bool is_all = false;

  HitQuery query() const {
    if (is_all) return HitQuery::kAll;
    if (is_count) return HitQuery::kCount;
    return is_any ? HitQuery::kAny : HitQuery::kNearest;
  }
  /// Returns the output files that are given: hits and their offsets.
  std::vector<std::filesystem::path> outputs() const;
};

}  // namespace promin::work
