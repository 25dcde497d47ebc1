// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

// Scene is bound as it is: what fills it is used while nothing else has it (promin/_scene.py).
#include "promin/scene.h"
