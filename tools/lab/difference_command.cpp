// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// promin-lab difference measures the difference of a picture by another renderer from one by promin, in linear light
// clamped to [0, 1], the range that each renderer can write.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "lab/commands.h"
#include "measure/compare_images.h"

namespace promin::lab {
namespace {

struct DifferenceOptions {
  std::string first;
  std::string second;
  CompareOptions compare;
};

Image read_clamped(const std::string& file) {
  Image image = read_image(file);
  for (vec3& pixel : image.pixels) pixel = glm::clamp(pixel, 0.0F, 1.0F);
  return image;
}

/// Returns the root of the mean squared difference of all channels; the pictures have one size.
double rmse_of(const Image& a, const Image& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const dvec3 difference = dvec3(a.pixels[i]) - dvec3(b.pixels[i]);
    sum += glm::dot(difference, difference);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.pixels.size())));
}

void print_difference(const DifferenceOptions& options) {
  const Image first = read_clamped(options.first);
  const Image second = read_clamped(options.second);
  const ImageDifference difference = compare_images(first, second, options.compare);
  const nlohmann::ordered_json json = {{"mean_absolute", difference.mean_absolute},
                                       {"rmse", rmse_of(first, second)},
                                       {"threshold", options.compare.fail},
                                       {"different_percent", difference.failed_percent()},
                                       {"largest", difference.largest}};
  fmt::print("{}\n", json.dump());
}

}  // namespace

app::Command add_difference_command(CLI::App& program) {
  using app::OptionValues;
  CLI::App& command =
      app::add_command(program, "difference",
                       "Prints as JSON how two pictures of linear light differ. They may be EXR or 16-bit PPM files");
  const auto options = std::make_shared<DifferenceOptions>();
  options->compare.fail = 0.02F;
  app::OptionTable table(command);
  table.add_required("FIRST", "", "A picture", [=](const OptionValues& words) { options->first = words.text(); });
  table.add_required("SECOND", "", "A second picture of the same size",
                     [=](const OptionValues& words) { options->second = words.text(); });
  table.add("--fail", "D", "Limit above which a pixel counts as different, 0 to 1 [0.02]",
            [=](const OptionValues& words) { options->compare.fail = static_cast<float>(words.real(0, 0.0, 1.0)); });
  return {&command, [options] { print_difference(*options); }};
}

}  // namespace promin::lab
