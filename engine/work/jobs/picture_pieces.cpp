// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/picture_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "core/divide_up.h"
#include "core/parse_number.h"
#include "promin/error.h"
#include "trace/film/refinement.h"
#include "work/pictures/frame_plan.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

/// Defaults for dividing pictures: the approximate largest number of pixels of a band of one picture, and the smallest
/// number of rows of a band.
constexpr uint64_t kBandPixels = uint64_t{1} << 19;
constexpr uint64_t kLeastBandRows = 8;
/// The largest number of parts of a picture.
constexpr uint64_t kMostParts = 1'000'000;
/// Prefix of the names of a path's pieces.
constexpr std::string_view kOfFrame = "frame";

/// Returns the start of each of `count` nearly equal parts of 0...length, and then the end.
std::vector<uint32_t> divide(uint32_t length, uint32_t count) {
  std::vector<uint32_t> places;
  for (uint64_t i = 0; i <= count; ++i) places.push_back(static_cast<uint32_t>(i * length / count));
  return places;
}

/// Returns the default number of bands for each of this number of pictures.
uint32_t choose_bands(const PixelWindow& window, size_t pictures) {
  const uint64_t rows = window.hi.y - window.lo.y;
  const uint64_t usual = std::min(divide_up<uint64_t>(kUsualPieces, pictures), rows / kLeastBandRows);
  const uint64_t of_large = pictures == 1 ? std::min<uint64_t>(area_of(window) / kBandPixels, rows) : 1;
  return static_cast<uint32_t>(std::max<uint64_t>({1, usual, of_large}));
}

std::string name_frame(uint32_t frame) {
  return fmt::format("{}{:06}", kOfFrame, frame);
}

/// Returns the first word of a piece's name, which identifies its frame. Without frames it is always the same.
std::string frame_prefix_of(const std::string& piece) {
  return piece.starts_with(kOfFrame) ? piece.substr(0, piece.find('_')) : "";
}

/// Returns the pieces of each picture of a job.
std::vector<std::vector<size_t>> find_pictures_of(const jobs::Job& job) {
  const std::vector<std::string>& names = job.manifest().pieces;
  std::vector<std::vector<size_t>> pictures;
  for (size_t piece = 0; piece < names.size(); ++piece) {
    if (piece == 0 || frame_prefix_of(names[piece]) != frame_prefix_of(names[piece - 1])) pictures.emplace_back();
    pictures.back().push_back(piece);
  }
  return pictures;
}

std::vector<size_t> find_pieces_of(const jobs::Job& job, uint32_t frame) {
  const std::vector<std::string>& names = job.manifest().pieces;
  const std::string begin = name_frame(frame) + "_";
  std::vector<size_t> pieces;
  for (size_t piece = 0; piece < names.size(); ++piece) {
    if (names[piece].starts_with(begin)) pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace

std::vector<PixelWindow> cut_picture(const PixelWindow& window, const JobOptions& options, size_t pictures) {
  const uvec2 size = window.hi - window.lo;
  const uvec2 tiles = options.tiles.value_or(uvec2(1, options.pieces.value_or(choose_bands(window, pictures))));
  if (tiles.x > size.x || tiles.y > size.y) {
    throw UsageError({"job.pieces.many",
                      fmt::format("{} columns and {} rows of pieces are too many for a picture of {}x{} pixels",
                                  tiles.x, tiles.y, size.x, size.y),
                      "", "use --pieces or --tiles to request fewer"});
  }
  if (uint64_t{tiles.x} * tiles.y > kMostParts) {
    throw UsageError({"job.pieces.many",
                      fmt::format("{} pieces are more than the limit of {}", uint64_t{tiles.x} * tiles.y, kMostParts),
                      "", "use --pieces or --tiles to request fewer"});
  }
  const std::vector<uint32_t> columns = divide(size.x, tiles.x);
  const std::vector<uint32_t> rows = divide(size.y, tiles.y);
  std::vector<PixelWindow> parts;
  for (size_t row = 0; row < tiles.y; ++row) {
    for (size_t column = 0; column < tiles.x; ++column) {
      parts.push_back(
          {window.lo + uvec2(columns[column], rows[row]), window.lo + uvec2(columns[column + 1], rows[row + 1])});
    }
  }
  return parts;
}

std::vector<std::string> name_pieces(const std::vector<std::optional<uint32_t>>& frames,
                                     const std::vector<PixelWindow>& parts) {
  std::vector<std::string> names;
  for (const std::optional<uint32_t>& frame : frames) {
    for (const PixelWindow& part : parts) {
      const std::string of_frame = frame ? name_frame(*frame) + "_" : "";
      names.push_back(fmt::format("{}y{:05}-{:05}_x{:05}-{:05}", of_frame, part.lo.y, part.hi.y, part.lo.x, part.hi.x));
    }
  }
  return names;
}

std::vector<std::vector<size_t>> choose_pictures(const jobs::Job& job,
                                                 const std::optional<std::vector<uint32_t>>& frames) {
  if (!frames) return find_pictures_of(job);
  std::vector<std::vector<size_t>> pictures;
  for (const uint32_t frame : *frames) {
    pictures.push_back(find_pieces_of(job, frame));
    if (!pictures.back().empty()) continue;
    throw UsageError({"job.frame.missing", fmt::format("the job has no frame {}", frame), job.folder().string(),
                      "give frames that belong to the job"});
  }
  return pictures;
}

bool has_several_frames(const jobs::Job& job) {
  return frame_prefix_of(job.manifest().pieces.front()) != frame_prefix_of(job.manifest().pieces.back());
}

std::vector<fs::path> number_pictures(const jobs::Job& job, const std::vector<fs::path>& files,
                                      const std::optional<std::vector<uint32_t>>& frames) {
  std::vector<fs::path> numbered;
  bool is_before_first = true;
  for (const std::vector<size_t>& pieces : choose_pictures(job, frames)) {
    const std::string frame = frame_prefix_of(job.manifest().pieces[pieces.front()]);
    if (frame.empty()) return files;
    std::string_view digits = std::string_view(frame).substr(kOfFrame.size());
    const uint32_t number = take_number<uint32_t>(digits).value_or(0);
    const bool is_first = std::exchange(is_before_first, false);
    for (const fs::path& file : files) {
      fs::path of_frame = number_file(file, number);
      // A film is one file.
      if (of_frame != file || is_first) numbered.push_back(std::move(of_frame));
    }
  }
  return numbered;
}

}  // namespace promin::work
