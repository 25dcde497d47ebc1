// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "formats/load_report.h"
#include "formats/obj/mtl.h"
#include "promin/scene.h"

namespace promin {

/// The pictures of MTL materials, each once for each use.
class ObjTextures {
 public:
  /// Decodes the pictures of all maps of the materials on all cores. Maps whose pictures cannot be decoded cause a
  /// warning and are marked as unusable.
  ObjTextures(const std::vector<MtlMaterial*>& materials, LoadReport& report);

  /// Returns the slot of a usable map; an empty one for nullptr.
  TextureSlot read_slot(const MtlMap* map, ImageUse use);

  /// Returns the slot of a colour picture combined with the alpha of another picture: its alpha channel if it has one,
  /// else its red. Without a colour picture the colour is white; if both are nullptr, the slot is empty. One file may
  /// serve both.
  TextureSlot read_base_color(const MtlMap* color, const MtlMap* alpha);

  /// Returns the slot of a picture with roughness in green and metallic in blue, combined from a map of each. A missing
  /// map gives 1; if both are nullptr, the slot is empty.
  TextureSlot read_metallic_roughness(const MtlMap* roughness, const MtlMap* metallic);

  /// Returns the slot of the normals computed from a height map (formats/obj/heights.h). If its picture holds normals
  /// instead, they are used with a warning. Returns an empty slot for nullptr, and if there are no slopes.
  TextureSlot read_heights(const MtlMap* map);

  /// Moves the images and textures of the slots to the scene.
  void finish(Scene& scene);

 private:
  using ImagePointer = std::shared_ptr<const TextureImage>;

  ImagePointer find_picture(const MtlMap* map, ImageUse use) const;
  TextureSlot place(const MtlMap& map, uint32_t image);
  ImagePointer merge(const ImagePointer& roughness, const ImagePointer& metallic);
  ImagePointer merge_alpha(const ImagePointer& color, const ImagePointer& alpha);

  LoadReport& report_;
  std::map<std::pair<std::string, ImageUse>, ImagePointer> pictures_;
  std::vector<ImagePointer> images_;
  std::vector<Texture> textures_;
  /// Indices of images_, by the pictures that they were made from.
  std::map<std::pair<ImagePointer, ImagePointer>, uint32_t> image_numbers_;
  /// Indices in images_ of normal maps, by the height map's picture and the fields of HeightMap. A picture that is a
  /// normal map itself has a height of 0.
  std::map<std::tuple<ImagePointer, double, double, int, bool>, uint32_t> height_numbers_;
  /// Indices of textures_, by image and whether it is clamped.
  std::map<std::pair<uint32_t, bool>, uint32_t> texture_numbers_;
};

}  // namespace promin
