// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "cast_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
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
  /// Hits, or with --count counts.
  std::filesystem::path output;
  std::optional<std::filesystem::path> offsets;
  bool is_any = false;
  bool is_count = false;
  bool is_all = false;

  HitQuery query() const {
    if (is_all) return HitQuery::kAll;
    if (is_count) return HitQuery::kCount;
    return is_any ? HitQuery::kAny : HitQuery::kNearest;
  }
  std::vector<std::filesystem::path> outputs() const {
    return offsets ? std::vector{output, *offsets} : std::vector{output};
  }
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
                                options.output = w.text();
                              });
  table.add_flag("--any", "Ask only whether anything is hit: t is 0 then, and infinite on a miss", options.is_any);
  table.add_flag("--count", "Write how often each ray crosses a surface instead, as int32", options.is_count);
  table.add_flag("--all", "Write all hits of each ray instead, ray after ray, by t; needs --offsets", options.is_all);
  table.add("--offsets", "OFFSETS.npy",
            "With --all: N + 1 uint64, where in HITS.npy each ray's hits begin and the last one's end",
            [&](const OptionValues& w) { options.offsets = w.text(); });
  add_tracing_options(table, options.tracing);
  add_measuring_options(table, options.tracing);
}

void check_query(const CastOptions& options) {
  std::vector<std::string> asked;
  if (options.is_any) asked.emplace_back("--any");
  if (options.is_count) asked.emplace_back("--count");
  if (options.is_all) asked.emplace_back("--all");
  if (asked.size() > 1) {
    throw UsageError(
        {asked[0] + " and " + asked[1] + " ask for different things", "on the command line", "give one of them"});
  }
  if (options.is_all && !options.offsets) {
    throw UsageError({"--all is given without --offsets", "on the command line",
                      "add --offsets OFFSETS.npy, which tells the hits of each ray apart"});
  }
  if (options.offsets && !options.is_all) {
    throw UsageError({"--offsets is given without --all", "on the command line", "add --all or take it away"});
  }
}

void check_cast_options(const CastOptions& options) {
  check_tracing_options(options.tracing);
  check_query(options);
  for (const std::filesystem::path& output : options.outputs()) {
    if (lower_case_ending(output) != ".npy") {
      throw UsageError({"unknown output ending \"" + output.extension().string() + "\"", output.string(), "use .npy"});
    }
  }
  std::vector<std::filesystem::path> inputs = input_files(options.tracing);
  inputs.push_back(options.rays);
  check_outputs(inputs, options.outputs(), options.tracing.stats);
}

/// The file's next rays, at most kChunkRays; none at its end.
std::vector<Ray> read_chunk(RayReader& reader, uint64_t done) {
  std::vector<Ray> rays(static_cast<size_t>(std::min(kChunkRays, reader.count() - done)));
  reader.read(rays);
  return rays;
}

/// Gives hits the numbers that the file has for its objects.
void number_as_in_file(const Scene& scene, std::span<Hit> hits) {
  if (scene.object_numbers.empty()) return;
  for (Hit& hit : hits) {
    if (hit.object >= 0) hit.object = static_cast<int32_t>(object_number(scene, static_cast<uint32_t>(hit.object)));
  }
}

/// What a query makes of rays, chunk by chunk, and the files that it writes.
class Answers {
 public:
  virtual ~Answers() = default;
  /// Returns the milliseconds of tracing. What is traced with `is_last` is kept, or written as it comes.
  virtual double trace(std::span<const Ray> rays, bool is_last, const ProgressCallback& progress) = 0;
  /// Writes what was kept of the last chunk.
  virtual void write() = 0;
  virtual void commit() = 0;
  /// What is told of it beside the number of rays.
  virtual std::string summary() const { return ""; }
  /// The milliseconds that writing took within trace().
  virtual double write_ms() const { return 0.0; }
};

/// A hit for each ray: the nearest, or any.
class OneHitEach : public Answers {
 public:
  OneHitEach(const CastOptions& options, Caster& caster, const Scene& scene, uint64_t ray_count)
      : caster_(caster), scene_(scene), query_(options.query()), writer_(options.output, ray_count) {}
  double trace(std::span<const Ray> rays, bool /*is_last*/, const ProgressCallback& progress) override {
    hits_.resize(rays.size());
    return caster_.cast(rays, hits_, query_, progress);
  }
  void write() override {
    number_as_in_file(scene_, hits_);
    writer_.write(hits_);
  }
  void commit() override { writer_.commit(); }

 private:
  Caster& caster_;
  const Scene& scene_;
  HitQuery query_;
  HitWriter writer_;
  std::vector<Hit> hits_;
};

class Counts : public Answers {
 public:
  Counts(const CastOptions& options, Caster& caster, uint64_t ray_count)
      : caster_(caster), writer_(options.output, ray_count) {}
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

/// The hits are written while they are listed, as there may be any number of a chunk's.
class Lists : public Answers {
 public:
  Lists(const CastOptions& options, Caster& caster, const Scene& scene, uint64_t ray_count)
      : caster_(caster), scene_(scene), hit_writer_(options.output), offset_writer_(*options.offsets, ray_count + 1) {
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
    if (scene_.object_numbers.empty()) {
      hit_writer_.write(list.hits);
    } else {
      hits_.assign(list.hits.begin(), list.hits.end());
      number_as_in_file(scene_, hits_);
      hit_writer_.write(hits_);
    }
    offsets_.assign(list.offsets.begin() + 1, list.offsets.end());
    for (uint64_t& offset : offsets_) offset += hit_count_;
    offset_writer_.write(offsets_);
    hit_count_ += list.hits.size();
    write_ms_ += writing.ms();
  }

  Caster& caster_;
  const Scene& scene_;
  HitWriter hit_writer_;
  OffsetWriter offset_writer_;
  uint64_t hit_count_ = 0;
  double write_ms_ = 0.0;
  std::vector<Hit> hits_;
  std::vector<uint64_t> offsets_;
};

std::unique_ptr<Answers> make_answers(const CastOptions& options, Caster& caster, const Scene& scene,
                                      uint64_t ray_count) {
  if (options.is_all) return std::make_unique<Lists>(options, caster, scene, ray_count);
  if (options.is_count) return std::make_unique<Counts>(options, caster, ray_count);
  return std::make_unique<OneHitEach>(options, caster, scene, ray_count);
}

/// `rays` is the first chunk. Throws Cancelled if a signal asks for the end.
void answer_all(std::vector<Ray> rays, RayReader& reader, Answers& answers, const CastOptions& options, RunStats& stats,
                const Console& console, const DeferredSignals& signals) {
  const uint32_t repeats = options.tracing.repeat_count;
  stats.trace_ms.assign(repeats, 0.0);
  Progress progress(console.is_quiet());
  for (uint64_t done = 0; !rays.empty(); rays = read_chunk(reader, done)) {
    for (uint32_t i = 0; i < repeats; ++i) {
      if (signals.is_pending()) throw Cancelled();
      const auto tell = [&](double fraction) {
        const double chunk_share = static_cast<double>(rays.size()) * (i + fraction) / repeats;
        progress.update((static_cast<double>(done) + chunk_share) / static_cast<double>(reader.count()));
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

  // What is answered is written as it comes, to temporary files that a signal must not leave behind.
  const DeferredSignals while_writing;
  const std::unique_ptr<Answers> answers = make_answers(options, caster, scene, reader.count());
  try {
    answer_all(std::move(rays), reader, *answers, options, stats, console, while_writing);
  } catch (const Cancelled&) {
    return;  // the signal ends the program
  }
  check_validation(*device, stats);
  const Stopwatch commit;
  answers->commit();
  stats.write_ms += commit.ms();
  stats.total_ms = total.ms();
  tell_end(stats, console);
  if (tracing.stats) write_text_file(*tracing.stats, to_json(stats));
  if (!console.is_quiet()) {
    fmt::print("{} rays{} in {:.1f} ms ({:.3g} Mrays/s) on {}: {}\n", reader.count(), answers->summary(),
               stats.median_trace_ms(), stats.mrays_per_s(), stats.device.name,
               fmt::join(names_of(options.outputs()), ", "));
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
