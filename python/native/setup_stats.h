// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "promin/setup_stats.h"

namespace promin::python {

/// Returns the statistics with their members' names as keys. The tree's statistics are in the same dict; warnings are
/// sentences.
inline nanobind::dict describe(const SetupStats& stats) {
  nanobind::dict result;
  result["bvh_ms"] = stats.bvh_ms;
  result["upload_ms"] = stats.upload_ms;
  result["pipeline_ms"] = stats.pipeline_ms;
  result["device_bytes"] = stats.device_bytes;
  result["features"] = stats.features;
  result["degenerate_triangles"] = stats.degenerate_triangles;
  result["builder"] = stats.bvh.builder;
  result["nodes"] = stats.bvh.nodes;
  result["sah_cost"] = stats.bvh.sah_cost;
  nanobind::list warnings;
  for (const Problem& warning : stats.warnings) warnings.append(warning.sentence());
  result["warnings"] = warnings;
  return result;
}

}  // namespace promin::python
