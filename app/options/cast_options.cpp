// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/cast_options.h"

#include <fmt/format.h>

#include <string>

#include "options/arguments.h"
#include "options/job_options.h"
#include "options/tracing_options.h"

namespace promin::app {

void add_cast_options(CLI::App& command, CastSpec& options) {
  OptionTable table(command);
  add_scene_argument(table, options.tracing);
  table.add_required("RAYS.npy", "",
                     "NumPy file with an array of N x 8 float32 or float64 numbers: origin xyz, tmin, direction xyz "
                     "(any length), tmax",
                     [&](const OptionValues& w) { options.rays = w.text(); });
  table.add_repeated("-o,--output", "HITS.npy",
                     "NumPy file to write: t, object, primitive, u, v and normal of each ray's nearest hit",
                     [&](const OptionValues& w) {
                       if (w.all().size() > 1) w.refuse("--output takes only one file here");
                       options.output = w.text();
                     });
  table.add_flag("--any", "Report only whether a ray hits anything. t is 0 on a hit and infinite on a miss",
                 options.is_any);
  table.add_flag("--count", "Write the number of surfaces that each ray crosses, as int32, instead of hits",
                 options.is_count);
  table.add_flag("--all",
                 "Write all hits of each ray instead of the nearest hit. They are ordered by ray, then by t. This "
                 "option needs --offsets",
                 options.is_all);
  table.add("--offsets", "OFFSETS.npy",
            "With --all: file for N + 1 uint64 numbers. Number i is the index of the first hit of ray i in HITS.npy. "
            "The last number is the number of hits",
            [&](const OptionValues& w) { options.offsets = w.text(); });
  add_job_options(table, options.job,
                  fmt::format("With --job: number of pieces to divide the rays into, 1 to {}. Each piece is saved when "
                              "it is complete, so at most one is lost if the program is killed [{}; fewer for less "
                              "than {} rays in all, more for over {}, with --all over {}]",
                              kMostRayPieces, kUsualPieces, kUsualPieces * kLeastPieceRays, kUsualPieces * kPieceRays,
                              kUsualPieces * kPieceRaysOfAll),
                  kMostRayPieces);
  add_tracing_options(table, options.tracing);
  add_measuring_options(table, options.tracing);
}

}  // namespace promin::app
