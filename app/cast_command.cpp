// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "cast_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <vector>

#include "console.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "deferred_signals.h"
#include "outputs.h"
#include "progress.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "rays/npy.h"
#include "tracing_run.h"

namespace promin::app {
namespace {

/// Rays in memory at a time.
constexpr uint64_t kChunkRays = uint64_t{1} << 20;

struct CastOptions {
  TracingOptions tracing;
  std::filesystem::path rays;
  std::filesystem::path hits;
  bool is_any = false;

  HitQuery query() const { return is_any ? HitQuery::kAny : HitQuery::kNearest; }
};

void add_cast_options(CLI::App& command, CastOptions& options) {
  OptionTable table(command);
  add_scene_argument(table, options.tracing);
  table.add_required("RAYS.npy", "", "NumPy array of N x 8 float32: origin xyz, tmin, direction xyz (any length), tmax",
                     [&](const OptionValues& w) { options.rays = w.text(); });
  table.add_required_repeated("-o,--output", "HITS.npy",
                              "NumPy array to write: t, object, primitive, u, v, normal of each ray's nearest hit",
                              [&](const OptionValues& w) {
                                if (w.all().size() > 1) w.refuse("--output takes one file here");
                                options.hits = w.text();
                              });
  table.add_flag("--any", "Ask only whether anything is hit: t is 0 then, and infinite on a miss", options.is_any);
  add_tracing_options(table, options.tracing);
  add_measuring_options(table, options.tracing);
}

void check_cast_options(const CastOptions& options) {
  check_tracing_options(options.tracing);
  if (lower_case_ending(options.hits) != ".npy") {
    throw UsageError(
        {"unknown output ending \"" + options.hits.extension().string() + "\"", options.hits.string(), "use .npy"});
  }
  std::vector<std::filesystem::path> inputs = input_files(options.tracing);
  inputs.push_back(options.rays);
  check_outputs(inputs, {options.hits}, options.tracing.stats);
}

/// The file's next rays, at most kChunkRays; none at its end.
std::vector<Ray> read_chunk(RayReader& reader, uint64_t done) {
  std::vector<Ray> rays(static_cast<size_t>(std::min(kChunkRays, reader.count() - done)));
  reader.read(rays);
  return rays;
}

/// Gives hits the numbers that the file has for its objects.
void number_as_in_file(const Scene& scene, std::vector<Hit>& hits) {
  if (scene.object_numbers.empty()) return;
  for (Hit& hit : hits) {
    if (hit.object >= 0) hit.object = static_cast<int32_t>(object_number(scene, static_cast<uint32_t>(hit.object)));
  }
}

/// `rays` is the first chunk. False if a signal asked for the end.
bool cast_all(std::vector<Ray> rays, RayReader& reader, HitWriter& writer, const Scene& scene, Caster& caster,
              const CastOptions& options, RunStats& stats, const Console& console, const DeferredSignals& signals) {
  const uint32_t repeats = options.tracing.repeat_count;
  stats.trace_ms.assign(repeats, 0.0);
  std::vector<Hit> hits;
  Progress progress(console.is_quiet());
  for (uint64_t done = 0; !rays.empty(); rays = read_chunk(reader, done)) {
    hits.resize(rays.size());
    for (uint32_t i = 0; i < repeats; ++i) {
      if (signals.is_pending()) return false;
      stats.trace_ms[i] += caster.cast(rays, hits, options.query());
      const double chunk_share = static_cast<double>(rays.size()) * (i + 1) / repeats;
      progress.update((static_cast<double>(done) + chunk_share) / static_cast<double>(reader.count()));
    }
    number_as_in_file(scene, hits);
    const Stopwatch write;
    writer.write(hits);
    stats.write_ms += write.ms();
    done += rays.size();
  }
  return true;
}

void cast(const CastOptions& options) {
  const Stopwatch total;
  const TracingOptions& tracing = options.tracing;
  check_cast_options(options);
  const Console console(tracing.verbosity());

  RunStats stats;
  RayReader reader(options.rays);
  const Scene scene = load_for(tracing, stats, console);
  const gpu::DeviceHandle device = open_device_for(tracing, stats, console);
  CasterOptions caster_options;
  choose_tree(tracing, caster_options);
  Caster caster(*device, scene, caster_options);
  std::vector<Ray> rays = read_chunk(reader, 0);
  caster.prepare(options.query(), rays);
  take_setup(caster.setup_stats(), stats, console);
  (options.is_any ? stats.rays.shadow : stats.rays.primary) = reader.count();

  // The hits are written as they come, to a temporary file that a signal must not leave behind.
  const DeferredSignals while_writing;
  HitWriter writer(options.hits, reader.count());
  if (!cast_all(std::move(rays), reader, writer, scene, caster, options, stats, console, while_writing)) return;
  check_validation(*device, stats);
  const Stopwatch commit;
  writer.commit();
  stats.write_ms += commit.ms();
  stats.total_ms = total.ms();
  tell_end(stats, console);
  if (tracing.stats) write_text_file(*tracing.stats, to_json(stats));
  if (!console.is_quiet()) {
    fmt::print("{} rays in {:.1f} ms ({:.3g} Mrays/s) on {}: {}\n", reader.count(), stats.median_trace_ms(),
               stats.mrays_per_s(), stats.device.name, options.hits.string());
  }
}

}  // namespace

Command add_cast_command(CLI::App& program) {
  CLI::App& command = add_command(program, "cast", "Answer rays from a file with hits");
  const auto options = std::make_shared<CastOptions>();
  add_cast_options(command, *options);
  return {&command, [options] { cast(*options); }};
}

}  // namespace promin::app
