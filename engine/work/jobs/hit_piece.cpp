// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/hit_piece.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/json_text.h"
#include "promin/error.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Names of the queries, indexed by HitQuery.
constexpr std::array<std::string_view, 4> kQueryNames = {"nearest", "any", "count", "all"};

std::string_view name_of_query(HitQuery query) {
  return kQueryNames[static_cast<size_t>(query)];
}

}  // namespace

std::string encode_hit_piece(const HitPiece& piece) {
  const Json json = {{"driver", piece.driver},
                     {"query", name_of_query(piece.query)},
                     {"first_ray", piece.rays.begin},
                     {"rays", piece.rays.count()}};
  return json_text(json);
}

HitPiece decode_hit_piece(const jobs::Content& content, const fs::path& file) {
  const InputError bad(
      {"job.piece.kind", "the piece does not contain hits", file.string(), "remove it and run the job again"});
  HitPiece piece;
  try {
    const Json json = read_ordered_json(content.description);
    const auto query = std::ranges::find(kQueryNames, json.at("query").get<std::string>());
    if (query == kQueryNames.end()) throw bad;
    piece.query = static_cast<HitQuery>(query - kQueryNames.begin());
    piece.driver = json.at("driver").get<std::string>();
    piece.rays.begin = json.at("first_ray").get<uint64_t>();
    piece.rays.end = piece.rays.begin + json.at("rays").get<uint64_t>();
  } catch (const nlohmann::json::exception&) {
    throw bad;
  }
  const uint64_t count = piece.rays.count();
  const uint64_t bytes = content.bytes.size();
  bool is_whole = bytes == count * (piece.query == HitQuery::kCount ? sizeof(int32_t) : sizeof(Hit));
  if (piece.query == HitQuery::kAll) {
    uint64_t last = 0;
    is_whole = bytes / sizeof(uint64_t) >= count;
    if (is_whole && count > 0) std::memcpy(&last, &content.bytes[bytes - sizeof(last)], sizeof(last));
    is_whole = is_whole && bytes % sizeof(Hit) == count * sizeof(uint64_t) % sizeof(Hit) &&
               (bytes - count * sizeof(uint64_t)) / sizeof(Hit) == last;
  }
  if (!is_whole) throw bad;
  return piece;
}

}  // namespace promin::work
