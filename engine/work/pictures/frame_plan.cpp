// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/frame_plan.h"

#include <fmt/format.h>

#include "promin/error.h"

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

std::vector<PlannedFrame> plan_frames(const RenderSpec& options) {
  if (!options.path) return {{std::nullopt, std::nullopt, options.pictures}};
  const auto path = std::make_shared<const PathPictures>(read_camera_path(*options.path), options.fps);
  const FrameRange range = choose_frames(options, path->count());
  std::vector<PlannedFrame> frames;
  for (uint32_t number = range.first; number <= range.last; ++number) {
    PlannedFrame frame{number, path->camera(number), {}, path};
    for (const std::filesystem::path& file : options.pictures) frame.pictures.push_back(number_file(file, number));
    frames.push_back(std::move(frame));
  }
  for (const std::filesystem::path& file : options.pictures) {
    if (frames.size() == 1 || number_file(file, 0) != file) continue;
    throw UsageError({"output.frames.one", fmt::format("{} frames would be written to one file", frames.size()),
                      file.string(), "put #### into its name, which stands for the frame number"});
  }
  return frames;
}

}  // namespace promin::work
