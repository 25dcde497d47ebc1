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

/// A texture map of a material, with the options of its line.
struct MtlMap {
  /// The picture's file, relative to the scene. It may not exist.
  std::string file = {};
  /// Factor and offset of texture coordinates: u' = scale u + offset, and the same for v, which increases upwards.
  dvec2 scale{1.0};
  dvec2 offset{0.0};
  bool is_clamped = false;
  /// The option -bm, multiplied by the gain of -mm.
  double strength = 1.0;
  /// The option -imfchan: the channel of RGBA, counted from 0, or 4 for the luminance.
  int channel = 4;
  /// True if its picture could be read.
  bool is_usable = true;
};

/// A material with the values of its lines.
struct MtlMaterial {
  std::string name;
  /// The numbers of each keyword; the last statement with a keyword counts. Missing numbers are 0, but a single number
  /// gives all three components of a colour.
  std::map<std::string, dvec3> numbers = {};
  /// The supported maps by keyword; the last statement with a keyword counts.
  std::map<std::string, MtlMap> maps = {};

  dvec3 find(const std::string& keyword, double otherwise) const;
  /// Returns a usable map, or nullptr.
  const MtlMap* find_map(const std::string& keyword) const;
};

/// Parses the statements Ka, Kd, Ks, Ke, Ns, illum, Pr, Pm, d, Tr, Tf and Ni, and map_Ka, map_Kd, map_d, map_Ks,
/// map_Ke, map_Pr, map_Pm, norm and bump (also map_Bump and map_bump, which count as bump) with their options; other
/// maps cause warnings. Wrong numbers are repaired with a report: a statement with a word that is no number is ignored,
/// and a negative factor of light becomes 0. `name` is the file's name in messages. `folder` is its folder relative to
/// the scene, empty or with a slash at its end.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& name, const std::string& folder,
                                   LoadReport& report);

}  // namespace promin
