// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/film.h"

#include <gtest/gtest.h>

#include "device/device.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

class FilmTest : public test::DeviceTest {};

// A driver may return memory that still has its old content. If a kernel read numbers from this memory, the loop that
// checks loops could run up to 2^32 times. A driver that ends loops would then report cut loops. With another driver
// the device would be busy for a minute.
TEST_F(FilmTest, WarmsUpWhateverItsMemoryHeld) {
  const world::Scene scene = test::make_scene_of_everything();
  const PackedScene packed = pack_scene(scene, "sah");
  Film film(device(),
            upload_scene(device(), packed, {scene.materials, scene.textures, scene.lights, scene.environment}),
            features_of(scene));
  film.reserve(64);
  device().run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(*film.buffer().handle(), 0, VK_WHOLE_SIZE, ~0U);
  });
  film.warm_up();
  EXPECT_FALSE(film.take_counts().has_cut_loops);
}

}  // namespace
}  // namespace promin
