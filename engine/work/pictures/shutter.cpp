// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/shutter.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/radical_inverse.h"
#include "trace/film/film_records.h"
#include "work/pictures/camera_choice.h"
#include "work/pictures/camera_path.h"
#include "work/pictures/view_setup.h"

namespace promin::work {
namespace {

template <typename Value>
void add_values(const std::vector<Value>& more, std::vector<Value>& sum) {
  for (size_t i = 0; i < std::min(sum.size(), more.size()); ++i) sum[i] += more[i];
}

template <typename Value>
void divide_values(float count, std::vector<Value>& sum) {
  if constexpr (std::is_same_v<Value, uint32_t>) return;
  for (Value& value : sum) value = value / static_cast<Value>(count);
}

/// Returns whether a picture has the mean of an AOV over its samples.
constexpr bool is_mean(AovSource source) {
  return source == AovSource::kParts || source == AovSource::kUnlit;
}

/// Counts the objects that a sample shows.
void count_objects(const Aovs& sample, CoverageTally& tally) {
  for (size_t i = 0; i < sample.object_coverage.size(); ++i) tally.add(i, sample.object_coverage[i].front().id);
}

/// Adds the result of a sample to the sum of those before it. The middle sample gives the AOVs of surfaces.
void add_sample(RenderResult& sample, bool is_middle, RenderResult& sum) {
  add_values(sample.image.pixels, sum.image.pixels);
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (is_mean(AovSource::SOURCE)) {                                \
    add_values(sample.aovs.FIELD, sum.aovs.FIELD);                 \
  } else if (is_middle) {                                          \
    sum.aovs.FIELD = std::move(sample.aovs.FIELD);                 \
  }
#include "promin/kinds/aovs.def"
  sum.rays += sample.rays;
  sum.trace_ms += sample.trace_ms;
}

void finish(uint32_t count, RenderResult& sum) {
  const auto divisor = static_cast<float>(count);
  divide_values(divisor, sum.image.pixels);
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (is_mean(AovSource::SOURCE)) divide_values(divisor, sum.aovs.FIELD);
#include "promin/kinds/aovs.def"
  std::ranges::fill(sum.aovs.samples, count);
  sum.samples_per_pixel = count;
}

}  // namespace

PlannedFrame frame_between(const PictureRun& run, const PlannedFrame& frame, double fraction) {
  PlannedFrame moment = frame;
  double interval_s = 1.0 / run.options.fps.value_or(kDefaultFps);
  if (frame.path != nullptr) {
    const PathPictures path = frame.path->moved_to(run.scene.center);
    interval_s = path.seconds_after(*frame.number);
    moment.camera = path.camera_after(*frame.number, fraction * interval_s);
    put_lens(run.options.view, *moment.camera);
  } else if (run.options.turntable) {
    moment.camera = turn_around(run.scene, run.options.view, *frame.camera, fraction, *run.options.turntable);
  }
  if (frame.time_s) moment.time_s = *frame.time_s + fraction * interval_s;
  return moment;
}

namespace {

TracedFrame trace_open_shutter(FrameRenderers& renderers, FrameMotion& motion, const PictureRun& run,
                               const PlannedFrame& frame, const View& view, const ProgressCallback& on_progress) {
  const double shutter = run.options.shutter.value_or(0.0);
  const uint32_t count = view.samples_per_pixel;
  RenderResult sum;
  std::vector<uint32_t> materials;
  for (const Object& object : run.scene.objects) materials.push_back(object.material);
  std::optional<CoverageTally> tally;
  for (uint32_t i = 0; i < count; ++i) {
    const double fraction = shutter * radical_inverse(i);
    const PlannedFrame moment = frame_between(run, frame, fraction);
    Renderer& renderer = renderers.at(moment);
    View view_then = view;
    RunStats unused;
    renderers.describe(moment, view_then, unused);
    RenderResult sample = render_sample(renderer, view_then, i,
                                        [&](double done) { return !on_progress || on_progress((i + done) / count); });
    const bool is_middle = i == count / 2;
    if (!tally) tally.emplace(sample.aovs.object_coverage.size(), materials);
    count_objects(sample.aovs, *tally);
    if (is_middle) motion.add(frame, fraction, view_then, sample.aovs);
    if (i == 0) {
      sum = std::move(sample);
    } else {
      add_sample(sample, is_middle, sum);
    }
  }
  finish(count, sum);
  for (size_t i = 0; i < sum.aovs.object_coverage.size(); ++i) tally->put(i, count, i, sum.aovs);
  TracedFrame traced;
  traced.trace_ms.push_back(sum.trace_ms);
  traced.result = std::move(sum);
  return traced;
}

}  // namespace

TracedFrame trace_frame(FrameRenderers& renderers, FrameMotion& motion, const PictureRun& run,
                        const PlannedFrame& frame, const View& view, const std::optional<double>& limit_s,
                        const ProgressCallback& on_progress) {
  if (run.options.shutter) return trace_open_shutter(renderers, motion, run, frame, view, on_progress);
  TracedFrame traced = trace(renderers.at(frame), view, run.options, limit_s, on_progress);
  motion.add(frame, 0.0, view, traced.result.aovs);
  return traced;
}

}  // namespace promin::work
