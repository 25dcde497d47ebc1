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

#include "promin/framing.h"
#include "promin/lighting.h"
#include "promin/math.h"
#include "promin/renderer.h"
#include "work/spec/common_spec.h"
#include "work/spec/environment_choice.h"

namespace promin::work {

// Ranges of members, for both options and JSON.

inline constexpr uint32_t kMaxFrame = 9999999;
/// The shortest time of an open shutter, as a fraction of the time between two frames.
inline constexpr double kMinShutter = 1e-3;
/// The smallest number of frames of a turntable.
inline constexpr uint32_t kMinTurntable = 2;
inline constexpr double kMaxBackground = 1e9;
/// The largest exposure in stops. With larger values, floats would overflow.
inline constexpr double kMaxExposureEv = 64.0;
inline constexpr uint32_t kMaxTextureMib = 8192;
/// The smallest time limit in seconds.
inline constexpr double kMinTimeLimit = 1e-3;
inline constexpr double kMaxTimeLimit = 1e6;
/// The smallest and the largest field of view in degrees. Angles of 0 and 180 degrees show nothing.
inline constexpr double kMinFovDeg = 1e-3;
inline constexpr double kMaxFovDeg = 180.0 - kMinFovDeg;
inline constexpr double kMaxTurnDeg = 3600.0;
inline constexpr double kMinZoom = 1e-3;
inline constexpr double kMaxZoom = 1e3;

/// The background that camera rays see.
struct BackgroundChoice {
  /// True if camera rays see the environment; otherwise they see the colour.
  bool is_environment = false;
  /// True if the colour is linear light, which is exposed and tone mapped. Otherwise it is sRGB, 0 to 1, which is
  /// displayed unchanged.
  bool is_linear = false;
  vec3 color{0.0F};

  bool operator==(const BackgroundChoice&) const = default;
};

/// The user's choices of light and display. Open choices depend on the scene (promin/lighting.h).
struct LookOptions {
  LightChoice light = LightChoice::kAuto;
  /// The illuminance from emissive surfaces in lux, if no other light counts. No option; settle_light() sets it.
  double surface_lux = 0.0;
  /// Whether a ground under the scene shows its shadow; if empty, it does with LightChoice::kSoft.
  std::optional<bool> has_ground = std::nullopt;
  std::optional<BackgroundChoice> background = std::nullopt;
  /// Exposure in stops; empty if it is chosen automatically.
  std::optional<float> exposure_ev = std::nullopt;
  /// True if the exposure is computed from the picture (average_exposure_ev); `exposure_ev` is then empty.
  bool averages_exposure = false;
  std::optional<ToneMapping> tone_mapping = std::nullopt;
  bool dithers = false;
  /// The value of RendererOptions::texture_bytes, in MiB.
  uint32_t texture_memory_mib = kDefaultTextureBytes >> 20;

  bool wants_ground() const { return has_ground.value_or(light == LightChoice::kSoft); }
};

/// The user's choices of a camera's position, directions and lens. Positions are in the world. Directions need not be
/// unit vectors.
struct PoseOptions {
  /// The side from which the scene is framed, even if the scene has cameras.
  std::optional<Framing> from = std::nullopt;
  /// The fraction of the picture that a framed scene covers.
  std::optional<float> fit = std::nullopt;
  std::optional<dvec3> eye = std::nullopt;
  /// At most one of the next two members may be set.
  std::optional<dvec3> look_at = std::nullopt;
  std::optional<dvec3> direction = std::nullopt;
  std::optional<dvec3> up = std::nullopt;
  Orbit orbit = {};
  /// Factor by which the picture is magnified around its middle.
  double zoom = 1.0;
  /// The vertical field of view in degrees, in (0, 180).
  std::optional<double> fov_deg = std::nullopt;
  std::optional<double> near = std::nullopt;

  bool looks() const { return look_at || direction; }
  bool any() const { return from || fit || eye || looks() || up || orbit != Orbit() || zoom != 1.0 || fov_deg || near; }
};

/// The user's choices of the view, from which make_view (view_setup.h) makes a View.
struct ViewOptions {
  /// Size in pixels; a side of 0 is computed from the camera's aspect ratio.
  std::optional<uvec2> size;
  std::optional<PixelWindow> crop;
  /// Samples per pixel; if empty, the default of View.
  std::optional<uint32_t> samples_per_pixel = std::nullopt;
  PixelFilter filter = PixelFilter::kBox;
  /// @cond
#define PROMIN_VIEW_NUMBER(NAME, TYPE, MIN, MAX, USUAL, PLACEHOLDER, HELP) std::optional<TYPE> NAME = std::nullopt;
#include "work/spec/view_numbers.def"
  /// @endcond
  DebugView debug_view = DebugView::kNone;
  DepthKind depth_kind = DepthKind::kRay;
  bool has_no_shadows = false;
  std::optional<Integrator> integrator = std::nullopt;
  LookOptions look;
  /// Indices of the scene's lights to switch off.
  std::vector<uint32_t> lights_off;
  /// The name or number of a camera of the scene.
  std::optional<std::string> camera;
  /// True if a camera frames the scene. The scene's cameras are then ignored, unless one is named.
  bool frames_scene = false;
  /// True if a camera that frames the scene must show it from all sides at the same distance, for a turntable.
  bool shows_all_sides = false;
  /// A camera that replaces those of the scene.
  std::optional<Camera> given_camera;
  PoseOptions pose;
  /// The lens of all cameras (Camera::aperture_radius and focus_distance), if it is given.
  std::optional<double> aperture_radius = std::nullopt;
  std::optional<double> focus_distance = std::nullopt;
  EnvironmentOptions environment;
};

/// A range of frame numbers, counted from 0; both ends are included.
struct FrameRange {
  uint32_t first = 0;
  uint32_t last = 0;
};

/// The default number of samples per pixel with Integrator::kWhitted. Eight samples remove the stairs at edges and the
/// noise of small mirrors. They cost about one additional second on two cores at 640x480.
inline constexpr uint32_t kDefaultSamples = 8;

/// The quality of a picture, for people who do not want to choose a number of samples.
enum class Quality : uint32_t { kDraft, kNormal, kHigh, kBest };

/// Returns the names to display, indexed by Quality.
std::span<const std::string_view> quality_names();
/// The number of samples of Quality::kHigh.
inline constexpr uint32_t kHighSamples = 32;
/// Pictures of the other integrators have noise and take this many times the samples of each quality. With 8 samples,
/// the files that light themselves show noise everywhere, with 32 hardly any.
inline constexpr uint32_t kNoiseFactor = 4;

/// Returns the number of samples per pixel that a quality stands for in pictures of a mode. For Quality::kBest, it is
/// that of pictures without an error target.
uint32_t samples_of(Quality quality, const RenderMode& mode);

/// The space in which errors are measured: in linear light, or as displayed.
enum class ErrorSpace : uint32_t { kLinear, kDisplay };

/// Returns the names to display, indexed by ErrorSpace.
std::span<const std::string_view> error_space_names();

/// Returns the smallest target error as a text with a fraction.
std::string least_error();

/// The user's choices of accuracy. Choices that the user leaves open are computed from the others.
struct ErrorOptions {
  std::optional<float> target;
  /// Time limit in seconds.
  std::optional<double> time_limit_s;
  std::optional<uint32_t> min_samples;
  std::optional<uint32_t> max_samples;
  /// The space in which errors are measured.
  std::optional<ErrorSpace> space;

  bool is_given() const { return target || time_limit_s; }
  /// Returns the error target; empty for a fixed number of samples.
  std::optional<ErrorTarget> error_target() const;
  /// Returns the error target; if no error is given, it has this error. The display transform is not set yet
  /// (fit_to_display).
  ErrorTarget target_or(float error) const;
};

/// Sets the members of a target that depend on the display: the radiance of white and, if errors are measured as
/// displayed, the transform.
void fit_to_display(ErrorTarget& target, const DisplayTransform& display);

/// Returns the options that have exactly this target as their result.
std::string describe_options(const ErrorTarget& target);
/// Returns a text about the errors that were reached, in the measure of the target: "error 0.015625", "error 0.015625
/// to 0.125", or one of these with " as shown".
std::string describe_errors(float least, float most, const ErrorTarget& target);

/// Returns a text about pixels that have missed a target, such as " but for 750 pixels of at most 0.0161"; empty if
/// there are none.
std::string describe_unmet(const PictureError& error);

/// A specification of pictures of a scene. spec_json.h reads and writes it as JSON.
struct RenderSpec {
  TracingOptions tracing;
  /// The files of the pictures. If the user names none, name_pictures() determines them.
  std::vector<std::filesystem::path> pictures;
  /// True if frames whose pictures exist are skipped.
  bool skips_existing = false;
  ViewOptions view;
  std::optional<Quality> quality;
  ErrorOptions error;
  JobOptions job;
  /// Channels of an EXR in addition to R, G and B.
  AovSet aovs;
  /// True if AovSet::unlit is only needed to display the pictures. This is known after the scene is read.
  bool hides_unlit = false;
  ExrOptions exr;
  /// True if the user has chosen the compression of EXRs, even if it is the default.
  bool names_compression = false;
  /// The number of frames of a turntable, whose camera moves once around the scene.
  std::optional<uint32_t> turntable;
  /// A camera path, and the frames to render; if `frames` is empty, all frames. Without a path and a turntable they are
  /// frames of the scene's animation.
  std::optional<std::filesystem::path> path;
  std::optional<FrameRange> frames;
  /// The number of pictures per second, in the form that PathPictures takes.
  std::optional<double> fps;
  /// The fraction of the time between two frames for which the shutter is open; empty for no motion blur.
  std::optional<double> shutter;
  /// A pixel to explain. No picture is written then.
  std::optional<uvec2> explained_pixel;
  bool has_all_features = false;

  /// Returns whether the camera moves from frame to frame along a path or around the scene.
  bool moves_camera() const { return path || turntable; }
  /// Returns whether the pictures are frames of the scene's animation, and the camera does not move.
  bool makes_film() const { return !moves_camera() && (frames || fps); }
  /// Returns whether one of the files is a film (film_file.h).
  bool names_film() const;
  /// Returns whether the frames have different poses of the scene. A path or a turntable shows an animation that the
  /// user names.
  bool moves_scene() const {
    return makes_film() || (moves_camera() && !tracing.motion.animations.empty() && !tracing.motion.time_s);
  }
};

/// Chooses the frames of the whole animation if a film is named without frames.
void complete_film(RenderSpec& options);

/// Sets the number of samples or the error target of the quality. The view's integrator must be chosen.
void apply_quality(RenderSpec& options);

/// Returns the pictures that a command writes: the named ones. If none is named and no pixel is explained, they have
/// the scene's name with .exr and .png in the current folder, with #### for frames of a path or film.
std::vector<std::filesystem::path> name_pictures(const RenderSpec& options);

}  // namespace promin::work
