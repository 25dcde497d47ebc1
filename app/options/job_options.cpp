// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/job_options.h"

#include <fmt/format.h>

namespace promin::app {
namespace {

constexpr uint32_t kMostShares = 1000000;

jobs::Share read_share(const OptionValues& words) {
  const std::string& text = words.text();
  const size_t slash = text.find('/');
  if (slash == std::string::npos) words.refuse(fmt::format("--piece takes I/N, such as 0/4, not \"{}\"", text));
  const OptionValues numbers = words.with({text.substr(0, slash), text.substr(slash + 1)});
  const uint32_t count = numbers.whole(1, 1, kMostShares);
  return {numbers.whole(0, 0, count - 1), count};
}

}  // namespace

void add_job_options(OptionTable& table, JobOptions& job, const std::string& pieces_help, uint32_t most_pieces) {
  table.add("--job", "DIR",
            "Save the finished pieces of the work in this folder. If the program is interrupted, the same command "
            "continues the work",
            [&](const OptionValues& w) { job.folder = w.text(); });
  table.add("--pieces", "N", pieces_help,
            [&job, most_pieces](const OptionValues& w) { job.pieces = w.whole(0, 1, most_pieces); });
  table.add("--piece", "I/N",
            "With --job: make only every N-th piece, starting with piece I, and do not write the outputs. promin merge "
            "writes them when all pieces are made",
            [&](const OptionValues& w) { job.share = read_share(w); });
}

}  // namespace promin::app
