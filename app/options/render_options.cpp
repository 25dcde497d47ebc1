// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/render_options.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <string>
#include <type_traits>

#include "core/count_of.h"
#include "core/parse_number.h"
#include "core/suggest.h"
#include "image/picture_endings.h"
#include "options/arguments.h"
#include "options/job_options.h"
#include "options/load_options.h"
#include "options/pose_options.h"
#include "options/tracing_options.h"
#include "promin/aovs.h"
#include "promin/error.h"
#include "promin/image.h"
#include "promin/validate.h"
#include "promin/view.h"
#include "trace/film/refinement.h"
#include "work/pictures/camera_path.h"
#include "work/spec/spec_json.h"

namespace promin::app {
namespace {

constexpr std::string_view kAuto = "auto";
constexpr std::string_view kAverage = "average";
constexpr std::string_view kCryptomatte = "cryptomatte";
/// A name that both --aov and --shading accept.
constexpr std::string_view kNormal = "normal";
constexpr std::string_view kNormals = "normals";
constexpr std::array<std::string_view, 2> kFeatureChoices = {"scene", "all"};

/// Reads names separated by commas.
AovSet read_aovs(const OptionValues& words) {
  AovSet choice;
  for (std::string name : split_list(words.text())) {
    if (name == kNormals) name = kNormal;
    bool is_known = false;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (name == #FIELD) is_known = choice.FIELD = true;
#include "promin/kinds/aovs.def"
    if (name == kCryptomatte) is_known = choice.cryptomatte = true;
    if (is_known) continue;
    std::vector<std::string_view> known(aov_names().begin(), aov_names().end());
    known.push_back(kCryptomatte);
    words.refuse(
        fmt::format("--aov takes names from {}, separated by commas, not \"{}\"", fmt::join(known, ", "), name),
        nearest_name(name, known));
  }
  return choice;
}

PixelWindow read_window(const OptionValues& words) {
  const PixelWindow window = {{words.whole(0, 0, kMaxSide), words.whole(1, 0, kMaxSide)},
                              {words.whole(2, 0, kMaxSide), words.whole(3, 0, kMaxSide)}};
  if (window.lo.x >= window.hi.x || window.lo.y >= window.hi.y) {
    words.refuse("--crop contains no pixels, because it needs X0 < X1 and Y0 < Y1");
  }
  return window;
}

BackgroundChoice read_background(const OptionValues& words) {
  // A colour that begins like a number has three words.
  const std::string& first = words.text();
  const bool is_word = first.front() == '#' || std::isalpha(static_cast<unsigned char>(first.front())) != 0;
  if (is_word) return words.read(work::read_background);
  return {.color = vec3(dvec3(words.real(0, 0.0, 1.0), words.real(1, 0.0, 1.0), words.real(2, 0.0, 1.0)))};
}

/// Reads an error as "0.02" or "1/64".
float read_error(const OptionValues& words) {
  // The limit is slightly smaller than the smallest target, because the shortest decimals of the target, which programs
  // print, represent a slightly smaller number.
  const auto least = static_cast<double>(std::nextafter(kMinTargetError, 0.0F));
  const std::optional<double> quotient = words.fraction();
  const double error = quotient ? *quotient : words.real(0, least, 1.0);
  if (error < least || error > 1.0) {
    words.refuse(fmt::format("--target-error takes {} to 1, not \"{}\"", least_error(), words.text()));
  }
  return std::max(static_cast<float>(error), kMinTargetError);
}

/// Reads a range "3-7", or a single number "3".
FrameRange read_frames(const OptionValues& words) {
  const std::string& text = words.text();
  const size_t dash = text.find('-');
  const OptionValues ends = words.with({text.substr(0, dash), text.substr(dash == std::string::npos ? 0 : dash + 1)});
  const FrameRange range = {ends.whole(0, 0, kMaxFrame), ends.whole(1, 0, kMaxFrame)};
  if (range.first > range.last) words.refuse("--frames contains no frame, because A-B needs A <= B");
  return range;
}

/// Reads numbers separated by commas. The result has each number once, in ascending order.
std::vector<uint32_t> read_numbers(const OptionValues& words) {
  std::vector<uint32_t> numbers;
  for (const std::string& number : split_list(words.text())) {
    const std::optional<uint32_t> value = to_number<uint32_t>(number);
    if (!value) {
      words.refuse(
          fmt::format("--lights-off takes numbers of 0 or more, separated by commas, not \"{}\"", words.text()));
    }
    numbers.push_back(*value);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Reads a debug view. It also accepts the name of the AOV.
DebugView read_shading(const OptionValues& words) {
  const OptionValues canonical = words.text() == kNormal ? words.with({std::string(kNormals)}) : words;
  return canonical.name<DebugView>(debug_view_names());
}

template <typename Number>
Number read_number(const OptionValues& words, Number min, Number max) {
  if constexpr (std::is_floating_point_v<Number>) {
    return static_cast<Number>(words.real(0, static_cast<double>(min), static_cast<double>(max)));
  } else {
    return words.whole(0, min, max);
  }
}

void add_look_options(OptionTable& table, LookOptions& look) {
  const std::span<const std::string_view> lights = light_choice_names();
  table.add("--light", fmt::format("{}", fmt::join(lights.subspan(1), "|")),
            "Light that is added if the scene has no light or no sky. soft is the studio with soft shadows: a sun 10 "
            "degrees wide, --integrator direct and --ground. fill is the studio without its sun, and darker [studio; "
            "files that their own surfaces light strongly: fill; classic scenes: headlight]",
            [&look, lights](const OptionValues& w) { look.light = w.name<LightChoice>(lights, 1); });
  table.add(
      "--ground", "on|off",
      "Show the shadow of the scene on a ground under it, which is otherwise invisible [off; with --light soft: on]",
      [&look](const OptionValues& w) {
        constexpr std::array kWords = {std::string_view("off"), std::string_view("on")};
        look.has_ground = w.choice(kWords) == kWords[1];
      });
  table.add("--background", fmt::format("R G B|COLOR|{}", work::kEnvironmentShown),
            "Colour of the background in the picture: white, '#336699' or three numbers from 0 to 1. linear:R,G,B is "
            "linear light, which exposure and tone mapping change. environment shows the sky that lights the scene "
            "[the background of the file; if it has none, a grey gradient, or black for classic scenes]",
            [&](const OptionValues& w) { look.background = read_background(w); });
  table.add(
      "--exposure", fmt::format("EV|{}|{}", kAuto, kAverage),
      "Exposure of PNG files and the window in stops. +1 doubles the brightness. auto computes it from the scene's "
      "lights, average from the picture itself or from the first picture of a path [auto; classic scenes: 0]",
      [&](const OptionValues& w) {
        look.exposure_ev.reset();
        look.averages_exposure = w.text() == kAverage;
        if (w.text() == kAuto || w.text() == kAverage) return;
        constexpr std::array kWords = {kAuto, kAverage};
        look.exposure_ev = static_cast<float>(w.real(0, -kMaxExposureEv, kMaxExposureEv, kWords));
      });
  table.add(
      "--tone-mapping", fmt::format("{}", fmt::join(tone_mapping_names(), "|")),
      "Curve that compresses light that is too bright for PNG files and the window [neutral; classic scenes: none]",
      [&](const OptionValues& w) { look.tone_mapping = w.name<ToneMapping>(tone_mapping_names()); });
  table.add_flag(
      "--dither",
      "Add noise of less than one 8-bit step to PNG files and the window. It hides bands in smooth gradients",
      look.dithers);
  table.add("--texture-memory", "MIB",
            fmt::format("Device memory for textures in MiB, 1 to {}. The sizes of the largest textures are halved "
                        "until all of them fit [{}]",
                        kMaxTextureMib, look.texture_memory_mib),
            [&](const OptionValues& w) { look.texture_memory_mib = w.whole(0, 1, kMaxTextureMib); });
}

}  // namespace

void add_environment_options(OptionTable& table, EnvironmentOptions& options) {
  table.add("--environment", "FILE",
            "Equirectangular panorama that surrounds the scene, .hdr or .exr. Its middle is in the direction -Z [the "
            "scene's own sky]",
            [&](const OptionValues& w) { options.panorama = w.text(); });
  table.add(
      "--environment-rotation", "DEG",
      "Turn the sky about its upward direction by this angle in degrees. If +Y is up, it turns from +Z towards +X [0]",
      [&](const OptionValues& w) { options.rotation_deg = w.real(0, -kMaxRotationDeg, kMaxRotationDeg); });
  table.add("--environment-intensity", "X", "Multiply the sky's radiance by this factor [1]",
            [&](const OptionValues& w) { options.intensity = w.real(0, 0.0, kMaxIntensity); });
  table.add(
      "--light-rotation", "DEG",
      "Turn the sky and directional lights about the sky's upward direction by this angle in degrees. If +Y is up, "
      "they turn from +Z towards +X [0]",
      [&](const OptionValues& w) { options.light_rotation_deg = w.real(0, -kMaxRotationDeg, kMaxRotationDeg); });
}

void add_view_options(OptionTable& table, ViewOptions& view) {
  table.add("--size", fmt::format("WxH|{}", fmt::join(work::size_names(), "|")),
            "Size of the picture in pixels. 640 alone is a width; the height then follows from the camera's aspect "
            "ratio [the size in the scene file; if it has none, a height of 720]",
            [&](const OptionValues& w) { view.size = w.read(work::read_size); });
  table.add("--filter", fmt::format("{}", fmt::join(pixel_filter_names(), "|")),
            "Filter that weights samples by their distance from the pixel's centre [box]",
            [&](const OptionValues& w) { view.filter = w.name<PixelFilter>(pixel_filter_names()); });
#define PROMIN_VIEW_NUMBER(NAME, TYPE, MIN, MAX, USUAL, PLACEHOLDER, HELP) \
  table.add(option_of(#NAME), PLACEHOLDER, HELP,                           \
            [&](const OptionValues& w) { view.NAME = read_number<TYPE>(w, MIN, MAX); });
#include "work/spec/view_numbers.def"
  table.add(
      "--shading", "NAME",
      fmt::format("Property that the picture shows: {}. full is the light [full]", fmt::join(debug_view_names(), ", ")),
      [&](const OptionValues& w) { view.debug_view = read_shading(w); });
  table.add_flag("--no-shadows", "Do not trace shadow rays, so nothing casts a shadow", view.has_no_shadows);
  table.add("--integrator", fmt::format("{}", fmt::join(integrator_names(), "|")),
            "Method that computes light. whitted: the light of the environment reaches every point, and surfaces that "
            "emit light do not light others. direct: they light others, and objects also block the light of the "
            "environment, which gives soft shadows and takes more samples. path: surfaces also scatter light to other "
            "surfaces, up to --max-depth times [whitted; direct with --light soft, and if surfaces emit much light]",
            [&](const OptionValues& w) { view.integrator = w.name<Integrator>(integrator_names()); });
  table.add("--lights-off", "INDICES", "Indices of lights to switch off, counted from 0 and separated by commas",
            [&](const OptionValues& w) { view.lights_off = read_numbers(w); });
  add_look_options(table, view.look);
  table.add("--camera", "NAME|INDEX", "Name of a camera of the scene, or its index, counted from 0 [0]",
            [&](const OptionValues& w) { view.camera = w.text(); });
  add_pose_options(table, view.pose);
  table.add("--aperture-radius", "R",
            "Radius of the camera's lens in scene units. Only what lies at --focus-distance is sharp [0, no lens]",
            [&](const OptionValues& w) { view.aperture_radius = w.real(0, 0.0, kMaxCoordinate); });
  table.add("--focus-distance", "D", "Distance from the eye to the plane in focus, along the direction of view",
            [&](const OptionValues& w) { view.focus_distance = w.real(0, kLeastFocusDistance, kMaxCoordinate); });
  add_environment_options(table, view.environment);
}

void add_fps_option(OptionTable& table, std::optional<double>& fps) {
  table.add(
      "--fps", "N|stored",
      fmt::format("Pictures per second of the path or of the scene's animation, {} to {}. stored renders exactly the "
                  "frames in the path's file [the fps in the file; if it has none, stored. Without --path: 24]",
                  PathPictures::kMinFps, PathPictures::kMaxFps),
      [&](const OptionValues& w) {
        constexpr std::array<std::string_view, 1> kWords = {"stored"};
        const bool is_stored = w.text() == kWords[0];
        fps = is_stored ? PathPictures::kStored : w.real(0, PathPictures::kMinFps, PathPictures::kMaxFps, kWords);
      });
}

namespace {

void add_time_limit_option(OptionTable& table, ErrorOptions& error) {
  table.add("--time-limit", "SECONDS",
            "Replaces --spp: render the best picture that can be finished in this time, given as 20, 20s or 2min, and "
            "print the options that reproduce it",
            [&](const OptionValues& w) { error.time_limit_s = w.read(work::read_seconds); });
}

}  // namespace

void add_error_options(OptionTable& table, ErrorOptions& error, std::string_view target_help) {
  const auto read_power = [](const OptionValues& w, std::string_view name) {
    const uint32_t samples = w.whole(0, kMinRefinedSamples, kMaxRefinedSamples);
    if (!std::has_single_bit(samples)) w.refuse(fmt::format("{} takes a power of two, not {}", name, samples));
    return samples;
  };
  table.add("--target-error", "E", std::string(target_help),
            [&](const OptionValues& w) { error.target = read_error(w); });
  table.add(
      "--min-spp", "N",
      fmt::format("With --target-error: smallest number of samples per pixel, a power of two from {0} [{1}; {0} if "
                  "--target-error is 1/{2:g} or more]",
                  kMinRefinedSamples, ErrorTarget{}.min_samples, 1.0F / kCoarseError),
      [&, read_power](const OptionValues& w) { error.min_samples = read_power(w, "--min-spp"); });
  table.add("--max-spp", "N",
            fmt::format("With --target-error: largest number of samples per pixel, a power of two up to {} [{}]",
                        kMaxRefinedSamples, ErrorTarget{}.max_samples),
            [&, read_power](const OptionValues& w) { error.max_samples = read_power(w, "--max-spp"); });
  table.add("--error-in", fmt::format("{}", fmt::join(error_space_names(), "|")),
            "With --target-error: measure the error in linear light or in the displayed picture [linear]",
            [&](const OptionValues& w) { error.space = w.name<ErrorSpace>(error_space_names()); });
}

void add_sample_options(OptionTable& table, RenderSpec& options, std::string_view more_defaults) {
  table.add("-s,--spp", "N",
            fmt::format("Samples per pixel, 1 to {} [{}, with --integrator direct or path {}{}]", kMaxSamplesPerPixel,
                        kDefaultSamples, kNoiseFactor * kDefaultSamples, more_defaults),
            [&](const OptionValues& w) { options.view.samples_per_pixel = w.whole(0, 1, kMaxSamplesPerPixel); });
  table.add("--quality", fmt::format("{}", fmt::join(quality_names(), "|")),
            fmt::format("Replaces --spp: {}, {} or {} samples per pixel, {} times as many with --integrator direct or "
                        "path. best adds samples until the error of displayed colours is at most one 8-bit step "
                        "[normal]",
                        1, kDefaultSamples, kHighSamples, kNoiseFactor),
            [&](const OptionValues& w) { options.quality = w.name<Quality>(quality_names()); });
}

void add_render_options(CLI::App& command, RenderSpec& options) {
  ViewOptions& view = options.view;
  OptionTable table(command);

  add_scene_argument(table, options.tracing);
  table.add_repeated(
      "-o,--output", "FILE",
      "Picture to write: .exr or .hdr (linear), .png, .jpg, .webp or .tif (sRGB, 8 bit). One .mp4, .webm or .gif, or a "
      ".png without #### for several frames, holds all frames of a film; this needs ffmpeg. The name - stands for a "
      "PNG "
      "on the standard output. You may repeat this option [the scene's name with .exr and .png, in the current folder]",
      [&](const OptionValues& w) { options.pictures.assign(w.all().begin(), w.all().end()); });
  table.add("--explain", "X Y", "Print all rays of this pixel as JSON and write no picture. 0 0 is the top left pixel",
            [&](const OptionValues& w) {
              options.explained_pixel = uvec2(w.whole(0, 0, kMaxSide), w.whole(1, 0, kMaxSide));
            });
  add_sample_options(table, options, ", with --explain 1");
  add_error_options(
      table, options.error,
      fmt::format(
          "Add samples until the estimated error of each pixel is at most E, {} to 1, instead of --spp. White is 1",
          least_error()));
  add_time_limit_option(table, options.error);
  add_variant_option(table, options.tracing.load);
  add_view_options(table, view);
  table.add("--crop", "X0 Y0 X1 Y1", "Render only the pixels with X0 <= x < X1 and Y0 <= y < Y1. Row 0 is at the top",
            [&](const OptionValues& w) { view.crop = read_window(w); });

  table.add("--path", "FILE.json",
            "Render the frames of a camera path. #### in the name of -o stands for the frame number",
            [&](const OptionValues& w) { options.path = w.text(); });
  table.add("--turntable", "N",
            "Render N frames while the camera moves once around the scene, to the right. It shows the whole scene from "
            "all sides, or starts from the file's camera. --animation plays an animation meanwhile",
            [&](const OptionValues& w) { options.turntable = w.whole(0, kMinTurntable, kMaxFrame); });
  table.add("--frames", "A-B",
            "Render only frames A to B of a camera path, a turntable or the scene's animation, including B. The first "
            "frame is "
            "0. Without --path, frame I has the time I / fps [all]",
            [&](const OptionValues& w) { options.frames = read_frames(w); });
  add_fps_option(table, options.fps);
  table.add("--shutter", "S",
            fmt::format("Blur motion: the shutter is open for this fraction of the time between two frames, {} to 1. "
                        "Each sample of a pixel shows another moment [0, no blur]",
                        kMinShutter),
            [&](const OptionValues& w) { options.shutter = w.real(0, kMinShutter, 1.0); });
  table.add_flag("--skip-existing", "With --path: skip frames if their pictures exist already", options.skips_existing);

  add_job_options(table, options.job,
                  fmt::format("With --job: number of bands of rows to divide each picture into, 1 to {}. Each band is "
                              "saved when it is complete, so at most one is lost if the program is killed [at least {} "
                              "pieces in all; for a path at least one per frame]",
                              kMaxSide, kUsualPieces),
                  kMaxSide);
  table.add(
      "--tiles", "C R",
      "With --job, replaces --pieces: number of columns and rows of tiles to divide each picture into",
      [&](const OptionValues& w) { options.job.tiles = uvec2(w.whole(0, 1, kMaxSide), w.whole(1, 1, kMaxSide)); });
  table.add("--aov", "NAMES",
            fmt::format("Additional channels of an EXR, separated by commas: {},{}", fmt::join(aov_names(), ","),
                        kCryptomatte),
            [&](const OptionValues& w) {
              const bool has_alpha = options.aovs.alpha;
              options.aovs = read_aovs(w);
              options.aovs.alpha |= has_alpha;
            });
  table.add_flag(
      "--alpha",
      "Write an alpha channel, the fraction of each pixel that the scene covers, and make the background transparent",
      options.aovs.alpha);
  table.add("--depth", fmt::format("{}", fmt::join(depth_kind_names(), "|")),
            "Distance that --aov depth writes. ray is the distance from the eye, plane the distance along the "
            "direction of view [ray]",
            [&](const OptionValues& w) { options.view.depth_kind = w.name<DepthKind>(depth_kind_names()); });
  table.add_flag(
      "--half",
      "Store colours, normals and coverage of an EXR as 16-bit floats, with a relative error of at most 1/2048",
      options.exr.is_half);
  table.add("--compression", fmt::format("{}", fmt::join(exr_compression_names(), "|")),
            "Lossless compression of an EXR [zip]", [&](const OptionValues& w) {
              options.names_compression = true;
              options.exr.compression = w.name<ExrCompression>(exr_compression_names());
            });
  table.add("--features", "scene|all",
            "Features to compile into the kernels: the features that the scene uses, or all features, for measurements "
            "[scene]",
            [&](const OptionValues& w) { options.has_all_features = w.choice(kFeatureChoices) == "all"; });
  add_tracing_options(table, options.tracing);
  add_measuring_options(table, options.tracing);
}

}  // namespace promin::app
