// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/keys.h"

#include <GLFW/glfw3.h>

#include <array>

namespace promin::app {
namespace {

#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) ", " HELP
constexpr const char* kDebugViewHelp = "light"
#include "promin/kinds/debug_views.def"
    ;

#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) +1
static_assert(GLFW_KEY_F1
#include "promin/kinds/debug_views.def"
                  < GLFW_KEY_F11,
              "a debug view would have the key of the full screen or the screenshot: give the later ones other keys");

constexpr Press debug_view(int number) {
  return static_cast<Press>(static_cast<int>(Press::kFirstDebugView) + number);
}

// The keys. A row without a text is described by the row above it.
constexpr std::array kKeys = {
    KeyBinding{GLFW_KEY_W, "W, S", "fly forward and backward; in an orbit, move nearer and away", Hold::kAhead},
    KeyBinding{GLFW_KEY_S, "", "", Hold::kBack},
    KeyBinding{GLFW_KEY_A, "A, D", "fly left and right", Hold::kLeft},
    KeyBinding{GLFW_KEY_D, "", "", Hold::kRight},
    KeyBinding{GLFW_KEY_E, "E, Q", "fly up and down", Hold::kUp},
    KeyBinding{GLFW_KEY_Q, "", "", Hold::kDown},
    KeyBinding{GLFW_KEY_Z, "Z, X", "roll anticlockwise and clockwise", Hold::kRollLeft},
    KeyBinding{GLFW_KEY_X, "", "", Hold::kRollRight},
    KeyBinding{GLFW_KEY_LEFT_SHIFT, "Shift, Ctrl", "fly four times as fast, or a quarter as fast", Hold::kFast},
    KeyBinding{GLFW_KEY_RIGHT_SHIFT, "", "", Hold::kFast},
    KeyBinding{GLFW_KEY_LEFT_CONTROL, "", "", Hold::kSlow},
    KeyBinding{GLFW_KEY_RIGHT_CONTROL, "", "", Hold::kSlow},
    KeyBinding{GLFW_KEY_O, "O", "orbit the point in the middle, or return to flying", {}, Press::kOrbit},
    KeyBinding{GLFW_KEY_R, "R", "reset the camera", {}, Press::kReset},
    KeyBinding{GLFW_KEY_F, "F", "show the whole model", {}, Press::kFrame},
    KeyBinding{GLFW_KEY_1, "1, 3, 7", "view from the front, the right or the top", {}, Press::kFront},
    KeyBinding{GLFW_KEY_3, "", "", {}, Press::kRight},
    KeyBinding{GLFW_KEY_7, "", "", {}, Press::kTop},
    KeyBinding{GLFW_KEY_KP_1, "", "", {}, Press::kFront},
    KeyBinding{GLFW_KEY_KP_3, "", "", {}, Press::kRight},
    KeyBinding{GLFW_KEY_KP_7, "", "", {}, Press::kTop},
    KeyBinding{GLFW_KEY_PERIOD, ". and ,", "select the next or previous camera of the scene", {}, Press::kNextCamera},
    KeyBinding{GLFW_KEY_COMMA, "", "", {}, Press::kPreviousCamera},
    KeyBinding{GLFW_KEY_B, "B", "bookmark the camera", {}, Press::kBookmark},
    KeyBinding{GLFW_KEY_SPACE, "Space", "play or stop the animation", {}, Press::kPlay},
    KeyBinding{GLFW_KEY_LEFT, "Left, Right", "stop, and step back or ahead by 1/24 s", {}, Press::kStepBack},
    KeyBinding{GLFW_KEY_RIGHT, "", "", {}, Press::kStepAhead},
    KeyBinding{GLFW_KEY_DOWN, "Down, Up", "play at half or twice the speed", {}, Press::kSlower},
    KeyBinding{GLFW_KEY_UP, "", "", {}, Press::kFaster},
    KeyBinding{GLFW_KEY_N, "N", "show the next animation", {}, Press::kNextAnimation},
    KeyBinding{GLFW_KEY_F1, "F1, F2, ...", kDebugViewHelp, {}, debug_view(0)},
// F1 shows light, F2 the first debug view, and so on. F12 makes a screenshot.
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) \
  KeyBinding{GLFW_KEY_F1 + static_cast<int>(NUMBER), "", "", {}, debug_view(NUMBER)},
#include "promin/kinds/debug_views.def"
    KeyBinding{GLFW_KEY_P, "P", "pause refinement or replay", {}, Press::kPause},
    KeyBinding{GLFW_KEY_C, "C", "print the command that renders this view", {}, Press::kPrintCommand},
    KeyBinding{GLFW_KEY_F12, "F12", "write promin-NNNN.exr and .png", {}, Press::kScreenshot},
    KeyBinding{GLFW_KEY_F11, "F11", "toggle full screen", {}, Press::kFullscreen},
    KeyBinding{GLFW_KEY_TAB, "Tab", "hide or show the panel", {}, Press::kOverlay},
    KeyBinding{GLFW_KEY_H, "H", "show this help", {}, Press::kHelp},
    KeyBinding{GLFW_KEY_ESCAPE, "Esc", "quit", {}, Press::kQuit},
};

constexpr std::array kPointer = {
    PointerBinding{"left drag", "turn the model"},
    PointerBinding{"right drag", "move the picture; the middle button does the same"},
    PointerBinding{"Shift-drag", "turn the light"},
    PointerBinding{"wheel", "move nearer or further away"},
    PointerBinding{"double click", "look at that point and orbit it"},
    PointerBinding{"left click", "explain the pixel: its rays, light sources and contributions"},
    PointerBinding{"right click", "look around without a button; a second right click ends this"},
};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return kKeys;
}

std::span<const PointerBinding> pointer_bindings() {
  return kPointer;
}

}  // namespace promin::app
