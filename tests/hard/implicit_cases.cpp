// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These cases check the boxes and capsules of KHR_implicit_shapes.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>

#include "hard/hard_case.h"
#include "oracle/distance.h"

namespace promin::hard {
namespace {

/// The number of rays for each orientation.
const size_t kImplicitRayCount = some_of(25000);
/// The number of rays if many answers differ from the oracle's, because finding the margin of one takes a millisecond.
const size_t kGrazingRayCount = some_of(1000);

/// Expects the bounds BK and B2, and well-formed hits. B1 has no meaning for rays near an edge, because the normal
/// jumps there.
void expect_bounds(Lab& lab, const std::string& where, const Tally& tally) {
  lab.expect_at_most("|P - surface| / uS (BK), " + where, 8.0 * lab.rounding_factor(), tally.max_surface_error);
  lab.expect_at_most("margin of other answers / uS (B2), " + where, 2.0, tally.max_margin);
  lab.expect_at_most("malformed hits, " + where, 0.0, static_cast<double>(tally.malformed));
}

/// The rotations are those of box.cpp: none, a small one, a medium one, and the largest possible one.
constexpr std::array<vec3, 4> kTurns = {vec3(0.0F), vec3(1e-5F, -2e-6F, 3e-7F), vec3(0.1F, -0.25F, 0.2F),
                                        vec3(0.3F, 0.3F, -0.3F)};

struct BoxForm {
  const char* name;
  vec3 half_size;
};
constexpr BoxForm kCube{"cube", vec3(1.0F)};
constexpr BoxForm kBrick{"brick", vec3(1.0F, 0.6F, 0.3F)};
constexpr BoxForm kPlate{"plate", vec3(1.0F, 1e-4F, 1.0F)};
constexpr BoxForm kRod{"rod", vec3(1e-4F, 1e-4F, 1.0F)};
constexpr BoxForm kSmall{"small box", vec3(1e-3F, 2e-3F, 1e-3F)};

/// A box and the numbers with which rays are aimed at it.
struct AimedBox {
  world::Box box;
  dvec3 axes[3];

  AimedBox(const BoxForm& form, const vec3& center, const vec3& turn) : box{center, form.half_size, turn} {
    for (int i = 0; i < 3; ++i) axes[i] = dvec3(oracle::axis_of(box, i));
  }

  /// Returns the point with these coordinates, which go from -1 to 1 in the box.
  dvec3 at(const dvec3& place) const {
    dvec3 point(box.center);
    for (int i = 0; i < 3; ++i) point += place[i] * static_cast<double>(box.half_size[i]) * axes[i];
    return point;
  }
  double size() const { return glm::length(dvec3(box.half_size)); }
};

dvec3 random_place(Random& random, double spread) {
  return {random.uniform(-spread, spread), random.uniform(-spread, spread), random.uniform(-spread, spread)};
}

using MakeRay = std::function<Ray(const AimedBox&, Random&)>;

Tally cast_boxes(Lab& lab, const BoxForm& form, const vec3& center, Random& random, const MakeRay& make_ray,
                 size_t count = kImplicitRayCount) {
  Tally tally;
  for (const vec3& turn : kTurns) {
    const AimedBox aimed(form, center, turn);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) rays.push_back(make_ray(aimed, random));
    tally.add(lab.cast_and_judge(scene_of({aimed.box}), rays));
  }
  return tally;
}

void run_around_box(Lab& lab, const BoxForm& form, std::initializer_list<double> distances, const vec3& center,
                    Random& random) {
  for (const double distance : distances) {
    const Tally tally = cast_boxes(lab, form, center, random, [&](const AimedBox& aimed, Random& r) {
      return ray_towards(dvec3(aimed.box.center) + distance * r.direction(), aimed.at(random_place(r, 1.1)));
    });
    Lab::credit("box", tally.without_t_errors());
    expect_bounds(lab, form.name + label(", distance", distance), tally);
  }
}

void run_boxes_far_away(Lab& lab) {
  Random random(39);
  run_around_box(lab, kCube, {3.0, 1e1, 1e2, 1e3, 1e4, 1e5}, vec3(0.0F), random);
  run_around_box(lab, kBrick, {3.0, 1e3}, vec3(0.0F), random);
  run_around_box(lab, kPlate, {3.0, 1e3}, vec3(0.0F), random);
  run_around_box(lab, kRod, {3.0, 1e3}, vec3(0.0F), random);
  run_around_box(lab, kSmall, {10.0}, vec3(0.0F), random);
  run_around_box(lab, kBrick, {10.0}, vec3(1e5F, -1e5F, 1e5F), random);
}

/// Aims at edges and corners from directions that see both or all of their faces, well inside the silhouette: no ray
/// may miss. Rays towards a plate start nearby, because u S would exceed the plate's thickness for distant origins.
void run_implicit_box_edges(Lab& lab) {
  Random random(40);
  for (const BoxForm& form : {kCube, kBrick, kPlate}) {
    uint64_t leaks = 0;
    Tally all;
    for (const int fixed : {2, 3}) {
      const Tally tally = cast_boxes(lab, form, vec3(0.3F, -0.2F, 0.1F), random, [&](const AimedBox& aimed, Random& r) {
        // The point is not too near the edges of faces that the ray does not see.
        dvec3 place = random_place(r, 0.9);
        dvec3 outward(0.0);
        const int first = static_cast<int>(3.0 * r.uniform());
        for (int k = 0; k < fixed; ++k) {
          const int axis = (first + k) % 3;
          place[axis] = place[axis] < 0.0 ? -1.0 : 1.0;
          outward += place[axis] * r.uniform(0.2, 1.0) * aimed.axes[axis];
        }
        const dvec3 target = aimed.at(place);
        return ray_towards(target + aimed.size() *
                                        std::pow(10.0, r.uniform(0.5, form.half_size == kPlate.half_size ? 1.5 : 3.0)) *
                                        glm::normalize(outward),
                           target);
      });
      leaks += tally.misses;
      all.add(tally);
    }
    lab.expect_at_most(std::string("leaks at edges and corners, ") + form.name, 0.0, static_cast<double>(leaks));
    Lab::credit("box", all.without_t_errors(), leaks);
    expect_bounds(lab, std::string("edges and corners, ") + form.name, all);
  }
}

/// Casts rays along a face, as exactly as fp32 allows: in its plane, a little inside it and a little beside it.
void run_along_faces(Lab& lab) {
  Random random(41);
  for (const BoxForm& form : {kCube, kPlate}) {
    for (const double gap : {0.0, 1e-6, 1e-3}) {
      const Tally tally = cast_boxes(
          lab, form, vec3(0.0F), random,
          [&](const AimedBox& aimed, Random& r) {
            const int axis = static_cast<int>(3.0 * r.uniform());
            dvec3 place = random_place(r, 1.0);
            place[axis] = (place[axis] < 0.0 ? -1.0 : 1.0) * (1.0 + r.uniform(-gap, gap));
            const dvec3 along = r.perpendicular(aimed.axes[axis]);
            const dvec3 target = aimed.at(place);
            return ray_towards(target - 10.0 * along, target);
          },
          kGrazingRayCount);
      Lab::credit("box", tally.without_t_errors());
      expect_bounds(lab, std::string("along faces, ") + form.name + label(", gap", gap), tally);
    }
  }
}

struct CapsuleForm {
  const char* name;
  float half_height;
  float bottom;
  float top;
};
constexpr CapsuleForm kPill{"pill", 1.0F, 0.5F, 0.5F};
constexpr CapsuleForm kSkittle{"skittle", 1.0F, 0.7F, 0.25F};
constexpr CapsuleForm kDrop{"drop", 1.0F, 0.8F, 0.0F};
/// One sphere almost contains the other, so that the rest of the cone is flat.
constexpr CapsuleForm kEgg{"egg", 0.2501F, 1.0F, 0.5F};
/// Here the capsule is as close to a sphere as fp32 allows.
constexpr CapsuleForm kSphereAndLess{"all but a sphere", 0.25000003F, 0.5F, 1.0F};
constexpr CapsuleForm kHeld{"sphere in a sphere", 0.2F, 1.0F, 0.5F};
constexpr CapsuleForm kBall{"no height", 0.0F, 0.5F, 0.5F};
constexpr CapsuleForm kWire{"wire", 1.0F, 1e-4F, 1e-4F};

/// A capsule and the numbers with which rays are aimed at it.
struct AimedCapsule {
  world::Capsule capsule;
  dvec3 axis;

  AimedCapsule(const CapsuleForm& form, const vec3& center, const dvec3& given_axis)
      : capsule{center, vec3(glm::normalize(given_axis)), form.half_height, form.bottom, form.top},
        axis(glm::normalize(dvec3(capsule.axis))) {}

  double size() const {
    return static_cast<double>(capsule.half_height + std::max(capsule.radius_bottom, capsule.radius_top));
  }
  double height() const { return 2.0 * static_cast<double>(capsule.half_height); }
  /// Returns the sine of the angle between a generator and the axis. The capsule must have a side.
  double sine() const { return static_cast<double>(capsule.radius_bottom - capsule.radius_top) / height(); }
  /// Returns a point in the capsule enlarged by a tenth.
  dvec3 random_point(Random& random) const {
    const double along = random.uniform();
    const double radius = 1.1 * glm::mix(double{capsule.radius_bottom}, double{capsule.radius_top}, along);
    return dvec3(capsule.center) + (along - 0.5) * height() * axis +
           radius * std::cbrt(random.uniform()) * random.direction();
  }
  /// Returns a point on one of the circles where the cone touches the spheres.
  dvec3 seam_point(bool is_top, const dvec3& radial) const {
    const double radius = is_top ? capsule.radius_top : capsule.radius_bottom;
    const double cosine = std::sqrt((1.0 - sine()) * (1.0 + sine()));
    return dvec3(capsule.center) + (is_top ? 0.5 : -0.5) * height() * axis + radius * (sine() * axis + cosine * radial);
  }
};

const std::array<dvec3, 4> kAxes = {dvec3(0.0, 1.0, 0.0), dvec3(-1.0, 0.0, 0.0), dvec3(1.0, 2.0, -3.0),
                                    dvec3(1e-3, -1e-4, -1.0)};

Tally cast_capsules(Lab& lab, const CapsuleForm& form, const vec3& center, Random& random,
                    const std::function<Ray(const AimedCapsule&, Random&)>& make_ray,
                    size_t count = kImplicitRayCount) {
  Tally tally;
  for (const dvec3& axis : kAxes) {
    const AimedCapsule aimed(form, center, axis);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) rays.push_back(make_ray(aimed, random));
    tally.add(lab.cast_and_judge(scene_of({aimed.capsule}), rays));
  }
  Lab::credit("capsule", tally);
  return tally;
}

void run_capsules_around(Lab& lab, const CapsuleForm& form, std::initializer_list<double> distances, const vec3& center,
                         Random& random) {
  for (const double distance : distances) {
    const Tally tally = cast_capsules(lab, form, center, random, [&](const AimedCapsule& aimed, Random& r) {
      return ray_towards(dvec3(aimed.capsule.center) + distance * r.direction(), aimed.random_point(r));
    });
    expect_bounds(lab, form.name + label(", distance", distance), tally);
  }
}

void run_capsules_far_away(Lab& lab) {
  Random random(42);
  run_capsules_around(lab, kPill, {3.0, 1e1, 1e2, 1e3, 1e4, 1e5}, vec3(0.0F), random);
  for (const CapsuleForm& form : {kSkittle, kDrop, kEgg, kSphereAndLess, kHeld, kBall, kWire}) {
    run_capsules_around(lab, form, {3.0, 1e3}, vec3(0.0F), random);
  }
  run_capsules_around(lab, kSkittle, {10.0}, vec3(1e5F, -1e5F, 1e5F), random);
}

/// Aims at the circles where sphere and cone meet, from any direction that sees them: no ray may pass between them.
void run_seams(Lab& lab) {
  Random random(43);
  for (const CapsuleForm& form : {kPill, kSkittle, kDrop, kEgg, kSphereAndLess}) {
    const Tally tally = cast_capsules(lab, form, vec3(0.3F, -0.2F, 0.1F), random, [](const AimedCapsule& a, Random& r) {
      const dvec3 radial = r.perpendicular(a.axis);
      const dvec3 target = a.seam_point(a.capsule.radius_top > 0.0F && r.uniform() < 0.5, radial);
      const dvec3 normal = a.sine() * a.axis + std::sqrt((1.0 - a.sine()) * (1.0 + a.sine())) * radial;
      // The direction differs from the silhouette's by at least 0.1.
      const dvec3 outward = glm::normalize(r.uniform(0.1, 1.0) * normal + r.uniform() * r.perpendicular(normal));
      return ray_towards(target + a.size() * std::pow(10.0, r.uniform(0.5, 3.0)) * outward, target);
    });
    lab.expect_at_most(std::string("leaks at seams, ") + form.name, 0.0, static_cast<double>(tally.misses));
    expect_bounds(lab, std::string("seams, ") + form.name, tally);
  }
}

/// Casts rays along the axis and along generators, through the capsule and beside it.
void run_along_capsules(Lab& lab) {
  Random random(44);
  for (const CapsuleForm& form : {kPill, kSkittle, kDrop}) {
    for (const bool is_generator : {false, true}) {
      const Tally tally = cast_capsules(
          lab, form, vec3(0.0F), random,
          [&](const AimedCapsule& a, Random& r) {
            const dvec3 radial = r.perpendicular(a.axis);
            const double cosine = std::sqrt((1.0 - a.sine()) * (1.0 + a.sine()));
            const dvec3 along = is_generator ? cosine * a.axis - a.sine() * radial : a.axis;
            const dvec3 target = is_generator && r.uniform() < 0.5 ? a.seam_point(false, radial) : a.random_point(r);
            return ray_towards(target - (r.uniform() < 0.5 ? 10.0 : -10.0) * along, target);
          },
          kGrazingRayCount);
      expect_bounds(lab, std::string(is_generator ? "along generators, " : "along the axis, ") + form.name, tally);
    }
  }
}

constexpr std::array kImplicitCases{
    HardCase{39, "BoxFarAway", run_boxes_far_away}, HardCase{40, "BoxEdges", run_implicit_box_edges},
    HardCase{41, "AlongBoxFaces", run_along_faces}, HardCase{42, "CapsuleFarAway", run_capsules_far_away},
    HardCase{43, "CapsuleSeams", run_seams},        HardCase{44, "AlongCapsules", run_along_capsules}};

}  // namespace

std::span<const HardCase> implicit_cases() {
  return kImplicitCases;
}

}  // namespace promin::hard
