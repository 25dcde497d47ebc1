// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/image_bytes.h"

#include <nlohmann/json.hpp>
#include <string>

#include "formats/gltf/buffers.h"

namespace promin {

using nlohmann::json;

void read_gltf_image(const GltfDocument& document, size_t index, PictureSource& source, LoadReport& report) {
  const json& image = document.json["images"][index];
  if (image.contains("bufferView")) {
    source.file = bytes_of_view(document, image["bufferView"]);
    return;
  }
  if (!image.contains("uri")) {
    source.problem = Fault{
        .code = "gltf.image.missing", .what = "an image has neither a uri nor a bufferView", .cure = "add one of them"};
    return;
  }
  const auto& uri = image["uri"].get_ref<const std::string&>();
  const std::string place = "images[" + std::to_string(index) + "].uri";
  read_picture(source, report, [&](LoadReport& attempt, uint64_t most_bytes) {
    return read_gltf_uri(uri, place, attempt, most_bytes);
  });
}

}  // namespace promin
