// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "environment_options.h"
#include "job_options.h"
#include "pose_options.h"
#include "promin/lighting.h"
#include "promin/math.h"
#include "promin/renderer.h"
#include "tracing_options.h"

namespace CLI {
class App;
}

namespace promin::app {

/// What rays from the camera see that leave the scene.
struct BackgroundChoice {
  /// Whether they see what surrounds the scene; else the colour.
  bool is_environment = false;
  /// Whether the colour is linear light, exposed and tone mapped as all light is; else it is sRGB, 0 to 1, as shown.
  bool is_linear = false;
  vec3 color{0.0F};

  bool operator==(const BackgroundChoice&) const = default;
};

/// How a scene is lit and its pictures are shown, as the user asked for it. What the user leaves open follows from the
/// scene (promin/lighting.h).
struct LookOptions {
  LightChoice light = LightChoice::kAuto;
  std::optional<BackgroundChoice> background = std::nullopt;
  /// Stops.
  std::optional<float> exposure_ev = std::nullopt;
  /// Whether the picture tells its stops itself (average_exposure_ev); `exposure_ev` is not given then.
  bool averages_exposure = false;
  std::optional<ToneMapping> tone_mapping = std::nullopt;
  bool dithers = false;
  /// RendererOptions::texture_bytes in MiB.
  uint32_t texture_memory_mib = kDefaultTextureBytes >> 20;
};

/// The part of a scene that is shown, as the user asked for it; make_view (view_setup.h) makes a View of it.
struct ViewOptions {
  /// A side of 0 follows from the camera's aspect ratio.
  std::optional<uvec2> size;
  std::optional<PixelWindow> crop;
  /// View's where it is not given.
  std::optional<uint32_t> samples_per_pixel = std::nullopt;
  PixelFilter filter = PixelFilter::kBox;
  /// In pixels; the filter's own where it is not given.
  std::optional<float> filter_width = std::nullopt;
  /// As the scene needs where it is not given.
  std::optional<uint32_t> max_depth = std::nullopt;
  DebugView debug_view = DebugView::kNone;
  DepthKind depth_kind = DepthKind::kRay;
  bool has_no_shadows = false;
  LookOptions look;
  /// Indices of the scene's lights to leave out.
  std::vector<uint32_t> lights_off;
  /// The name or number of a camera.
  std::optional<std::string> camera;
  /// Whether the scene's cameras are left out unless one is named: the scene is framed.
  bool frames_scene = false;
  /// A pose that takes the place of the scene's cameras.
  std::optional<Camera> given_camera;
  PoseOptions pose;
  EnvironmentOptions environment;
};

/// Numbers of frames from 0, both included.
struct FrameRange {
  uint32_t first = 0;
  uint32_t last = 0;
};

/// Samples of a pixel where nobody says how many. Eight end the stairs at edges and the noise of small mirrors, for
/// about a second of two cores more at 640x480.
inline constexpr uint32_t kDefaultSamples = 8;

/// How good a picture is, for people who do not count samples.
enum class Quality : uint32_t { kDraft, kNormal, kHigh, kBest };

/// What errors are of: linear light, or what is shown of it.
enum class ErrorSpace : uint32_t { kLinear, kDisplay };

/// Names for people, by the value of the ErrorSpace.
std::span<const std::string_view> error_space_names();

/// The least error to aim at, as a fraction in words.
std::string least_error();

/// How exact pictures are to be. What the user leaves open follows from the rest.
struct ErrorOptions {
  std::optional<float> target;
  /// Seconds.
  std::optional<double> time_limit_s;
  std::optional<uint32_t> min_samples;
  std::optional<uint32_t> max_samples;
  /// In what errors are measured.
  std::optional<ErrorSpace> space;

  bool is_given() const { return target || time_limit_s; }
  /// Empty where pictures have samples of a fixed number.
  std::optional<ErrorTarget> error_target() const;
  /// Of this error where none is given. How the picture is shown is not known yet (fit_to_display).
  ErrorTarget target_or(float error) const;
};

/// Gives a target what hangs on how the picture is shown: what is white and, where errors are measured as they are
/// shown, by what.
void fit_to_display(ErrorTarget& target, const DisplayTransform& display);

/// The options that ask for such a target, to the bit.
std::string describe_options(const ErrorTarget& target);
/// "error 0.015625", "error 0.015625 to 0.125" or one of these with " as shown": errors that were reached, measured as
/// the target is.
std::string describe_errors(float least, float most, const ErrorTarget& target);

/// " but for 750 pixels of at most 0.0161": those that have missed a target; empty where none has.
std::string describe_unmet(const PictureError& error);

struct RenderOptions {
  TracingOptions tracing;
  /// Where the user names none, those of name_pictures.
  std::vector<std::filesystem::path> pictures;
  /// Whether frames are left out whose pictures are there.
  bool skips_existing = false;
  ViewOptions view;
  std::optional<Quality> quality;
  ErrorOptions error;
  JobOptions job;
  /// Channels that an EXR carries beside R, G and B.
  AovSet aovs;
  /// Whether AovSet::unlit is for what shows the pictures alone, which is known when the scene is read.
  bool hides_unlit = false;
  ExrOptions exr;
  /// Whether the user has said how EXRs are compressed, be it as they are anyway.
  bool names_compression = false;
  /// A camera path, and which of its frames to render; without `frames` all.
  std::optional<std::filesystem::path> path;
  std::optional<FrameRange> frames;
  /// The rate of pictures, as PathPictures takes it.
  std::optional<double> fps;
  /// A pixel to explain instead of writing a picture.
  std::optional<uvec2> explained_pixel;
  bool has_all_features = false;
};

/// Adds the rows that a window takes as well: what of the scene is shown, and the camera. `view` must outlive the
/// parsing.
void add_view_options(OptionTable& table, ViewOptions& view);

/// Adds the rows of --spp, with what is usual, and --quality. `options` must outlive the parsing.
void add_sample_options(OptionTable& table, RenderOptions& options, std::string_view usual);

/// Adds the rows of --target-error, with this help, and of the samples that go with it. `error` must outlive the
/// parsing.
void add_error_options(OptionTable& table, ErrorOptions& error, std::string_view target_help);

/// Adds the row of --fps, for whatever plays a path. `fps` must outlive the parsing.
void add_fps_option(OptionTable& table, std::optional<double>& fps);

/// Gives samples or an error to what is asked by its quality.
void apply_quality(RenderOptions& options);

/// Adds a row for each option to the command. `options` must outlive the parsing.
void add_render_options(CLI::App& command, RenderOptions& options);

/// The pictures that a command writes: those named or, where none is and no pixel is explained, the scene's name with
/// .exr and .png in the current folder, of a path's frames with #### for their numbers.
std::vector<std::filesystem::path> name_pictures(const RenderOptions& options);

/// Throws UsageError where there is a camera beside the option of this name, which brings cameras of its own.
void check_no_camera(const ViewOptions& options, std::string_view name);

/// Throws UsageError where the least samples are more than the most.
void check_error_target(const ErrorTarget& target);

/// Throws UsageError where two options contradict each other.
void check_render_options(const RenderOptions& options);

}  // namespace promin::app
