// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/frame_plan.h"

#include <fmt/format.h>

#include <cmath>

#include "promin/error.h"
#include "work/pictures/moving_scene.h"

namespace promin::work {
namespace {

FrameRange choose_frames(const RenderSpec& options, size_t count) {
  const auto last = static_cast<uint32_t>(count - 1);
  const FrameRange range = options.frames.value_or(FrameRange{0, last});
  if (range.last > last) {
    throw UsageError({"path.frame.missing", fmt::format("the path has no frame {}", range.last), options.path->string(),
                      fmt::format("choose frames from 0 to {}", last)});
  }
  return range;
}

/// Throws UsageError if several frames would be written to one file.
void check_numbers(const std::vector<PlannedFrame>& frames, const RenderSpec& options) {
  for (const std::filesystem::path& file : options.pictures) {
    if (frames.size() == 1 || number_file(file, 0) != file) continue;
    throw UsageError({"output.frames.one", fmt::format("{} frames would be written to one file", frames.size()),
                      file.string(), "put #### into its name, which stands for the frame number"});
  }
}

std::vector<PlannedFrame> plan_range(const RenderSpec& options, const FrameRange& range) {
  const double fps = options.fps.value_or(kDefaultFps);
  std::vector<PlannedFrame> frames;
  for (uint32_t number = range.first; number <= range.last; ++number) {
    PlannedFrame frame{number, std::nullopt, {}, number / fps};
    for (const std::filesystem::path& file : options.pictures) frame.pictures.push_back(number_file(file, number));
    frames.push_back(std::move(frame));
  }
  check_numbers(frames, options);
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

std::vector<PlannedFrame> plan_frames(const RenderSpec& options) {
  if (options.makes_film()) {
    return options.frames ? plan_range(options, *options.frames) : std::vector<PlannedFrame>{};
  }
  if (!options.path) return {{std::nullopt, std::nullopt, options.pictures}};
  const auto path = std::make_shared<const PathPictures>(read_camera_path(*options.path), options.fps);
  const FrameRange range = choose_frames(options, path->count());
  std::vector<PlannedFrame> frames;
  for (uint32_t number = range.first; number <= range.last; ++number) {
    PlannedFrame frame{number, path->camera(number), {}};
    frame.path = path;
    if (options.moves_scene()) frame.time_s = path->time_s(number);
    for (const std::filesystem::path& file : options.pictures) frame.pictures.push_back(number_file(file, number));
    frames.push_back(std::move(frame));
  }
  check_numbers(frames, options);
  return frames;
}

}  // namespace promin::work
