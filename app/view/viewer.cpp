// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "output/deferred_signals.h"
#include "output/explanation.h"
#include "output/message_of.h"
#include "promin/error.h"
#include "promin/image.h"
#include "work/pictures/view_setup.h"

namespace promin::app {
namespace {

/// The wait in seconds while there is work but no frame is free.
constexpr double kShortWait = 1e-3;
/// The wait in seconds while there is no work. The scene's files are checked at this interval.
constexpr double kLongWait = 0.1;
/// The shortest time in seconds between two drawings of the window.
constexpr double kDrawInterval = 1.0 / 75.0;
/// The smallest fraction of a frame's target time that is used for tracing.
constexpr double kLeastTraceShare = 0.5;

/// Rotates the light. A drag over the window's height rotates it by half a turn. The step size keeps the numbers in
/// commands short.
void drag_light(Surroundings& surroundings, double pixels, double window_height) {
  constexpr double kStepsOfDegree = 8.0;
  const double turned = surroundings.light_rotation_deg + 180.0 / window_height * pixels;
  surroundings.light_rotation_deg = std::remainder(std::round(kStepsOfDegree * turned) / kStepsOfDegree, 360.0);
}

/// Returns the colour that a slider shows for a background before the user changes it, sRGB.
vec3 background_of(const Environment& environment) {
  const bool has_backdrop = environment.shows_backdrop();
  const vec3 light =
      has_backdrop ? 0.5F * (environment.backdrop->top + environment.backdrop->bottom) : environment.background;
  return {encode_srgb(light.x), encode_srgb(light.y), encode_srgb(light.z)};
}

}  // namespace

std::string title_of(const std::filesystem::path& file) {
  return file.filename().string() + " - promin";
}

Viewer::Viewer(Window& window, std::shared_ptr<const gpu::Device> device, const Console& console, ViewerStart start,
               Background<OpenedScene> opening)
    : window_(window),
      device_(std::move(device)),
      console_(console),
      start_(std::move(start)),
      follows_display_(!start_.target_ms && device_->profile().keeps_up_with_display),
      target_ms_(start_.target_ms.value_or(ViewerStart::kCpuTargetMs)),
      file_(start_.file),
      opening_(std::move(opening)),
      swapchain_(*device_, start_.present_mode),
      display_(*device_, swapchain_),
      frames_(device_, swapchain_) {
  if (start_.present_mode && *start_.present_mode != swapchain_.present_mode()) {
    console_.warn(fmt::format("the display does not support the present mode {}; promin uses {}", *start_.present_mode,
                              swapchain_.present_mode()));
  }
  switches_.scene = start_.choice;
  switches_.scale = start_.scale;
  switches_.surroundings.light_rotation_deg = start_.environment.light_rotation_deg;
  fit_window();
  imgui_ = std::make_unique<ImguiRenderer>(*device_, window, swapchain_);
}

Viewer::~Viewer() {
  try {
    device_->wait_idle();
  } catch (const vk::SystemError&) {
    // If the device was lost, an earlier exception has reported it.
  }
}

void Viewer::run() {
  const DeferredSignals signals;
  try {
    show_frames(signals);
  } catch (...) {
    // The flight that was recorded so far is complete, even if the device was lost.
    if (start_.record) write_camera_path(*start_.record, recorder_.path());
    throw;
  }
  if (wants_screenshot_) console_.warn("no screenshot was taken: the window closed before its picture was complete");
  if (start_.record) write_camera_path(*start_.record, recorder_.path());
  screenshot_.wait();
  update_screenshot();
  dialog_.close();
}

bool Viewer::is_busy() const {
  const auto is_idle = [](const std::unique_ptr<TracedPicture>& picture) { return picture->is_idle(); };
  return !disposals_.empty() || putting_.is_busy() || opening_.is_busy() || query_.is_busy() || framing_.is_busy() ||
         (preparer_ && preparer_->is_busy()) || (traced_ && !traced_->is_idle()) ||
         !std::all_of(retired_.begin(), retired_.end(), is_idle);
}

bool Viewer::is_at_rest() const {
  return frames_to_draw_ == 0 && frames_.is_idle() && !is_busy() && !screenshot_.is_busy() && !is_replaying();
}

void Viewer::show_frames(const DeferredSignals& signals) {
  while (!is_quitting_ && !window_.should_close() && !signals.is_pending()) {
    handle_input();
    frames_.poll();
    update_opening();
    update_picture();
    update_surroundings();
    update_answers();
    update_screenshot();
    update_replay();
    if (describe_awaited() != shown_awaited_) draw_again();
    if (fit_window()) {
      if (!traced_) move_camera(false);
      trace();
      draw();
    }
    window_.wait(is_at_rest() ? kLongWait : kShortWait);
    // A rest lasts until the event that ends it.
    if (frames_to_draw_ == 0) keep_camera();
  }
  move_camera(false);
  console_.detail(fmt::format("no input waited longer than {:.0f} ms, for work of at most {:.0f} ms; {} keys pressed",
                              window_.longest_turn_ms(), window_.longest_work_ms(), window_.key_count()));
  // A screenshot that has been started is written.
  while (on_copied_) trace();
}

void Viewer::update_opening() {
  if (!opening_.is_ready()) return;
  try {
    show_scene(std::move(*opening_.take()));
  } catch (const Error& error) {
    // If the first scene fails, there is nothing else to show.
    if (!opened_.scene) throw;
    file_ = opened_.file;
    window_.set_title(title_of(file_));
    report_failure(error.what());
  }
}

void Viewer::show_scene(OpenedScene opened) {
  const bool is_first = !opened_.scene;
  // The integrator suits the file, unless the user has chosen another one in the panel.
  const bool has_chosen_integrator = !is_first && switches_.integrator != opened_.view.mode.integrator;
  opened_ = std::move(opened);
  const View& view = opened_.view;
  clock_ = AnimationClock(*opened_.scene, opened_.motion);
  control_ = CameraControl(view.camera, opened_.bounds, start_.up);
  camera_index_ = -1;
  replay_.reset();
  if (opened_.replay) replay_.emplace(*opened_.replay);
  has_replay_started_ = false;
  bookmarks_.clear();
  switches_.max_depth = view.max_depth;
  if (!has_chosen_integrator) switches_.integrator = view.mode.integrator;
  if (is_first) {
    switches_.has_shadows = view.mode.has_shadows;
    switches_.debug_view = view.mode.debug_view;
    window_.resize(view.size);
  } else {
    switches_.scene.lights_off.clear();
    switches_.scene.bvh.reset();
    switches_.surroundings = {.light_rotation_deg = start_.environment.light_rotation_deg};
  }
  keep_camera();
  preparer_ = std::make_unique<ScenePreparer>(device_, target_ms_, opened_.file, opened_.load, opened_.motion,
                                              opened_.sources, start_.look, opened_.environment, view);
  preparer_->begin(opened_.scene, opened_.look, request());
  draw_again();
}

PictureRequest Viewer::request() const {
  // If a picture must be shown in full from the start, it does not begin with a draft. No other kernel is compiled
  // before it is shown.
  const bool has_draft = asked_mode().debug_view == DebugView::kNone && !opened_.replay && !start_.record;
  const bool needs_draft = !traced_ || (is_draft_ && !traced_->picture().shown());
  return {.choice = switches_.scene,
          .surroundings = switches_.surroundings,
          .mode = asked_mode(),
          .motion = clock_.pose(),
          .size = glm::max(swapchain_.size(), uvec2(1)),
          .is_draft = has_draft && needs_draft};
}

void Viewer::move_camera(bool is_of_flight) {
  const Motion motion = window_.take_motion();
  if (motion.light != 0.0) drag_light(switches_.surroundings, motion.light, window_.framebuffer_size().y);
  if (is_of_flight) control_.place(replay_->next_camera(Window::now()));
  // The camera does not move while a screenshot waits.
  if (!is_replaying() && !wants_screenshot_ && opened_.scene) control_.apply(motion, window_.framebuffer_size().y);
  keep_camera();
}

void Viewer::keep_camera() {
  if (start_.record && opened_.scene) recorder_.add(Window::now(), control_.camera(), opened_.scene->center);
}

bool Viewer::is_picture_due() const {
  return !switches_.is_paused && replay_->is_due(Window::now());
}

void Viewer::update_replay() {
  if (!replay_ || !traced_) return;
  if (!has_replay_started_) {
    if (!traced_->picture().is_complete() || is_draft_) return;
    has_replay_started_ = true;
  } else if (replay_->is_done() && !traced_->is_busy()) {
    fmt::print("{}\n", replay_->summarize());
    std::fflush(stdout);
    replay_.reset();
    is_quitting_ = is_quitting_ || !start_.stays_open;
  }
}

void Viewer::update_screenshot() {
  try {
    if (std::optional<std::string> text = screenshot_.take()) {
      const std::string command = std::exchange(saved_command_, {});
      if (!command.empty()) window_.copy(command);
      report(*text +
             (command.empty() ? "" : "; this command renders the same and was copied to the clipboard: " + command));
    }
  } catch (const Error& error) {
    saved_command_.clear();
    report_failure(error.what());
  }
}

void Viewer::dispose() {
  std::erase_if(disposals_, [](const std::future<void>& disposal) {
    return disposal.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  for (std::unique_ptr<TracedPicture>& picture : retired_) {
    if (!picture->is_idle()) continue;
    disposals_.push_back(std::async(std::launch::async, [gone = std::move(picture)]() mutable { gone.reset(); }));
  }
  std::erase(retired_, nullptr);
}

void Viewer::update_picture() {
  dispose();
  if (!preparer_) return;
  // A pixel query uses the lights that would change. Compilation also uses them if the scene is not on a separate
  // device.
  const bool is_free = !traced_ || !traced_->picture().is_compiling() || sets_apart(*device_);
  if (preparer_->is_ready() && !query_.is_busy() && !on_copied_ && is_free && has_shown_pose()) {
    try {
      show_picture(std::move(*preparer_->take()));
    } catch (const std::exception& error) {
      if (!traced_) throw;
      // After any error, also a lack of memory, the old picture stays.
      clock_.stop();
      report_failure(error.what());
    }
  }
  // Compilation may run on the devices to which the environment is copied, so only one of the two may run.
  if (!traced_ || putting_.is_busy() || preparer_->is_busy()) return;
  // The pose rests while a screenshot waits.
  const double now_s = Window::now();
  if (!wants_screenshot_ && !on_copied_) move_time(now_s);
  const bool is_playing = clock_.is_playing();
  if (preparer_->update(scene_, traced_->scene().device, request(), now_s) && !is_playing) draw_again();
}

bool Viewer::may_put_surroundings() const {
  const auto is_idle = [](const std::unique_ptr<TracedPicture>& picture) { return picture->is_idle(); };
  return traced_ && !putting_.is_busy() && scene_->surroundings != switches_.surroundings &&
         scene_->takes(switches_.surroundings) && !preparer_->is_busy() && !query_.is_busy() && !on_copied_ &&
         !traced_->picture().is_compiling() && std::all_of(retired_.begin(), retired_.end(), is_idle);
}

void Viewer::move_time(double now_s) {
  clock_.advance(now_s);
  if (clock_.is_playing() == playing_since_s_.has_value()) return;
  if (playing_since_s_) {
    console_.detail(fmt::format("played {} poses in {:.1f} s, {} of them with a scene that was on the device",
                                played_poses_, now_s - *playing_since_s_, reused_scenes_));
    playing_since_s_.reset();
  } else {
    playing_since_s_ = now_s;
    played_poses_ = 0;
    reused_scenes_ = 0;
  }
}

void Viewer::update_surroundings() {
  try {
    if (putting_.take()) {
      traced_->picture().take_scene_change();
      draw_again();
    }
  } catch (const std::exception& error) {
    report_failure(error.what());
  }
  if (!may_put_surroundings() || !traced_->is_idle()) return;
  scene_->surroundings = switches_.surroundings;
  putting_.start([scene = scene_] {
    scene->put();
    return true;
  });
}

void Viewer::show_picture(ReadyPicture ready) {
  ready.take_lights();
  const bool is_first = !scene_;
  const bool is_new = scene_ && scene_->base != ready.scene->base;
  if (is_new && scene_->base != opened_.scene) move_cameras(scene_->scene->center - ready.scene->scene->center);
  if (scene_ != ready.scene) explanation_.close();
  if (scene_ && scene_->motion != ready.scene->motion) {
    ++played_poses_;
    if (ready.is_reused) ++reused_scenes_;
  }
  if (traced_ && !is_new) ready.picture->picture().take_pace(traced_->picture());
  if (traced_) retired_.push_back(std::move(traced_));
  traced_ = std::move(ready.picture);
  scene_ = std::move(ready.scene);
  mode_ = ready.mode;
  is_draft_ = ready.is_draft;
  draw_again();
  std::string text = is_new ? "read " + file_.filename().string() : "";
  if (is_new) report(text);
  const auto warn = [&](const std::string& warning) {
    console_.warn(warning);
    text += "\nwarning: " + warning;
  };
  if (is_new) {
    for (const std::string& warning : scene_->scene->warnings) warn(warning);
  }
  if (is_new || is_first) {
    for (const Problem& warning : scene_->setup_stats.warnings) warn(message_of(warning));
  }
  if (is_new) message_ = text;
}

void Viewer::move_cameras(const dvec3& offset) {
  if (offset == dvec3(0.0)) return;
  control_.move(offset);
  for (Camera& bookmark : bookmarks_) bookmark.eye = vec3(dvec3(bookmark.eye) + offset);
}

void Viewer::update_answers() {
  try {
    if (std::optional<ExplainedPixel> answer = query_.take_explained()) {
      console_.detail(fmt::format("explained: {}; {} keys pressed before", answer->title, window_.key_count()));
      console_.details(explain_text(answer->explanation, *answer->scene));
      explanation_.open(std::move(*answer));
      draw_again();
    }
    if (const std::optional<std::optional<dvec3>> point = query_.take_point()) {
      std::optional<dvec3> center = *point;
      if (!center && is_of_middle_ && !opened_.bounds.is_empty()) center = dvec3(opened_.bounds.center());
      if (std::exchange(wants_orbit_, false) && center) control_.orbit(*center);
      draw_again();
    }
    if (const std::optional<Camera> framed = framing_.take()) control_.place(*framed);
  } catch (const std::exception& error) {
    wants_orbit_ = wants_orbit_ && query_.is_looking_for_point();
    report_failure(error.what());
  }
}

bool Viewer::awaits_mode() const {
  return is_draft_ || (mode_ != asked_mode() && preparer_->will_show(asked_mode()));
}

std::string Viewer::describe_awaited() const {
  if (opening_.is_busy()) return "loading " + file_.filename().string();
  if (preparer_ && preparer_->is_busy()) return preparer_->describe();
  if (traced_ && traced_->picture().is_compiling()) return "compiling the kernels for refinement";
  return query_.is_busy() ? "tracing a pixel" : "";
}

bool Viewer::fit_window() {
  if (window_.take_change_of_place() && follows_display_) target_ms_ = window_.refresh_interval_ms();
  // Drawing takes milliseconds, so waiting for its end is short.
  if (imgui_ && window_.overlay_scale() != imgui_->scale()) {
    frames_.finish();
    imgui_->set_scale(window_.overlay_scale());
    draw_again();
  }
  const uvec2 size = window_.framebuffer_size();
  if (size.x == 0 || size.y == 0) return false;
  // The size of the surface may differ from the requested size.
  if (!swapchain_.is_out_of_date() && size == asked_size_) return true;
  frames_.finish();
  if (!swapchain_.recreate(size)) return false;
  asked_size_ = size;
  draw_again();
  return true;
}

void Viewer::trace() {
  for (const std::unique_ptr<TracedPicture>& retired : retired_) static_cast<void>(retired->poll(Window::now()));
  if (!traced_) return;
  while (const std::optional<FinishedFrame> finished = traced_->poll(Window::now())) take_finished(*finished);
  // The encoded picture must be taken before the next frame encodes again.
  if (!frames_.is_idle()) return;
  if (const std::optional<EncodedPicture> encoded = traced_->take_encoded()) {
    display_.take(*encoded);
    log_shown();
    frames_to_draw_ = std::max(frames_to_draw_, 1);
  }
  // No new frame may begin, because the ready picture will replace the current one or its scene is about to change.
  if ((preparer_->is_ready() && !on_copied_) || putting_.is_busy() || may_put_surroundings()) return;
  if (traced_->size() != swapchain_.size()) {
    if (traced_->is_busy()) return;
    traced_->resize(swapchain_.size());
  }
  if (has_tracing()) begin_frame();
}

void Viewer::log_shown() {
  static constexpr std::array kWords = {"nothing", "a draft", "a picture", "a refined picture"};
  const bool is_refined = traced_->picture().shown()->error.has_value();
  const Shown shown = is_draft_ ? Shown::kDraft : is_refined ? Shown::kRefined : Shown::kWhole;
  if (shown <= best_shown_) return;
  best_shown_ = shown;
  console_.detail(
      fmt::format("shown: {}; {} keys pressed before", kWords[static_cast<size_t>(shown)], window_.key_count()));
}

bool Viewer::has_tracing() const {
  if (is_replaying() && !switches_.is_paused) return is_picture_due();
  // The window applies the pause switch to the picture at the end of a frame.
  if (holds_refinement() != traced_->picture().is_paused()) return true;
  return window_.is_moving() || window_.has_turned() || wants_screenshot_ || traced_->has_work() ||
         traced_->display().exposure_ev != display().exposure_ev ||
         !shows_same(current_view(), traced_->picture().wanted());
}

void Viewer::begin_frame() {
  if (traced_->is_tracing()) return traced_->ask(Window::now());
  const bool is_of_flight = is_replaying() && is_picture_due();
  move_camera(is_of_flight);
  traced_->expose(display().exposure_ev);
  ProgressivePicture& picture = traced_->picture();
  picture.fix_scale(switches_.scale);
  picture.want(current_view());
  // While paused, only pictures that a screenshot needs are traced.
  picture.pause(holds_refinement() && !(wants_screenshot_ && !picture.is_complete()));
  traced_->begin_frame(is_of_flight, Window::now(),
                       [this](const vk::raii::CommandBuffer& commands) { record_screenshot(commands); });
}

void Viewer::record_screenshot(const vk::raii::CommandBuffer& commands) {
  const ProgressivePicture& picture = traced_->picture();
  if (!wants_screenshot_ || !picture.is_complete() || awaits_mode() || screenshot_.is_busy()) return;
  const View view = picture.shown()->view_of(picture.wanted());
  screenshot_.record_copy(traced_->scene().device, commands, picture.film(picture.shown()->film), view,
                          picture.has_unlit());
  const std::optional<std::filesystem::path> file = std::exchange(saved_file_, std::nullopt);
  DescribedScene described = described_scene(view);
  described.output = file;
  saved_command_ = file && can_describe(described, view) ? describe_command(described, view) : "";
  on_copied_ = [this, view, file, error = picture.shown()->error](const FinishedFrame& finished) {
    // The picture is not complete.
    if (finished.has_cut_loops) return screenshot_.drop();
    RunStats& stats = opened_.stats;
    stats.device = traced_->scene().device->info();
    stats.view = view;
    stats.errors.clear();
    if (error) stats.errors.push_back(*error);
    stats.display = traced_->display();
    stats.motion = scene_->motion;
    screenshot_.write(describe_picture(stats), stats.display, file);
  };
  wants_screenshot_ = false;
}

void Viewer::take_finished(const FinishedFrame& finished) {
  if (!finished.has_list && on_copied_) std::exchange(on_copied_, {})(finished);
  statistics_.add(finished);
  if (finished.is_of_flight) replay_->add(finished);
  if (finished.units == 0.0) return;
  try {
    traced_->learn(finished);
  } catch (const RunError& error) {
    if (!is_failure_) report_failure(error.what());
  }
  traced_->picture().set_budget(std::max(kLeastTraceShare * target_ms_, target_ms_ - statistics_.overhead_ms()));
}

void Viewer::draw() {
  if (frames_to_draw_ == 0 || Window::now() < next_draw_s_) return;
  const vk::raii::CommandBuffer* commands = frames_.begin();
  if (commands == nullptr) return;
  next_draw_s_ = Window::now() + kDrawInterval;
  --frames_to_draw_;
  build_overlay();
  window_.set_overlay_wants(imgui_->wants_keys(), imgui_->wants_pointer());
  swapchain_.begin_drawing(*commands, frames_.image());
  display_.record_drawing(*commands, swapchain_.size());
  imgui_->record(*commands);
  commands->endRenderPass();
  frames_.submit();
}

void Viewer::build_overlay() {
  imgui_->begin_frame();
  shown_awaited_ = describe_awaited();
  std::optional<WindowArea> panel;
  if (has_overlay_ && (!has_help_ || has_room_beside_help())) {
    OverlayContent content;
    content.statistics = &statistics_;
    content.picture = traced_ ? &traced_->picture() : nullptr;
    content.scene = scene_ ? scene_->scene.get() : nullptr;
    content.device = fmt::format("{} ({})", device_->info().name, device_->info().type);
    content.speed = control_.speed();
    if (scene_) content.exposure_ev = scene_->display.exposure_ev;
    if (scene_) content.background = background_of(scene_->scene->environment);
    content.awaited = shown_awaited_;
    content.message = message_;
    content.is_failure = is_failure_;
    content.bookmarks = bookmarks_;
    if (!replay_) content.clock = &clock_;
    content.entry = path_entry_ ? &*path_entry_ : nullptr;
    const OverlayAnswer answer = show_overlay(content, switches_);
    // The panel gets the height of its text in the next frame.
    if (std::exchange(overlay_height_, answer.height) != answer.height) frames_to_draw_ = std::max(frames_to_draw_, 1);
    panel = answer.area;
    if (answer.asked) ask_for_file(*answer.asked);
    if (answer.has_typed) take_file(path_entry_->use, path_entry_->text.data());
    if (answer.gives_up) path_entry_.reset();
    if (answer.camera) control_.place(*answer.camera);
    if (answer.speed) control_.set_speed(*answer.speed);
  }
  if (has_help_) {
    show_help();
  } else if (explanation_.is_open()) {
    explanation_.show(control_.camera(), scene_->display, panel);
  }
  imgui_->end_frame();
}

void Viewer::report(const std::string& text) {
  message_ = text;
  is_failure_ = false;
  console_.note(text);
  draw_again();
}

void Viewer::report_failure(const std::string& text) {
  message_ = text;
  is_failure_ = true;
  console_.warn(text);
  draw_again();
}

DisplayTransform Viewer::display() const {
  if (mode_.debug_view != DebugView::kNone) return {};
  DisplayTransform display = scene_->display;
  if (switches_.exposure_ev) display.exposure_ev = *switches_.exposure_ev;
  return display;
}

View Viewer::current_view() const {
  View view;
  view.camera = control_.camera();
  view.size = traced_->picture().full_size();
  view.filter = opened_.view.filter;
  view.filter_width = opened_.view.filter_width;
  view.max_depth = switches_.effective_depth();
  view.mode = mode_;
  // A flight is never at rest, and a draft is soon replaced by a better picture.
  if (mode_.debug_view == DebugView::kNone && !is_replaying() && !is_draft_ && !clock_.is_playing()) {
    view.error_target = start_.error_target;
    fit_to_display(*view.error_target, display());
  }
  return view;
}

View Viewer::reproducible_view() const {
  View view = current_view();
  const ProgressivePicture& picture = traced_->picture();
  // The view may have another error target than the shown picture.
  if (picture.is_complete() && shows_same(view, picture.wanted())) return picture.shown()->view_of(picture.wanted());
  view.error_target.reset();
  return view;
}

}  // namespace promin::app
