// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/merge_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "promin/error.h"
#include "trace/film/refinement.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/missing_pieces.h"
#include "work/jobs/picture_part.h"
#include "work/jobs/picture_pieces.h"
#include "work/pictures/camera_path.h"
#include "work/pictures/film_file.h"
#include "work/pictures/frame_plan.h"
#include "work/pictures/picture_files.h"
#include "work/pictures/run_stats.h"
#include "work/spec/check_spec.h"
#include "work/spec/spec_json.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

/// Copies a part's values to their positions in a row of parts.
template <typename Value>
void place(const std::vector<Value>& values, const PicturePart& part, std::vector<Value>& row) {
  const uvec2 size = size_of(part.part);
  const uint32_t width = size_of(part.window).x;
  const uint32_t x = part.part.lo.x - part.window.lo.x;
  for (uint32_t y = 0; y < size.y; ++y) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(size_t{y} * size.x), size.x,
                row.begin() + static_cast<std::ptrdiff_t>(size_t{y} * width + x));
  }
}

/// A row of parts of a picture that are side by side.
struct RowOfParts {
  Image image;
  std::vector<Channel> channels;

  explicit RowOfParts(const PicturePart& first) : channels(first.channels) {
    image.size = uvec2(size_of(first.window).x, size_of(first.part).y);
    image.pixels.assign(size_t{image.size.x} * image.size.y, vec3(0.0F));
    for (Channel& channel : channels) channel.values.assign(image.pixels.size(), 0);
  }

  void add(const PicturePart& part) {
    place(part.image.pixels, part, image.pixels);
    for (size_t i = 0; i < part.channels.size(); ++i) place(part.channels[i].values, part, channels[i].values);
  }
};

/// Checks that a part belongs to the same picture as the first part. Parts of another driver have other bits.
void check_same(const PicturePart& part, const PicturePart& first, const fs::path& file) {
  const auto is_same_channel = [](const Channel& a, const Channel& b) { return a.name == b.name; };
  const bool is_same = part.full_size == first.full_size && part.window.lo == first.window.lo &&
                       part.window.hi == first.window.hi && part.error.has_value() == first.error.has_value() &&
                       std::ranges::equal(part.channels, first.channels, is_same_channel);
  if (!is_same)
    throw InputError({"job.piece.other", "the piece does not belong to the same picture as the other pieces",
                      file.string(), "remove it and run the job again"});
  if (part.metadata.size() != first.metadata.size()) {
    throw InputError({"job.piece.other", "the piece's metadata differ from those of the other pieces", file.string(),
                      "remove it and run the job again"});
  }
  for (size_t i = 0; i < part.metadata.size(); ++i) {
    const auto& [name, value] = part.metadata[i];
    // Other versions of promin with the same version of results give the same pieces.
    const bool may_differ = is_error_metadata(name) || name == kVersionEntry;
    if (part.metadata[i] == first.metadata[i] || may_differ) continue;
    throw InputError({"job.device.other",
                      fmt::format("the piece has the {} \"{}\", but other pieces have \"{}\"", name, value,
                                  first.metadata[i].second),
                      file.string(), "remove the pieces of one device, and run the job again on the other device"});
  }
}

/// Returns a part without its pixels, to save memory.
PicturePart without_values(PicturePart part) {
  part.image = {};
  for (Channel& channel : part.channels) channel.values = {};
  return part;
}

/// Returns the accuracy of the whole picture from the accuracies of its parts.
std::optional<PictureError> sum_errors(const jobs::Job& job, std::span<const size_t> pieces, const PicturePart& first) {
  if (!first.error) return std::nullopt;
  PictureError whole{.target = first.error->target};
  for (const size_t piece : pieces) {
    const PicturePart part = decode_part(job.read(piece), job.file_of(piece));
    check_same(part, first, job.file_of(piece));
    whole += *part.error;
  }
  return whole;
}

/// Returns the number of frames per second of a film of a job's frames. Throws UsageError if it is unknown.
double find_frame_rate(const jobs::Job& job) {
  const std::optional<std::string> text = read_job_spec(job);
  const RenderSpec spec = text ? parse_spec<RenderSpec>(*text, spec_file(job)) : RenderSpec();
  if (!spec.path) return frame_rate_of(spec, nullptr);
  const PathPictures path(read_camera_path(*spec.path), spec.fps);
  return frame_rate_of(spec, &path);
}

/// The files that receive all frames of a job. They begin with the first frame, whose size they have.
class MergedFilms {
 public:
  MergedFilms(const jobs::Job& job, std::vector<fs::path> files, size_t frame_count)
      : files_(std::move(files)), frame_count_(frame_count), fps_(files_.empty() ? 0.0 : find_frame_rate(job)) {}

  /// Starts the films if they have not begun.
  const Films& begin(const PictureHeader& frame) {
    if (!films_.empty()) return films_;
    const bool has_alpha = std::ranges::find(frame.channels, "A", &Channel::name) != frame.channels.end();
    const FilmHeader header = {frame.size, has_alpha, fps_, frame_count_};
    for (const fs::path& file : files_) films_.push_back(std::make_unique<FilmFile>(file, header));
    return films_;
  }
  void commit() {
    for (const std::unique_ptr<FilmFile>& film : films_) film->commit();
  }

 private:
  std::vector<fs::path> files_;
  size_t frame_count_;
  double fps_;
  Films films_;
};

/// Writes one picture from its pieces to files of these names, with the number of its frame, and adds it to the films.
/// It writes row by row, and only one row of pieces is in memory at a time. Returns the accuracy of a picture with an
/// error target.
std::optional<PictureError> write_merged(const jobs::Job& job, std::span<const size_t> pieces,
                                         const std::vector<fs::path>& files, MergedFilms& films,
                                         const ProgressCallback& progress) {
  PicturePart part = decode_part(job.read(pieces.front()), job.file_of(pieces.front()));
  const PicturePart first = without_values(part);
  PictureHeader header;
  header.size = size_of(first.window);
  if (header.size != first.full_size) header.crop = CropPlacement{first.window.lo, first.full_size};
  header.metadata = first.metadata;
  const std::optional<PictureError> error = sum_errors(job, pieces, first);
  if (error) put_error(header.metadata, *error, area_of(first.window));
  for (const Channel& channel : first.channels)
    header.channels.push_back({channel.name, channel.is_integer, {}, channel.is_hidden});
  header.display = first.display;
  header.exr = first.exr;

  std::vector<fs::path> numbered;
  for (const fs::path& file : files) numbered.push_back(first.frame ? number_file(file, *first.frame) : file);
  PictureFiles written(numbered, header, films.begin(header));
  std::optional<RowOfParts> row;
  for (const size_t piece : pieces) {
    const double done = static_cast<double>(piece) / static_cast<double>(job.piece_count());
    if (progress && !progress(done)) throw Cancelled();
    if (piece != pieces.front()) part = decode_part(job.read(piece), job.file_of(piece));
    check_same(part, first, job.file_of(piece));
    if (!row) row.emplace(part);
    row->add(part);
    if (part.part.hi.x < part.window.hi.x) continue;
    written.write_rows(std::move(row->image), std::move(row->channels));
    row.reset();
  }
  written.commit();
  return error;
}

}  // namespace

void check_merged_pictures(const jobs::Job& job, const std::vector<fs::path>& files) {
  check_frame_files(files);
  const bool has_several = has_several_frames(job);
  if (const std::vector<fs::path> films = films_among(files, has_several); !films.empty()) {
    const double fps = find_frame_rate(job);
    for (const fs::path& film : films) check_film(film, fps);
  }
  if (!has_several) return;
  for (const fs::path& file : files) {
    if (number_file(file, 0) != file || holds_all_frames(file, has_several)) continue;
    throw UsageError({"output.frames.one", "several frames would be written to one file", file.string(),
                      "put #### into its name, which stands for the frame number"});
  }
}

std::optional<PictureError> merge_pictures(const jobs::Job& job, const std::vector<fs::path>& files,
                                           const ProgressCallback& progress,
                                           const std::optional<std::vector<uint32_t>>& frames) {
  const std::vector<std::vector<size_t>> pictures = choose_pictures(job, frames);
  std::vector<size_t> chosen;
  for (const std::vector<size_t>& pieces : pictures) chosen.insert(chosen.end(), pieces.begin(), pieces.end());
  check_done(job, chosen);
  std::optional<PictureError> all;
  const bool has_several = has_several_frames(job);
  std::vector<fs::path> of_frames = files;
  std::erase_if(of_frames, [&](const fs::path& file) { return holds_all_frames(file, has_several); });
  MergedFilms films(job, films_among(files, has_several), pictures.size());
  for (const std::vector<size_t>& pieces : pictures) {
    const std::optional<PictureError> error = write_merged(job, pieces, of_frames, films, progress);
    if (error && all) {
      *all += *error;
    } else if (error) {
      all = error;
    }
  }
  films.commit();
  return all;
}

}  // namespace promin::work
