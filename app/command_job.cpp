// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "command_job.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include "arguments.h"
#include "cast_job.h"
#include "cast_options.h"
#include "core/count_of.h"
#include "deferred_signals.h"
#include "fingerprint.h"
#include "job_words.h"
#include "merge_job.h"
#include "picture_job.h"
#include "progress.h"
#include "promin/error.h"
#include "render_job.h"
#include "render_options.h"

namespace promin::app {
namespace {

namespace fs = std::filesystem;

/// Parses arguments of the command of this name.
void parse(CLI::App& program, const CLI::App& command, const std::vector<std::string>& arguments) {
  check_asks_for_work(arguments);
  const std::string name = command.get_name();
  std::vector<const char*> words = {"promin", name.c_str()};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  static_cast<void>(parse_arguments(program, static_cast<int>(words.size()), words.data()));
  check_is_kept(given_options(command));
}

/// Refuses another driver, because its pieces have other bits.
void check_driver(const jobs::Job& job, const std::string& driver) {
  const std::string of_pieces = find_driver(job);
  if (of_pieces.empty() || of_pieces == driver) return;
  throw UsageError({"job.device.other",
                    fmt::format("the job's pieces were made on {}, and the chosen device is {}", of_pieces, driver),
                    job.folder().string(), "choose the first one by --device, or name another folder"});
}

/// Makes the missing pieces of a share. Returns their number, or nothing if a signal has ended it before.
std::optional<size_t> make_share(const jobs::Job& job, PlannedJob& planned, const jobs::Share& share,
                                 const JobSteps& steps, const Console& console) {
  const std::vector<size_t> missing = jobs::find_missing(job, share);
  if (missing.empty()) return 0;
  // A signal ends the work after the current piece is written, and the program at the end of this function.
  const DeferredSignals while_working;
  const gpu::DeviceHandle device = steps.open_device();
  const std::string driver = driver_of(gpu::info_of(*device));
  check_driver(job, driver);
  const auto tell_stopped = [&](size_t piece) {
    console.note(
        fmt::format("stopped before piece {} of {}; the same command continues the job", piece, job.piece_count()));
  };
  std::unique_ptr<PieceMaker> maker;
  try {
    maker = planned.open(*device, missing.size(), [&](double) { return !while_working.is_pending(); });
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
      console.warn(fmt::format("{}: {}; it is made again", job.file_of(next.number).string(), next.why));
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
  const size_t made = jobs::run_share(job, share, {driver, ""}, before, make);
  if (is_whole && while_working.is_pending())
    console.note("stopped after the last piece; the same command continues the job");
  return is_whole ? std::optional(made) : std::nullopt;
}

std::string describe_made(size_t made, size_t all) {
  if (made == 0) return fmt::format("all {} were made before", count_of(all, "piece"));
  return fmt::format("made {} of {} now", made, count_of(all, "piece"));
}

}  // namespace

std::unique_ptr<PlannedJob> plan_job(const std::string& kind, const std::vector<std::string>& arguments,
                                     const fs::path& folder, const Console& console, std::shared_ptr<RaySource> rays) {
  CLI::App program("", "promin");
  // Parses words to options with the functions that add the options to a command.
  const auto parse_to = [&](auto& options, const auto& add_options) -> CLI::App& {
    CLI::App& command = add_command(program, kind, "");
    add_options(command, options);
    parse(program, command, arguments);
    options.job.folder = folder;
    // A share needs no output files.
    options.job.share = jobs::Share{};
    return command;
  };
  if (kind == kPictureJob) {
    if (rays != nullptr) throw UsageError({"job.rays.none", "a job of pictures has no rays", "", "leave the rays out"});
    RenderOptions options;
    const CLI::App& command = parse_to(options, add_render_options);
    check_render_options(options);
    return plan_pictures(prepare_pictures(options, plan_frames(options), console), command, console);
  }
  if (kind == kRayJob) {
    CastOptions options;
    const CLI::App& command = parse_to(options, add_cast_options);
    check_cast_options(options);
    return plan_rays(options, command, console, std::move(rays));
  }
  throw UsageError(
      {"job.command.unknown", fmt::format("the command \"{}\" cannot run as a job", kind), "", "use render or cast"});
}

jobs::Job create_job(PlannedJob& planned, const fs::path& folder) {
  const jobs::Job job = jobs::Job::create(folder, planned.manifest());
  if (read_arguments(job) != planned.arguments()) write_arguments(job, planned.arguments());
  planned.remember();
  return job;
}

std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Console& console, std::shared_ptr<RaySource> rays) {
  const std::optional<std::vector<std::string>> arguments = read_arguments(job);
  if (!arguments) {
    throw InputError({"job.command.damaged",
                      "the file does not name the command that makes the job's pieces, or it is damaged",
                      arguments_file(job).string(), "run the job's command once more"});
  }
  std::unique_ptr<PlannedJob> planned =
      plan_job(job.manifest().kind, *arguments, job.folder(), console, std::move(rays));
  job.check_same(planned->manifest());
  planned->remember();
  return planned;
}

std::string find_driver(const jobs::Job& job) {
  for (size_t piece = 0; piece < job.piece_count(); ++piece) {
    if (job.state_of(piece) != jobs::PieceState::kDone) continue;
    const nlohmann::json json = nlohmann::json::parse(job.read(piece).description, nullptr, false);
    const auto driver = json.is_object() ? json.find("driver") : json.end();
    return driver != json.end() && driver->is_string() ? driver->get<std::string>() : "";
  }
  return "";
}

void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console) {
  const jobs::Job job = [&] {
    // Signals are deferred so that no temporary files remain.
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
