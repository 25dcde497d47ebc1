// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-compare: how far apart two pictures are, in linear light clamped to [0, 1] as every renderer can write it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "measure/compare_images.h"
#include "promin/error.h"

namespace {

promin::Image read_clamped(const std::string& file) {
  promin::Image image = promin::read_image(file);
  for (promin::vec3& pixel : image.pixels) pixel = glm::clamp(pixel, 0.0F, 1.0F);
  return image;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Prints as JSON how two pictures of linear light differ; EXR, or 16-bit PPM.", "promin-compare");
  std::string first;
  std::string second;
  promin::CompareOptions options;
  options.fail = 0.02F;
  program.add_option("FIRST", first, "A picture")->required();
  program.add_option("SECOND", second, "Another of the same size")->required();
  program.add_option("--fail", options.fail, "A pixel that differs by more counts as different [0.02]");
  CLI11_PARSE(program, argc, argv);
  try {
    const promin::ImageDifference difference =
        promin::compare_images(read_clamped(first), read_clamped(second), options);
    const nlohmann::ordered_json json = {{"mean_absolute", difference.mean_absolute},
                                         {"threshold", options.fail},
                                         {"different_percent", difference.failed_percent()},
                                         {"largest", difference.largest}};
    fmt::print("{}\n", json.dump());
    return 0;
  } catch (const promin::Error& error) {
    fmt::print(stderr, "promin-compare: error: {}\n", error.what());
    return 1;
  }
}
