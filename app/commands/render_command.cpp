// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/render_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <functional>
#include <memory>

#include "commands/frame_rendering.h"
#include "commands/job_run.h"
#include "core/count_of.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "formats/file_kind.h"
#include "options/render_help.h"
#include "options/render_options.h"
#include "options/spec_options.h"
#include "options/tracing_options.h"
#include "output/console.h"
#include "output/deferred_signals.h"
#include "output/explanation.h"
#include "output/outputs.h"
#include "output/progress.h"
#include "output/standard_output.h"
#include "promin/error.h"
#include "promin/image.h"
#include "trace/film/refinement.h"
#include "work/jobs/render_job.h"
#include "work/pictures/film_file.h"
#include "work/pictures/frame_renderers.h"
#include "work/pictures/picture_run.h"
#include "work/pictures/shutter.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace {

/// Factor of the time limit. A picture that takes longer than this is late.
constexpr double kLateShare = 1.2;
/// Fraction of the time limit. A picture that takes less could have used more of the time.
constexpr double kEarlyShare = 0.67;

/// Returns the number of samples per pixel. With an error target, returns the accuracy of all frames together.
std::string describe_samples(const RunStats& stats) {
  if (stats.errors.empty() || !stats.view->error_target) return fmt::format("{} spp", stats.view->samples_per_pixel);
  PictureError all = stats.errors.front();
  for (const PictureError& error : std::span(stats.errors).subspan(1)) all += error;
  const auto [least, most] = std::ranges::minmax(stats.errors, {}, &PictureError::target);
  const auto pictures = static_cast<double>(stats.errors.size());
  return fmt::format("{:.4g} spp, {}{}", mean_samples(*stats.view, all) / pictures,
                     describe_errors(least.target, most.target, *stats.view->error_target), describe_unmet(all));
}

/// Returns the options that reproduce the last picture that a run with a time limit reached.
std::string describe_reached(const RunStats& stats) {
  const std::string name = stats.frames.empty() ? "" : fmt::format(" of frame {}", stats.frames.back());
  if (!stats.view->error_target)
    return fmt::format("the same picture{} again: --spp {}", name, stats.view->samples_per_pixel);
  ErrorTarget target = *stats.view->error_target;
  target.error = stats.errors.back().target;
  return fmt::format("the same picture{} again: {}", name, describe_options(target));
}

/// Reports the result of a run with a time limit.
void tell_reached(const RunStats& stats, double limit_s, double taken_s, const Console& console) {
  if (taken_s > kLateShare * limit_s) {
    const bool is_least = !stats.view->error_target && stats.view->samples_per_pixel == 1;
    console.note(fmt::format("the picture took {:.1f} s, longer than the limit of {:g} s{}", taken_s, limit_s,
                             is_least ? ": even one sample per pixel takes longer" : ""));
  }
  const uint32_t samples = stats.view->samples_per_pixel;
  const uint32_t usual = samples_of(Quality::kNormal, stats.view->mode);
  if (!stats.view->error_target && samples < usual) {
    const double sample_s = 1e-3 * stats.median_trace_ms() / samples;
    console.note(
        fmt::format("the time was enough for {} of the default {} samples per pixel, which take about {:.0f} s",
                    samples, usual, taken_s + (usual - samples) * sample_s));
  }
  const bool can_refine = !stats.errors.empty() && stats.errors.back().unmet_pixels > 0 &&
                          stats.view->error_target->max_samples < kMaxRefinedSamples;
  if (taken_s < kEarlyShare * limit_s && can_refine) {
    const uint32_t most = stats.view->error_target->max_samples;
    console.note(
        fmt::format("the picture was complete before the limit, because --max-spp allows {} samples per pixel; "
                    "--max-spp {} uses more of the time",
                    most, std::min(4 * most, kMaxRefinedSamples)));
  }
  console.note(describe_reached(stats));
}

std::string summarize(const RunStats& stats, const RenderSpec& options) {
  const std::string frames = stats.frames.empty() ? "" : count_of(stats.frames.size(), "frame") + ", ";
  const std::string time_of = stats.frames.empty() ? "" : " a frame";
  return fmt::format("{}x{}, {}, {}{:.1f} s, {:.4g} Mrays in {:.1f} ms{} ({:.3g} Mrays/s) on {}: {}",
                     stats.view->size.x, stats.view->size.y, describe_samples(stats), frames, 1e-3 * stats.total_ms,
                     1e-6 * static_cast<double>(stats.rays.total()), stats.median_trace_ms(), time_of,
                     stats.mrays_per_s(), stats.device.name, fmt::join(names_of(name_pictures(options)), ", "));
}

/// Returns approximately the seconds for writing the pictures of a view.
double writing_s(const View& view, size_t pictures) {
  constexpr double kSecondsPerPixel = 3e-7;
  return kSecondsPerPixel * static_cast<double>(area_of(window_of(view))) * static_cast<double>(pictures);
}

/// Returns the files that hold all frames.
std::vector<std::filesystem::path> films_of(const RenderSpec& options, const std::vector<PlannedFrame>& frames) {
  return films_among(options.pictures, frames.size() > 1);
}

FilmHeader describe_film(const RenderSpec& options, const std::vector<PlannedFrame>& frames,
                         const PixelWindow& window) {
  return {.size = window.hi - window.lo,
          .has_alpha = options.aovs.alpha,
          .fps = frame_rate_of(options, frames.front().path.get()),
          .frame_count = frames.size()};
}

/// Renders all frames after loading the scene once. The message of an error names the frame. The pictures of earlier
/// frames are complete then. A film appears after its last frame.
void render_frames(const PictureRun& run, const Stopwatch& total, const gpu::Device& device, FrameRenderers& renderers,
                   RunStats& stats, const Console& console) {
  const std::vector<PlannedFrame>& frames = run.frames;
  const RenderSpec& options = run.options;
  const Scene& scene = run.scene;
  // A film is incomplete until its last frame. Therefore a signal ends the program only when the film is removed.
  std::optional<DeferredSignals> while_filming;
  Films films;
  if (const std::vector<std::filesystem::path> files = films_of(options, frames); !files.empty()) {
    while_filming.emplace();
    const FilmHeader header = describe_film(options, frames, window_of(*stats.view));
    for (const std::filesystem::path& file : files) films.push_back(std::make_unique<FilmFile>(file, header));
  }
  Progress progress(console.is_quiet());
  FrameMotion motion(run);
  const View asked = *stats.view;
  const std::optional<double> limit_s = options.error.time_limit_s;
  for (size_t i = 0; i < frames.size(); ++i) {
    const PlannedFrame& frame = frames[i];
    const std::string name = frame.number ? fmt::format("frame {}", *frame.number) : "";
    renderers.at(frame);
    stats.view = asked;
    renderers.describe(frame, *stats.view, stats);
    // The first frame's time includes loading and compiling; each frame's time includes writing its pictures.
    const Stopwatch of_frame;
    const auto taken_s = [&] { return 1e-3 * (i == 0 ? total : of_frame).ms(); };
    std::optional<double> left_s;
    if (limit_s) left_s = *limit_s - taken_s() - writing_s(*stats.view, frame.pictures.size());
    try {
      const auto on_progress = [&](double fraction) {
        progress.update((static_cast<double>(i) + fraction) / static_cast<double>(frames.size()), name);
        return !while_filming || !while_filming->is_pending();
      };
      const auto tracer = [&](const View& view, const std::optional<double>& left, const ProgressCallback& tell) {
        return trace_frame(renderers, motion, run, frame, view, left, tell);
      };
      render_frame(frame, options, left_s, device, scene, tracer, stats, films, on_progress);
      if (limit_s) {
        progress.clear();
        tell_reached(stats, *limit_s, taken_s(), console);
      }
    } catch (const RunError& error) {
      if (name.empty()) throw;
      std::vector<Problem> problems = error.problems();
      std::string& where = problems.front().where;
      where += (where.empty() ? "" : ": ") + name;
      throw RunError(problems);
    }
  }
  for (const std::unique_ptr<FilmFile>& film : films) film->commit();
}

std::vector<std::filesystem::path> inputs_of(const RenderSpec& options) {
  std::vector<std::filesystem::path> files = input_files(options.tracing);
  if (options.path) files.push_back(*options.path);
  if (options.view.environment.panorama) files.push_back(*options.view.environment.panorama);
  return files;
}

/// Returns the files of a run.
std::vector<std::filesystem::path> pictures_of(const RenderSpec& options, const std::vector<PlannedFrame>& frames) {
  std::vector<std::filesystem::path> files = films_of(options, frames);
  for (const PlannedFrame& frame : frames) files.insert(files.end(), frame.pictures.begin(), frame.pictures.end());
  return files;
}

bool is_file_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

/// Returns whether all pictures of a frame exist; folders and empty files do not count.
bool is_there(const PlannedFrame& frame) {
  return std::ranges::all_of(frame.pictures, [](const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) > 0 && !error;
  });
}

/// Throws UsageError if a file with a default name exists, unless it is a picture that promin rendered from a scene of
/// this name.
void check_default_names(const std::vector<std::filesystem::path>& pictures, const std::string& scene) {
  const auto found = std::ranges::find_if(
      pictures, [&](const std::filesystem::path& file) { return is_file_there(file) && !is_picture_of(file, scene); });
  if (found == pictures.end()) return;
  throw UsageError({"output.foreign", found->string() + " exists already and promin did not make it from " + scene, "",
                    "give the file to write with -o"});
}

/// Throws UsageError if several pictures would be written to the standard output.
void check_standard_output(const RenderSpec& options) {
  const auto count = std::count(options.pictures.begin(), options.pictures.end(), StandardOutput::kName);
  if (count == 0) return;
  const auto refuse = [](const std::string& what) {
    throw UsageError({"output.standard.taken", what, "", "give a file"});
  };
  if (count > 1) refuse("-o - is given twice");
  if (options.path) refuse("-o - takes one picture, not the frames of --path");
  if (options.turntable) refuse("-o - takes one picture, not the frames of --turntable");
  if (options.makes_film()) refuse("-o - takes one picture, not the frames of an animation");
  if (options.job.folder) refuse("-o - and --job contradict each other");
}

/// Checks the files of the frames, and removes frames whose pictures exist if the user wants that. Returns false if
/// nothing remains. Throws UsageError.
bool has_work(const RenderSpec& given, const RenderSpec& options, std::vector<PlannedFrame>& frames,
              const Console& console) {
  const TracingOptions& tracing = options.tracing;
  const bool goes_on = options.job.folder && is_file_there(*options.job.folder / "job.json");
  const std::vector<std::filesystem::path> all = pictures_of(options, frames);
  if (given.pictures.empty() && !goes_on) check_default_names(all, tracing.scene.filename().string());
  if (options.skips_existing && !films_of(options, frames).empty()) {
    throw UsageError({"usage.options.contradict",
                      "--skip-existing and a film contradict each other, because a film needs all of its frames",
                      films_of(options, frames).front().string(), "remove one of them"});
  }
  const size_t skipped = options.skips_existing ? std::erase_if(frames, is_there) : 0;
  check_outputs(inputs_of(options), pictures_of(options, frames), tracing.stats);
  if (skipped > 0) {
    console.note(fmt::format("skipped {} of {}, whose pictures exist already", skipped,
                             count_of(skipped + frames.size(), "frame")));
  }
  if (!frames.empty()) return true;
  if (tracing.stats)
    console.note(fmt::format("{} is not written, because nothing was traced", tracing.stats->string()));
  return false;
}

/// Continues a job. If all pieces are done, writes its pictures. Calls `begin` after all checks have passed.
void render_job(const RenderSpec& given, PictureRun run, const Console& console, const std::function<void()>& begin) {
  const RenderSpec options = run.options;
  RunStats stats;
  const JobSteps steps = {.begin = begin,
                          .open_device = [&] { return open_device_for(options.tracing, stats, console); },
                          .files = options.pictures};
  run_job(*plan_pictures(given, std::move(run), console), options.job, steps, console);
}

void render(const RenderSpec& asked, bool prints_spec) {
  const Stopwatch total;
  RenderSpec given = asked;
  complete_film(given);
  const TracingOptions& tracing = given.tracing;
  const Console console(verbosity_of(given.tracing));
  check_render_spec(given);
  if (prints_spec) return print_spec(given);
  check_standard_output(given);
  // Checks the scene's name first, so that pictures are not named after a file that is not a scene.
  check_scene_name(tracing.scene);
  RenderSpec options = given;
  const StandardOutput standard_output(options.pictures);
  options.pictures = name_pictures(options);
  check_frame_files(options.pictures);
  std::vector<PlannedFrame> frames = plan_frames(options);
  // The length of a whole film is known only after the scene is read.
  const bool is_known = !frames.empty();
  if (is_known && !has_work(given, options, frames, console)) return;

  std::optional<StageNote> stage;
  stage.emplace("loading", console);
  PictureRun run = prepare_pictures(options, std::move(frames), console);
  stage.reset();
  if (!is_known && !has_work(given, options, run.frames, console)) return;
  options = run.options;
  check_overwrites(files_of(run.sources), pictures_of(options, run.frames), tracing.stats);
  // A film that cannot be written is refused before any work.
  for (const std::filesystem::path& film : films_of(options, run.frames)) {
    check_film(film, frame_rate_of(options, run.frames.front().path.get()));
  }
  const auto tell_names = [&] {
    if (!given.pictures.empty() || options.pictures.empty()) return;
    console.note(fmt::format("writing {} and {}", options.pictures[0].string(), options.pictures[1].string()));
  };
  if (options.job.folder) {
    render_job(given, std::move(run), console, tell_names);
    return;
  }
  tell_names();
  const Scene& scene = run.scene;
  RunStats& stats = run.stats;
  const gpu::DeviceHandle device = open_device_for(tracing, stats, console);
  stage.emplace("compiling", console);
  FrameRenderers renderers(*device, run,
                           make_renderer_options(options, count_samples(*stats.view, run.frames.size(), options)));
  Renderer& renderer = renderers.at(run.frames.front());
  stage.reset();
  take_setup(renderer.setup_stats(), *device, stats, console);
  if (options.explained_pixel) {
    const Explanation explanation = renderer.explain(*stats.view, *options.explained_pixel);
    check_validation(*device, stats);
    fmt::print("{}", explain_json(explanation, scene));
    return;
  }
  render_frames(run, total, *device, renderers, stats, console);

  const DeferredSignals while_writing;
  stats.total_ms = total.ms();
  tell_end(stats, console);
  if (tracing.stats) write_text_file(*tracing.stats, to_json(stats));
  if (!console.is_quiet()) fmt::print(standard_output.messages(), "{}\n", summarize(stats, given));
  standard_output.write();
}

}  // namespace

Command add_render_command(CLI::App& program) {
  CLI::App& command = add_command(program, "render", "Render a picture of a scene");
  const auto options = std::make_shared<RenderSpec>();
  const auto prints_spec = std::make_shared<bool>(false);
  add_spec_option(command, *options);
  add_render_options(command, *options);
  add_print_spec_option(command, *prints_spec);
  arrange_help(program, command);
  return {&command, [options, prints_spec] { render(*options, *prints_spec); }};
}

}  // namespace promin::app
