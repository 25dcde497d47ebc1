// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/load_report.h"
#include "promin/math.h"

namespace promin {

/// A texture map as its line describes it.
struct MtlMap {
  /// Relative to the scene; may not exist.
  std::string file = {};
  /// u' = scale u + offset, and the same for v, which increases upwards.
  dvec2 scale{1.0};
  dvec2 offset{0.0};
  bool is_clamped = false;
  /// The option -bm, times the gain of -mm.
  double strength = 1.0;
  /// The option -imfchan: the channel of RGBA, from 0, or 4 for the luminance.
  int channel = 4;
  /// Whether its picture could be read.
  bool is_usable = true;
};

/// A material as its lines describe it.
struct MtlMaterial {
  std::string name;
  /// The values by keyword; of repeated ones the last. Missing numbers are 0, but a single number gives all three of a
  /// colour.
  std::map<std::string, dvec3> numbers = {};
  /// The supported maps by keyword; of repeated ones the last.
  std::map<std::string, MtlMap> maps = {};

  dvec3 find(const std::string& keyword, double otherwise) const;
  /// Returns a usable map, or nullptr.
  const MtlMap* find_map(const std::string& keyword) const;
};

/// Parses the statements Ka, Kd, Ks, Ke, Ns, illum, Pr, Pm, d, Tr, Tf and Ni, and map_Ka, map_Kd, map_d, map_Ks,
/// map_Ke, map_Pr, map_Pm, norm and bump (also map_Bump and map_bump, which count as bump) with their options; other
/// maps cause warnings. The report repairs numbers: a statement with another word is ignored, and a negative factor of
/// light counts as 0. `name` is the file's name in messages, `folder` its folder relative to the scene, empty or with a
/// slash at its end.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& name, const std::string& folder,
                                   LoadReport& report);

}  // namespace promin
