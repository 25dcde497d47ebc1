# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Vectors are tuples; quaternions are (x, y, z, w) as in glTF."""

import math


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    # The loop replaces sum(), because Python 3.12 changed its rounding and the scenes must not depend on the version.
    total = 0.0
    for x, y in zip(a, b):
        total += x * y
    return total


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    return scale(a, 1.0 / length(a))


def quaternion_about(axis, angle_deg):
    """Returns the rotation about an axis (any length), anticlockwise seen from its tip."""
    half = math.radians(angle_deg) / 2.0
    return scale(normalize(axis), math.sin(half)) + (math.cos(half),)


def multiply(p, q):
    """Returns the quaternion that rotates by q first, then by p."""
    pv, qv = p[:3], q[:3]
    vector = add(add(scale(qv, p[3]), scale(pv, q[3])), cross(pv, qv))
    return vector + (p[3] * q[3] - dot(pv, qv),)


def quaternion_from_basis(right, up, back):
    """Returns the rotation that takes +X, +Y, +Z to these orthonormal vectors."""
    m = list(zip(right, up, back))
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0.0:
        s = 2.0 * math.sqrt(trace + 1.0)
        return ((m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s, s / 4.0)
    i = max(range(3), key=lambda axis: m[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2.0 * math.sqrt(max(0.0, 1.0 + m[i][i] - m[j][j] - m[k][k]))
    q = [0.0, 0.0, 0.0, (m[k][j] - m[j][k]) / s]
    q[i], q[j], q[k] = s / 4.0, (m[j][i] + m[i][j]) / s, (m[k][i] + m[i][k]) / s
    return tuple(q)


def look_rotation(direction, up=(0.0, 1.0, 0.0)):
    """Returns the rotation of a camera or light that looks along `direction` (in glTF they look along -Z)."""
    back = normalize(scale(direction, -1.0))
    if abs(dot(back, normalize(up))) > 0.999999:
        up = (0.0, 0.0, -1.0)
    right = normalize(cross(up, back))
    return quaternion_from_basis(right, cross(back, right), back)


def axis_rotation(axis):
    """Returns the shortest rotation that takes +Y to `axis`."""
    x, y, z = normalize(axis)
    if y < -0.999999:
        return (1.0, 0.0, 0.0, 0.0)
    return normalize((z, 0.0, -x, 1.0 + y))
