// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These cases check what the host keeps away from the device: numbers that fp32 cannot hold are refused, and cameras do
// not drift.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "hard/hard_case.h"
#include "support/gltf_builder.h"
#include "support/scene_folder.h"
#include "work/pictures/camera.h"

namespace promin::hard {
namespace {

using nlohmann::json;

/// Writes scenes of one analytic shape into a folder of its own, and loads them.
class ShapeFolder : public SceneFolder {
 public:
  /// Returns whether load_scene refuses the shape under the node's transform, or does not draw it. `text_of_42`
  /// replaces 42 in the file, for values that JSON's own numbers cannot express.
  bool refuses(const json& shape, const json& node = json::object(), const std::string& text_of_42 = "42") const {
    GltfBuilder gltf = triangle_gltf();
    gltf.json["extensions"]["KHR_implicit_shapes"]["shapes"] = {shape};
    gltf.json["meshes"][0]["primitives"][0]["extensions"]["PROMIN_mesh_primitive_implicit_shape"]["shape"] = 0;
    gltf.json["nodes"][0].update(node);
    std::string text = gltf.text();
    if (const size_t at = text.find("42.0"); at != std::string::npos) text.replace(at, 4, text_of_42);
    if (!refusal("shape.gltf", text).empty()) return true;
    return load_scene(folder_ / "shape.gltf").objects.front().geometry == Object::kNoGeometry;
  }

 private:
  void TestBody() override {}
};

json sphere_of(double radius) {
  return {{"type", "sphere"}, {"sphere", {{"radius", radius}}}};
}

json cylinder_of(double height, double radius_bottom, double radius_top) {
  return {{"type", "cylinder"},
          {"cylinder", {{"height", height}, {"radiusBottom", radius_bottom}, {"radiusTop", radius_top}}}};
}

void run_overflow(Lab& lab) {
  const ShapeFolder folder;
  const auto at = [](double distance) { return json{{"translation", {distance, 0, 0}}}; };
  int taken = 0;
  taken += !folder.refuses(sphere_of(1e18), at(1e20));
  taken += !folder.refuses(sphere_of(1e18));
  taken += !folder.refuses(sphere_of(1.0), at(1e20));
  taken += !folder.refuses(sphere_of(1.0), at(-1e20));
  taken += !folder.refuses(sphere_of(1.0), {{"scale", {1e18, 1e18, 1e18}}});
  lab.expect_at_most("spheres of r = 1e18 or at 1e20 that are taken", 0.0, taken);
  lab.expect_at_most("spheres of r = 1e14 at 1e14 that are refused", 0.0, folder.refuses(sphere_of(1e14), at(1e14)));
}

void run_degenerate_shapes(Lab& lab) {
  const ShapeFolder folder;
  const json good = cylinder_of(1.0, 1.0, 1.0);
  const json cone = cylinder_of(1.0, 1.0, 0.0);
  const auto turned = [](double x) { return json{{"rotation", {0.0, 0.0, x, 1.0}}}; };
  int taken = 0;
  // The height or the radius is zero, by itself or because of the scale.
  taken += !folder.refuses(cylinder_of(0.0, 1.0, 1.0));
  taken += !folder.refuses(cylinder_of(0.0, 1.0, 0.0));
  taken += !folder.refuses(cylinder_of(1.0, 0.0, 0.0));
  taken += !folder.refuses(sphere_of(0.0));
  for (const json& shape : {good, cone}) {
    taken += !folder.refuses(shape, {{"scale", {1.0, 0.0, 1.0}}});
    taken += !folder.refuses(shape, {{"scale", {0.0, 1.0, 0.0}}});
    taken += !folder.refuses(shape, {{"scale", {0.0, 0.0, 0.0}}});
  }
  lab.expect_at_most("shapes without height or radius that are taken", 0.0, taken);

  taken = 0;
  for (const json& shape : {good, cone}) {
    // JSON does not have these numbers.
    for (const char* number : {"NaN", "1e999", "-1e999", "Infinity"}) {
      taken += !folder.refuses(shape, turned(42.0), number);
    }
    // The number is finite in double, but not in fp32.
    taken += !folder.refuses(shape, {{"matrix", {1, 0, 0, 0, 0, 1e300, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
    taken += !folder.refuses(shape, {{"scale", {1.0, 1e300, 1.0}}});
  }
  lab.expect_at_most("axes of NaN or infinity that are taken", 0.0, taken);

  int refused = 0;
  for (const json& shape : {good, cone, sphere_of(1.0)}) refused += folder.refuses(shape, turned(0.0));
  refused += folder.refuses(good, {{"scale", {1.0, 1e-10, 1.0}}});
  lab.expect_at_most("sound shapes that are refused", 0.0, refused);
}

/// Returns the largest element of |R^T R - I|.
double orthonormality_error(const dmat3& r) {
  const dmat3 product = glm::transpose(r) * r;
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double error = std::abs(product[i][j] - (i == j ? 1.0 : 0.0));
      worst = error <= worst ? worst : error;  // keeps a NaN
    }
  }
  return worst;
}

void run_camera(Lab& lab) {
  Random random(37);
  FreeCamera camera;
  double worst = 0.0;
  double worst_in_use = 0.0;
  const auto keep_worst = [](double& kept, double error) { kept = error <= kept ? kept : error; };
  for (int step = 0; step < 100'000; ++step) {
    const double alpha = random.uniform(-1.0, 1.0);
    const double beta = random.uniform(-1.0, 1.0);
    const double gamma = random.uniform(-1.0, 1.0);
    camera.rotate(alpha, beta, gamma);
    const dvec3 way{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    camera.move(way.x, way.y, way.z);
    keep_worst(worst, orthonormality_error(camera.rotation()));
    const dvec3 look(camera.camera().look);
    const dvec3 up(camera.camera().up);
    keep_worst(worst_in_use, orthonormality_error(dmat3(glm::cross(look, up), up, -look)));
  }
  lab.expect_at_most("|R^T R - I| of rotation(), 1e5 steps", 1e-6, worst);
  lab.expect_at_most("|R^T R - I| of the fp32 vectors, 1e5 steps", 1e-6, worst_in_use);
}

constexpr std::array kHostCases{HardCase{5, "SphereBeyondFp32", run_overflow},
                                HardCase{17, "DegenerateShapes", run_degenerate_shapes},
                                HardCase{37, "CameraSteps", run_camera}};

}  // namespace

std::span<const HardCase> host_cases() {
  return kHostCases;
}

}  // namespace promin::hard
