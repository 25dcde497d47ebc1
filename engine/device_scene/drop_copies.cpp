// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/drop_copies.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <tuple>
#include <unordered_map>
#include <variant>

#include "core/hash.h"
#include "core/rounding.h"
#include "scene/alpha.h"

namespace promin {
namespace {

using layout::Primitive;

/// Counts primitives, indexed by the bits of their first corner.
class CornerCounts {
 public:
  void add(const Primitive& p) { ++counts_[bucket_of(p)]; }
  bool may_have_copies(const Primitive& p) const { return counts_[bucket_of(p)] > kMostCopies; }
  bool may_have_copies() const {
    return std::ranges::any_of(counts_, [](uint32_t count) { return count > kMostCopies; });
  }

 private:
  static constexpr int kBits = 16;

  static size_t bucket_of(const Primitive& p) {
    const uint64_t word = uint64_t{std::bit_cast<uint32_t>(p.a.x)} << 32 | std::bit_cast<uint32_t>(p.a.y);
    const uint64_t mixed =
        (word ^ uint64_t{std::bit_cast<uint32_t>(p.a.z)} * 0x9E3779B97F4A7C15ULL) * 0xD6E8FEB86659FD93ULL;
    return static_cast<size_t>(mixed >> (64 - kBits));
  }

  std::vector<uint32_t> counts_ = std::vector<uint32_t>(size_t{1} << kBits);
};

/// The data that a primitive and its copies have in common.
struct Shown {
  std::array<uint32_t, 10> words;
  uint32_t material;

  Shown(const Primitive& p, uint32_t surface) : material(surface) {
    for (int i = 0; i < 4; ++i) {
      words[static_cast<size_t>(i)] = std::bit_cast<uint32_t>(p.a[i]);
      words[static_cast<size_t>(4 + i)] = std::bit_cast<uint32_t>(p.b[i]);
    }
    words[8] = p.c.x;
    words[9] = p.c.z;
  }
  bool operator==(const Shown&) const = default;
};

struct HashOfShown {
  size_t operator()(const Shown& shown) const {
    Hash64 hash;
    hash.add(std::as_bytes(std::span(shown.words)));
    hash.add(shown.material);
    return static_cast<size_t>(hash.value());
  }
};

float transmission_of(const Phong& model) {
  return max_component(model.transmission);
}
float transmission_of(const MetallicRoughness& model) {
  return model.transmission;
}
float transmission_of(const Unlit& /*model*/) {
  return 0.0F;
}

/// Keeps the elements whose index is not in `dropped`, which is sorted.
template <typename Elements>
void keep_others(Elements& elements, const std::vector<size_t>& dropped) {
  auto next = dropped.begin();
  size_t kept = 0;
  for (size_t i = 0; i < elements.size(); ++i) {
    if (next != dropped.end() && *next == i) {
      ++next;
    } else {
      elements[kept++] = elements[i];
    }
  }
  elements.resize(kept);
}

}  // namespace

// Textures are ignored, so that scenes for casts, which have no textures, have the same trees.
bool hides_copies(const Material& material) {
  return !has_holes(material) &&
         std::visit([](const auto& model) { return transmission_of(model); }, material.model) == 0.0F;
}

DroppedCopies drop_copies(const world::Scene& scene, Collected& collected) {
  DroppedCopies copies;
  const std::span<const Primitive> all = collected.bounded;
  // Parts of triangles have their own weights, so they are not copies.
  if (all.size() <= kMostCopies || !collected.numbers.parts.empty()) return copies;
  CornerCounts counts;
  for (const Primitive& p : all) counts.add(p);
  if (!counts.may_have_copies()) return copies;

  std::unordered_map<Shown, std::vector<size_t>, HashOfShown> groups;
  for (size_t i = 0; i < all.size(); ++i) {
    if (!counts.may_have_copies(all[i])) continue;
    const uint32_t material = collected.bounded_surfaces[i].corners_material.w & layout::SURFACE_MATERIAL_MASK;
    groups[Shown(all[i], material)].push_back(i);
  }
  std::vector<size_t> dropped;
  for (const auto& [shown, members] : groups) {
    if (members.size() <= kMostCopies || !hides_copies(scene.materials.at(shown.material))) continue;
    copies.materials.insert(shown.material);
    std::vector<uint32_t>& left_out = copies.by_first[all[members.front()].c.y];
    for (const size_t member : std::span(members).subspan(1)) left_out.push_back(all[member].c.y);
    dropped.insert(dropped.end(), members.begin() + 1, members.end());
  }
  std::ranges::sort(dropped);
  keep_others(collected.bounded, dropped);
  keep_others(collected.bounded_surfaces, dropped);
  keep_others(collected.boxes, dropped);
  return copies;
}

}  // namespace promin
