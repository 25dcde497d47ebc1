// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/read_panorama.h"

#include <cmath>
#include <sstream>

#include "core/count_of.h"
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

/// Sets finite negative numbers to 0. Returns a sentence with their number; empty if there are no such numbers.
std::string remove_negatives(Image& image, const std::string& name) {
  size_t count = 0;
  std::ostringstream first;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      float& value = image.pixels[i][channel];
      if (!(value < 0.0F) || std::isinf(value)) continue;
      if (++count == 1) first << value << " in pixel " << i % image.size.x << ", " << i / image.size.x;
      value = 0.0F;
    }
  }
  if (count == 0) return "";
  std::ostringstream sentence;
  sentence << count_of(count, "number") << " of " << name << " " << verb_of(count, "is", "are")
           << " negative, the first " << first.str() << "; " << verb_of(count, "it is read", "they are read")
           << " as 0";
  return sentence.str();
}

Panorama make_panorama(Image image, bool holds_radiance, const std::string& name, std::vector<std::string>& warnings) {
  if (!holds_radiance) {
    for (vec3& pixel : image.pixels) pixel = to_linear(pixel);
  }
  if (std::string warning = remove_negatives(image, name); !warning.empty()) warnings.push_back(std::move(warning));
  Environment environment;
  Panorama panorama = {std::make_shared<const Image>(std::move(image))};
  environment.sky = panorama;
  if (const std::vector<Problem> problems = validate(environment); !problems.empty()) {
    throw InputError({problems.front().code, problems.front().what, name, problems.front().cure});
  }
  return panorama;
}

constexpr uvec2 kMostPixels{Panorama::kMaxWidth, Panorama::kMaxHeight};

}  // namespace

Panorama read_panorama(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string ending = lower_case_ending(file);
  return make_panorama(read_image_within(file, kMostPixels), ending == ".hdr" || ending == ".exr", file.string(),
                       warnings);
}

Panorama read_panorama(std::span<const std::byte> file, const std::string& name, std::vector<std::string>& warnings) {
  return make_panorama(read_image_bytes(file, name, kMostPixels), holds_light(file), name, warnings);
}

}  // namespace promin
