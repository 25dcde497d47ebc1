// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/skins.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/rounding.h"
#include "core/utf8.h"
#include "formats/gltf/accessors.h"
#include "formats/gltf/json_lookup.h"
#include "formats/gltf/json_rule.h"

namespace promin {
namespace {

using nlohmann::json;

/// Sets the last row of a joint's matrix to 0 0 0 1. In a valid file the row differs from this only by rounding.
void make_joint_affine(dmat4& matrix, const std::string& place, LoadReport& report) {
  for (int column = 0; column < 4; ++column) {
    const double wanted = column == 3 ? 1.0 : 0.0;
    double& number = matrix[column][3];
    // The comparison is written so that NaN fails.
    if (!(std::abs(number - wanted) <= kMostRounding)) {
      report.repair({"gltf.matrix.affine", "an inverse bind matrix is not affine", std::to_string(number), place,
                     "make its last row 0 0 0 1", "its last row is read as 0 0 0 1"});
    }
    number = wanted;
  }
}

/// Returns the inverse bind matrices of a skin; identities if it has none.
std::vector<dmat4> read_inverse_bind_matrices(const GltfDocument& document, const json& skin, const std::string& place,
                                              LoadReport& report) {
  const size_t joint_count = elements_of(skin, "joints").size();
  std::vector<dmat4> matrices(joint_count, dmat4(1.0));
  const auto accessor = skin.find("inverseBindMatrices");
  if (accessor == skin.end()) return matrices;
  const std::vector<float> numbers = read_floats(document, *accessor, report);
  if (numbers.size() < 16 * joint_count) {
    report.refuse("gltf.skin.count",
                  "a skin has " + std::to_string(numbers.size() / 16) + " inverse bind matrices for " +
                      std::to_string(joint_count) + " joints",
                  place, "give one matrix for each joint");
    return matrices;
  }
  for (size_t joint = 0; joint < joint_count; ++joint) {
    for (int i = 0; i < 16; ++i) {
      matrices[joint][i / 4][i % 4] = static_cast<double>(numbers[16 * joint + static_cast<size_t>(i)]);
    }
    make_joint_affine(matrices[joint], place + ", element " + std::to_string(joint), report);
  }
  return matrices;
}

}  // namespace

GltfSkins::GltfSkins(const GltfDocument& document, LoadReport& report) : document_(document), report_(report) {
  for (const json& source : elements_of(document.json, "skins")) {
    Skin& skin = skins_.emplace_back();
    skin.name = to_utf8(source.value("name", ""));
    skin.joints = elements_of(source, "joints").get<std::vector<uint32_t>>();
    if (!skin.joints.empty()) continue;
    report.repair({"gltf.skin.empty", "a skin has no joints", "", "skins[" + std::to_string(skins_.size() - 1) + "]",
                   "export the file again", "its meshes are placed by their nodes"});
  }
}

const PosedSkin& GltfSkins::find(int index, std::span<const dmat4> world_from_node) {
  const auto [known, is_new] = poses_.try_emplace(index);
  if (!is_new) return known->second;
  const std::string place = "skins[" + std::to_string(index) + "]";
  Skin& skin = skins_[static_cast<size_t>(index)];
  skin.inverse_bind = read_inverse_bind_matrices(document_, document_.json["skins"][static_cast<size_t>(index)],
                                                 place + ".inverseBindMatrices", report_);
  known->second = pose_skin(skin, world_from_node);
  const std::vector<dmat4>& matrices = known->second.joint_matrices;
  const auto wrong = std::ranges::find_if_not(matrices, [](const dmat4& matrix) { return is_finite(matrix); });
  if (wrong != matrices.end()) {
    report_.refuse("gltf.node.far", "a joint's place in the world overflows",
                   place + ".joints[" + std::to_string(wrong - matrices.begin()) + "]",
                   "use smaller translations and scales in it and its parents");
    known->second = {};
  }
  return known->second;
}

}  // namespace promin
