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

/// The pictures that materials of MTL files name, each once for each use.
class ObjTextures {
 public:
  /// Decodes the pictures of all maps of the materials on all cores. Maps of what cannot be decoded are warned about
  /// and marked as not usable.
  ObjTextures(const std::vector<MtlMaterial*>& materials, LoadReport& report);

  /// The slot of a map that is usable; an empty one for nullptr.
  TextureSlot read_slot(const MtlMap* map, ImageUse use);

  /// The slot of a picture of colours with the alpha of another: its alpha where it has any, else its red. White where
  /// there is none of colours; an empty slot where both are nullptr. One file for both has what it needs.
  TextureSlot read_base_color(const MtlMap* color, const MtlMap* alpha);

  /// The slot of a picture with roughness in green and metallic in blue, made of a map of each; full where one is
  /// nullptr, and an empty slot where both are.
  TextureSlot read_metallic_roughness(const MtlMap* roughness, const MtlMap* metallic);

  /// The slot of the normals that a map of heights gives (formats/obj/heights.h), or of those that its picture holds in
  /// truth, with a warning. An empty one for nullptr, and where there are no slopes.
  TextureSlot read_heights(const MtlMap* map);

  /// Hands over the images and textures of the slots.
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
  /// Indices of images_, by the pictures that they are made of.
  std::map<std::pair<ImagePointer, ImagePointer>, uint32_t> image_numbers_;
  /// Indices of images_ of normals, by the picture of heights and the fields of HeightMap; a height of 0 is that of a
  /// picture that holds normals itself.
  std::map<std::tuple<ImagePointer, double, double, int, bool>, uint32_t> height_numbers_;
  /// Indices of textures_, by image and whether it is clamped.
  std::map<std::pair<uint32_t, bool>, uint32_t> texture_numbers_;
};

}  // namespace promin
