// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cli_fixture.h"
#include "image/channel_file.h"
#include "support/moving_gltf.h"

namespace promin {

/// A film of a bar. In a second, the bar moves from x = 0 to x = 8 in front of an orthographic camera of 16 x 1 units.
class BarFilmTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    GltfBuilder gltf;
    const size_t positions = gltf.add<float>({-1, -2, 0, 1, -2, 0, 1, 2, 0, -1, 2, 0}, "VEC3");
    const size_t triangles = gltf.add<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    gltf.json["materials"] = {
        {{"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}, {"doubleSided", true}}};
    gltf.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_animation_pointer"};
    gltf.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", triangles}, {"material", 0}}}}}};
    gltf.add_node({{"mesh", 0}});
    gltf.json["cameras"] = {
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 8}, {"ymag", 0.5}, {"znear", 0.1}, {"zfar", 9}}}}};
    gltf.add_node({{"camera", 0}, {"translation", {4, 0, 4}}});
    test::animate(gltf, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 8, 0, 0}, "VEC3");
    write("bar.gltf", gltf.text());
  }

  Image film(OptionValues more, const std::string& output) const {
    more.insert(more.begin(), {"bar.gltf", "--frames", "0", "--fps", "1", "--size", "64x4", "--background", "black",
                               "--exposure", "0", "--tone-mapping", "none"});
    return render(more, output);
  }

  /// Returns the bits of a channel, row by row.
  std::vector<uint32_t> read_channel(const std::string& file, const std::string& name) const {
    ChannelFile channels(folder() / file);
    const auto channel = std::ranges::find(channels.channels(), name, &FileChannel::name);
    if (channel == channels.channels().end()) {
      ADD_FAILURE() << "no channel " << name;
      return {};
    }
    channels.read_rows(0, channels.row_count());
    const uvec2 size = read_image(folder() / file).size;
    std::vector<uint32_t> bits(size_t{size.x} * size.y);
    for (size_t i = 0; i < bits.size(); ++i) bits[i] = channels.bits(*channel, i % size.x, i / size.x);
    return bits;
  }
};

}  // namespace promin
