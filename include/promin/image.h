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

/// A linear RGB picture. Row 0 is at the top.
struct Image {
  /// Width and height.
  uvec2 size{0};
  /// size.x * size.y pixels in row order.
  std::vector<vec3> pixels;

  /// Returns a pixel; x counts from the left, y from the top. The coordinates are not checked.
  const vec3& at(uint32_t x, uint32_t y) const { return pixels[static_cast<size_t>(y) * size.x + x]; }
  /// Returns a pixel for writing. The coordinates are not checked.
  vec3& at(uint32_t x, uint32_t y) { return pixels[static_cast<size_t>(y) * size.x + x]; }
};

/// A channel of a picture in addition to R, G and B. It has one value for each pixel.
struct Channel {
  /// The channel's name in an EXR, e.g. "Z" or "N.X".
  std::string name;
  /// True if the values are 32-bit integers and not floats.
  bool is_integer = false;
  /// The integers, or the bits of the floats; one for each pixel.
  std::vector<uint32_t> values;
  /// True if only the display of the picture uses the channel. An EXR does not store such a channel.
  bool is_hidden = false;
};

/// Pairs of name and value in the header of an EXR, e.g. {"promin:scene", "showcase.gltf"}.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// The position of a crop in the whole picture.
struct CropPlacement {
  /// The crop's upper left pixel in the coordinates of the whole picture.
  uvec2 lo{0};
  /// Width and height of the whole picture.
  uvec2 full_size{0};
};

/// Returns whether write_image() supports the file name's extension: .exr, .png, .jpg, .jpeg, .webp, .tif, .tiff or
/// .hdr.
PROMIN_EXPORT bool is_writable_format(const std::filesystem::path& file);

/// Returns whether files with this extension can store channels in addition to R, G and B. Only .exr can.
PROMIN_EXPORT bool has_named_channels(const std::filesystem::path& file);

/// The compression of an EXR, always lossless. kZip compresses blocks of 16 rows, kPiz blocks of 32, kRle and kZips
/// single rows. If 16 rows have more than 8 MiB, kZip acts like kZips.
enum class ExrCompression : uint32_t { kNone, kRle, kZips, kZip, kPiz };

/// Returns the names to display, indexed by ExrCompression.
PROMIN_EXPORT std::span<const std::string_view> exr_compression_names();

/// Options for writing an EXR.
struct ExrOptions {
  /// True if an EXR stores colours, normals and coverage as 16-bit floats, with a relative error of at most 2^-11 and a
  /// largest value of 65504. Distances, positions, errors and ids keep 32 bits.
  bool is_half = false;
  /// The compression of the pixels.
  ExrCompression compression = ExrCompression::kZip;
};

/// Writes a picture; the file name's extension determines the format. An .exr stores R, G and B as linear fp32, then
/// `channels`, and `metadata` in its header. In an .exr, a crop is the data window inside the display window of the
/// whole picture. A .png stores 8-bit sRGB, clamped, after the transform `display`. A .png uses two kinds of
/// `channels`: "A", the alpha by which the pixels are premultiplied, and the channels of Aovs::unlit, whose colours it
/// does not change. It stores a crop as a picture of the crop's size, and takes only the name of the scene from
/// `metadata`. A .jpg or .jpeg stores the same values without "A" (libjpeg-turbo, quality 92, 4:4:4). A .webp (libwebp,
/// quality 92), .tif or .tiff stores the same values with "A". A .hdr stores linear R, G and B. The plugin for pictures
/// writes the last three formats. Equal arguments give equal bytes. The write is atomic: the picture is written to a
/// temporary file beside the target, which is then renamed. After a failure the target is unchanged. Any thread may
/// call this function. Throws UsageError for another extension, for a picture without pixels, and if the pixels, a
/// channel's values or the crop do not match the size; throws RunError if the file cannot be written.
PROMIN_EXPORT void write_image(const std::filesystem::path& file, const Image& image, const Metadata& metadata = {},
                               const std::optional<CropPlacement>& crop = std::nullopt,
                               std::span<const Channel> channels = {}, const DisplayTransform& display = {},
                               const ExrOptions& exr = {});

/// The largest number of pixels that read_image() accepts. The function refuses a larger picture before it reads the
/// pixels.
inline constexpr uint64_t kMaxReadPixels = uint64_t{1} << 28;

/// Reads a picture of any format that OpenImageIO supports. The result holds R, G and B, or a luminance three times, as
/// fp32 without conversion. The function reads the data window of an EXR. It multiplies the colours of WebP and EXR
/// files by alpha, but not those of other formats. Any thread may call this function. Throws InputError if the file is
/// not such a picture, and RunError if the plugin that reads pictures, libpromin_pictures.so, is missing.
PROMIN_EXPORT Image read_image(const std::filesystem::path& file);

/// Returns linear light encoded with the sRGB transfer curve (IEC 61966-2-1), computed in double on the host. The
/// result is clamped to [0, 1]; NaN becomes 0.
PROMIN_EXPORT float encode_srgb(float linear);

}  // namespace promin
