// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "view/motion.h"

namespace promin::app {

/// An action that a key triggers once when it is pressed.
enum class Press {
  kHelp,
  kOverlay,
  kFullscreen,
  kReset,
  kPause,
  kOrbit,
  kBookmark,
  kPrintCommand,
  kScreenshot,
  kQuit,
  kFrame,
  kFront,
  kRight,
  kTop,
  kPreviousCamera,
  kNextCamera,
  kPlay,
  kStepBack,
  kStepAhead,
  kSlower,
  kFaster,
  kNextAnimation,
  /// Light and the debug views, in the order of DebugView's values.
  kFirstDebugView
};

/// A key, by GLFW's number, and its effect. It is also a row of the help.
struct KeyBinding {
  int key = 0;
  const char* name = "";
  const char* effect = "";
  std::optional<Hold> hold = std::nullopt;
  std::optional<Press> press = std::nullopt;
};

std::span<const KeyBinding> key_bindings();

/// An action of the pointer, and its effect.
struct PointerBinding {
  const char* name = "";
  const char* effect = "";
};
std::span<const PointerBinding> pointer_bindings();

}  // namespace promin::app
