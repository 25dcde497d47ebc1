// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "jobs/job.h"
#include "promin/ray.h"

namespace promin::work {

/// A range of the rays of a file: from `begin` up to, but without, `end`.
struct RayRange {
  uint64_t begin = 0;
  uint64_t end = 0;

  uint64_t count() const { return end - begin; }
};

/// The description of a piece. The piece's bytes are hits or counts. With kAll, the hits are followed by an offset for
/// each ray: the number of hits up to the ray's end.
struct HitPiece {
  HitQuery query = HitQuery::kNearest;
  std::string driver;
  RayRange rays;
};

/// Returns the description as the text of a piece (docs/jobs.md).
std::string encode_hit_piece(const HitPiece& piece);
/// Reads the description of a piece and checks its bytes against it. Throws InputError.
HitPiece decode_hit_piece(const jobs::Content& content, const std::filesystem::path& file);

/// Returns a piece's bytes, or a part of them, as values of their type. They are aligned, because they begin at an
/// allocation or after hits.
template <typename Value>
std::span<const Value> values_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const Value*>(bytes.data()), bytes.size() / sizeof(Value)};
}

}  // namespace promin::work
