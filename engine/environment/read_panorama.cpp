// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/read_panorama.h"

#include "core/file.h"
#include "core/srgb.h"
#include "image/read_image.h"
#include "promin/error.h"
#include "promin/validate.h"

namespace promin {
namespace {

bool holds_radiance(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  return ending == ".hdr" || ending == ".exr";
}

vec3 to_linear(const vec3& codes) {
  const auto channel = [&](int i) { return static_cast<float>(srgb_to_linear(static_cast<double>(codes[i]))); };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

Panorama read_panorama(const std::filesystem::path& file) {
  Image image = read_image_within(file, {Panorama::kMaxWidth, Panorama::kMaxHeight});
  if (!holds_radiance(file)) {
    for (vec3& pixel : image.pixels) pixel = to_linear(pixel);
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
