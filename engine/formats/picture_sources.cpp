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

/// Pictures of light hold numbers where colours of textures are codes of sRGB.
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

/// Of most files far more than what comes before the size, and little to read.
constexpr uint64_t kHeadBytes = uint64_t{1} << 16;

void take_bytes(PictureSource& source, LoadReport& report, const ReadPictureBytes& read, uint64_t most_bytes) {
  LoadReport attempt(report.file());
  std::optional<std::vector<std::byte>> bytes;
  try {
    bytes = read(attempt, most_bytes);
    attempt.throw_if_refused();
  } catch (const InputError& error) {
    source.problem = error.problems().front().what;
  }
  for (const SourceFile& file : attempt.sources()) report.add_source(file.file);
  if (!source.problem.empty()) return;
  source.own = std::move(*bytes);
  source.file = source.own;
}

bool tells_size(std::span<const std::byte> head) {
  try {
    read_picture_size(head);
    return true;
  } catch (const PictureError&) {
    return false;
  }
}

}  // namespace

void read_picture(PictureSource& source, LoadReport& report, const ReadPictureBytes& read) {
  if (!source.takes_texels) {
    take_bytes(source, report, read, kHeadBytes);
    const bool is_whole = source.file.size() < kHeadBytes;
    if (!source.problem.empty() || is_whole || tells_size(source.file)) return;
  }
  take_bytes(source, report, read, std::numeric_limits<uint64_t>::max());
}

void decode_pictures(std::span<PictureSource> sources, LoadReport& report) {
  for_each_index(sources.size(), 0, [&](size_t i) {
    PictureSource& source = sources[i];
    if (!source.problem.empty()) return;
    try {
      if (source.takes_texels) {
        DecodedPicture picture = decode_picture(source.file);
        source.image->size = picture.size;
        source.image->texels = std::move(picture.texels);
        if (source.image->use == ImageUse::kColor && holds_light(source.file)) encode_light(source.image->texels);
      } else {
        source.image->size = read_picture_size(source.file);
      }
    } catch (const PictureError& error) {
      source.problem = error.what();
    }
    source.own = {};
  });
  for (const PictureSource& source : sources) {
    if (!source.problem.empty()) report.warn("image " + source.title + " is ignored: " + source.problem);
  }
}

}  // namespace promin
