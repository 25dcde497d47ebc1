// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/bundle_images.h"

#include <algorithm>

#include "scene/alpha.h"
#include "scene/glass.h"
#include "scene/texture_slots.h"

namespace promin {
namespace {

bool have_equal_samplers(const Texture& a, const Texture& b) {
  return a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.is_magnified_linearly == b.is_magnified_linearly &&
         a.is_minified_linearly == b.is_minified_linearly && a.has_levels == b.has_levels &&
         a.are_levels_linear == b.are_levels_linear;
}

class BundleFinder {
 public:
  BundleFinder(const world::Scene& scene, std::span<const float> cutoffs) : scene_(scene) {
    for (size_t i = 0; i < scene.images.size(); ++i) {
      is_alone_.push_back(cutoffs[i] > 0.0F || scene.images[i]->texels.empty());
    }
    for (const Material& material : scene.materials) {
      if (!has_holes(material) && !is_clear(material)) continue;
      for (const TextureSlot& slot : slots_of(material)) is_alone_[image_of(slot)] = true;
    }
  }

  void add(const Material& material) {
    const std::vector<TextureSlot> slots = slots_of(material);
    for (const TextureSlot& slot : slots) {
      ImageBundle bundle;
      // Colours come first.
      for (const bool are_colors : {true, false}) {
        for (const TextureSlot& other : slots) {
          const uint32_t image = image_of(other);
          const bool is_color = scene_.images[image]->use == ImageUse::kColor;
          if (is_color != are_colors || !are_alike(slot, other) || std::ranges::count(bundle, image) > 0) continue;
          if (bundle.size() < (are_colors ? kMostColorsBundled : kMostBundled)) bundle.push_back(image);
        }
      }
      if (bundle.size() < 2) continue;
      for (const uint32_t image : bundle) is_alone_[image] = true;
      bundles_.push_back(std::move(bundle));
    }
  }
  /// Returns the bundles, or none if they do not pay. A look-up of a bundle costs a CPU as much as those of two images
  /// that stand alone.
  std::vector<ImageBundle> take() {
    uint64_t alone = 0;
    uint64_t bundled = 0;
    for (const Material& material : scene_.materials) {
      const std::vector<TextureSlot> slots = slots_of(material);
      for (auto slot = slots.begin(); slot != slots.end(); ++slot) {
        const auto has_image = [&](const TextureSlot& other) { return image_of(other) == image_of(*slot); };
        const auto has_bundle = [&](const TextureSlot& other) {
          return has_image(other) || (bundle_of(other) < bundles_.size() && bundle_of(other) == bundle_of(*slot));
        };
        const auto is_found = [&](const auto& is_beside) {
          return std::any_of(slots.begin(), slot, [&](const TextureSlot& other) {
            return is_beside(other) && are_looked_up_alike(other, *slot);
          });
        };
        alone += is_found(has_image) ? 0 : 1;
        bundled += is_found(has_bundle) ? 0 : 1;
      }
    }
    return 2 * bundled <= alone ? std::move(bundles_) : std::vector<ImageBundle>();
  }

 private:
  std::vector<TextureSlot> slots_of(const Material& material) const {
    std::vector<TextureSlot> slots;
    for_each_slot(material, [&](const TextureSlot& slot, const char* /*name*/, ImageUse /*use*/) {
      if (slot.exists() && slot.texture < scene_.textures.size()) slots.push_back(slot);
    });
    return slots;
  }
  uint32_t image_of(const TextureSlot& slot) const { return scene_.textures[slot.texture].image; }

  /// Returns the index of the slot's bundle, or the number of bundles.
  size_t bundle_of(const TextureSlot& slot) const {
    const auto has_image = [&](const ImageBundle& bundle) { return std::ranges::count(bundle, image_of(slot)) > 0; };
    return static_cast<size_t>(std::ranges::find_if(bundles_, has_image) - bundles_.begin());
  }

  bool are_looked_up_alike(const TextureSlot& a, const TextureSlot& b) const {
    return a.uv_set == b.uv_set && a.to_u == b.to_u && a.to_v == b.to_v &&
           have_equal_samplers(scene_.textures[a.texture], scene_.textures[b.texture]);
  }

  /// Returns whether both images are free and fit in one bundle.
  bool are_alike(const TextureSlot& a, const TextureSlot& b) const {
    return !is_alone_[image_of(a)] && !is_alone_[image_of(b)] && are_looked_up_alike(a, b) &&
           scene_.images[image_of(a)]->size == scene_.images[image_of(b)]->size;
  }

  const world::Scene& scene_;
  /// For each image, whether it belongs to no further bundle.
  std::vector<bool> is_alone_;
  std::vector<ImageBundle> bundles_;
};

}  // namespace

std::vector<ImageBundle> find_image_bundles(const world::Scene& scene, std::span<const float> cutoffs) {
  BundleFinder finder(scene, cutoffs);
  for (const Material& material : scene.materials) finder.add(material);
  return finder.take();
}

}  // namespace promin
