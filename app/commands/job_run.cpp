// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/job_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>

#include "core/count_of.h"
#include "output/deferred_signals.h"
#include "output/outputs.h"
#include "output/progress.h"
#include "promin/error.h"
#include "work/jobs/build_id.h"
#include "work/jobs/fingerprint.h"
#include "work/jobs/merge_job.h"
#include "work/jobs/spec_job.h"
#include "work/spec/render_spec.h"

namespace promin::app {
namespace {

namespace fs = std::filesystem;

/// Throws UsageError if the job's first piece was made by another driver, because it has other bits.
void check_driver(const jobs::Job& job, const std::string& driver) {
  for (size_t piece = 0; piece < job.piece_count(); ++piece) {
    const std::optional<jobs::Maker> maker = job.maker_of(piece);
    if (!maker || maker->made_on.empty()) continue;
    if (maker->made_on == driver) return;
    throw UsageError(
        {"job.device.other",
         fmt::format("the job's pieces were made on {}, but the chosen device is {}", maker->made_on, driver),
         job.folder().string(), "select the first one with --device, or use another folder"});
  }
}

/// Throws UsageError if another build, which gives other bits, has made the job's pieces.
void check_bits(const jobs::Job& job, const jobs::Maker& own, PieceMaker& maker, const ProgressCallback& progress,
                const Console& console) {
  const auto make = [&](size_t piece) { return maker.make(piece, progress); };
  const std::optional<size_t> same = jobs::check_build(job, own, make);
  if (same) console.detail(fmt::format("made piece {} of another build again, with the same bits", *same));
}

/// Makes the missing pieces of a share. Returns their number; nullopt if a signal has ended the work early.
std::optional<size_t> make_share(const jobs::Job& job, PlannedJob& planned, const jobs::Share& share,
                                 const JobSteps& steps, const Console& console) {
  const std::vector<size_t> missing = jobs::find_missing(job, share);
  if (missing.empty()) return 0;
  const size_t all = job.piece_count();
  if (share.is_all() && missing.size() < all) {
    console.note(fmt::format("the job continues: {} of {} pieces are complete", all - missing.size(), all));
  }
  // After a signal, the work ends when the current piece is written, and the program ends at the end of this function.
  const DeferredSignals while_working;
  const gpu::DeviceHandle device = steps.open_device();
  const std::string driver = driver_of(gpu::info_of(*device));
  check_driver(job, driver);
  const jobs::Maker own{driver, "", build_id()};
  const auto tell_stopped = [&](size_t piece) {
    console.note(
        fmt::format("stopped before piece {} of {}; the same command continues the job", piece, job.piece_count()));
  };
  std::unique_ptr<PieceMaker> maker;
  try {
    const auto go_on = [&](double) { return !while_working.is_pending(); };
    maker = planned.open(*device, missing.size(), go_on);
    check_bits(job, own, *maker, go_on, console);
  } catch (const Cancelled&) {
    tell_stopped(missing.front());
    return {};
  }
  Progress progress(console.is_quiet());
  jobs::NextPiece at_hand;
  bool is_whole = true;
  const auto before = [&](const jobs::NextPiece& next) {
    if (while_working.is_pending()) {
      tell_stopped(next.number);
      is_whole = false;
      return false;
    }
    if (!next.why.empty()) {
      console.warn(fmt::format("{}: {}; promin makes it again", job.file_of(next.number).string(), next.why));
    }
    at_hand = next;
    return true;
  };
  const auto make = [&](size_t piece) {
    return maker->make(piece, [&](double fraction) {
      progress.update((static_cast<double>(at_hand.before) + fraction) / static_cast<double>(at_hand.total));
      return true;
    });
  };
  const size_t made = jobs::run_share(job, share, own, before, make);
  if (is_whole && while_working.is_pending())
    console.note("stopped after the last piece; the same command continues the job");
  return is_whole ? std::optional(made) : std::nullopt;
}

std::string describe_made(size_t made, size_t all) {
  if (made == 0) return fmt::format("all {} were made before", count_of(all, "piece"));
  return fmt::format("made {} of {} now", made, count_of(all, "piece"));
}

}  // namespace

std::string merge_job_deferring(const jobs::Job& job, const std::vector<fs::path>& outputs) {
  const DeferredSignals while_writing;
  std::string made = fmt::format("{}", fmt::join(names_of(outputs), ", "));
  try {
    const auto error = merge_job(job, outputs, [&](double) { return !while_writing.is_pending(); });
    if (error && error->unmet_pixels > 0) made += fmt::format(", error {}{}", error->target, describe_unmet(*error));
  } catch (const Cancelled&) {
    // From here on the signal can end the program.
  }
  return made;
}

void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console) {
  const jobs::Job job = [&] {
    // Signals are deferred while files are written, so that no temporary files remain.
    const DeferredSignals while_writing;
    return create_job(planned, *options.folder);
  }();
  steps.begin();
  const std::optional<size_t> made = make_share(job, planned, options.share.value_or(jobs::Share{}), steps, console);
  if (!made) return;
  if (options.share) {
    if (!console.is_quiet()) {
      fmt::print("{} made of {}, in {}\n", count_of(*made, "piece"), job.piece_count(), options.folder->string());
    }
    return;
  }
  const std::string outputs = merge_job_deferring(job, steps.files);
  if (!console.is_quiet()) fmt::print("{}: {}\n", describe_made(*made, job.piece_count()), outputs);
}

}  // namespace promin::app
