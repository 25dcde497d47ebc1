// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "promin/framing.h"
#include "scene/facets.h"
#include "scene/stray_geometry.h"

// Recognises scenes that surround the viewer, such as rooms.
namespace promin {
namespace {

/// The smallest fraction of backs in views from outside for which a scene is an interior.
constexpr double kLeastBacks = 0.75;
/// The largest fraction of backs in the view through an open side of a room; these backs are the ends of its walls.
constexpr double kMostBacksOfOpenSide = 0.1;
/// The largest fraction of backs among the facets inside the hull.
constexpr double kMostBacksWithin = 0.5;
/// Objects inside must lie deeper than this fraction of the scene's size.
constexpr double kLeastDepth = 0.02;
/// Number of pixels along a side of the pictures from outside.
constexpr int kSide = 64;

/// The views of a scene along an axis, from both ends.
struct Silhouette {
  struct Pixel {
    double depth;
    bool is_back = false;
  };
  std::array<std::vector<Pixel>, 2> ends;

  Silhouette() {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    ends[0].assign(size_t{kSide} * kSide, {kFar});
    ends[1].assign(size_t{kSide} * kSide, {-kFar});
  }
};

/// Orthographic pictures of the facets within a box, from its six sides. A pixel has the depth of the nearest facet,
/// and whether the facet's back is visible.
class SixPictures {
 public:
  explicit SixPictures(const Bounds& bounds) : lo_(bounds.lo), size_(dvec3(bounds.hi) - dvec3(bounds.lo)) {
    size_ = glm::max(size_, dvec3(std::numeric_limits<double>::min()));
  }

  void draw(const Facet& facet) {
    for (int axis = 0; axis < 3; ++axis) draw(facet, axis);
  }

  /// Returns the fraction of backs among the pixels that show a facet.
  double share_of_backs() const {
    std::vector<Silhouette::Pixel> all;
    for (const Silhouette& silhouette : silhouettes_) {
      for (const auto& end : silhouette.ends) all.insert(all.end(), end.begin(), end.end());
    }
    return share_of_backs(all);
  }

  /// An end of a horizontal axis, if +Y is up.
  struct Side {
    int axis;
    size_t end;
  };

  /// Returns the open horizontal side, if there is one. From there almost no backs are visible.
  std::optional<Side> find_open_side() const {
    for (const Side side : {Side{2, 1}, Side{2, 0}, Side{0, 1}, Side{0, 0}}) {
      if (share_of_backs(pictures_of(side.axis)[side.end]) <= kMostBacksOfOpenSide) return side;
    }
    return std::nullopt;
  }

  /// Returns whether a point lies deep behind the visible facets of all six sides except an open side.
  bool is_enclosed(const dvec3& point, const std::optional<Side>& open) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto& ends = pictures_of(axis);
      const size_t pixel = pixel_of(point, axis);
      const double margin = kLeastDepth * size_[axis];
      const bool is_open = open && open->axis == axis;
      if (!(is_open && open->end == 0) && !(ends[0][pixel].depth + margin < point[axis])) return false;
      if (!(is_open && open->end == 1) && !(point[axis] < ends[1][pixel].depth - margin)) return false;
    }
    return true;
  }

 private:
  const std::array<std::vector<Silhouette::Pixel>, 2>& pictures_of(int axis) const {
    return silhouettes_[static_cast<size_t>(axis)].ends;
  }

  static double share_of_backs(const std::vector<Silhouette::Pixel>& pixels) {
    double backs = 0.0;
    double all = 0.0;
    for (const Silhouette::Pixel& pixel : pixels) {
      if (!std::isfinite(pixel.depth)) continue;
      all += 1.0;
      backs += pixel.is_back ? 1.0 : 0.0;
    }
    return all > 0.0 ? backs / all : 0.0;
  }

  /// Returns the coordinates of a point in pixels of the picture along an axis.
  dvec2 place_of(const dvec3& point, int axis) const {
    const dvec3 share = (point - lo_) / size_;
    return double{kSide} * dvec2(share[(axis + 1) % 3], share[(axis + 2) % 3]);
  }

  size_t pixel_of(const dvec3& point, int axis) const {
    const dvec2 place = glm::clamp(glm::floor(place_of(point, axis)), 0.0, double{kSide - 1});
    return static_cast<size_t>(place.y) * kSide + static_cast<size_t>(place.x);
  }

  /// Draws a facet: processes the pixels whose middles it covers.
  void draw(const Facet& facet, int axis) {
    std::array<dvec2, 3> at;
    for (size_t i = 0; i < 3; ++i) at[i] = place_of(facet.corners[i], axis);
    const dvec2 ab = at[1] - at[0];
    const dvec2 ac = at[2] - at[0];
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (area == 0.0) return;
    const dvec2 lo = glm::clamp(glm::ceil(glm::min(at[0], glm::min(at[1], at[2])) - 0.5), 0.0, double{kSide});
    const dvec2 hi = glm::clamp(glm::floor(glm::max(at[0], glm::max(at[1], at[2])) - 0.5), -1.0, double{kSide - 1});
    for (int y = static_cast<int>(lo.y); y <= static_cast<int>(hi.y); ++y) {
      for (int x = static_cast<int>(lo.x); x <= static_cast<int>(hi.x); ++x) {
        const dvec2 ap = dvec2(x, y) + 0.5 - at[0];
        const double b = (ap.x * ac.y - ap.y * ac.x) / area;
        const double c = (ab.x * ap.y - ab.y * ap.x) / area;
        if (b < 0.0 || c < 0.0 || b + c > 1.0) continue;
        const double depth =
            (1.0 - b - c) * facet.corners[0][axis] + b * facet.corners[1][axis] + c * facet.corners[2][axis];
        take(axis, static_cast<size_t>(y) * kSide + static_cast<size_t>(x), depth, area > 0.0, facet.shows_back);
      }
    }
  }

  /// Stores a facet's depth in a pixel if it is the nearest. A facet that is counterclockwise in a picture shows its
  /// front to the upper end of the axis.
  void take(int axis, size_t pixel, double depth, bool faces_upper_end, bool shows_back) {
    auto& ends = silhouettes_[static_cast<size_t>(axis)].ends;
    Silhouette::Pixel& lower = ends[0][pixel];
    Silhouette::Pixel& upper = ends[1][pixel];
    if (depth < lower.depth && (!faces_upper_end || shows_back)) lower = {depth, faces_upper_end};
    if (depth > upper.depth && (faces_upper_end || shows_back)) upper = {depth, !faces_upper_end};
  }

  dvec3 lo_;
  dvec3 size_;
  std::array<Silhouette, 3> silhouettes_;
};

/// The most triangles of instances for which the function looks for a room.
constexpr uint64_t kMostTrianglesOfRoom = uint64_t{1} << 26;

/// Calls `use` with the facets of a scene's main part. `counts_wholes` is false to skip objects that count as wholes.
template <class Use>
void for_each_facet(const Scene& scene, const MainPart& part, bool counts_wholes, const Use& use) {
  const auto is_skipped = [&](size_t object) { return !counts_wholes && part.is_whole(object); };
  any_facet(scene, is_skipped, [&](const Facet& facet) {
    if (part.centers) {
      Bounds bounds;
      for (const dvec3& corner : facet.corners) bounds.extend(vec3(corner));
      if (!holds(*part.centers, bounds.center())) return false;
    }
    use(facet);
    return false;
  });
}

/// Sums over the triangles of a mesh: six times the volume between the triangles and the origin, and the normals with
/// the length of twice the areas.
struct MeshVolume {
  double volume = 0.0;
  dvec3 normals{0.0};
};

MeshVolume mesh_volume_of(const Mesh& mesh) {
  MeshVolume sums;
  for (const uvec3& triangle : mesh.triangles) {
    const dvec3 a(mesh.positions[triangle.x]);
    const dvec3 normal = glm::cross(dvec3(mesh.positions[triangle.y]) - a, dvec3(mesh.positions[triangle.z]) - a);
    sums.volume += glm::dot(a, normal);
    sums.normals += normal;
  }
  return sums;
}

/// Returns six times the volume that the facets bound; negative if they show their backs to the outside.
double signed_volume(const Scene& scene, const MainPart& part) {
  const dvec3 center(part.bounds.center());
  double sum = 0.0;
  for_each_facet(scene, part, false, [&](const Facet& facet) {
    const auto& [a, b, c] = facet.corners;
    sum += glm::dot(a - center, glm::cross(b - a, c - a));
  });
  std::map<uint32_t, MeshVolume> volumes;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (!part.is_whole(i) || (part.centers && !holds(*part.centers, part.wholes[i].center()))) continue;
    const Object& object = scene.objects[i];
    const auto [volume, is_new] = volumes.try_emplace(object.geometry);
    if (is_new) volume->second = mesh_volume_of(std::get<Mesh>(scene.geometries[object.geometry]));
    const dmat3 turn(object.world_from_object);
    const dvec3 from_center = dvec3(object.world_from_object[3]) - center;
    // The product with the inverse transpose gives the sum of normals in the world.
    const dvec3 normals = glm::transpose(glm::inverse(turn)) * volume->second.normals;
    sum += std::abs(glm::determinant(turn)) * (volume->second.volume + glm::dot(from_center, normals));
  }
  return sum;
}

uint64_t count_triangles_of_wholes(const Scene& scene, const MainPart& part) {
  uint64_t count = 0;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (part.is_whole(i)) count += primitive_count(scene, scene.objects[i]);
  }
  return count;
}

}  // namespace

Framing framing_of(const Scene& scene, const MainPart& part) {
  constexpr Framing kOutside = Framing::kThreeQuarter;
  // Most scenes can be classified without pictures.
  if (part.bounds.is_empty() || signed_volume(scene, part) >= 0.0) return kOutside;
  if (count_triangles_of_wholes(scene, part) > kMostTrianglesOfRoom) return kOutside;
  SixPictures outside(part.bounds);
  for_each_facet(scene, part, true, [&](const Facet& facet) { outside.draw(facet); });
  if (outside.share_of_backs() < kLeastBacks) return kOutside;

  const auto open = outside.find_open_side();
  std::vector<Facet> within;
  Bounds bounds;
  for_each_facet(scene, part, true, [&](const Facet& facet) {
    const auto& corners = facet.corners;
    if (!outside.is_enclosed((corners[0] + corners[1] + corners[2]) / 3.0, open)) return;
    within.push_back(facet);
    for (const dvec3& corner : corners) bounds.extend(vec3(corner));
  });
  if (within.empty()) return kOutside;
  SixPictures inside(bounds);
  for (const Facet& facet : within) inside.draw(facet);
  if (inside.share_of_backs() > kMostBacksWithin) return kOutside;
  if (!open) return Framing::kInside;
  if (open->axis == 0) return open->end == 0 ? Framing::kLeft : Framing::kRight;
  return open->end == 0 ? Framing::kBack : Framing::kFront;
}

Framing framing_of(const Scene& scene) {
  return framing_of(scene, find_main_part(scene));
}

}  // namespace promin
