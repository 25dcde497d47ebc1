// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/cast_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "commands/job_run.h"
#include "core/count_of.h"
#include "core/file.h"
#include "core/rounding.h"
#include "core/stopwatch.h"
#include "options/cast_options.h"
#include "options/spec_options.h"
#include "options/tracing_options.h"
#include "output/console.h"
#include "output/deferred_signals.h"
#include "output/outputs.h"
#include "output/progress.h"
#include "promin/caster.h"
#include "promin/error.h"
#include "rays/npy.h"
#include "work/jobs/cast_job.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace {

/// Returns whether the ray misses every scene (promin/ray.h).
bool misses_all(const Ray& ray) {
  return !is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == vec3(0.0F) ||
         !(std::max(ray.tmin, 0.0F) < ray.tmax) || std::isnan(ray.tmin);
}

/// Reads the rays of a file around a scene's center, chunk by chunk.
struct RayChunks {
  RayReader& reader;
  dvec3 center;
  /// Number of rays so far that miss every scene, and the index of the first such ray.
  uint64_t idle_count = 0;
  uint64_t first_idle = 0;

  /// Returns the next rays, at most kChunkRays; empty at the end of the file.
  std::vector<Ray> next(uint64_t done) {
    std::vector<Ray> rays(static_cast<size_t>(std::min(kChunkRays, reader.count() - done)));
    reader.read(rays, center);
    for (const Ray& ray : rays) {
      if (!misses_all(ray)) continue;
      if (idle_count++ == 0) first_idle = done + static_cast<uint64_t>(&ray - rays.data());
    }
    return rays;
  }
};

void warn_of_idle_rays(const RayChunks& chunks, const Console& console) {
  if (chunks.idle_count == 0) return;
  console.warn(
      fmt::format("{} of {} cannot hit anything; the first of them is number {}; a ray needs a direction that is not "
                  "0, tmin < tmax and no NaN",
                  chunks.idle_count, count_of(chunks.reader.count(), "ray"), chunks.first_idle));
}

/// The results of a query, chunk by chunk, and its files.
class Answers {
 public:
  virtual ~Answers() = default;
  /// Traces a chunk of rays and returns the milliseconds of tracing. The results of the last chunk (`is_last`) are
  /// kept, or written immediately.
  virtual double trace(std::span<const Ray> rays, bool is_last, const ProgressCallback& progress) = 0;
  /// Writes the kept results of the last chunk.
  virtual void write() = 0;
  virtual void commit() = 0;
  /// Returns a description for the summary, in addition to the number of rays.
  virtual std::string summary() const { return ""; }
  /// Returns the milliseconds that trace() spent on writing.
  virtual double write_ms() const { return 0.0; }
};

/// Results with one hit for each ray: the nearest hit or any hit.
class OneHitEach : public Answers {
 public:
  OneHitEach(const CastSpec& options, Caster& caster, uint64_t ray_count)
      : caster_(caster), query_(options.query()), writer_(*options.output, ray_count) {}
  double trace(std::span<const Ray> rays, bool /*is_last*/, const ProgressCallback& progress) override {
    hits_.resize(rays.size());
    return caster_.cast(rays, hits_, query_, progress);
  }
  void write() override { writer_.write(hits_); }
  void commit() override { writer_.commit(); }

 private:
  Caster& caster_;
  HitQuery query_;
  HitWriter writer_;
  std::vector<Hit> hits_;
};

class Counts : public Answers {
 public:
  Counts(const CastSpec& options, Caster& caster, uint64_t ray_count)
      : caster_(caster), writer_(*options.output, ray_count) {}
  double trace(std::span<const Ray> rays, bool /*is_last*/, const ProgressCallback& progress) override {
    counts_.resize(rays.size());
    return caster_.count(rays, counts_, progress);
  }
  void write() override { writer_.write(counts_); }
  void commit() override { writer_.commit(); }

 private:
  Caster& caster_;
  CountWriter writer_;
  std::vector<int32_t> counts_;
};

/// Lists of all hits. Hits are written while they are listed, because a chunk may have any number of them.
class Lists : public Answers {
 public:
  Lists(const CastSpec& options, Caster& caster, uint64_t ray_count)
      : caster_(caster), hit_writer_(*options.output), offset_writer_(*options.offsets, ray_count + 1) {
    offset_writer_.write(std::array{uint64_t{0}});
  }
  double trace(std::span<const Ray> rays, bool is_last, const ProgressCallback& progress) override {
    const auto take = [&](const HitList& list) {
      if (is_last) write(list);
    };
    return caster_.list(rays, take, Caster::kListBytes, progress);
  }
  void write() override {}
  void commit() override { ArrayWriter::commit_together({&hit_writer_, &offset_writer_}); }
  std::string summary() const override { return fmt::format(", {} hits", hit_count_); }
  double write_ms() const override { return write_ms_; }

 private:
  void write(const HitList& list) {
    const Stopwatch writing;
    hit_writer_.write(list.hits);
    offsets_.assign(list.offsets.begin() + 1, list.offsets.end());
    for (uint64_t& offset : offsets_) offset += hit_count_;
    offset_writer_.write(offsets_);
    hit_count_ += list.hits.size();
    write_ms_ += writing.ms();
  }

  Caster& caster_;
  HitWriter hit_writer_;
  OffsetWriter offset_writer_;
  uint64_t hit_count_ = 0;
  double write_ms_ = 0.0;
  std::vector<Hit> hits_;
  std::vector<uint64_t> offsets_;
};

std::unique_ptr<Answers> make_answers(const CastSpec& options, Caster& caster, uint64_t ray_count) {
  if (options.is_all) return std::make_unique<Lists>(options, caster, ray_count);
  if (options.is_count) return std::make_unique<Counts>(options, caster, ray_count);
  return std::make_unique<OneHitEach>(options, caster, ray_count);
}

/// Traces all rays; `rays` is the first chunk. Throws Cancelled after a signal.
void answer_all(std::vector<Ray> rays, RayChunks& chunks, Answers& answers, const CastSpec& options, RunStats& stats,
                const Console& console, const DeferredSignals& signals) {
  const uint32_t repeats = options.tracing.repeat_count;
  stats.trace_ms.assign(repeats, 0.0);
  Progress progress(console.is_quiet());
  for (uint64_t done = 0; !rays.empty(); rays = chunks.next(done)) {
    for (uint32_t i = 0; i < repeats; ++i) {
      if (signals.is_pending()) throw Cancelled();
      const auto tell = [&](double fraction) {
        const double chunk_share = static_cast<double>(rays.size()) * (i + fraction) / repeats;
        progress.update((static_cast<double>(done) + chunk_share) / static_cast<double>(chunks.reader.count()));
        return !signals.is_pending();
      };
      stats.trace_ms[i] += answers.trace(rays, i + 1 == repeats, tell);
    }
    const Stopwatch write;
    answers.write();
    stats.write_ms += write.ms();
    done += rays.size();
  }
  stats.write_ms += answers.write_ms();
}

/// Continues a job. If all pieces are done, writes the job's files.
void cast_job(const CastSpec& options, const Console& console) {
  RunStats stats;
  const JobSteps steps = {.open_device = [&] { return open_device_for(options.tracing, stats, console); },
                          .files = options.outputs()};
  run_job(*plan_rays(options, console), options.job, steps, console);
}

void cast(const CastSpec& options, bool prints_spec) {
  const Stopwatch total;
  const TracingOptions& tracing = options.tracing;
  const Console console(verbosity_of(tracing));
  check_cast_spec(options);
  if (prints_spec) return print_spec(options);
  std::vector<std::filesystem::path> inputs = input_files(tracing);
  inputs.push_back(options.rays);
  check_outputs(inputs, options.outputs(), tracing.stats);
  if (options.job.folder) {
    cast_job(options, console);
    return;
  }

  RunStats stats;
  RayReader reader(options.rays);
  std::vector<SourceFile> sources;
  const Scene scene = load_for(tracing, stats, console, sources);
  check_overwrites(files_of(sources), options.outputs(), tracing.stats);
  const gpu::DeviceHandle device = open_device_for(tracing, stats, console);
  CasterOptions caster_options;
  choose_tree(tracing, caster_options);
  Caster caster(*device, scene, caster_options);
  RayChunks chunks{reader, scene.center};
  std::vector<Ray> rays = chunks.next(0);
  caster.prepare(options.query(), rays);
  take_setup(caster.setup_stats(), *device, stats, console);
  (options.is_any ? stats.rays.shadow : stats.rays.primary) = reader.count();

  // Results are written immediately to temporary files, which must not remain after a signal.
  const DeferredSignals while_writing;
  const std::unique_ptr<Answers> answers = make_answers(options, caster, reader.count());
  try {
    answer_all(std::move(rays), chunks, *answers, options, stats, console, while_writing);
  } catch (const Cancelled&) {
    return;  // The signal ends the program.
  }
  check_validation(*device, stats);
  const Stopwatch commit;
  answers->commit();
  stats.write_ms += commit.ms();
  stats.total_ms = total.ms();
  warn_of_idle_rays(chunks, console);
  tell_end(stats, console);
  if (tracing.stats) write_text_file(*tracing.stats, to_json(stats));
  if (!console.is_quiet()) {
    fmt::print("{}{} in {:.1f} ms ({:.3g} Mrays/s) on {}: {}\n", count_of(reader.count(), "ray"), answers->summary(),
               stats.median_trace_ms(), stats.mrays_per_s(), stats.device.name,
               fmt::join(names_of(options.outputs()), ", "));
  }
}

}  // namespace

Command add_cast_command(CLI::App& program) {
  CLI::App& command = add_command(program, "cast", "Cast rays from a file into a scene and write their hits");
  const auto options = std::make_shared<CastSpec>();
  const auto prints_spec = std::make_shared<bool>(false);
  add_spec_option(command, *options);
  add_cast_options(command, *options);
  add_print_spec_option(command, *prints_spec);
  return {&command, [options, prints_spec] { cast(*options, *prints_spec); }};
}

}  // namespace promin::app
