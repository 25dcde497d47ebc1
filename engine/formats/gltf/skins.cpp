// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/skins.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/rounding.h"
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

GltfSkins::GltfSkins(const GltfDocument& document, const std::vector<PlacedNode>& placed, LoadReport& report)
    : document_(document), report_(report) {
  const size_t count = elements_of(document.json, "skins").size();
  if (count > 0) world_from_node_ = place_all_gltf_nodes(document, placed, report.center());
  for (size_t skin = 0; skin < count; ++skin) {
    if (has_joints(static_cast<int>(skin))) continue;
    report.repair({"gltf.skin.empty", "a skin has no joints", "", "skins[" + std::to_string(skin) + "]",
                   "export the file again", "its meshes are placed by their nodes"});
  }
}

bool GltfSkins::has_joints(int skin) const {
  return !elements_of(document_.json["skins"][static_cast<size_t>(skin)], "joints").empty();
}

const GltfPose& GltfSkins::find(int skin) {
  const auto [known, is_new] = poses_.try_emplace(skin);
  if (is_new) known->second = make_pose(skin);
  return known->second;
}

GltfPose GltfSkins::make_pose(int skin) const {
  const json& source = document_.json["skins"][static_cast<size_t>(skin)];
  const std::string place = "skins[" + std::to_string(skin) + "]";
  GltfPose pose;
  pose.joint_matrices = read_inverse_bind_matrices(document_, source, place + ".inverseBindMatrices", report_);
  for (size_t joint = 0; joint < pose.joint_matrices.size(); ++joint) {
    dmat4& matrix = pose.joint_matrices[joint];
    matrix = world_from_node_[source["joints"][joint].get<size_t>()] * matrix;
    if (!is_finite(matrix)) {
      report_.refuse("gltf.node.far", "a joint's place in the world overflows",
                     place + ".joints[" + std::to_string(joint) + "]",
                     "use smaller translations and scales in it and its parents");
      return {};
    }
  }
  const auto mirrors = [](const dmat4& matrix) { return glm::determinant(dmat3(matrix)) < 0.0; };
  pose.is_hidden = std::ranges::all_of(pose.joint_matrices, has_no_area);
  if (!pose.is_hidden && std::ranges::all_of(pose.joint_matrices, mirrors)) {
    pose.world_from_mesh[0][0] = -1.0;
    for (dmat4& matrix : pose.joint_matrices) matrix = pose.world_from_mesh * matrix;
  }
  return pose;
}

}  // namespace promin
