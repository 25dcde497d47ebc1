// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/picture_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/divide_up.h"
#include "core/json_text.h"
#include "promin/error.h"
#include "work/jobs/missing_pieces.h"
#include "work/pictures/frame_plan.h"
#include "work/pictures/picture_files.h"
#include "work/pictures/run_stats.h"
#include "work/spec/check_spec.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Defaults for dividing pictures: the approximate largest number of pixels of a band of one picture, and the smallest
/// number of rows of a band.
constexpr uint64_t kBandPixels = uint64_t{1} << 19;
constexpr uint64_t kLeastBandRows = 8;
/// The largest number of parts of a picture.
constexpr uint64_t kMostParts = 1'000'000;
/// Prefix of the names of a path's pieces.
constexpr std::string_view kOfFrame = "frame";

Json json_of(const PixelWindow& window) {
  return {window.lo.x, window.lo.y, window.hi.x, window.hi.y};
}

PixelWindow read_window(const Json& json) {
  return {uvec2(json.at(0).get<uint32_t>(), json.at(1).get<uint32_t>()),
          uvec2(json.at(2).get<uint32_t>(), json.at(3).get<uint32_t>())};
}

Json json_of(const PictureError& error) {
  return {{"target", error.target},
          {"largest_claim", error.largest_claim},
          {"unmet_pixels", error.unmet_pixels},
          {"samples", error.samples}};
}

PictureError error_of(const Json& json) {
  return {.target = json.at("target"),
          .largest_claim = json.at("largest_claim"),
          .unmet_pixels = json.at("unmet_pixels"),
          .samples = json.at("samples")};
}

/// Returns the choice with this index. Throws std::out_of_range if there is no such choice.
template <typename Choice>
Choice choice_of(const Json& json, size_t count) {
  const auto number = json.get<int64_t>();
  if (number < 0 || static_cast<size_t>(number) >= count) throw std::out_of_range("no such choice");
  return static_cast<Choice>(number);
}

uvec2 size_of(const PixelWindow& window) {
  return window.hi - window.lo;
}

size_t area_of(const PixelWindow& window) {
  return static_cast<size_t>(size_of(window).x) * size_of(window).y;
}

/// Returns the start of each of `count` nearly equal parts of 0...length, and then the end.
std::vector<uint32_t> divide(uint32_t length, uint32_t count) {
  std::vector<uint32_t> places;
  for (uint64_t i = 0; i <= count; ++i) places.push_back(static_cast<uint32_t>(i * length / count));
  return places;
}

/// Returns the device and driver (driver_of) of a picture with these metadata.
std::string driver_from(const Metadata& metadata) {
  std::string driver;
  for (const auto& [name, value] : metadata) {
    if (name == "promin:device" || name == "promin:driver") driver += (driver.empty() ? "" : ", ") + value;
  }
  return driver;
}

bool is_within(const PixelWindow& part, const PixelWindow& window) {
  return glm::all(glm::lessThanEqual(window.lo, part.lo)) && glm::all(glm::lessThanEqual(part.hi, window.hi)) &&
         glm::all(glm::lessThan(part.lo, part.hi));
}

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

/// Writes one picture from its pieces to files of these names, with the number of its frame. It writes row by row, and
/// only one row of pieces is in memory at a time. Returns the accuracy of a picture with an error target.
std::optional<PictureError> write_merged(const jobs::Job& job, std::span<const size_t> pieces,
                                         const std::vector<fs::path>& files, const ProgressCallback& progress) {
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
  PictureFiles written(numbered, header);
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

/// Returns the pieces of the pictures of the given frames, in their order. Throws UsageError if the job has no such
/// frame.
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

/// Checks, before anything is written, that each frame has its own file.
void check_numbered(const jobs::Job& job, const std::vector<fs::path>& files) {
  const std::vector<std::string>& pieces = job.manifest().pieces;
  if (!pieces.front().starts_with(kOfFrame) || frame_prefix_of(pieces.front()) == frame_prefix_of(pieces.back()))
    return;
  for (const fs::path& file : files) {
    if (number_file(file, 0) != file) continue;
    throw UsageError({"output.frames.one", "several frames would be written to one file", file.string(),
                      "put #### into its name, which stands for the frame number"});
  }
}

/// Returns the default number of bands for each of this number of pictures.
uint32_t choose_bands(const PixelWindow& window, size_t pictures) {
  const uint64_t rows = size_of(window).y;
  const uint64_t usual = std::min(divide_up<uint64_t>(kUsualPieces, pictures), rows / kLeastBandRows);
  const uint64_t of_large = pictures == 1 ? std::min<uint64_t>(area_of(window) / kBandPixels, rows) : 1;
  return static_cast<uint32_t>(std::max<uint64_t>({1, usual, of_large}));
}

}  // namespace

std::vector<PixelWindow> cut_picture(const PixelWindow& window, const JobOptions& options, size_t pictures) {
  const uvec2 size = size_of(window);
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

jobs::Content encode_part(const PicturePart& part) {
  Json channels = Json::array();
  for (const Channel& channel : part.channels) {
    channels.push_back({{"name", channel.name}, {"is_integer", channel.is_integer}});
    if (channel.is_hidden) channels.back()["is_hidden"] = true;
  }
  Json json = {{"driver", driver_from(part.metadata)},
               {"full_size", {part.full_size.x, part.full_size.y}},
               {"window", json_of(part.window)},
               {"part", json_of(part.part)},
               {"exposure_ev", part.display.exposure_ev},
               {"tone_mapping", part.display.tone_mapping},
               {"dithers", part.display.dithers},
               {"exr", {part.exr.is_half, part.exr.compression}},
               {"channels", channels},
               {"metadata", part.metadata}};
  if (part.frame) json["frame"] = *part.frame;
  if (part.error) json["error"] = json_of(*part.error);
  jobs::Content content{json_text(json), {}};
  const auto append = [&](const auto& values) {
    const auto bytes = std::as_bytes(std::span(values));
    content.bytes.insert(content.bytes.end(), bytes.begin(), bytes.end());
  };
  append(part.image.pixels);
  for (const Channel& channel : part.channels) append(channel.values);
  return content;
}

PicturePart decode_part(const jobs::Content& content, const fs::path& file) {
  const InputError bad(
      {"job.piece.kind", "the piece is not part of a picture", file.string(), "remove it and run the job again"});
  PicturePart part;
  try {
    const Json json = read_ordered_json(content.description);
    if (json.contains("frame")) part.frame = json.at("frame").get<uint32_t>();
    part.full_size = uvec2(json.at("full_size").at(0).get<uint32_t>(), json.at("full_size").at(1).get<uint32_t>());
    part.window = read_window(json.at("window"));
    part.part = read_window(json.at("part"));
    part.display.exposure_ev = json.at("exposure_ev");
    part.display.tone_mapping = choice_of<ToneMapping>(json.at("tone_mapping"), tone_mapping_names().size());
    part.display.dithers = json.at("dithers");
    const Json& exr = json.at("exr");
    part.exr = {exr.at(0).get<bool>(), choice_of<ExrCompression>(exr.at(1), exr_compression_names().size())};
    part.metadata = json.at("metadata").get<Metadata>();
    for (const Json& channel : json.at("channels")) {
      part.channels.push_back({channel.at("name"), channel.at("is_integer"), {}, channel.contains("is_hidden")});
    }
    if (json.contains("error")) part.error = error_of(json.at("error"));
  } catch (const nlohmann::json::exception&) {
    throw bad;
  } catch (const std::out_of_range&) {
    throw bad;
  }
  if (!is_within(part.part, part.window) || glm::any(glm::greaterThan(part.window.hi, part.full_size))) throw bad;
  const size_t pixels = area_of(part.part);
  if (content.bytes.size() != pixels * (sizeof(vec3) + sizeof(uint32_t) * part.channels.size())) throw bad;
  part.image.size = size_of(part.part);
  part.image.pixels.resize(pixels);
  const std::byte* from = content.bytes.data();
  std::memcpy(part.image.pixels.data(), from, pixels * sizeof(vec3));
  from += pixels * sizeof(vec3);
  for (Channel& channel : part.channels) {
    channel.values.resize(pixels);
    std::memcpy(channel.values.data(), from, pixels * sizeof(uint32_t));
    from += pixels * sizeof(uint32_t);
  }
  return part;
}

std::vector<fs::path> number_pictures(const jobs::Job& job, const std::vector<fs::path>& files,
                                      const std::optional<std::vector<uint32_t>>& frames) {
  std::vector<fs::path> numbered;
  for (const std::vector<size_t>& pieces : choose_pictures(job, frames)) {
    const std::string frame = frame_prefix_of(job.manifest().pieces[pieces.front()]);
    if (frame.empty()) return files;
    uint32_t number = 0;
    std::from_chars(frame.data() + kOfFrame.size(), frame.data() + frame.size(), number);
    for (const fs::path& file : files) numbered.push_back(number_file(file, number));
  }
  return numbered;
}

void check_merged_pictures(const jobs::Job& job, const std::vector<fs::path>& files) {
  check_pictures(files);
  check_numbered(job, files);
}

std::optional<PictureError> merge_pictures(const jobs::Job& job, const std::vector<fs::path>& files,
                                           const ProgressCallback& progress,
                                           const std::optional<std::vector<uint32_t>>& frames) {
  const std::vector<std::vector<size_t>> pictures = choose_pictures(job, frames);
  std::vector<size_t> chosen;
  for (const std::vector<size_t>& pieces : pictures) chosen.insert(chosen.end(), pieces.begin(), pieces.end());
  check_done(job, chosen);
  std::optional<PictureError> all;
  for (const std::vector<size_t>& pieces : pictures) {
    const std::optional<PictureError> error = write_merged(job, pieces, files, progress);
    if (error && all) {
      *all += *error;
    } else if (error) {
      all = error;
    }
  }
  return all;
}

}  // namespace promin::work
