// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

// The module binds Scene itself. promin/_scene.py fills a scene only while no other object uses it.
#include "promin/scene.h"
