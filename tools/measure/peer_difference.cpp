// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// How far a picture of another renderer is from one of promin, in linear light clamped to [0, 1] as every one can
// write.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "measure/compare_images.h"
#include "run_program.h"

namespace {

promin::Image read_clamped(const std::string& file) {
  promin::Image image = promin::read_image(file);
  for (promin::vec3& pixel : image.pixels) pixel = glm::clamp(pixel, 0.0F, 1.0F);
  return image;
}

struct ComparisonOptions {
  std::string first;
  std::string second;
  promin::CompareOptions compare;
};

void compare(const ComparisonOptions& options) {
  const promin::Image first = read_clamped(options.first);
  const promin::ImageDifference difference =
      promin::compare_images(first, read_clamped(options.second), options.compare);
  const nlohmann::ordered_json json = {{"mean_absolute", difference.mean_absolute},
                                       {"threshold", options.compare.fail},
                                       {"different_percent", difference.failed_percent()},
                                       {"largest", difference.largest}};
  fmt::print("{}\n", json.dump());
}

promin::app::Command add_compare_command(CLI::App& program) {
  using promin::app::OptionValues;
  const auto options = std::make_shared<ComparisonOptions>();
  options->compare.fail = 0.02F;
  promin::app::OptionTable table(program);
  table.add_required("FIRST", "", "A picture", [=](const OptionValues& words) { options->first = words.text(); });
  table.add_required("SECOND", "", "Another of the same size",
                     [=](const OptionValues& words) { options->second = words.text(); });
  table.add("--fail", "D", "A pixel that differs by more counts as different, 0 to 1 [0.02]",
            [=](const OptionValues& words) { options->compare.fail = static_cast<float>(words.real(0, 0.0, 1.0)); });
  return {&program, [options] { compare(*options); }};
}

}  // namespace

int main(int argc, char** argv) {
  return promin::app::run_program("promin-peer-difference",
                                  "Prints as JSON how two pictures of linear light differ; EXR, or 16-bit PPM.",
                                  {add_compare_command}, argc, argv);
}
