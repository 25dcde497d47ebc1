// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "deferred_signals.h"
#include "promin/error.h"
#include "run_program.h"

namespace promin::app {
namespace {

/// The wait in seconds while there is something to do but no frame is free.
constexpr double kShortWait = 1e-3;
/// The wait in seconds while there is nothing to do; the scene's files are looked at as often.
constexpr double kLongWait = 0.1;
/// The least part of a frame's target time that is spent on tracing.
constexpr double kLeastTraceShare = 0.5;

}  // namespace

Viewer::Viewer(Window& window, const gpu::Device& device, const Console& console, ScenePreparer& preparer,
               ReadyPicture picture, ViewerStart start, RunStats stats)
    : window_(window),
      device_(device),
      console_(console),
      preparer_(preparer),
      start_(std::move(start)),
      stats_(std::move(stats)),
      follows_display_(!start_.target_ms && device.profile().keeps_up_with_display),
      target_ms_(start_.target_ms.value_or(ViewerStart::kCpuTargetMs)),
      control_(start_.view.camera, speed_to_cross(bounds_of(*picture.scene->scene))),
      swapchain_(device, start_.present_mode),
      display_(device, swapchain_),
      frames_(device, swapchain_),
      screenshot_(device) {
  if (start_.present_mode && *start_.present_mode != swapchain_.present_mode()) {
    console_.warn(
        fmt::format("the window has no present mode {}; {} is used", *start_.present_mode, swapchain_.present_mode()));
  }
  if (start_.replay) replay_.emplace(*start_.replay);
  switches_.scene = start_.choice;
  switches_.scale = start_.scale;
  switches_.has_shadows = picture.mode.has_shadows;
  switches_.debug_view = picture.mode.debug_view;
  switches_.max_depth = start_.view.max_depth;
  show_picture(std::move(picture));
  fit_window();
  imgui_ = std::make_unique<ImguiRenderer>(device, window, swapchain_);
}

Viewer::~Viewer() {
  try {
    device_.wait_idle();
  } catch (const vk::SystemError&) {
    // A lost device: what threw before says so.
  }
}

void Viewer::run() {
  const DeferredSignals signals;
  try {
    show_frames(signals);
  } catch (...) {
    // The flight up to here is whole, whatever happened to the device.
    if (start_.record) write_camera_path(*start_.record, recorder_.path());
    throw;
  }
  if (wants_screenshot_) console_.warn("no screenshot was taken: the window closed before its picture was complete");
  if (start_.record) write_camera_path(*start_.record, recorder_.path());
  screenshot_.wait();
  update_screenshot();
}

void Viewer::show_frames(const DeferredSignals& signals) {
  keep_camera();
  while (!is_quitting_ && !window_.should_close() && !signals.is_pending()) {
    window_.poll();
    frames_.poll([&](const FinishedFrame& finished) { take_finished(finished); });
    handle_input();
    update_picture();
    update_answers();
    update_screenshot();
    update_replay();
    // Asking the display for the window's size takes as long as drawing the overlay; no frame, no question.
    if (!frames_.has_room()) {
      if (has_work()) frames_.ask();
      window_.wait(kShortWait);
      continue;
    }
    if (!fit_window() || !has_work()) {
      const bool is_at_rest =
          frames_.is_idle() && !preparer_.is_busy() && !query_.is_busy() && !screenshot_.is_busy() && !is_replaying();
      window_.wait(is_at_rest ? kLongWait : kShortWait);
      // The rest lasts until the event that ends it.
      keep_camera();
      continue;
    }
    Frame* frame = frames_.begin();
    if (frame == nullptr) {
      window_.wait(kShortWait);
      continue;
    }
    record(*frame);
    frames_.submit(*frame);
  }
  keep_camera();
  finish_frames();
}

void Viewer::move_camera(Frame& frame) {
  const Motion motion = window_.take_motion();
  if (is_replaying()) {
    frame.is_of_flight = is_picture_due();
    if (frame.is_of_flight) control_.place(replay_->next_camera(Window::now()));
  } else if (!wants_screenshot_) {
    // While a screenshot waits the camera holds still.
    control_.apply(motion, window_.framebuffer_size().y);
  }
  keep_camera();
}

void Viewer::keep_camera() {
  if (start_.record) recorder_.add(Window::now(), control_.camera(), scene_->scene->center);
}

bool Viewer::is_picture_due() const {
  return !switches_.is_paused && replay_->is_due(Window::now());
}

void Viewer::update_replay() {
  if (!replay_) return;
  if (!has_replay_started_) {
    if (!picture_->is_complete()) return;
    has_replay_started_ = true;
  } else if (replay_->is_done() && frames_.is_idle()) {
    fmt::print("{}\n", replay_->summarize());
    std::fflush(stdout);
    replay_.reset();
    is_quitting_ = is_quitting_ || !start_.stays_open;
  }
}

void Viewer::update_screenshot() {
  try {
    if (const std::optional<std::string> text = screenshot_.take()) report(*text);
  } catch (const Error& error) {
    report_failure(error.what());
  }
}

void Viewer::update_picture() {
  // All must be idle: a frame in flight traces the picture that would go, and a question and what is compiled for the
  // picture use the lights that would change.
  if (preparer_.is_ready() && frames_.is_idle() && !query_.is_busy() && !picture_->is_compiling()) {
    try {
      show_picture(std::move(*preparer_.take()));
    } catch (const std::exception& error) {
      // Whatever the error is, lack of memory included, the old picture stays.
      report_failure(error.what());
    }
  }
  const PictureRequest request{switches_.scene, asked_mode(), swapchain_.size()};
  if (preparer_.update(scene_, request, Window::now())) draw_again();
}

void Viewer::show_picture(ReadyPicture ready) {
  // The new picture may be too large for the memory, so its room is made before the old one goes.
  if (asked_size_ != uvec2(0)) ready.picture.resize(swapchain_.size());
  ready.take_lights();
  const bool is_new = scene_ && scene_->scene != ready.scene->scene;
  if (is_new) move_cameras(scene_->scene->center - ready.scene->scene->center);
  if (!scene_ || scene_ != ready.scene) explanation_.text.clear();
  picture_.emplace(std::move(ready.picture));
  scene_ = std::move(ready.scene);
  mode_ = ready.mode;
  // The window has no size before it has images.
  if (asked_size_ != uvec2(0)) fit_picture();
  draw_again();
  if (!is_new) return;
  std::string text = "read " + start_.file.filename().string();
  report(text);
  const auto warn = [&](const std::string& warning) {
    console_.warn(warning);
    text += "\nwarning: " + warning;
  };
  for (const std::string& warning : scene_->scene->warnings) warn(warning);
  for (const Problem& warning : scene_->renderer->setup_stats().warnings) warn(message_of(warning));
  message_ = text;
}

void Viewer::move_cameras(const dvec3& offset) {
  if (offset == dvec3(0.0)) return;
  control_.move(offset);
  for (Camera& bookmark : bookmarks_) bookmark.eye = vec3(dvec3(bookmark.eye) + offset);
}

void Viewer::update_answers() {
  try {
    if (std::optional<PixelText> answer = query_.take_text()) {
      explanation_ = std::move(*answer);
      console_.details(explanation_.text);
      draw_again();
    }
    if (const std::optional<std::optional<dvec3>> middle = query_.take_middle()) {
      const Bounds bounds = bounds_of(*scene_->scene);
      const std::optional<dvec3> center =
          *middle || bounds.is_empty() ? *middle : std::optional(dvec3(bounds.center()));
      if (std::exchange(wants_orbit_, false) && center) control_.orbit(*center);
      draw_again();
    }
  } catch (const std::exception& error) {
    wants_orbit_ = wants_orbit_ && query_.is_looking_for_middle();
    report_failure(error.what());
  }
}

bool Viewer::awaits_mode() const {
  return mode_ != asked_mode() && preparer_.will_show(asked_mode());
}

std::string Viewer::describe_awaited() const {
  if (preparer_.is_busy()) return preparer_.describe();
  if (picture_->is_compiling()) return "compiling what refines";
  return query_.is_busy() ? "tracing a pixel" : "";
}

bool Viewer::fit_window() {
  if (window_.take_change_of_place() && follows_display_) target_ms_ = window_.refresh_interval_ms();
  if (imgui_ && window_.overlay_scale() != imgui_->scale()) {
    finish_frames();
    imgui_->set_scale(window_.overlay_scale());
    draw_again();
  }
  const uvec2 size = window_.framebuffer_size();
  if (size.x == 0 || size.y == 0) return false;
  // The surface may have given another size than it was asked for.
  if (!swapchain_.is_out_of_date() && size == asked_size_) return true;
  finish_frames();
  const uvec2 before = swapchain_.size();
  if (!swapchain_.recreate(size)) return false;
  asked_size_ = size;
  if (swapchain_.size() != before) fit_picture();
  draw_again();
  return true;
}

void Viewer::fit_picture() {
  picture_->resize(swapchain_.size());
  const uvec2 full_size = picture_->full_size();
  display_.bind({&picture_->film(0), &picture_->film(1)}, full_size.x * full_size.y, display(), picture_->has_unlit());
  encoded_count_ = 0;
}

void Viewer::finish_frames() {
  frames_.finish([&](const FinishedFrame& finished) { take_finished(finished); });
}

void Viewer::take_finished(const FinishedFrame& finished) {
  statistics_.add(finished);
  if (finished.is_of_flight) replay_->add(finished);
  if (finished.units == 0.0) return;
  const double trace_ms = finished.stages.trace > 0.0 ? finished.stages.trace : finished.time_ms;
  try {
    picture_->take_finished({.units = finished.units,
                             .time_ms = trace_ms,
                             .has_cut_loops = finished.has_cut_loops,
                             .has_list = finished.has_list});
  } catch (const RunError& error) {
    if (!is_failure_) report_failure(error.what());
  }
  picture_->set_budget(std::max(kLeastTraceShare * target_ms_, target_ms_ - statistics_.overhead_ms()));
}

bool Viewer::has_work() const {
  // The ready picture is taken in when the last frame is done, so no new frame may begin.
  if (preparer_.is_ready()) return false;
  if (is_replaying() && !switches_.is_paused) return is_picture_due();
  return frames_to_draw_ > 0 || window_.is_moving() || wants_screenshot_ ||
         (!picture_->is_settled() && !picture_->awaits_samples());
}

void Viewer::record(Frame& frame) {
  move_camera(frame);
  build_overlay();
  picture_->fix_scale(switches_.scale);
  picture_->want(current_view());
  // While paused, tracing goes on only as far as a screenshot needs.
  picture_->pause(switches_.is_paused && !(wants_screenshot_ && !picture_->is_complete()));
  record_tracing(frame);
  record_display(frame);
  if (frames_to_draw_ > 0) --frames_to_draw_;
}

void Viewer::record_tracing(Frame& frame) {
  using Stage = vk::PipelineStageFlagBits;
  // The frame before may have copied a screenshot from the film that is traced now.
  frame.commands.pipelineBarrier(Stage::eTransfer, Stage::eComputeShader, {}, {}, {}, {});
  frame.units = picture_->record(frame.commands);
  frame.has_list = picture_->has_recorded_list();
  if (frame.units > 0.0) picture_->record_take_counts(frame.commands, *frame.counters);
  if (wants_screenshot_ && picture_->is_complete() && !awaits_mode() && !screenshot_.is_busy()) {
    const View view = picture_->shown()->view_of(picture_->wanted());
    screenshot_.record_copy(frame.commands, picture_->film(picture_->shown()->film), view, picture_->has_unlit());
    frame.on_finished = [this, view, error = picture_->shown()->error](const FinishedFrame& finished) {
      // It is not whole.
      if (finished.has_cut_loops) {
        screenshot_.drop();
        return;
      }
      stats_.view = view;
      stats_.errors.clear();
      if (error) stats_.errors.push_back(*error);
      stats_.display = display();
      screenshot_.write(describe_picture(stats_), stats_.display);
    };
    wants_screenshot_ = false;
  }
  frame.mark(FrameMark::kTraced);
}

void Viewer::record_display(const Frame& frame) {
  if (encoded_count_ != picture_->shown_count()) {
    display_.record_encoding(frame.commands, *picture_->shown());
    encoded_count_ = picture_->shown_count();
  }
  swapchain_.begin_drawing(frame.commands, frame.image);
  display_.record_drawing(frame.commands, swapchain_.size());
  frame.mark(FrameMark::kDisplayed);
  imgui_->record(frame.commands);
  frame.commands.endRenderPass();
}

void Viewer::build_overlay() {
  imgui_->begin_frame();
  if (has_overlay_) {
    OverlayContent content;
    content.statistics = &statistics_;
    content.picture = &*picture_;
    content.scene = scene_->scene.get();
    content.device = fmt::format("{} ({})", device_.info().name, device_.info().type);
    content.speed = control_.speed();
    content.is_orbiting = control_.is_orbiting();
    content.awaited = describe_awaited();
    content.message = message_;
    content.is_failure = is_failure_;
    content.bookmarks = bookmarks_;
    if (const std::optional<Camera> picked = show_overlay(content, switches_)) control_.place(*picked);
  }
  if (has_help_) show_help();
  if (!explanation_.text.empty() && !show_explanation(explanation_.title, explanation_.text)) explanation_.text.clear();
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
  return mode_.debug_view == DebugView::kNone ? scene_->display : DisplayTransform();
}

View Viewer::current_view() const {
  View view;
  view.camera = control_.camera();
  view.size = picture_->full_size();
  view.filter = start_.view.filter;
  view.filter_width = start_.view.filter_width;
  view.max_depth = switches_.effective_depth();
  view.mode = mode_;
  // A flight is never at rest, and compiling what refines would take its time.
  if (mode_.debug_view == DebugView::kNone && !is_replaying()) {
    view.error_target = start_.error_target;
    fit_to_display(*view.error_target, scene_->display);
  }
  return view;
}

View Viewer::reproducible_view() const {
  View view = current_view();
  if (picture_->is_complete() && shows_same(view, picture_->wanted())) return picture_->shown()->view_of(view);
  view.error_target.reset();
  return view;
}

}  // namespace promin::app
