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

/// The pictures of MTL materials. Each picture is stored once for each of its uses.
class ObjTextures {
 public:
  /// Decodes the pictures of all maps of the materials on all cores. Maps whose pictures cannot be decoded cause a
  /// warning and are marked as unusable.
  ObjTextures(const std::vector<MtlMaterial*>& materials, LoadReport& report);

  /// Returns the slot of a usable map; an empty one for nullptr.
  TextureSlot read_slot(const MtlMap* map, ImageUse use);

  /// Returns the slot of a colour picture, combined with the alpha of another picture: the other picture's alpha
  /// channel if it has one, otherwise its red channel. Without a colour picture the colour is white. If both pointers
  /// are nullptr, the slot is empty. Both may name the same file.
  TextureSlot read_base_color(const MtlMap* color, const MtlMap* alpha);

  /// Returns the slot of a picture with roughness in green and metallic in blue, combined from the two maps. A missing
  /// map gives 1. If both pointers are nullptr, the slot is empty.
  TextureSlot read_metallic_roughness(const MtlMap* roughness, const MtlMap* metallic);

  /// Returns the slot of the normals computed from a height map (formats/obj/heights.h). If the picture contains
  /// normals and not heights, the normals are used with a warning. Returns an empty slot for nullptr, and if there are
  /// no slopes.
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
  /// Indices into images_, by the pictures from which the images were made.
  std::map<std::pair<ImagePointer, ImagePointer>, uint32_t> image_numbers_;
  /// Indices into images_ of normal maps, by the height map's picture and the members of HeightMap. If the picture is
  /// itself a normal map, its height is 0.
  std::map<std::tuple<ImagePointer, double, double, int, bool>, uint32_t> height_numbers_;
  /// Indices into textures_, by image and whether the texture is clamped.
  std::map<std::pair<uint32_t, bool>, uint32_t> texture_numbers_;
};

}  // namespace promin
