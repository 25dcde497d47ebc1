// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/picture_sources.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "core/srgb.h"
#include "image/picture_formats.h"
#include "textures/decode_picture.h"

namespace promin {
namespace {

/// Converts light to sRGB: pictures of light store linear values, but colours of textures are sRGB values.
void encode_light(std::span<uint32_t> texels) {
  std::array<uint32_t, 256> codes{};
  for (size_t i = 0; i < codes.size(); ++i) {
    codes[i] = static_cast<uint32_t>(std::lround(255.0 * linear_to_srgb(static_cast<double>(i) / 255.0)));
  }
  for (uint32_t& texel : texels) {
    texel =
        (texel & 0xFF000000U) | codes[texel & 0xFF] | codes[texel >> 8 & 0xFF] << 8 | codes[texel >> 16 & 0xFF] << 16;
  }
}

/// Number of bytes that are read to find a picture's size. Most files state the size within these bytes.
constexpr uint64_t kHeadBytes = uint64_t{1} << 16;

void take_bytes(PictureSource& source, LoadReport& report, const ReadPictureBytes& read, uint64_t most_bytes) {
  LoadReport attempt = report.make_attempt();
  std::optional<std::vector<std::byte>> bytes;
  try {
    bytes = read(attempt, most_bytes);
    attempt.throw_if_refused();
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    source.problem =
        attempt.refused_fault().value_or(Fault{.code = problem.code, .what = problem.what, .cure = problem.cure});
  }
  for (const SourceFile& file : attempt.sources()) report.add_source(file.file);
  if (source.problem) return;
  source.own = std::move(*bytes);
  source.file = source.own;
}

bool tells_size(std::span<const std::byte> head) {
  try {
    read_picture_size(head);
    return true;
  } catch (const DecodeError&) {
    return false;
  }
}

/// Decodes a picture. Returns the libraries' warning about a picture that could be decoded; empty if there is none.
std::string decode(PictureSource& source) {
  TextureImage& image = *source.image;
  if (!source.takes_texels) {
    image.size = read_picture_size(source.file);
    return "";
  }
  DecodedPicture picture = decode_picture(source.file);
  image.size = picture.size;
  image.texels = std::move(picture.texels);
  if (image.use == ImageUse::kColor && holds_light(source.file)) encode_light(image.texels);
  return picture.warning;
}

/// Reports a picture's problem. Materials that use a picture for several uses have a source for each use.
void report_problem(const PictureSource& source, LoadReport& report) {
  Fault fault = *source.problem;
  if (!fault.value.starts_with(source.title)) fault.place = "image " + source.title;
  fault.repair = "promin draws materials without it" + (fault.cure.empty() ? "" : "; " + fault.cure);
  source.is_file_at_fault ? report.repair(fault) : report.warn(fault);
}

void report_damage(const PictureSource& source, const std::string& warning, LoadReport& report) {
  report.repair({.code = "picture.damaged",
                 .what = "a picture is damaged",
                 .value = warning,
                 .place = "image " + source.title,
                 .cure = "write or export it again",
                 .repair = "the part that can be decoded is shown"});
}

}  // namespace

std::string describe_problem(const PictureSource& source) {
  const Fault& fault = *source.problem;
  return fault.what + (fault.value.empty() ? "" : " (" + fault.value + ")");
}

void read_picture(PictureSource& source, LoadReport& report, const ReadPictureBytes& read) {
  if (!source.takes_texels) {
    take_bytes(source, report, read, kHeadBytes);
    const bool is_whole = source.file.size() < kHeadBytes;
    if (source.problem || is_whole || tells_size(source.file)) return;
  }
  take_bytes(source, report, read, std::numeric_limits<uint64_t>::max());
}

void decode_pictures(std::span<PictureSource> sources, LoadReport& report) {
  std::vector<std::string> warnings(sources.size());
  for_each_index(sources.size(), 0, [&](size_t i) {
    PictureSource& source = sources[i];
    if (source.problem) return;
    try {
      warnings[i] = decode(source);
    } catch (const DecodeError& error) {
      source.problem = Fault{.code = "picture.unusable",
                             .what = std::string("a picture cannot be used: ") + error.what(),
                             .cure = "use another picture"};
      source.is_file_at_fault = error.is_file_at_fault();
    }
    source.own = {};
  });
  for (size_t i = 0; i < sources.size(); ++i) {
    if (sources[i].problem) report_problem(sources[i], report);
    if (!warnings[i].empty()) report_damage(sources[i], warnings[i], report);
  }
}

}  // namespace promin
