// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "promin/display.h"
#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// A linear RGB picture; row 0 is the top.
struct Image {
  /// Width and height.
  uvec2 size{0};
  /// Row by row, size.x * size.y of them.
  std::vector<vec3> pixels;

  /// A pixel, x from the left and y from the top. Coordinates beyond the picture are not checked.
  const vec3& at(uint32_t x, uint32_t y) const { return pixels[static_cast<size_t>(y) * size.x + x]; }
  /// The same, to change.
  vec3& at(uint32_t x, uint32_t y) { return pixels[static_cast<size_t>(y) * size.x + x]; }
};

/// A channel of a picture beside R, G and B, with a value for each pixel.
struct Channel {
  /// As the EXR names it: "Z", "N.X".
  std::string name;
  /// Whether the values are integers of 32 bits and not floats.
  bool is_integer = false;
  /// The integers, or the bits of the floats; as many as the picture has pixels.
  std::vector<uint32_t> values;
  /// Whether it is there only to show the picture: an EXR leaves it out.
  bool is_hidden = false;
};

/// Name and value pairs that an EXR carries in its header, e.g. {"promin:scene", "showcase.gltf"}.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Where a crop lies in the whole picture.
struct CropPlacement {
  /// The crop's upper left pixel in the whole picture.
  uvec2 lo{0};
  /// Width and height of the whole picture.
  uvec2 full_size{0};
};

/// Whether write_image knows the file's ending: .exr, .png, .jpg, .jpeg, .webp, .tif, .tiff or .hdr.
PROMIN_EXPORT bool is_writable_format(const std::filesystem::path& file);

/// Whether a file of this ending holds channels beside R, G and B: .exr.
PROMIN_EXPORT bool has_named_channels(const std::filesystem::path& file);

/// How an EXR is compressed, always without loss: kZip by blocks of 16 rows, kPiz of 32, kRle and kZips by rows. Where
/// 16 rows have more than 8 MiB, kZip is kZips.
enum class ExrCompression : uint32_t { kNone, kRle, kZips, kZip, kPiz };

/// Names for people, by the value of the ExrCompression.
PROMIN_EXPORT std::span<const std::string_view> exr_compression_names();

/// How an EXR keeps its numbers.
struct ExrOptions {
  /// Halves in place of floats for colours, normals and shares: off by 2^-11 of the value at most, 65504 at most.
  /// Distances, places, errors and what tells one thing from another stay as they are.
  bool is_half = false;
  /// See ExrCompression.
  ExrCompression compression = ExrCompression::kZip;
  /// A part for each group of channels in place of one for all: some programs read single groups faster, and others
  /// cannot read such files.
  bool is_multipart = false;
};

/// Writes .exr (R, G, B linear fp32, then `channels`, zip, with `metadata`; a crop is the data window of the whole
/// picture's display window), .png (as `display` shows it, sRGB, 8 bit, clamped, without `channels` but for one named
/// "A", by which the pixels are taken as multiplied, and those of Aovs::unlit, which are shown as they are; a crop is a
/// picture of its own; it names the scene of `metadata`), .jpg and .jpeg (the same without "A", by libjpeg-turbo,
/// quality 92, 4:4:4), .webp (with "A", by libwebp, quality 92), .tif and .tiff (with "A") or .hdr (R, G, B linear).
/// Equal arguments give equal bytes. The last three kinds are written by the plugin for pictures. Atomic: the picture
/// is written to a temporary file beside the target and renamed; on failure the target is as it was. Any thread may
/// call it. Throws UsageError for another ending, for a picture without pixels and where the pixels, a channel's values
/// or the crop do not suit the size; RunError where the file cannot be written.
PROMIN_EXPORT void write_image(const std::filesystem::path& file, const Image& image, const Metadata& metadata = {},
                               const std::optional<CropPlacement>& crop = std::nullopt,
                               std::span<const Channel> channels = {}, const DisplayTransform& display = {},
                               const ExrOptions& exr = {});

/// The most pixels that read_image takes; larger pictures are refused before their pixels are read.
inline constexpr uint64_t kMaxReadPixels = uint64_t{1} << 28;

/// Reads R, G, B, or a luminance as all three, of any format OpenImageIO knows, as fp32 without conversion, not
/// multiplied by alpha but of WebP and EXR; of an EXR the data window. Any thread may call it. Throws InputError where
/// the file is no such picture, RunError where libpromin_pictures.so, the plugin that reads pictures, is missing.
PROMIN_EXPORT Image read_image(const std::filesystem::path& file);

/// Linear light to the sRGB transfer curve, in double on the host (IEC 61966-2-1); clamps to [0, 1], NaN becomes 0.
PROMIN_EXPORT float encode_srgb(float linear);

}  // namespace promin
