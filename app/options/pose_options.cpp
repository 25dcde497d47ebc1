// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/pose_options.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "options/arguments.h"
#include "promin/validate.h"
#include "work/spec/value_words.h"

namespace promin::app {
namespace {

dvec3 read_up(const OptionValues& words) {
  const std::optional<dvec3> axis = work::find_axis(words.text());
  return axis ? *axis : words.vector(kMaxCoordinate);
}

/// Adds rows for former options, whose messages name the replacement.
void add_former_options(OptionTable& table) {
  table.add_hidden("--look", [](const OptionValues& w) {
    w.refuse("there is no option --look; use --look-at X Y Z for a point, or --direction X Y Z for a direction");
  });
  table.add_hidden("--framing", [](const OptionValues& w) {
    const bool is_known = std::ranges::find(framing_names(), w.text()) != framing_names().end();
    w.refuse("there is no option --framing", is_known ? "--from " + w.text() : "--from");
  });
}

}  // namespace

void add_pose_options(OptionTable& table, PoseOptions& pose) {
  table.add("--from", fmt::format("{}", fmt::join(framing_names(), "|")),
            "Show the whole scene from this side and ignore its cameras [the scene's first camera; if it has none, "
            "three-quarter, or inside if the scene is a room]. three-quarter shows a flat scene from the front",
            [&](const OptionValues& w) { pose.from = w.name<Framing>(framing_names()); });
  table.add(
      "--fit", "X",
      fmt::format(
          "Frame the scene, as --from does, so that its longer side covers this fraction of the picture, {} to 1 [{}]",
          kMinFit, kDefaultFit),
      [&](const OptionValues& w) { pose.fit = static_cast<float>(w.real(0, double{kMinFit}, 1.0)); });
  const auto add_turn = [&](const char* name, const char* help, double& turn) {
    table.add(name, "DEG", help, [&turn](const OptionValues& w) { turn = w.real(0, -kMaxTurnDeg, kMaxTurnDeg); });
  };
  add_turn("--azimuth",
           "Move the camera around the scene to the right by this angle in degrees. It starts from the file's camera, "
           "if there is one, or from the side of --from [0]",
           pose.orbit.azimuth_deg);
  add_turn("--elevation", "Move the camera upwards around the scene by this angle in degrees, after --azimuth [0]",
           pose.orbit.elevation_deg);
  add_turn("--roll", "Turn the picture clockwise by this angle in degrees, after --elevation [0]", pose.orbit.roll_deg);
  table.add("--zoom", "X", "Magnify the picture around its middle by this factor [1]",
            [&](const OptionValues& w) { pose.zoom = w.real(0, kMinZoom, kMaxZoom); });
  table.add("--eye", "X Y Z", "Position of the eye; replaces that of the camera",
            [&](const OptionValues& w) { pose.eye = w.vector(kMaxCoordinate); });
  table.add(
      "--look-at", "X Y Z",
      "Point to look at [the camera's direction; with --eye in a scene without a camera, the middle of the scene]",
      [&](const OptionValues& w) { pose.look_at = w.vector(kMaxCoordinate); });
  table.add("--direction", "X Y Z", "Direction of view; replaces that of the camera",
            [&](const OptionValues& w) { pose.direction = w.vector(kMaxCoordinate); });
  table.add("--up", fmt::format("X Y Z|{}", fmt::join(work::axis_names(), "|")),
            "Direction that points up. With --from it is the upward direction of the scene [y]. Otherwise it is the "
            "upward direction of the picture [the camera's]",
            [&](const OptionValues& w) { pose.up = read_up(w); });
  table.add("--fov", "DEG", "Vertical field of view in degrees; replaces that of the camera",
            [&](const OptionValues& w) { pose.fov_deg = w.real(0, kMinFovDeg, kMaxFovDeg); });
  table.add("--near", "T",
            "Distance of the near plane from the eye in scene units; replaces that of the camera. Geometry in front of "
            "it is not drawn",
            [&](const OptionValues& w) { pose.near = w.real(0, 0.0, kMaxCoordinate); });
  add_former_options(table);
}

}  // namespace promin::app
