// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/pose_options.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "options/arguments.h"
#include "promin/validate.h"

namespace promin::app {
namespace {

constexpr std::array<std::string_view, 6> kAxes = {"x", "y", "z", "-x", "-y", "-z"};

dvec3 read_up(const OptionValues& words) {
  const auto found = std::ranges::find(kAxes, words.text());
  if (found == kAxes.end()) return words.vector(kMaxCoordinate);
  const auto place = static_cast<int>(found - kAxes.begin());
  dvec3 axis(0.0);
  axis[place % 3] = place < 3 ? 1.0 : -1.0;
  return axis;
}

/// Adds rows for former options, whose messages name the replacement.
void add_former_options(OptionTable& table) {
  table.add_hidden("--look", [](const OptionValues& w) {
    w.refuse("there is no option --look: --look-at X Y Z takes a point to look at, --direction X Y Z a direction");
  });
  table.add_hidden("--framing", [](const OptionValues& w) {
    const bool is_known = std::ranges::find(framing_names(), w.text()) != framing_names().end();
    w.refuse("there is no option --framing", is_known ? "--from " + w.text() : "--from");
  });
}

}  // namespace

void add_pose_options(OptionTable& table, PoseOptions& pose) {
  table.add("--from", fmt::format("{}", fmt::join(framing_names(), "|")),
            "View the whole scene from this side, even if it has cameras [the scene's camera; without one "
            "three-quarter, or inside for a scene that surrounds the viewer]",
            [&](const OptionValues& w) {
              const auto place = std::ranges::find(framing_names(), w.choice(framing_names()));
              pose.from = static_cast<Framing>(place - framing_names().begin());
            });
  table.add(
      "--fit", "X",
      fmt::format("Part of the picture that the scene covers in a view of --from, {} to 1 [{}]", kMinFit, kDefaultFit),
      [&](const OptionValues& w) { pose.fit = static_cast<float>(w.real(0, double{kMinFit}, 1.0)); });
  const auto add_turn = [&](const char* name, const char* help, double& turn) {
    table.add(name, "DEG", help, [&turn](const OptionValues& w) { turn = w.real(0, -kMaxTurnDeg, kMaxTurnDeg); });
  };
  add_turn("--azimuth", "Orbit the camera around the scene to the right, in degrees [0]", pose.orbit.azimuth_deg);
  add_turn("--elevation", "Then orbit the camera upwards, in degrees [0]", pose.orbit.elevation_deg);
  add_turn("--roll", "Then turn the picture clockwise, in degrees [0]", pose.orbit.roll_deg);
  table.add("--zoom", "X", "Magnify the picture around its middle [1]",
            [&](const OptionValues& w) { pose.zoom = w.real(0, kMinZoom, kMaxZoom); });
  table.add("--eye", "X Y Z", "Position of the eye, in place of the camera's",
            [&](const OptionValues& w) { pose.eye = w.vector(kMaxCoordinate); });
  table.add("--look-at", "X Y Z", "Point to look at [with --eye, in a scene without a camera: the middle of the scene]",
            [&](const OptionValues& w) { pose.look_at = w.vector(kMaxCoordinate); });
  table.add("--direction", "X Y Z", "Direction of view, in place of the camera's",
            [&](const OptionValues& w) { pose.direction = w.vector(kMaxCoordinate); });
  table.add("--up", fmt::format("X Y Z|{}", fmt::join(kAxes, "|")),
            "Direction that points up: in the scene for a view of --from, else in the picture [y; the camera's]",
            [&](const OptionValues& w) { pose.up = read_up(w); });
  table.add("--fov", "DEG", "Vertical field of view in degrees, in place of the camera's",
            [&](const OptionValues& w) { pose.fov_deg = w.real(0, kMinFovDeg, kMaxFovDeg); });
  table.add("--near", "T",
            "Distance from the eye in scene units up to which nothing is drawn, in place of the camera's",
            [&](const OptionValues& w) { pose.near = w.real(0, 0.0, kMaxCoordinate); });
  add_former_options(table);
}

}  // namespace promin::app
