// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/compare_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/count_of.h"
#include "core/json_text.h"
#include "core/srgb.h"
#include "image/compare_channels.h"
#include "options/help.h"
#include "output/console.h"
#include "output/outputs.h"
#include "output/rows.h"
#include "output/work_names.h"
#include "promin/compare.h"
#include "promin/error.h"
#include "promin/image.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace fs = std::filesystem;

namespace {

constexpr double kMostDifference = 1e9;

struct CompareOptions {
  fs::path first;
  fs::path second;
  std::optional<fs::path> difference;
  /// The largest allowed difference of a channel; if empty, any difference is allowed.
  std::optional<double> fail;
  std::optional<double> fail_percent;
  double pixels_per_degree = kPixelsPerDegree;
  bool prints_json = false;
  bool is_quiet = false;
};

PictureEncoding common_encoding(const CompareOptions& options) {
  const PictureEncoding encoding = encoding_of(options.first);
  if (encoding == encoding_of(options.second)) return encoding;
  throw InputError({"picture.pair.spaces", "one picture contains linear light, but the other contains sRGB values",
                    fmt::format("{} and {}", options.first.string(), options.second.string()),
                    "give two .exr or two .png files"});
}

/// Returns the colour for an error of 0...1, in linear light. The colours run from black through violet and orange to
/// white, like matplotlib's map "magma" at five places.
vec3 heat_color(float error) {
  constexpr std::array<dvec3, 5> kCodes = {{{0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}}};
  const double place = static_cast<double>(std::clamp(error, 0.0F, 1.0F)) * (kCodes.size() - 1);
  const auto below = std::min(static_cast<size_t>(place), kCodes.size() - 2);
  const dvec3 code = glm::mix(kCodes[below], kCodes[below + 1], place - static_cast<double>(below)) / 255.0;
  return {srgb_to_linear(code.x), srgb_to_linear(code.y), srgb_to_linear(code.z)};
}

/// Writes FLIP in colours. To a file of linear light it writes the absolute differences, with FLIP as a channel.
void write_difference(const fs::path& file, const Image& first, const Image& second,
                      const PictureDifference& difference) {
  Image shown = first;
  if (!has_named_channels(file)) {
    std::ranges::transform(difference.flip_map, shown.pixels.begin(), heat_color);
    write_image(file, shown);
    return;
  }
  Channel flip{"flip", false, {}};
  for (size_t i = 0; i < shown.pixels.size(); ++i) {
    shown.pixels[i] = glm::abs(first.pixels[i] - second.pixels[i]);
    flip.values.push_back(std::bit_cast<uint32_t>(difference.flip_map[i]));
  }
  write_image(file, shown, {}, std::nullopt, {&flip, 1});
}

/// Returns the number, or null for an infinite number, because JSON has no infinity.
nlohmann::json number_or_null(double number) {
  return std::isfinite(number) ? nlohmann::json(number) : nlohmann::json(nullptr);
}

void print_comparison_json(const PictureDifference& difference, const std::vector<ChannelDifference>& others) {
  nlohmann::ordered_json json = {{"pixels", difference.pixel_count},
                                 {"mean", difference.mean},
                                 {"rmse", difference.rmse},
                                 {"psnr_db", number_or_null(difference.psnr_db)},
                                 {"flip", difference.flip},
                                 {"largest", number_or_null(difference.largest)},
                                 {"largest_at", {difference.largest_at.x, difference.largest_at.y}},
                                 {"different", difference.different_count},
                                 {"non_finite", difference.non_finite_count}};
  json["channels"] = nlohmann::ordered_json::object();
  for (const ChannelDifference& other : others) {
    json["channels"][other.name] = {{"largest", number_or_null(other.largest)},
                                    {"largest_at", {other.largest_at.x, other.largest_at.y}},
                                    {"different", other.different_count}};
  }
  fmt::print("{}\n", json_text(json, 2));
}

/// Prints the difference of a picture or of one of its channels.
template <typename Difference>
double percent_different(const Difference& difference) {
  return 100.0 * static_cast<double>(difference.different_count) / static_cast<double>(difference.pixel_count);
}

template <typename Difference>
std::string describe_largest(const Difference& difference) {
  const std::string largest = fmt::format("{:.6g}", difference.largest);
  if (difference.largest == 0.0) return largest;
  return largest + fmt::format(", at pixel {} {}", difference.largest_at.x, difference.largest_at.y);
}

template <typename Difference>
std::string describe_different(const Difference& difference, double fail) {
  return fmt::format("{} ({:.4g} %) {} by more than {:g}", count_of(difference.different_count, "pixel"),
                     percent_different(difference), verb_of(difference.different_count, "differs", "differ"), fail);
}

/// Prints a line for each channel that differs.
void print_channels(const std::vector<ChannelDifference>& others, double fail) {
  std::vector<std::string> lines;
  size_t equal = 0;
  for (const ChannelDifference& other : others) {
    if (other.largest == 0.0) {
      ++equal;
      continue;
    }
    lines.push_back(
        fmt::format("{}: largest {}; {}", other.name, describe_largest(other), describe_different(other, fail)));
  }
  if (equal > 0) lines.push_back(fmt::format("{} in addition to R, G and B are equal", equal));
  promin::app::print_rows("channels", lines);
}

void print_difference(const PictureDifference& difference, double fail) {
  print_row("mean", fmt::format("{:.6g}", difference.mean));
  print_row("RMSE", fmt::format("{:.6g}", difference.rmse));
  print_row("PSNR", fmt::format("{:.6g} dB", difference.psnr_db));
  print_row("FLIP", fmt::format("{:.6g}", difference.flip));
  print_row("largest", describe_largest(difference));
  print_row("over", describe_different(difference, fail));
  if (difference.non_finite_count > 0) {
    print_row("not finite", fmt::format("{} {} a NaN or an infinity", count_of(difference.non_finite_count, "pixel"),
                                        verb_of(difference.non_finite_count, "has", "have")));
  }
}

/// Warns of a limit that differences of values of 0 to 1 cannot exceed, and suggests another.
void warn_of_idle_limit(const CompareOptions& options, PictureEncoding encoding) {
  constexpr double kMostCode = 255.0;
  if (encoding != PictureEncoding::kSrgb || !options.fail || *options.fail < 1.0) return;
  const std::string meant =
      *options.fail <= kMostCode ? fmt::format("; {0:g} of 255 is --fail {0:g}/255", *options.fail) : "";
  Console(Verbosity::kNormal)
      .warn(fmt::format("--fail {:g} never fails, because the values of these files are from 0 to 1{}", *options.fail,
                        meant));
}

/// Throws DifferenceError if more pixels differ than allowed. `in` names the channel.
template <typename Difference>
void check_limit(const Difference& difference, const std::string& in, const CompareOptions& options) {
  if (percent_different(difference) <= options.fail_percent.value_or(0.0)) return;
  const std::string allowed = options.fail_percent ? fmt::format(", {:.6g} % where {:g} % is allowed",
                                                                 percent_different(difference), *options.fail_percent)
                                                   : "";
  throw DifferenceError({"picture.pair.differs",
                         fmt::format("{} {} by more than {:g}{}{}, with the largest difference at pixel {} {} ({:.6g})",
                                     count_of(difference.different_count, "pixel"),
                                     verb_of(difference.different_count, "differs", "differ"), *options.fail, in,
                                     allowed, difference.largest_at.x, difference.largest_at.y, difference.largest),
                         fmt::format("{} compared with {}", options.second.string(), options.first.string()), ""});
}

void compare(const CompareOptions& options) {
  if (options.fail_percent && !options.fail) {
    throw UsageError({"usage.option.needs", "--fail-percent needs the limit of --fail", "", "give --fail as well"});
  }
  if (options.difference) {
    check_pictures({*options.difference});
    check_outputs({options.first, options.second}, {*options.difference}, std::nullopt);
  }
  // The files are read first, so that a file that is not a picture is reported as such and not as a picture with
  // another encoding.
  const Image first = read_image(options.first);
  const Image second = read_image(options.second);
  const PictureEncoding encoding = common_encoding(options);
  warn_of_idle_limit(options, encoding);
  const double fail = options.fail.value_or(0.0);
  const PictureDifference difference = compare_pictures(
      first, second, {.encoding = encoding, .fail = fail, .pixels_per_degree = options.pixels_per_degree});
  const std::vector<ChannelDifference> others = compare_other_channels(options.first, options.second, fail);
  if (options.difference) write_difference(*options.difference, first, second, difference);
  if (options.prints_json) {
    print_comparison_json(difference, others);
  } else if (!options.is_quiet) {
    print_difference(difference, fail);
    print_channels(others, fail);
  }
  if (!options.fail) return;
  check_limit(difference, "", options);
  for (const ChannelDifference& other : others) check_limit(other, " in " + other.name, options);
}

}  // namespace

Command add_compare_command(CLI::App& program) {
  CLI::App& command = add_command(program, "compare", "Measure how much two pictures differ");
  const auto options = std::make_shared<CompareOptions>();
  OptionTable table(command);
  table.add_required("FIRST", "", "A picture: .exr with linear light, .png or another format with sRGB",
                     [=](const OptionValues& words) { options->first = words.text(); });
  table.add_required("SECOND", "",
                     "A second picture with the same size and channels. All channels are compared, also those in "
                     "further parts of an EXR",
                     [=](const OptionValues& words) { options->second = words.text(); });
  table.add("-o,--output", "FILE",
            "Write a picture of the differences. A .png shows how visible they are (FLIP), from black to white. An "
            ".exr holds the absolute differences, and FLIP as a channel",
            [=](const OptionValues& words) { options->difference = words.text(); });
  table.add(
      "--fail", "X",
      "Exit with code 5 if any pixel differs by more than X. The values of a PNG are from 0 to 1, so X may be 2/255",
      [=](const OptionValues& words) {
        const std::optional<double> quotient = words.fraction();
        options->fail = quotient ? *quotient : words.real(0, 0.0, kMostDifference);
      });
  table.add("--fail-percent", "P", "With --fail: percentage of pixels that may differ by more than X [0]",
            [=](const OptionValues& words) { options->fail_percent = words.real(0, 0.0, 100.0); });
  table.add("--pixels-per-degree", "N",
            fmt::format("Pixels per degree of the viewer's field of view, for FLIP [{:.4g}, for a screen of 3840 "
                        "pixels that is seen from a distance of its width]",
                        options->pixels_per_degree),
            [=](const OptionValues& words) { options->pixels_per_degree = words.real(0, 1.0, 1000.0); });
  table.add_flag("--json", "Print JSON", options->prints_json);
  table.add_flag("--quiet", "Print only errors", options->is_quiet);
  add_examples(command, {{"promin compare before.png after.png", "prints how much they differ"},
                         {"promin compare before.png after.png -o where.png", "shows where they differ"},
                         {"promin compare before.png after.png --fail 2/255 --fail-percent 0.1",
                          "fails if more than 0.1 % of the pixels differ by more than 2/255"}});
  return {&command, [options] { compare(*options); }};
}

}  // namespace promin::app
