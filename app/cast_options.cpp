// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "cast_options.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "arguments.h"
#include "core/file.h"
#include "promin/error.h"

namespace promin::app {

std::vector<std::filesystem::path> CastOptions::outputs() const {
  std::vector<std::filesystem::path> files;
  if (output) files.push_back(*output);
  if (offsets) files.push_back(*offsets);
  return files;
}

void add_cast_options(CLI::App& command, CastOptions& options) {
  OptionTable table(command);
  add_scene_argument(table, options.tracing);
  table.add_required("RAYS.npy", "",
                     "NumPy array of N x 8 float32 or float64: origin xyz, tmin, direction xyz (any length), tmax",
                     [&](const OptionValues& w) { options.rays = w.text(); });
  table.add_repeated("-o,--output", "HITS.npy",
                     "NumPy array to write: t, object, primitive, u, v, normal of each ray's nearest hit",
                     [&](const OptionValues& w) {
                       if (w.all().size() > 1) w.refuse("--output takes one file here");
                       options.output = w.text();
                     });
  table.add_flag("--any", "Report only whether a ray hits anything: t is 0 on a hit and infinite on a miss",
                 options.is_any);
  table.add_flag("--count", "Write the number of surfaces that each ray crosses, as int32, in place of hits",
                 options.is_count);
  table.add_flag("--all",
                 "Write all hits of each ray, ray by ray and sorted by t, in place of the nearest; needs --offsets",
                 options.is_all);
  table.add(
      "--offsets", "OFFSETS.npy",
      "With --all: N + 1 uint64 indices into HITS.npy, where the hits of each ray begin and those of the last ray end",
      [&](const OptionValues& w) { options.offsets = w.text(); });
  add_job_options(
      table, options.job,
      fmt::format(
          "With --job: number of pieces that the rays are divided into, 1 to {}; each piece is saved when it is done, "
          "so a kill loses at most one [{}; fewer for less than {} rays in all, more for over {}, with --all over {}]",
          kMostRayPieces, kUsualPieces, kUsualPieces * kLeastPieceRays, kUsualPieces * kPieceRays,
          kUsualPieces * kPieceRaysOfAll),
      kMostRayPieces);
  add_tracing_options(table, options.tracing);
  add_measuring_options(table, options.tracing);
}

namespace {

void check_query(const CastOptions& options) {
  std::vector<std::string> asked;
  if (options.is_any) asked.emplace_back("--any");
  if (options.is_count) asked.emplace_back("--count");
  if (options.is_all) asked.emplace_back("--all");
  if (asked.size() > 1) {
    throw UsageError(
        {"usage.options.contradict", asked[0] + " and " + asked[1] + " contradict each other", "", "give one of them"});
  }
  if (options.is_all && !options.offsets && !options.job.share) {
    throw UsageError({"usage.option.needs", "--all is given without --offsets", "",
                      "add --offsets OFFSETS.npy, which says where the hits of each ray begin"});
  }
  if (options.offsets && !options.is_all) {
    throw UsageError(
        {"usage.option.needs", "--offsets is given without --all", "", "add --all or leave --offsets out"});
  }
}

void check_job_options(const CastOptions& options) {
  check_has_job(options.job);
  if (!options.output && !options.job.share) {
    throw UsageError({"usage.option.required", "--output is required", "", "see promin cast --help"});
  }
  if (!options.job.folder) return;
  const std::pair<bool, std::string_view> others[] = {{options.tracing.stats.has_value(), "--stats"},
                                                      {options.tracing.repeat_count > 1, "--repeat"}};
  for (const auto& [is_given, name] : others) {
    if (!is_given) continue;
    throw UsageError(
        {"usage.options.contradict", fmt::format("--job and {} contradict each other", name), "", "leave one out"});
  }
  if (options.job.share && !options.outputs().empty()) {
    throw UsageError({"usage.options.contradict", "--piece and --output contradict each other: a share writes no file",
                      "", "leave one out; promin merge writes the file when all pieces are made"});
  }
}

}  // namespace

void check_arrays(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& file : files) {
    if (lower_case_ending(file) == ".npy") continue;
    throw UsageError({"output.ending", "the output's ending \"" + file.extension().string() + "\" is unknown",
                      file.string(), "use .npy"});
  }
}

void check_cast_options(const CastOptions& options) {
  check_tracing_options(options.tracing);
  check_query(options);
  check_job_options(options);
  check_arrays(options.outputs());
}

}  // namespace promin::app
