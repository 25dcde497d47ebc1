// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/read_panorama.h"

#include "core/file.h"
#include "core/srgb.h"
#include "image/picture_formats.h"
#include "image/read_image.h"
#include "promin/error.h"
#include "promin/validate.h"

namespace promin {
namespace {

vec3 to_linear(const vec3& codes) {
  const auto channel = [&](int i) { return static_cast<float>(srgb_to_linear(static_cast<double>(codes[i]))); };
  return {channel(0), channel(1), channel(2)};
}

Panorama make_panorama(Image image, bool holds_radiance, const std::string& name) {
  if (!holds_radiance) {
    for (vec3& pixel : image.pixels) pixel = to_linear(pixel);
  }
  Environment environment;
  Panorama panorama = {std::make_shared<const Image>(std::move(image))};
  environment.sky = panorama;
  if (const std::vector<Problem> problems = validate(environment); !problems.empty()) {
    throw InputError({problems.front().what, name, problems.front().cure});
  }
  return panorama;
}

constexpr uvec2 kMostPixels{Panorama::kMaxWidth, Panorama::kMaxHeight};

}  // namespace

Panorama read_panorama(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  return make_panorama(read_image_within(file, kMostPixels), ending == ".hdr" || ending == ".exr", file.string());
}

Panorama read_panorama(std::span<const std::byte> file, const std::string& name) {
  return make_panorama(read_image_bytes(file, name, kMostPixels), holds_light(file), name);
}

}  // namespace promin
