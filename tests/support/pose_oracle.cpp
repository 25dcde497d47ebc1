// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "support/pose_oracle.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace promin::test {
namespace {

using nlohmann::json;
using Real = long double;
using Numbers = std::vector<Real>;
using Matrix = std::array<std::array<Real, 4>, 4>;  // Rows of columns: matrix[row][column].

Matrix identity() {
  Matrix m{};
  for (size_t i = 0; i < 4; ++i) m[i][i] = 1;
  return m;
}

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix m{};
  for (size_t row = 0; row < 4; ++row) {
    for (size_t column = 0; column < 4; ++column) {
      for (size_t k = 0; k < 4; ++k) m[row][column] += a[row][k] * b[k][column];
    }
  }
  return m;
}

OraclePoint transform(const Matrix& m, const OraclePoint& p) {
  OraclePoint result{};
  for (size_t row = 0; row < 3; ++row) result[row] = m[row][0] * p[0] + m[row][1] * p[1] + m[row][2] * p[2] + m[row][3];
  return result;
}

/// Section 3.6: accessors, sparse accessors, and accessors without a buffer view.
class Reader {
 public:
  explicit Reader(const GltfBuilder& gltf) : gltf_(gltf) {}

  Numbers read(size_t index) const {
    const json& accessor = gltf_.json["accessors"][index];
    const size_t count = accessor["count"];
    const size_t width = width_of(accessor["type"]);
    const int type = accessor["componentType"];
    const bool is_normalized = accessor.value("normalized", false);
    Numbers numbers(count * width, 0);
    if (accessor.contains("bufferView")) {
      const json& view = gltf_.json["bufferViews"][accessor["bufferView"].get<size_t>()];
      const size_t stride = view.value("byteStride", width * size_of(type));
      for (size_t i = 0; i < count; ++i) {
        for (size_t c = 0; c < width; ++c) {
          const size_t at = accessor.value("byteOffset", size_t{0}) + i * stride + c * size_of(type);
          numbers[i * width + c] = number(view, at, type, is_normalized);
        }
      }
    }
    if (!accessor.contains("sparse")) return numbers;
    const json& sparse = accessor["sparse"];
    const json& places = gltf_.json["bufferViews"][sparse["indices"]["bufferView"].get<size_t>()];
    const json& values = gltf_.json["bufferViews"][sparse["values"]["bufferView"].get<size_t>()];
    const int place_type = sparse["indices"]["componentType"];
    for (size_t i = 0; i < sparse["count"]; ++i) {
      const auto place = static_cast<size_t>(number(places, i * size_of(place_type), place_type, false));
      for (size_t c = 0; c < width; ++c) {
        numbers[place * width + c] = number(values, (i * width + c) * size_of(type), type, is_normalized);
      }
    }
    return numbers;
  }

  size_t width(size_t index) const { return width_of(gltf_.json["accessors"][index]["type"]); }

 private:
  static size_t width_of(const std::string& type) {
    static const std::map<std::string, size_t> kWidths = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    return kWidths.at(type);
  }
  static size_t size_of(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

  template <class Stored>
  static Real convert(const char* bytes, bool is_normalized) {
    Stored stored;
    std::memcpy(&stored, bytes, sizeof(Stored));
    if (!is_normalized) return static_cast<Real>(stored);
    return std::max(static_cast<Real>(stored) / static_cast<Real>(std::numeric_limits<Stored>::max()), Real{-1});
  }

  Real number(const json& view, size_t offset, int type, bool is_normalized) const {
    const char* bytes = gltf_.bytes.data() + view.value("byteOffset", size_t{0}) + offset;
    switch (type) {
      case 5120:
        return convert<int8_t>(bytes, is_normalized);
      case 5121:
        return convert<uint8_t>(bytes, is_normalized);
      case 5122:
        return convert<int16_t>(bytes, is_normalized);
      case 5123:
        return convert<uint16_t>(bytes, is_normalized);
      case 5125:
        return convert<uint32_t>(bytes, is_normalized);
      default:
        return convert<float>(bytes, false);
    }
  }

  const GltfBuilder& gltf_;
};

Numbers unit(Numbers q) {
  Real square = 0;
  for (const Real part : q) square += part * part;
  for (Real& part : q) part /= std::sqrt(square);
  return q;
}

/// Appendix C.
Numbers interpolate(const Numbers& times, const Numbers& values, const std::string& how, size_t width, bool is_rotation,
                    Real time) {
  const size_t parts = how == "CUBICSPLINE" ? 3 : 1;
  const auto value = [&](size_t key, size_t part) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>((key * parts + part) * width);
    return Numbers(first, first + static_cast<std::ptrdiff_t>(width));
  };
  const auto finish = [&](Numbers result) { return is_rotation ? unit(std::move(result)) : result; };
  const size_t middle = parts / 2;
  if (time <= times.front()) return finish(value(0, middle));
  if (time >= times.back()) return finish(value(times.size() - 1, middle));
  size_t k = 0;
  while (times[k + 1] <= time) ++k;
  if (how == "STEP") return finish(value(k, 0));
  const Real length = times[k + 1] - times[k];
  const Real t = (time - times[k]) / length;
  Numbers a = value(k, middle);
  Numbers b = value(k + 1, middle);
  Numbers result(width);
  if (how == "CUBICSPLINE") {
    const Numbers out = value(k, 2);
    const Numbers in = value(k + 1, 0);
    for (size_t i = 0; i < width; ++i) {
      result[i] = (2 * t * t * t - 3 * t * t + 1) * a[i] + length * (t * t * t - 2 * t * t + t) * out[i] +
                  (-2 * t * t * t + 3 * t * t) * b[i] + length * (t * t * t - t * t) * in[i];
    }
    return finish(result);
  }
  if (!is_rotation) {
    for (size_t i = 0; i < width; ++i) result[i] = (1 - t) * a[i] + t * b[i];
    return result;
  }
  a = unit(a);
  b = unit(b);
  Real dot = 0;
  for (size_t i = 0; i < 4; ++i) dot += a[i] * b[i];
  const Real angle = std::acos(std::min(std::abs(dot), Real{1}));
  const Real sign = dot < 0 ? -1 : 1;
  for (size_t i = 0; i < 4; ++i) {
    result[i] = angle < Real{1e-10} ? (1 - t) * a[i] + sign * t * b[i]
                                    : std::sin(angle * (1 - t)) / std::sin(angle) * a[i] +
                                          sign * std::sin(angle * t) / std::sin(angle) * b[i];
  }
  return finish(result);
}

class Oracle {
 public:
  Oracle(const GltfBuilder& gltf, const std::vector<size_t>& clips, Real time)
      : document_(gltf.json), reader_(gltf), time_(time) {
    for (const size_t clip : clips) evaluate(document_["animations"][clip]);
  }

  std::vector<std::vector<OraclePoint>> take() {
    find_worlds();
    std::vector<size_t> roots;
    if (document_.contains("scenes")) {
      roots = document_["scenes"][document_.value("scene", size_t{0})]["nodes"].get<std::vector<size_t>>();
    } else {
      for (size_t i = 0; i < nodes().size(); ++i) {
        if (!parents_.contains(i)) roots.push_back(i);
      }
    }
    for (const size_t root : roots) visit(root, true);
    return objects_;
  }

 private:
  const json& nodes() const { return document_["nodes"]; }

  void evaluate(const json& animation) {
    for (const json& channel : animation["channels"]) {
      const json& target = channel["target"];
      std::string pointer;
      if (target["path"] == "pointer") {
        pointer = target["extensions"]["KHR_animation_pointer"]["pointer"];
      } else {
        pointer = "/nodes/" + std::to_string(target["node"].get<size_t>()) + "/" + target["path"].get<std::string>();
      }
      if (values_.contains(pointer)) continue;
      const json& sampler = animation["samplers"][channel["sampler"].get<size_t>()];
      const std::string how = sampler.value("interpolation", "LINEAR");
      const Numbers times = reader_.read(sampler["input"]);
      const Numbers values = reader_.read(sampler["output"]);
      const size_t width = values.size() / times.size() / (how == "CUBICSPLINE" ? 3 : 1);
      values_[pointer] = interpolate(times, values, how, width, pointer.ends_with("/rotation"), time_);
    }
  }

  Numbers property(size_t node, const std::string& name, Numbers usual) const {
    const auto animated = values_.find("/nodes/" + std::to_string(node) + "/" + name);
    if (animated != values_.end()) return animated->second;
    if (!nodes()[node].contains(name)) return usual;
    usual.clear();
    for (const json& number : nodes()[node][name]) usual.push_back(number.get<double>());
    return usual;
  }

  /// Section 3.5.3: the local transform.
  Matrix local(size_t node) const {
    Matrix m = identity();
    if (nodes()[node].contains("matrix")) {
      for (size_t i = 0; i < 16; ++i) m[i % 4][i / 4] = nodes()[node]["matrix"][i].get<double>();
      return m;
    }
    const Numbers t = property(node, "translation", {0, 0, 0});
    const Numbers q = unit(property(node, "rotation", {0, 0, 0, 1}));
    const Numbers s = property(node, "scale", {1, 1, 1});
    const Real x = q[0];
    const Real y = q[1];
    const Real z = q[2];
    const Real w = q[3];
    const Real r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 3; ++column) m[row][column] = r[row][column] * s[column];
      m[row][3] = t[row];
    }
    return m;
  }

  void find_worlds() {
    for (size_t i = 0; i < nodes().size(); ++i) {
      if (!nodes()[i].contains("children")) continue;
      for (const json& child : nodes()[i]["children"]) parents_[child.get<size_t>()] = i;
    }
    for (size_t i = 0; i < nodes().size(); ++i) {
      Matrix world = local(i);
      for (auto above = parents_.find(i); above != parents_.end(); above = parents_.find(above->second)) {
        world = multiply(local(above->second), world);
      }
      worlds_.push_back(world);
    }
  }

  bool is_visible(size_t node) const {
    const std::string name = "extensions/KHR_node_visibility/visible";
    const auto animated = values_.find("/nodes/" + std::to_string(node) + "/" + name);
    if (animated != values_.end()) return animated->second[0] != 0;
    const auto extensions = nodes()[node].find("extensions");
    if (extensions == nodes()[node].end() || !extensions->contains("KHR_node_visibility")) return true;
    return (*extensions)["KHR_node_visibility"].value("visible", true);
  }

  void visit(size_t node, bool is_shown) {
    is_shown = is_shown && is_visible(node);
    if (nodes()[node].contains("mesh")) {
      const json& mesh = document_["meshes"][nodes()[node]["mesh"].get<size_t>()];
      for (const json& primitive : mesh["primitives"]) {
        objects_.push_back(is_shown ? corners(node, mesh, primitive) : std::vector<OraclePoint>{});
      }
    }
    if (!nodes()[node].contains("children")) return;
    for (const json& child : nodes()[node]["children"]) visit(child.get<size_t>(), is_shown);
  }

  Numbers weights(size_t node, const json& mesh) const {
    Numbers usual;
    if (mesh.contains("weights")) {
      for (const json& weight : mesh["weights"]) usual.push_back(weight.get<double>());
    }
    const bool has_own = nodes()[node].contains("weights");
    const std::string shared = "/meshes/" + std::to_string(nodes()[node]["mesh"].get<size_t>()) + "/weights";
    if (!has_own && values_.contains(shared)) usual = values_.at(shared);
    Numbers result = property(node, "weights", usual);
    for (size_t i = 0; i < 8; ++i) {
      const auto one = values_.find("/nodes/" + std::to_string(node) + "/weights/" + std::to_string(i));
      if (one == values_.end()) continue;
      if (result.size() <= i) result.resize(i + 1, 0);
      result[i] = one->second[0];
    }
    return result;
  }

  std::vector<OraclePoint> corners(size_t node, const json& mesh, const json& primitive) {
    Numbers positions = reader_.read(primitive["attributes"]["POSITION"]);
    const Numbers morph = weights(node, mesh);
    for (size_t i = 0; primitive.contains("targets") && i < primitive["targets"].size(); ++i) {
      if (i >= morph.size() || !primitive["targets"][i].contains("POSITION")) continue;
      const Numbers moves = reader_.read(primitive["targets"][i]["POSITION"]);
      for (size_t k = 0; k < positions.size(); ++k) positions[k] += morph[i] * moves[k];
    }
    std::vector<OraclePoint> points;
    for (size_t i = 0; i + 2 < positions.size(); i += 3) {
      points.push_back({positions[i], positions[i + 1], positions[i + 2]});
    }
    if (nodes()[node].contains("skin")) {
      skin(document_["skins"][nodes()[node]["skin"].get<size_t>()], primitive, points);
    } else {
      for (OraclePoint& point : points) point = transform(worlds_[node], point);
    }
    std::vector<OraclePoint> result;
    for (const Real index : reader_.read(primitive["indices"])) result.push_back(points[static_cast<size_t>(index)]);
    return result;
  }

  /// Section 3.7.3.
  void skin(const json& skin, const json& primitive, std::vector<OraclePoint>& points) const {
    std::vector<Matrix> joints;
    const Numbers inverse =
        skin.contains("inverseBindMatrices") ? reader_.read(skin["inverseBindMatrices"]) : Numbers{};
    for (size_t i = 0; i < skin["joints"].size(); ++i) {
      Matrix bind = identity();
      for (size_t k = 0; !inverse.empty() && k < 16; ++k) bind[k % 4][k / 4] = inverse[16 * i + k];
      joints.push_back(multiply(worlds_[skin["joints"][i].get<size_t>()], bind));
    }
    for (size_t vertex = 0; vertex < points.size(); ++vertex) {
      Matrix sum{};
      Real total = 0;
      for (size_t set = 0; primitive["attributes"].contains("JOINTS_" + std::to_string(set)); ++set) {
        const Numbers numbers = reader_.read(primitive["attributes"]["JOINTS_" + std::to_string(set)]);
        const Numbers shares = reader_.read(primitive["attributes"]["WEIGHTS_" + std::to_string(set)]);
        for (size_t k = 4 * vertex; k < 4 * vertex + 4; ++k) {
          if (shares[k] == 0) continue;
          total += shares[k];
          for (size_t row = 0; row < 4; ++row) {
            for (size_t column = 0; column < 4; ++column) {
              sum[row][column] += shares[k] * joints[static_cast<size_t>(numbers[k])][row][column];
            }
          }
        }
      }
      for (auto& row : sum) {
        for (Real& number : row) number /= total;
      }
      points[vertex] = transform(sum, points[vertex]);
    }
  }

  const json& document_;
  Reader reader_;
  Real time_;
  /// The animated values by their pointers.
  std::map<std::string, Numbers> values_;
  std::map<size_t, size_t> parents_;
  std::vector<Matrix> worlds_;
  std::vector<std::vector<OraclePoint>> objects_;
};

}  // namespace

std::vector<std::vector<OraclePoint>> pose_by_specification(const GltfBuilder& gltf, const std::vector<size_t>& clips,
                                                            long double time_s) {
  return Oracle(gltf, clips, time_s).take();
}

}  // namespace promin::test
