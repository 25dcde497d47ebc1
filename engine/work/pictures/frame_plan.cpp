// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/frame_plan.h"

#include <fmt/format.h>

#include <cmath>

#include "promin/error.h"
#include "work/pictures/film_file.h"
#include "work/pictures/moving_scene.h"

namespace promin::work {
namespace {

/// Returns the frames to render of a path or a turntable with this number of frames.
FrameRange choose_frames(const RenderSpec& options, size_t count) {
  const auto last = static_cast<uint32_t>(count - 1);
  const FrameRange range = options.frames.value_or(FrameRange{0, last});
  if (range.last > last) {
    throw UsageError({"path.frame.missing",
                      fmt::format("the {} has no frame {}", options.path ? "path" : "turntable", range.last),
                      options.path ? options.path->string() : "", fmt::format("choose frames from 0 to {}", last)});
  }
  return range;
}

/// Names the pictures of each frame. Throws UsageError if several frames would be written to one file that is no film.
void name_frames(std::vector<PlannedFrame>& frames, const RenderSpec& options) {
  const bool has_several = frames.size() > 1;
  for (const std::filesystem::path& file : options.pictures) {
    if (holds_all_frames(file, has_several)) continue;
    const bool is_numbered = number_file(file, 0) != file;
    if (!has_several || is_numbered) {
      for (PlannedFrame& frame : frames) frame.pictures.push_back(number_file(file, *frame.number));
      continue;
    }
    throw UsageError({"output.frames.one", fmt::format("{} frames would be written to one file", frames.size()),
                      file.string(), "put #### into its name, which stands for the frame number"});
  }
}

std::vector<PlannedFrame> plan_range(const RenderSpec& options, const FrameRange& range) {
  const double fps = options.fps.value_or(kDefaultFps);
  std::vector<PlannedFrame> frames;
  for (uint32_t number = range.first; number <= range.last; ++number) {
    frames.push_back({number, std::nullopt, {}, number / fps});
    if (!options.moves_scene()) frames.back().time_s.reset();
  }
  name_frames(frames, options);
  return frames;
}

}  // namespace

std::filesystem::path number_file(const std::filesystem::path& file, uint32_t number) {
  std::string name = file.filename().string();
  const size_t end = name.find_last_of('#');
  if (end == std::string::npos) return file;
  const size_t before = name.find_last_not_of('#', end);
  const size_t begin = before == std::string::npos ? 0 : before + 1;
  const size_t width = end + 1 - begin;
  name.replace(begin, width, fmt::format("{:0{}}", number, width));
  return file.parent_path() / name;
}

void move_frames(std::vector<PlannedFrame>& frames, const dvec3& center) {
  if (frames.empty() || frames.front().path == nullptr || center == dvec3(0.0)) return;
  const PathPictures moved = frames.front().path->moved_to(center);
  for (PlannedFrame& frame : frames) frame.camera = moved.camera(*frame.number);
}

std::vector<PlannedFrame> plan_film(const RenderSpec& options, double duration_s) {
  // Rounding may put the end slightly before the last frame's time.
  constexpr double kRounding = 1e-6;
  const double last = std::floor(duration_s * options.fps.value_or(kDefaultFps) + kRounding);
  if (last > kMaxFrame) {
    throw UsageError({"film.frames.many",
                      fmt::format("a film of {:g} s has {:.0f} frames, but the limit is {}", duration_s, last + 1.0,
                                  uint64_t{kMaxFrame} + 1),
                      "", "lower --fps, or give --frames"});
  }
  return plan_range(options, {0, static_cast<uint32_t>(last)});
}

double frame_rate_of(const RenderSpec& options, const PathPictures* path) {
  if (path == nullptr) return options.fps.value_or(kDefaultFps);
  if (path->interval_s() > 0.0) return 1.0 / path->interval_s();
  throw UsageError({"film.fps.missing", "the frames of the path have no rate, so they cannot become a film",
                    options.path->string(), "give --fps, or write the frames as pictures, such as -o frame.####.png"});
}

std::vector<PlannedFrame> plan_frames(const RenderSpec& options) {
  if (options.makes_film()) {
    return options.frames ? plan_range(options, *options.frames) : std::vector<PlannedFrame>{};
  }
  if (options.turntable) return plan_range(options, choose_frames(options, *options.turntable));
  if (!options.path) return {{std::nullopt, std::nullopt, options.pictures}};
  const auto path = std::make_shared<const PathPictures>(read_camera_path(*options.path), options.fps);
  const FrameRange range = choose_frames(options, path->count());
  std::vector<PlannedFrame> frames;
  for (uint32_t number = range.first; number <= range.last; ++number) {
    PlannedFrame frame{number, path->camera(number), {}};
    frame.path = path;
    if (options.moves_scene()) frame.time_s = path->time_s(number);
    frames.push_back(std::move(frame));
  }
  name_frames(frames, options);
  return frames;
}

}  // namespace promin::work
