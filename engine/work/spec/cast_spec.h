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

/// The default for the largest number of rays of a job's piece, without --all and with it, where there may be any
/// number of hits.
inline constexpr uint64_t kPieceRays = uint64_t{1} << 22;
inline constexpr uint64_t kPieceRaysOfAll = uint64_t{1} << 20;
/// The smallest number of rays of a piece when dividing into kUsualPieces.
inline constexpr uint64_t kLeastPieceRays = uint64_t{1} << 16;
inline constexpr uint32_t kMostRayPieces = 1'000'000;
/// Rays in memory at a time.
inline constexpr uint64_t kChunkRays = uint64_t{1} << 20;

/// The hits that are requested of a scene and rays. spec_json.h reads and writes it as JSON.
struct CastSpec {
  TracingOptions tracing;
  std::filesystem::path rays;
  JobOptions job;
  /// The file for hits, or with --count for counts.
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
  /// Returns the files of hits and of their offsets, as far as given.
  std::vector<std::filesystem::path> outputs() const;
};

}  // namespace promin::work
