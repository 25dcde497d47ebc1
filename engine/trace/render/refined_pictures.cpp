// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "promin/error.h"
#include "trace/render/picture_tracer.h"

// Pictures with an error target.
namespace promin {
namespace {

/// Factor by which refining to an error may exceed the estimated time.
constexpr double kCaution = 1.2;
/// Factor by which samples of a list take longer than samples of a whole picture.
constexpr double kListedCost = 1.5;
/// A picture is refined if reaching its first error leaves at least half of the time.
constexpr double kTimesFirstError = 2.0;
/// The fraction of the remaining time that is planned for a picture with a fixed number of samples.
constexpr double kPlannedShare = 0.95;
/// Factor of the time limit. A picture that takes longer, or is estimated to take longer, is abandoned.
constexpr double kLongest = 1.15;
/// The traced fraction of a picture from which its total time is estimated.
constexpr double kForetells = 0.1;

}  // namespace

PictureTracer::RefinedAovs PictureTracer::begin_refined_aovs(const PixelWindow& window, const View& view) const {
  const uvec2 size = window.hi - window.lo;
  const size_t count = static_cast<size_t>(size.x) * size.y;
  return {window, std::vector<LightParts>(has_parts(view.mode) ? count : 0),
          CoverageTally(wanted_.cryptomatte ? count : 0, scene_.object_materials())};
}

void PictureTracer::take_aovs(std::span<const ListedSample> list, const ReadFilm& read, RefinedAovs& aovs) const {
  if (aovs.parts.empty() && !wanted_.cryptomatte) return;
  const uint32_t width = aovs.window.hi.x - aovs.window.lo.x;
  for (size_t i = 0; i < list.size(); ++i) {
    const uvec2& pixel = list[i].pixel;
    // Samples of pixels around the window do not count here, because these pixels belong to other windows.
    if (glm::any(glm::lessThan(pixel, aovs.window.lo)) || glm::any(glm::greaterThanEqual(pixel, aovs.window.hi))) {
      continue;
    }
    const uvec2 place = pixel - aovs.window.lo;
    const size_t at = static_cast<size_t>(place.y) * width + place.x;
    if (!aovs.parts.empty()) aovs.parts[at].add(read, i);
    if (wanted_.cryptomatte) aovs.tally.add(at, object_of(read.record(0, i).w));
  }
}

void PictureTracer::refine(Refinement& refinement, const View& view, RefinedAovs& aovs, RenderResult& result,
                           const ProgressCallback& on_samples) {
  const size_t most_listed = std::min<size_t>(kMostListedSamples, kMaxFilmRecords / film_->records().count);
  std::vector<vec3> radiance;
  std::vector<vec4> unlit;
  for (auto list = refinement.next(most_listed); !list.empty(); list = refinement.next(most_listed)) {
    film_->put_list(list);
    const auto taken = static_cast<double>(refinement.sample_count());
    trace_window(*film_, list_window(list.size()), view, {0, 1}, result, [&](double fraction) {
      return !on_samples || on_samples(taken + fraction * static_cast<double>(list.size()));
    });
    const ReadFilm read = film_->read_list();
    radiance.resize(list.size());
    average_samples(read.records, 1, radiance);
    take_aovs(list, read, aovs);
    read_unlit(read, list.size(), unlit);
    refinement.take(radiance, unlit);
  }
}

void PictureTracer::take_refined(const Refinement& refinement, const RefinedAovs& aovs, const View& view,
                                 RenderResult& result) const {
  const PixelWindow& window = aovs.window;
  const PixelWindow whole = picture_window(view);
  const uvec2 size = window.hi - window.lo;
  refinement.add_to(*result.error);
  for (size_t i = 0; i < refinement.pixel_count(); ++i) {
    const uvec2 place = window.lo - whole.lo + uvec2(i % size.x, i / size.x);
    const size_t at = static_cast<size_t>(place.y) * result.image.size.x + place.x;
    const PixelEstimate& estimate = refinement.estimate(i);
    result.image.pixels[at] = estimate.mean();
    if (!result.aovs.samples.empty()) result.aovs.samples[at] = estimate.count();
    if (!result.aovs.error.empty()) result.aovs.error[at] = refinement.claim(i);
    if (!aovs.parts.empty()) aovs.parts[i].put(estimate.count(), at, result.aovs, result.image.pixels[at]);
    if (tells_unlit(view.mode)) result.aovs.unlit[at] = refinement.unlit(i);
    if (wanted_.cryptomatte) aovs.tally.put(i, estimate.count(), at, result.aovs);
  }
}

bool PictureTracer::tells_of_centers() const {
  return wanted_.steps || wanted_.has_any(AovSource::kSurface);
}

void PictureTracer::prepare_to_refine(const View& view) {
  prepare_refining_film(view.mode, has_lens(view.camera));
  if (tells_of_centers()) prepare_middle_film(view.mode);
}

RenderResult PictureTracer::begin_refined(const View& view, const ProgressCallback& progress) {
  RenderResult result = make_result(view);
  View centers = view;
  centers.error_target.reset();
  centers.samples_per_pixel = 1;
  prepare_to_refine(view);
  if (tells_of_centers()) trace_middle(centers, result, keep_going(progress));
  if (wanted_.ambient_occlusion) trace_occlusion(view, result, keep_going(progress));
  result.error.emplace(PictureError{.target = view.error_target->error});
  return result;
}

RenderResult PictureTracer::render_to_error(const View& view, const ProgressCallback& progress) {
  RenderResult result = begin_refined(view, progress);
  // The estimate assumes that the later parts take as long as the earlier parts.
  double taken = 0.0;
  double pixels_done = 0.0;
  double told = 0.0;
  const auto pixels = static_cast<double>(result.image.pixels.size());
  for (const PixelWindow& part : parts_to_refine(picture_window(view))) {
    Refinement refinement(view, part, tells_unlit(view.mode), film_->sampled_points(view));
    RefinedAovs aovs = begin_refined_aovs(part, view);
    const auto part_pixels = static_cast<double>(refinement.pixel_count());
    refine(refinement, view, aovs, result, [&](double of_part) {
      if (!progress) return true;
      const double left_of_part = std::max(refinement.foretell_total() - of_part, 0.0);
      const double a_pixel = (taken + of_part + left_of_part) / (pixels_done + part_pixels);
      const double left = left_of_part + a_pixel * (pixels - pixels_done - part_pixels);
      // If more work remains than was estimated, the reported progress stops for a while.
      told = std::max(told, (taken + of_part) / (taken + of_part + left));
      return progress(told);
    });
    taken += static_cast<double>(refinement.sample_count());
    pixels_done += part_pixels;
    take_refined(refinement, aovs, view, result);
  }
  return result;
}

RenderResult PictureTracer::refine_within(const View& view, double seconds, const ProgressCallback& progress) {
  const Stopwatch elapsed;
  View step = view;
  step.error_target->error = first_error(*view.error_target);
  RenderResult result = begin_refined(step, progress);
  const PixelWindow window = picture_window(view);
  Refinement refinement(step, window, tells_unlit(view.mode), film_->sampled_points(view));
  RefinedAovs aovs = begin_refined_aovs(window, step);
  const Stopwatch tracing;
  float& error = step.error_target->error;
  for (refine(refinement, step, aovs, result, progress); error > view.error_target->error;) {
    const float less = next_error(*view.error_target, error);
    const double ms_a_sample = tracing.ms() / static_cast<double>(refinement.sample_count());
    const double ms_ahead = kCaution * ms_a_sample * refinement.foretell_samples(less);
    if (elapsed.ms() + ms_ahead > 1e3 * seconds) break;
    error = less;
    refinement.aim(error);
    refine(refinement, step, aovs, result, progress);
  }
  result.error->target = error;
  take_refined(refinement, aovs, step, result);
  return result;
}

RenderResult PictureTracer::render_within(const View& view, double seconds, const ProgressCallback& progress) {
  const Stopwatch elapsed;
  const double limit_ms = 1e3 * seconds;
  const auto tell = [&](double) { return !progress || progress(std::min(1.0, elapsed.ms() / limit_ms)); };
  View fixed = view;
  fixed.error_target.reset();
  fixed.samples_per_pixel = 1;
  RenderResult best = render(fixed, tell);
  // The kernels for refinement take as long to compile as the kernels that traced this picture.
  const double compiling_ms = std::max(elapsed.ms() - best.trace_ms, stats_.pipeline_ms);
  const uint32_t first_samples = ClaimRule(view, film_->sampled_points(view)).first_samples;
  const double refining_ms = compiling_ms + kListedCost * best.trace_ms * first_samples;
  if (kTimesFirstError * refining_ms < limit_ms - elapsed.ms()) {
    bool is_late = false;
    try {
      return refine_within(view, seconds - 1e-3 * elapsed.ms(), [&](double fraction) {
        is_late = elapsed.ms() > kLongest * limit_ms;
        return !is_late && tell(fraction);
      });
    } catch (const Cancelled&) {
      if (!is_late) throw;
      return best;
    }
  }
  for (double ms_a_sample = std::max(best.trace_ms, 1e-3);;) {
    const double begin_ms = elapsed.ms();
    const double samples = std::floor(kPlannedShare * (limit_ms - begin_ms) / ms_a_sample);
    if (samples < 2.0) return best;
    fixed.samples_per_pixel = static_cast<uint32_t>(std::min(samples, double{kMaxSamplesPerPixel}));
    bool is_late = false;
    try {
      return render(fixed, [&](double fraction) {
        const double taken_ms = elapsed.ms() - begin_ms;
        ms_a_sample = taken_ms / (fraction * fixed.samples_per_pixel);
        is_late = fraction > kForetells && begin_ms + taken_ms / fraction > kLongest * limit_ms;
        return !is_late && tell(fraction);
      });
    } catch (const Cancelled&) {
      if (!is_late) throw;
    }
  }
}

}  // namespace promin
