// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <future>
#include <memory>

#include "console.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "deferred_signals.h"
#include "explanation.h"
#include "frame_plan.h"
#include "image/open_pictures.h"
#include "jobs/job.h"
#include "jobs/sha256.h"
#include "outputs.h"
#include "picture_files.h"
#include "picture_job.h"
#include "progress.h"
#include "promin/error.h"
#include "promin/image.h"
#include "render/renderer_impl.h"
#include "render_options.h"
#include "tracing_run.h"
#include "view_setup.h"

namespace promin::app {
namespace {

using GivenOptions = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// Of all pictures together.
uint64_t count_samples(const View& view, size_t frames, const RenderOptions& options) {
  if (options.explained_pixel) return view.samples_per_pixel;
  const uvec2 size = view.crop ? view.crop->hi - view.crop->lo : view.size;
  const uint32_t samples = view.error_target ? view.error_target->min_samples : view.samples_per_pixel;
  return uint64_t{size.x} * size.y * samples * frames * options.tracing.repeat_count;
}

TunedRendererOptions make_renderer_options(const RenderOptions& options, uint64_t expected_samples) {
  TunedRendererOptions result;
  result.expected_samples = expected_samples;
  choose_tree(options.tracing, result);
  result.texture_bytes = uint64_t{options.view.look.texture_memory_mib} << 20;
  result.force_all_features = options.has_all_features;
  result.has_error_target = options.error.is_given();
  result.mode = {options.view.debug_view, !options.view.has_no_shadows};
  result.aovs = options.aovs;
  // The average takes pixels that hit something.
  if (options.view.look.averages_exposure) result.aovs.object = true;
  return result;
}

/// A picture and the device's time for each of its repetitions.
struct TracedFrame {
  RenderResult result;
  std::vector<double> trace_ms;
};

TracedFrame trace(Renderer& renderer, const View& view, const RenderOptions& options,
                  const std::function<bool(double)>& on_progress) {
  TracedFrame frame;
  const uint32_t repeats = options.tracing.repeat_count;
  for (uint32_t i = 0; i < repeats; ++i) {
    const auto tell = [&](double fraction) { return on_progress((i + fraction) / repeats); };
    const std::optional<double> limit_s = options.error.time_limit_s;
    frame.result = limit_s ? renderer.render_within(view, *limit_s, tell) : renderer.render(view, tell);
    frame.trace_ms.push_back(frame.result.trace_ms);
  }
  return frame;
}

/// No times: equal pictures are equal files.
Metadata make_metadata(const RunStats& stats, const std::optional<uint32_t>& frame, const AovHeader& aovs) {
  Metadata metadata = describe_picture(stats);
  if (frame) metadata.emplace_back("promin:frame", std::to_string(*frame));
  metadata.insert(metadata.end(), aovs.metadata.begin(), aovs.metadata.end());
  return metadata;
}

PixelWindow window_of(const View& view) {
  return view.crop.value_or(PixelWindow{uvec2(0), view.size});
}

PictureHeader make_header(const RenderOptions& options, const Scene& scene, const std::optional<uint32_t>& frame,
                          const RunStats& stats) {
  const View& view = *stats.view;
  AovHeader aovs = describe_aovs(scene, options.aovs, view.depth_kind);
  PictureHeader header;
  header.size = window_of(view).hi - window_of(view).lo;
  if (view.crop) header.crop = CropPlacement{view.crop->lo, view.size};
  header.metadata = make_metadata(stats, frame, aovs);
  header.channels = std::move(aovs.channels);
  header.display = stats.display;
  header.exr = options.exr;
  return header;
}

/// The samples of a pixel and, with an error target, how exact that is; of several frames the worst.
std::string describe_samples(const RunStats& stats) {
  if (stats.errors.empty()) return fmt::format("{} spp", stats.view->samples_per_pixel);
  PictureError all = stats.errors.front();
  for (const PictureError& error : std::span(stats.errors).subspan(1)) {
    all.target = std::max(all.target, error.target);
    all.largest_claim = std::max(all.largest_claim, error.largest_claim);
    all.unmet_pixels += error.unmet_pixels;
    all.samples += error.samples;
  }
  const auto pictures = static_cast<double>(stats.errors.size());
  const std::string unmet =
      all.unmet_pixels == 0 ? ""
                            : fmt::format(" but for {} pixels of at most {:.3g}", all.unmet_pixels, all.largest_claim);
  return fmt::format("{:.4g} spp, error {:.9g}{}", mean_samples(*stats.view, all) / pictures, all.target, unmet);
}

/// The options that give a picture of a time limit again.
std::string describe_target(const RunStats& stats) {
  const ErrorTarget& target = *stats.view->error_target;
  return fmt::format("the picture{} of --target-error {:.9g} --min-spp {} --max-spp {}",
                     stats.frames.empty() ? "" : " of the last frame", stats.errors.back().target, target.min_samples,
                     target.max_samples);
}

std::string summarize(const RunStats& stats, const RenderOptions& options) {
  const std::string frames = stats.frames.empty() ? "" : fmt::format("{} frames, ", stats.frames.size());
  const std::string time_of = stats.frames.empty() ? "" : " a frame";
  return fmt::format("{}x{}, {}, {}{:.4g} Mrays in {:.1f} ms{} ({:.3g} Mrays/s) on {}: {}", stats.view->size.x,
                     stats.view->size.y, describe_samples(stats), frames,
                     1e-6 * static_cast<double>(stats.rays.total()), stats.median_trace_ms(), time_of,
                     stats.mrays_per_s(), stats.device.name, fmt::join(names_of(options.pictures), ", "));
}

/// Gives pixels the numbers that the file has for its objects.
void number_as_in_file(const Scene& scene, Aovs& aovs) {
  if (scene.object_numbers.empty()) return;
  for (uint32_t& object : aovs.object) {
    if (object != Aovs::kNoId) object = object_number(scene, object);
  }
}

/// Whether the whole picture decides what its files begin with, or takes one call: it is not written band by band then.
bool is_written_whole(const RenderOptions& options) {
  return options.error.is_given() || options.view.look.averages_exposure;
}

/// Where the picture tells its exposure itself, that of a path's first frame for all.
void expose_by_first(const RenderOptions& options, const RenderResult& result, RunStats& stats) {
  const bool is_first = stats.frames.size() <= 1;
  if (!options.view.look.averages_exposure || !is_first || options.view.debug_view != DebugView::kNone) return;
  stats.display.exposure_ev = average_exposure_ev(result.image.pixels, result.aovs.object);
}

/// Traces a frame and writes its pictures, of large ones a band while the next is traced.
void render_frame(const PlannedFrame& planned, const RenderOptions& options, const gpu::Device& device,
                  const Scene& scene, Renderer& renderer, RunStats& stats,
                  const std::function<void(double)>& on_progress) {
  if (planned.number) stats.frames.push_back(*planned.number);
  const PixelWindow window = window_of(*stats.view);
  const size_t channels = 3 + describe_aovs(scene, options.aovs, stats.view->depth_kind).channels.size();
  const auto bands = is_written_whole(options) ? std::vector{window} : cut_bands(window, channels);
  // From the first band that is written on a signal waits until nothing is left behind.
  std::optional<DeferredSignals> while_writing;
  std::optional<PictureFiles> files;
  std::vector<double> trace_ms(options.tracing.repeat_count, 0.0);
  const auto rows = static_cast<double>(window.hi.y - window.lo.y);
  for (const PixelWindow& band : bands) {
    View view = *stats.view;
    if (bands.size() > 1) view.crop = band;
    TracedFrame traced = trace(renderer, view, options, [&](double fraction) {
      on_progress((band.lo.y - window.lo.y + fraction * (band.hi.y - band.lo.y)) / rows);
      return !while_writing || !while_writing->is_pending();
    });
    check_validation(device, stats);
    number_as_in_file(scene, traced.result.aovs);
    stats.rays += traced.result.rays;
    if (traced.result.error) stats.errors.push_back(*traced.result.error);
    for (size_t i = 0; i < trace_ms.size(); ++i) trace_ms[i] += traced.trace_ms[i];
    expose_by_first(options, traced.result, stats);
    const Stopwatch write;
    if (!files) {
      while_writing.emplace();
      files.emplace(planned.pictures, make_header(options, scene, planned.number, stats));
    }
    files->write_rows(std::move(traced.result.image), make_channels(scene, traced.result.aovs, options.aovs));
    stats.write_ms += write.ms();
  }
  const Stopwatch write;
  files->commit();
  stats.write_ms += write.ms();
  if (planned.number) {
    stats.trace_ms.push_back(median(trace_ms));
  } else {
    stats.trace_ms = trace_ms;
  }
}

/// What of the options does not reach a bit of a piece; the files that others name are in the manifest by their hashes.
constexpr std::string_view kNotInJob[] = {"SCENE",   "--output",   "--job",     "--piece", "--pieces",
                                          "--tiles", "--stats",    "--device",  "--quiet", "--builder",
                                          "--bvh",   "--features", "--verbose", "--repeat"};
constexpr std::string_view kNamesFile[] = {"--path", "--environment"};

jobs::Manifest make_manifest(const RenderOptions& options, const GivenOptions& given, const RunStats& stats,
                             const std::vector<SourceFile>& sources, std::vector<std::string> pieces) {
  jobs::Manifest manifest;
  manifest.kind = kPictureJob;
  manifest.options = {{"version", PROMIN_VERSION}, {"program", jobs::sha256_of_file("/proc/self/exe")}};
  for (const auto& [name, words] : given) {
    if (std::ranges::find(kNotInJob, name) != std::end(kNotInJob)) continue;
    const bool is_file = std::ranges::find(kNamesFile, name) != std::end(kNamesFile);
    const std::string value = fmt::format("{}", fmt::join(words, " "));
    manifest.options.emplace_back(name, is_file ? std::filesystem::path(value).filename().string() : value);
  }
  manifest.options.emplace_back("size", fmt::format("{}x{}", stats.view->size.x, stats.view->size.y));
  for (const SourceFile& source : sources) {
    if (!source.stamp) continue;
    manifest.files.push_back(jobs::describe_input(source.file));
    if (stamp_of(source.file) == source.stamp) continue;
    throw InputError({"the file has changed while it was read", source.file.string(), "try again"});
  }
  if (options.path) manifest.files.push_back(jobs::describe_input(*options.path));
  const auto& panorama = options.view.environment.panorama;
  if (panorama) manifest.files.push_back(jobs::describe_input(*panorama));
  manifest.pieces = std::move(pieces);
  return manifest;
}

/// Makes the pieces of a job: each a part of a frame.
class JobRun {
 public:
  JobRun(const RenderOptions& options, const std::vector<PlannedFrame>& frames, const Scene& scene, RunStats& stats,
         const Console& console)
      : options_(options),
        frames_(frames),
        scene_(scene),
        stats_(stats),
        console_(console),
        whole_view_(*stats.view),
        window_(window_of(*stats.view)),
        parts_(cut_picture(window_, options.job, frames.size() == 1)),
        progress_(console.is_quiet()) {}

  std::vector<std::string> piece_names() const {
    std::vector<std::optional<uint32_t>> numbers;
    for (const PlannedFrame& frame : frames_) numbers.push_back(frame.number);
    return name_pieces(numbers, parts_);
  }

  /// Returns how many pieces it has made. False in `is_whole` where a signal has ended it before its share was done.
  size_t run(const jobs::Job& job, bool& is_whole) {
    const jobs::Share share = options_.job.share.value_or(jobs::Share{});
    is_whole = true;
    size_t done = 0;
    // A signal ends the work when the piece at hand is written, and the program at the end of this.
    const DeferredSignals while_working;
    const auto before = [&](const jobs::NextPiece& next) {
      if (while_working.is_pending()) {
        console_.note(
            fmt::format("stopped before piece {} of {}; the same command goes on", next.number, job.piece_count()));
        is_whole = false;
        return false;
      }
      if (!next.why.empty()) {
        console_.warn(fmt::format("{} {}; it is made anew", job.file_of(next.number).string(), next.why));
      }
      next_ = next;
      return true;
    };
    open_device();
    check_driver(job);
    done = jobs::run_share(job, share, fmt::format("{}, {}", stats_.device.name, stats_.device.driver), before,
                           [&](size_t piece) { return make(piece); });
    return done;
  }

 private:
  void open_device() {
    device_ = open_device_for(options_.tracing, stats_, console_);
    const size_t pieces = frames_.size() * parts_.size();
    const size_t shares = options_.job.share ? options_.job.share->count : 1;
    const uint64_t samples = count_samples(whole_view_, frames_.size(), options_) / std::min(shares, pieces);
    renderer_.emplace(make_renderer(*device_, scene_, make_renderer_options(options_, samples)));
    take_setup(renderer_->setup_stats(), stats_, console_);
  }

  /// Another driver's pieces have other bits.
  void check_driver(const jobs::Job& job) const {
    const std::string of_pieces = find_driver(job);
    const std::string own = driver_of(describe_picture(stats_));
    if (of_pieces.empty() || of_pieces == own) return;
    throw UsageError({fmt::format("the job's pieces were made on {}, and this is {}", of_pieces, own),
                      options_.job.folder->string(), "go on with that device by --device, or take another folder"});
  }

  jobs::Content make(size_t piece) {
    const PlannedFrame& frame = frames_[piece / parts_.size()];
    View view = whole_view_;
    if (frame.camera) view.camera = *frame.camera;
    view.crop = parts_[piece % parts_.size()];
    TracedFrame traced = trace(*renderer_, view, options_, [&](double fraction) {
      progress_.update((static_cast<double>(next_.before) + fraction) / static_cast<double>(next_.total));
      return true;
    });
    check_validation(*device_, stats_);
    number_as_in_file(scene_, traced.result.aovs);
    stats_.errors.clear();
    if (traced.result.error) stats_.errors.push_back(*traced.result.error);
    const AovHeader aovs = describe_aovs(scene_, options_.aovs, view.depth_kind);
    return encode_part({.frame = frame.number,
                        .full_size = view.size,
                        .window = window_,
                        .part = *view.crop,
                        .metadata = make_metadata(stats_, frame.number, aovs),
                        .exr = options_.exr,
                        .display = stats_.display,
                        .error = traced.result.error,
                        .image = std::move(traced.result.image),
                        .channels = make_channels(scene_, traced.result.aovs, options_.aovs)});
  }

  const RenderOptions& options_;
  const std::vector<PlannedFrame>& frames_;
  const Scene& scene_;
  RunStats& stats_;
  const Console& console_;
  View whole_view_;
  PixelWindow window_;
  std::vector<PixelWindow> parts_;
  Progress progress_;
  jobs::NextPiece next_;
  gpu::DeviceHandle device_;
  std::optional<Renderer> renderer_;
};

/// Renders all frames with what is loaded once. An error says at which frame it happened; the pictures of those before
/// are whole.
void render_frames(const std::vector<PlannedFrame>& frames, const RenderOptions& options, const gpu::Device& device,
                   const Scene& scene, Renderer& renderer, RunStats& stats, const Console& console) {
  Progress progress(console.is_quiet());
  for (size_t i = 0; i < frames.size(); ++i) {
    const PlannedFrame& frame = frames[i];
    const std::string name = frame.number ? fmt::format("frame {}", *frame.number) : "";
    if (frame.camera) stats.view->camera = *frame.camera;
    try {
      render_frame(frame, options, device, scene, renderer, stats, [&](double fraction) {
        progress.update((static_cast<double>(i) + fraction) / static_cast<double>(frames.size()), name);
      });
    } catch (const RunError& error) {
      if (name.empty()) throw;
      std::vector<Problem> problems = error.problems();
      problems.front().what = name + ": " + problems.front().what;
      throw RunError(problems);
    }
  }
}

std::vector<std::filesystem::path> input_files(const RenderOptions& options) {
  std::vector<std::filesystem::path> files = input_files(options.tracing);
  if (options.path) files.push_back(*options.path);
  if (options.view.environment.panorama) files.push_back(*options.view.environment.panorama);
  return files;
}

std::vector<std::filesystem::path> pictures_of(const std::vector<PlannedFrame>& frames) {
  std::vector<std::filesystem::path> files;
  for (const PlannedFrame& frame : frames) files.insert(files.end(), frame.pictures.begin(), frame.pictures.end());
  return files;
}

void check_explained_pixel(const RenderOptions& options, const uvec2& size) {
  if (!options.explained_pixel || glm::all(glm::lessThan(*options.explained_pixel, size))) return;
  throw UsageError({fmt::format("--explain is beyond the picture of {}x{}", size.x, size.y), "on the command line",
                    "stay within it or give a larger --size"});
}

/// Opens the plugin for pictures on a thread, while the tree is built and the pipeline compiled. Not before there is a
/// device: the dynamic loader takes turns, and a Vulkan driver that has to wait for the plugin's libraries costs a
/// tenth of a second.
std::future<void> open_pictures_aside() {
  return std::async(std::launch::async, [] { open_pictures(); });
}

bool is_file_there(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

/// Whether all pictures of a frame are there.
bool is_there(const PlannedFrame& frame) {
  return std::ranges::all_of(frame.pictures, is_file_there);
}

/// Throws UsageError where a picture is there whose name the user has not given.
void check_default_names(const std::vector<std::filesystem::path>& pictures) {
  const auto found = std::ranges::find_if(pictures, is_file_there);
  if (found == pictures.end()) return;
  throw UsageError({"the picture is there already", found->string(), "say by -o where to write"});
}

/// Goes on with a job, and where it has all pieces writes its pictures.
void render_job(const RenderOptions& options, const GivenOptions& words, const std::vector<PlannedFrame>& frames,
                const Scene& scene, const std::vector<SourceFile>& sources, RunStats& stats, const Console& console) {
  JobRun run(options, frames, scene, stats, console);
  const jobs::Job job =
      jobs::Job::create(*options.job.folder, make_manifest(options, words, stats, sources, run.piece_names()));
  const jobs::Share share = options.job.share.value_or(jobs::Share{});
  bool is_whole = true;
  const size_t made = jobs::find_missing(job, share).empty() ? 0 : run.run(job, is_whole);
  if (!is_whole) return;
  if (!share.is_all()) {
    if (!console.is_quiet())
      fmt::print("{} pieces made of {}, in {}\n", made, job.piece_count(), options.job.folder->string());
    return;
  }
  merge_pictures(job, options.pictures);
  if (console.is_quiet()) return;
  fmt::print("{} of {} pieces made now: {}\n", made, job.piece_count(), fmt::join(names_of(options.pictures), ", "));
}

void render(const RenderOptions& given, const GivenOptions& words) {
  const Stopwatch total;
  const TracingOptions& tracing = given.tracing;
  check_render_options(given);
  RenderOptions options = given;
  options.pictures = name_pictures(given);
  check_pictures(options.pictures);
  std::vector<PlannedFrame> frames = plan_frames(options);
  const bool goes_on = options.job.folder && is_file_there(*options.job.folder / "job.json");
  if (given.pictures.empty() && !goes_on) check_default_names(pictures_of(frames));
  const size_t skipped = options.skips_existing ? std::erase_if(frames, is_there) : 0;
  check_outputs(input_files(options), pictures_of(frames), tracing.stats);
  const bool has_pictures = !options.pictures.empty();
  if (has_pictures) find_pictures();
  const Console console(tracing.verbosity());
  if (skipped > 0) {
    console.note(fmt::format("skipped {} of {} frames, whose pictures are there", skipped, skipped + frames.size()));
  }
  if (frames.empty()) return;
  if (given.pictures.empty() && !options.pictures.empty()) {
    console.note(fmt::format("writing {} and {}", options.pictures[0].string(), options.pictures[1].string()));
  }

  RunStats stats;
  std::vector<SourceFile> sources;
  Scene scene = load_for(tracing, stats, console, sources);
  ViewOptions view = options.view;
  view.given_camera = frames.front().camera;
  stats.view = make_view(scene, view, console);
  stats.view->error_target = options.error.error_target();
  check_explained_pixel(options, stats.view->size);
  const AssumedLight assumed = light_up(scene, view.look, EnvironmentChoice(view.environment));
  stats.display = choose_display(scene, view.look, view.debug_view);
  if (stats.view->error_target) stats.view->error_target->white = std::exp2(-stats.display.exposure_ev);
  const bool is_displayed = std::ranges::any_of(options.pictures, std::not_fn(has_named_channels));
  const std::string assumptions =
      describe_assumptions(scene, view, assumed, is_displayed ? std::optional(stats.display) : std::nullopt);
  if (!assumptions.empty()) console.note(assumptions);
  check_lights(scene, options.view.lights_off);
  switch_lights(scene.lights, options.view.lights_off);
  const auto is_on = [](const Light& light) { return light.is_on; };
  stats.light_count = static_cast<size_t>(std::count_if(scene.lights.begin(), scene.lights.end(), is_on));

  if (options.job.folder) {
    render_job(options, words, frames, scene, sources, stats, console);
    return;
  }
  const gpu::DeviceHandle device = open_device_for(tracing, stats, console);
  std::future<void> pictures;
  if (has_pictures) pictures = open_pictures_aside();
  Renderer renderer =
      make_renderer(*device, scene, make_renderer_options(options, count_samples(*stats.view, frames.size(), options)));
  take_setup(renderer.setup_stats(), stats, console);
  if (options.explained_pixel) {
    const Explanation explanation = renderer.explain(*stats.view, *options.explained_pixel);
    check_validation(*device, stats);
    fmt::print("{}", explain_json(explanation, scene));
    return;
  }
  // A plugin that does not load is told of before the tracing, which may take long.
  pictures.get();
  render_frames(frames, options, *device, scene, renderer, stats, console);

  if (options.error.time_limit_s) console.note(describe_target(stats));
  const DeferredSignals while_writing;
  stats.total_ms = total.ms();
  tell_end(stats, console);
  if (tracing.stats) write_text_file(*tracing.stats, to_json(stats));
  if (!console.is_quiet()) fmt::print("{}\n", summarize(stats, options));
}

}  // namespace

Command add_render_command(CLI::App& program) {
  CLI::App& command = add_command(program, "render", "Render a picture of a scene");
  const auto options = std::make_shared<RenderOptions>();
  add_render_options(command, *options);
  return {&command, [options, &command] { render(*options, given_options(command)); }};
}

}  // namespace promin::app
