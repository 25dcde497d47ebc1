// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/missing_pieces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "core/count_of.h"
#include "promin/error.h"

namespace promin::work {
namespace {

/// The largest number of missing pieces that a message names.
constexpr size_t kMostNamed = 5;

/// Throws RunError if pieces are missing. `count` is the number of pieces that were checked.
void refuse_missing(const jobs::Job& job, const std::vector<size_t>& missing, size_t count) {
  if (missing.empty()) return;
  std::vector<std::string> names;
  for (size_t i = 0; i < std::min(missing.size(), kMostNamed); ++i) {
    std::string why;
    static_cast<void>(job.state_of(missing[i], &why));
    names.push_back(job.manifest().pieces[missing[i]] + (why.empty() ? "" : " (" + why + ")"));
  }
  throw RunError({"job.pieces.missing",
                  fmt::format("{} of {} {} missing or bad: {}{}", missing.size(), count_of(count, "piece"),
                              verb_of(missing.size(), "is", "are"), fmt::join(names, ", "),
                              missing.size() > kMostNamed ? ", …" : ""),
                  job.file_of(missing.front()).parent_path().string(), "run the job again to make the missing pieces"});
}

}  // namespace

void check_done(const jobs::Job& job, const std::vector<size_t>& pieces) {
  refuse_missing(job, jobs::keep_missing(job, pieces), pieces.size());
}

void check_whole(const jobs::Job& job) {
  refuse_missing(job, jobs::find_missing(job), job.piece_count());
}

}  // namespace promin::work
