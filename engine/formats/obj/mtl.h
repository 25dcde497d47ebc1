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

/// A texture map as its line has it.
struct MtlMap {
  /// As written, with slashes as dividers; may not exist.
  std::string file = {};
  /// That of the MTL, relative to the scene: empty or with a slash at its end.
  std::string folder = {};
  /// u' = scale u + offset, and v likewise, which grows upwards.
  dvec2 scale{1.0};
  dvec2 offset{0.0};
  bool is_clamped = false;
  /// The option -bm.
  double strength = 1.0;
  /// Whether its picture could be read.
  bool is_usable = true;
};

/// A material as its lines have it.
struct MtlMaterial {
  std::string name;
  /// The values by keyword, the last of equal ones. Missing numbers are 0, but a single number is all three of a
  /// colour.
  std::map<std::string, dvec3> numbers = {};
  /// The maps that are read, by keyword, the last of equal ones.
  std::map<std::string, MtlMap> maps = {};

  dvec3 find(const std::string& keyword, double otherwise) const;
  /// nullptr where there is none that is usable.
  const MtlMap* find_map(const std::string& keyword) const;
};

/// Parses the statements Ka, Kd, Ks, Ke, Ns, illum, Pr and Pm, which the report repairs, d, Tr, Tf and Ni, of which
/// what is no number counts as not there, and map_Ka, map_Kd, map_d, map_Ks, map_Ke, map_Pr, map_Pm and norm with their
/// options; other maps are warned about. `name` is that of the file for messages, `folder` its own, relative to the
/// scene: empty or with a slash at its end.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& name, const std::string& folder,
                                   LoadReport& report);

}  // namespace promin
