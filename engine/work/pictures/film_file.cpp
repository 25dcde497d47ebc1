// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/film_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string>
#include <string_view>

#include "core/file.h"
#include "image/encode_shown.h"
#include "promin/error.h"
#include "work/pictures/ffmpeg.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

/// A format of films.
struct FilmFormat {
  std::string_view ending;
  /// The name of the format in messages.
  std::string_view name;
  /// The name of the format for ffmpeg.
  std::string_view container;
  bool stores_alpha;
  bool needs_even_sides;
};

constexpr std::array<FilmFormat, 4> kFilmFormats = {{{".mp4", "MP4", "mp4", false, true},
                                                     {".webm", "WebM", "webm", true, true},
                                                     {".gif", "GIF", "gif", true, false},
                                                     {".png", "PNG", "apng", true, false}}};

/// Viewers show frames of a GIF that are shorter than two hundredths of a second for a longer time.
constexpr double kMostGifFps = 50.0;
/// The largest amount of memory for the frames of a GIF with one palette. ffmpeg keeps all frames until it knows the
/// palette. A larger GIF has a palette for each frame.
constexpr uint64_t kMostPaletteBytes = uint64_t{1} << 29;

const FilmFormat* find_format(const fs::path& file) {
  const std::string ending = lower_case_ending(file);
  const auto found = std::ranges::find(kFilmFormats, ending, &FilmFormat::ending);
  return found == kFilmFormats.end() ? nullptr : &*found;
}

uint32_t round_up_to_even(uint32_t side) {
  return side + side % 2;
}

/// Returns the size of the frames that ffmpeg receives.
uvec2 encoded_size(const FilmFormat& format, const uvec2& size) {
  return format.needs_even_sides ? uvec2(round_up_to_even(size.x), round_up_to_even(size.y)) : size;
}

using Words = std::vector<std::string>;

void append(Words& words, std::initializer_list<std::string_view> more) {
  for (const std::string_view word : more) words.emplace_back(word);
}

/// Adds the conversion from sRGB to the colours of films, and the tags that describe them.
void add_film_colors(Words& words, std::string_view pixel_format) {
  append(words, {"-vf", "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+bitexact+full_chroma_int",
                 "-pix_fmt", pixel_format, "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc",
                 "iec61966-2-1", "-color_range", "tv"});
}

void add_gif_filters(Words& words, const FilmHeader& header) {
  const uint64_t bytes = uint64_t{4} * header.size.x * header.size.y * header.frame_count;
  const bool has_one_palette = bytes <= kMostPaletteBytes;
  const std::string make = fmt::format("palettegen=stats_mode={}:reserve_transparent={}",
                                       has_one_palette ? "full" : "single", header.has_alpha ? 1 : 0);
  const std::string use =
      fmt::format("paletteuse=new={}{}", has_one_palette ? 0 : 1, header.has_alpha ? ":alpha_threshold=128" : "");
  append(words, {"-filter_complex", fmt::format("split[a][b];[a]{}[p];[b][p]{}", make, use), "-loop", "0"});
}

/// Returns the arguments of ffmpeg. The options of bits keep times and random numbers out of the film. The number of
/// threads of x264 affects bits, so it is fixed.
Words make_ffmpeg_arguments(const FilmFormat& format, const FilmHeader& header, const fs::path& file) {
  const uvec2 size = encoded_size(format, header.size);
  Words words;
  append(words, {"-nostdin",
                 "-hide_banner",
                 "-loglevel",
                 "error",
                 "-f",
                 "rawvideo",
                 "-pixel_format",
                 header.has_alpha ? "rgba" : "rgb24",
                 "-video_size",
                 fmt::format("{}x{}", size.x, size.y),
                 "-framerate",
                 fmt::format("{}", header.fps),
                 "-i",
                 "pipe:0",
                 "-map_metadata",
                 "-1",
                 "-fflags",
                 "+bitexact",
                 "-flags:v",
                 "+bitexact"});
  if (format.ending == ".mp4") {
    add_film_colors(words, "yuv420p");
    append(words, {"-c:v", "libx264", "-preset", "medium", "-crf", "18", "-threads", "4", "-movflags", "+faststart"});
  } else if (format.ending == ".webm") {
    add_film_colors(words, header.has_alpha ? "yuva420p" : "yuv420p");
    append(words, {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-deadline", "good", "-cpu-used", "2", "-row-mt",
                   "0", "-threads", "4"});
    if (header.has_alpha) append(words, {"-metadata:s:v:0", "alpha_mode=1"});
  } else if (format.ending == ".gif") {
    add_gif_filters(words, header);
  } else {
    append(words, {"-c:v", "apng", "-pred", "mixed", "-plays", "0"});
  }
  // The prefix keeps ffmpeg from taking a name with a colon for an address.
  append(words, {"-f", format.container, "-y", "file:" + file.string()});
  return words;
}

}  // namespace

bool is_film(const fs::path& file) {
  const FilmFormat* format = find_format(file);
  return format != nullptr && format->ending != ".png";
}

bool film_stores_alpha(const fs::path& file) {
  const FilmFormat* format = find_format(file);
  return format != nullptr && format->stores_alpha;
}

bool holds_all_frames(const fs::path& file, bool has_several_frames) {
  if (is_film(file)) return true;
  const bool is_numbered = file.filename().string().find('#') != std::string::npos;
  return has_several_frames && find_format(file) != nullptr && !is_numbered;
}

std::vector<fs::path> films_among(const std::vector<fs::path>& files, bool has_several_frames) {
  std::vector<fs::path> films;
  std::ranges::copy_if(files, std::back_inserter(films),
                       [&](const fs::path& file) { return holds_all_frames(file, has_several_frames); });
  return films;
}

void check_film(const fs::path& file, double fps) {
  if (lower_case_ending(file) == ".gif" && fps > kMostGifFps) {
    throw UsageError(
        {"film.fps.many",
         fmt::format("a GIF shows at most {:g} frames per second, and the film has {:g}", kMostGifFps, fps),
         file.string(), "lower --fps, or write a .mp4 or .webm"});
  }
  check_ffmpeg(file);
}

class FilmFile::Impl {
 public:
  Impl(const fs::path& file, const FilmFormat& format, const FilmHeader& header)
      : size_(header.size),
        encoded_size_(encoded_size(format, header.size)),
        has_alpha_(header.has_alpha),
        output_(file),
        ffmpeg_(file, make_ffmpeg_arguments(format, header, output_.temporary())) {}

  void write_rows(const Image& rows, std::span<const Channel> channels, const DisplayTransform& display,
                  const uvec2& lo) {
    std::vector<uint8_t> bytes = encode_shown(rows, channels, display, lo + uvec2(0, rows_written_), has_alpha_);
    if (encoded_size_.x != size_.x) bytes = repeat_last_column(bytes, rows.size.y);
    ffmpeg_.write(bytes);
    rows_written_ += rows.size.y;
    if (rows_written_ < size_.y) return;
    const size_t row_bytes = bytes.size() / rows.size.y;
    if (encoded_size_.y != size_.y) ffmpeg_.write(std::span(bytes).last(row_bytes));
    rows_written_ = 0;
  }

  void commit() {
    ffmpeg_.finish();
    output_.commit();
  }

 private:
  std::vector<uint8_t> repeat_last_column(const std::vector<uint8_t>& bytes, uint32_t row_count) const {
    const size_t pixel_bytes = has_alpha_ ? 4 : 3;
    const size_t row_bytes = pixel_bytes * size_.x;
    std::vector<uint8_t> wider;
    wider.reserve(bytes.size() + pixel_bytes * row_count);
    for (size_t y = 0; y < row_count; ++y) {
      const auto row = bytes.begin() + static_cast<std::ptrdiff_t>(y * row_bytes);
      const auto end = row + static_cast<std::ptrdiff_t>(row_bytes);
      wider.insert(wider.end(), row, end);
      wider.insert(wider.end(), end - static_cast<std::ptrdiff_t>(pixel_bytes), end);
    }
    return wider;
  }

  uvec2 size_;
  uvec2 encoded_size_;
  bool has_alpha_;
  uint32_t rows_written_ = 0;
  // The process ends before its temporary file is removed.
  AtomicFile output_;
  Ffmpeg ffmpeg_;
};

FilmFile::FilmFile(const fs::path& file, const FilmHeader& header) {
  check_film(file, header.fps);
  const FilmFormat& format = *find_format(file);
  FilmHeader stored = header;
  stored.has_alpha &= format.stores_alpha;
  impl_ = std::make_unique<Impl>(file, format, stored);
}
FilmFile::~FilmFile() = default;

void FilmFile::write_rows(const Image& rows, std::span<const Channel> channels, const DisplayTransform& display,
                          const uvec2& lo) {
  impl_->write_rows(rows, channels, display, lo);
}

void FilmFile::commit() {
  impl_->commit();
}

}  // namespace promin::work
