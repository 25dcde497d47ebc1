// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "command_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cast_job.h"
#include "cast_options.h"
#include "core/count_of.h"
#include "core/file.h"
#include "deferred_signals.h"
#include "outputs.h"
#include "picture_job.h"
#include "progress.h"
#include "promin/error.h"
#include "promin/image.h"
#include "render_job.h"
#include "render_options.h"
#include "sources_hash.h"

namespace promin::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Missing pieces that a message names.
constexpr size_t kMostNamed = 5;
/// Of the file that keeps arguments.
constexpr int kFormat = 1;

/// How a job takes an option. What has no row is an ordinary option: it decides about bits, is no file, and is kept.
struct OptionOfJobs {
  std::string_view name;
  /// Whether the manifest has its words. The files that SCENE and others name are there by their hashes.
  bool is_in_manifest = true;
  /// Kept by its absolute path, as the job may be planned again from any folder.
  bool names_file = false;
  /// Not where each who works on a job chooses for themselves.
  bool is_kept = true;
  /// Where it is given this one word it counts as not given, as that is what it is then whatever the scene.
  std::string_view default_word = "";
  /// Who says it instead, where a job's arguments have no place for it.
  const char* said_elsewhere = nullptr;
};
constexpr const char* kMergeSays = "what the files are called is said when pieces are merged";
constexpr OptionOfJobs kOptionsOfJobs[] = {
    {.name = "SCENE", .is_in_manifest = false, .names_file = true},
    {.name = "RAYS.npy", .is_in_manifest = false, .names_file = true},
    {.name = "--bvh", .is_in_manifest = false, .names_file = true},
    {.name = "--compression", .default_word = "zip"},
    {.name = "--depth", .default_word = "ray"},
    {.name = "--environment", .names_file = true},
    {.name = "--environment-intensity", .default_word = "1"},
    {.name = "--environment-rotation", .default_word = "0"},
    {.name = "--error-in", .default_word = "linear"},
    {.name = "--exposure", .default_word = "auto"},
    {.name = "--filter", .default_word = "box"},
    {.name = "--path", .names_file = true},
    {.name = "--output", .is_in_manifest = false, .is_kept = false, .said_elsewhere = kMergeSays},
    {.name = "--offsets", .is_in_manifest = false, .is_kept = false, .said_elsewhere = kMergeSays},
    {.name = "--job", .is_in_manifest = false, .is_kept = false, .said_elsewhere = "the folder is said beside them"},
    {.name = "--piece",
     .is_in_manifest = false,
     .is_kept = false,
     .said_elsewhere = "who makes the pieces chooses them"},
    {.name = "--device",
     .is_in_manifest = false,
     .is_kept = false,
     .said_elsewhere = "who makes the pieces chooses it"},
    {.name = "--stats", .is_in_manifest = false, .is_kept = false},
    {.name = "--quiet", .is_in_manifest = false, .is_kept = false},
    {.name = "--verbose", .is_in_manifest = false, .is_kept = false},
    {.name = "--builder", .is_in_manifest = false},
    {.name = "--features", .is_in_manifest = false},
    {.name = "--pieces", .is_in_manifest = false},
    {.name = "--repeat", .is_in_manifest = false},
    {.name = "--shading", .default_word = "full"},
    {.name = "--spp", .default_word = "1"},
    {.name = "--tiles", .is_in_manifest = false}};

const OptionOfJobs& option_of_jobs(std::string_view name) {
  static constexpr OptionOfJobs kOrdinary;
  const auto* const row = std::ranges::find(kOptionsOfJobs, name, &OptionOfJobs::name);
  return row != std::end(kOptionsOfJobs) ? *row : kOrdinary;
}

bool is_default(const OptionOfJobs& option, const std::vector<std::string>& words) {
  return !option.default_word.empty() && words.size() == 1 && words.front() == option.default_word;
}

fs::path arguments_file(const fs::path& folder) {
  return folder / "command.json";
}

/// Parses what the command of this name takes.
void parse(CLI::App& program, const CLI::App& command, const std::vector<std::string>& arguments) {
  for (const std::string& word : arguments) {
    if (word != "-h" && word != "--help" && word != "--version") continue;
    throw UsageError({word + " makes no job", "in its arguments", "leave it out"});
  }
  const std::string name = command.get_name();
  std::vector<const char*> words = {"promin", name.c_str()};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  static_cast<void>(parse_arguments(program, static_cast<int>(words.size()), words.data()));
  for (const auto& [option, values] : given_options(command)) {
    const char* const why = option_of_jobs(option).said_elsewhere;
    if (why == nullptr) continue;
    throw UsageError(
        {option + " is none of a job's arguments", "in its arguments", std::string("leave it out; ") + why});
  }
}

/// Another driver's pieces have other bits.
void check_driver(const jobs::Job& job, const std::string& driver) {
  const std::string of_pieces = find_driver(job);
  if (of_pieces.empty() || of_pieces == driver) return;
  throw UsageError({fmt::format("the job's pieces were made on {}, and this is {}", of_pieces, driver),
                    job.folder().string(), "go on with that device by --device, or take another folder"});
}

/// Whether a file is, by all that the manifest tells, one that the job's pieces hang on.
bool is_input(const jobs::Job& job, const fs::path& file) {
  return std::ranges::any_of(job.manifest().files, [&](const jobs::InputFile& input) {
    std::error_code none;
    return input.name == file.filename() && fs::file_size(file, none) == input.size_bytes && !none &&
           jobs::describe_input(file).sha256 == input.sha256;
  });
}

/// Throws RunError where pieces are missing, of so many that were looked at.
void refuse_missing(const jobs::Job& job, const std::vector<size_t>& missing, size_t count) {
  if (missing.empty()) return;
  std::vector<std::string> names;
  for (size_t i = 0; i < std::min(missing.size(), kMostNamed); ++i) names.push_back(job.manifest().pieces[missing[i]]);
  throw RunError({fmt::format("{} of {} {} missing or bad: {}{}", missing.size(), count_of(count, "piece"),
                              verb_of(missing.size(), "is", "are"), fmt::join(names, ", "),
                              missing.size() > kMostNamed ? ", …" : ""),
                  job.file_of(missing.front()).parent_path().string(),
                  "run the job again, which makes what is missing"});
}

/// Makes what is missing of a share. Returns how many pieces it has made, nothing where a signal has ended it before.
std::optional<size_t> make_share(const jobs::Job& job, PlannedJob& planned, const jobs::Share& share,
                                 const JobSteps& steps, const Console& console) {
  const std::vector<size_t> missing = jobs::find_missing(job, share);
  if (missing.empty()) return 0;
  // A signal ends the work when the piece at hand is written, and the program at the end of this.
  const DeferredSignals while_working;
  const gpu::DeviceHandle device = steps.open_device();
  const std::string driver = driver_of(gpu::info_of(*device));
  check_driver(job, driver);
  const auto tell_stopped = [&](size_t piece) {
    console.note(fmt::format("stopped before piece {} of {}; the same command goes on", piece, job.piece_count()));
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
      console.warn(fmt::format("{} {}; it is made anew", job.file_of(next.number).string(), next.why));
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
  if (is_whole && while_working.is_pending()) console.note("stopped with the last piece; the same command goes on");
  return is_whole ? std::optional(made) : std::nullopt;
}

}  // namespace

jobs::Manifest begin_manifest(std::string_view kind, const GivenOptions& given) {
  jobs::Manifest manifest;
  manifest.kind = kind;
  manifest.options = {{"version", PROMIN_VERSION}, {"program", std::string(kSourcesHash)}};
  for (const auto& [name, words] : given) {
    const OptionOfJobs& option = option_of_jobs(name);
    if (!option.is_in_manifest || is_default(option, words)) continue;
    const std::string value = words.empty() ? "given" : fmt::format("{}", fmt::join(words, " "));
    manifest.options.emplace_back(name, option.names_file ? fs::path(value).filename().string() : value);
  }
  return manifest;
}

void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources) {
  for (const SourceFile& source : sources) {
    if (!source.stamp) continue;
    manifest.files.push_back(jobs::describe_input(source.file));
    if (stamp_of(source.file) == source.stamp) continue;
    throw InputError({"the file has changed while it was read", source.file.string(), "try again"});
  }
}

fs::path shared_tree_file(const JobOptions& job, const std::string& builder) {
  return *job.folder / "trees" / (builder + ".pbvh");
}

std::vector<std::string> keep_arguments(const CLI::App& command) {
  std::vector<std::string> arguments;
  for (const auto& [name, words] : given_options(command)) {
    const OptionOfJobs& option = option_of_jobs(name);
    if (!option.is_kept || is_default(option, words)) continue;
    if (name.starts_with('-')) arguments.push_back(name);
    for (const std::string& word : words) {
      arguments.push_back(option.names_file ? fs::absolute(word).lexically_normal().string() : word);
    }
  }
  return arguments;
}

std::unique_ptr<PlannedJob> plan_job(const std::string& kind, const std::vector<std::string>& arguments,
                                     const fs::path& folder, const Console& console, std::shared_ptr<RaySource> rays) {
  CLI::App program("", "promin");
  // Parses the words to options, by what adds these to a command.
  const auto parse_to = [&](auto& options, const auto& add_options) -> CLI::App& {
    CLI::App& command = add_command(program, kind, "");
    add_options(command, options);
    parse(program, command, arguments);
    options.job.folder = folder;
    // A share, as it makes no file.
    options.job.share = jobs::Share{};
    return command;
  };
  if (kind == kPictureJob) {
    if (rays != nullptr) throw UsageError({"a job of pictures has no rays", "", "leave them out"});
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
  throw UsageError({fmt::format("no command \"{}\" makes jobs", kind), "", "name render or cast"});
}

jobs::Job create_job(PlannedJob& planned, const fs::path& folder) {
  const jobs::Job job = jobs::Job::create(folder, planned.manifest());
  if (read_arguments(job) != planned.arguments()) {
    const Json json = {{"promin_command", kFormat}, {"kind", job.manifest().kind}, {"arguments", planned.arguments()}};
    write_text_file(arguments_file(folder), json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  planned.remember();
  return job;
}

std::optional<std::vector<std::string>> read_arguments(const jobs::Job& job) {
  const Json json = Json::parse(std::ifstream(arguments_file(job.folder())), nullptr, false);
  try {
    if (json.is_object() && json.at("promin_command") == kFormat && json.at("kind") == job.manifest().kind) {
      return json.at("arguments").get<std::vector<std::string>>();
    }
  } catch (const nlohmann::json::exception&) {
  }
  return {};
}

std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Console& console, std::shared_ptr<RaySource> rays) {
  const std::optional<std::vector<std::string>> arguments = read_arguments(job);
  if (!arguments) {
    throw InputError({"does not say by what command the job's pieces are made, or is damaged",
                      arguments_file(job.folder()).string(), "give the job's command once more"});
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
    const Json json = Json::parse(job.read(piece).description, nullptr, false);
    const auto driver = json.is_object() ? json.find("driver") : json.end();
    return driver != json.end() && driver->is_string() ? driver->get<std::string>() : "";
  }
  return "";
}

std::string driver_of(const gpu::DeviceInfo& device) {
  return fmt::format("{}, {}", device.name, device.driver);
}

void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console) {
  const jobs::Job job = [&] {
    // No signal leaves the temporary files of what is written here.
    const DeferredSignals while_writing;
    return create_job(planned, *options.folder);
  }();
  const std::optional<size_t> made = make_share(job, planned, options.share.value_or(jobs::Share{}), steps, console);
  if (!made) return;
  if (options.share) {
    if (!console.is_quiet()) {
      fmt::print("{} made of {}, in {}\n", count_of(*made, "piece"), job.piece_count(), options.folder->string());
    }
    return;
  }
  steps.merge(job);
  if (console.is_quiet()) return;
  fmt::print("{} of {} made now: {}\n", *made, count_of(job.piece_count(), "piece"), steps.outputs);
}

void check_done(const jobs::Job& job, const std::vector<size_t>& pieces) {
  refuse_missing(job, jobs::keep_missing(job, pieces), pieces.size());
}

void check_whole(const jobs::Job& job) {
  refuse_missing(job, jobs::find_missing(job), job.piece_count());
}

void check_job_files(const jobs::Job& job, const std::vector<fs::path>& outputs,
                     const std::optional<std::vector<uint32_t>>& frames) {
  const std::string& kind = job.manifest().kind;
  if (kind == kPictureJob) {
    check_merged_pictures(job, outputs);
  } else if (kind == kRayJob) {
    check_merged_hits(job, outputs);
  } else {
    throw InputError({fmt::format("the job is one of \"{}\", and not of promin render or cast", kind),
                      job.folder().string(), "name the folder of promin render --job or promin cast --job"});
  }
  for (const fs::path& output : kind == kPictureJob ? number_pictures(job, outputs, frames) : outputs) {
    if (!is_input(job, output)) continue;
    throw UsageError({"the output would overwrite an input", output.string(), "name another file"});
  }
}

void merge_job(const jobs::Job& job, const std::vector<fs::path>& outputs, const ProgressCallback& progress,
               bool is_mixed, const std::optional<std::vector<uint32_t>>& frames) {
  check_job_files(job, outputs, frames);
  if (job.manifest().kind == kPictureJob) return merge_pictures(job, outputs, progress, frames);
  if (frames) throw UsageError({"answers to rays have no frames", job.folder().string(), "leave the frames out"});
  merge_hits(job, outputs, progress, is_mixed);
}

void merge_job_deferring(const jobs::Job& job, const std::vector<fs::path>& outputs) {
  const DeferredSignals while_writing;
  try {
    merge_job(job, outputs, [&](double) { return !while_writing.is_pending(); });
  } catch (const Cancelled&) {
    // What the signal's sender wants is an end, and has it now.
  }
}

}  // namespace promin::app
