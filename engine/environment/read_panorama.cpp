// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/read_panorama.h"

#include <cmath>

#include "core/file.h"
#include "image/read_image.h"
#include "promin/error.h"
#include "promin/validate.h"

namespace promin {
namespace {

bool holds_radiance(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  return ending == ".hdr" || ending == ".exr";
}

/// sRGB's transfer curve to linear light (IEC 61966-2-1).
float decode_srgb(float encoded) {
  const double x = encoded;
  return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

}  // namespace

Panorama read_panorama(const std::filesystem::path& file) {
  Image image = read_image_within(file, {Panorama::kMaxWidth, Panorama::kMaxHeight});
  if (!holds_radiance(file)) {
    for (vec3& pixel : image.pixels) pixel = {decode_srgb(pixel.x), decode_srgb(pixel.y), decode_srgb(pixel.z)};
  }
  Environment environment;
  Panorama panorama = {std::make_shared<const Image>(std::move(image))};
  environment.sky = panorama;
  if (const std::vector<Problem> problems = validate(environment); !problems.empty()) {
    throw InputError({problems.front().what, file.string(), problems.front().cure});
  }
  return panorama;
}

}  // namespace promin
