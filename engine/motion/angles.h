// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin {

// Functions of angles that use only +, -, * and /, which IEEE 754 rounds alike everywhere. The functions of the C
// library depend on the processor, and poses must not.

/// Returns the sine of an angle in [0, pi/2], with an error of at most 4e-16.
double sine(double angle);

/// Returns the sine of any finite angle, with an error of at most 1e-15 for angles of a few turns.
double sine_of_any(double angle);

/// Returns the angle in [0, pi/4] with this sine. The error is at most 4e-16.
double angle_of_sine(double sine);

}  // namespace promin
