// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// This program uses promin as a library. It makes a scene in memory, checks it, renders it, changes it, renders it
// again, and casts rays. It writes a picture to the file that the argument names, and catches a failure.
#include <cstdio>
#include <vector>

#include <promin/caster.h>
#include <promin/device.h>
#include <promin/framing.h>
#include <promin/renderer.h>
#include <promin/validate.h>

int main(int argument_count, char** arguments) {
  promin::Mesh floor;
  floor.positions = {{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}};
  floor.triangles = {{0, 2, 1}, {0, 3, 2}};
  promin::Scene scene;
  scene.materials.resize(1);
  scene.add("floor", floor);
  scene.add("ball", promin::Sphere{{0, 1, 0}, 1.0});
  promin::Light light;
  light.position = {3, 5, 2};
  scene.lights.push_back(light);
  for (const promin::Problem& problem : promin::validate(scene)) std::puts(problem.sentence().c_str());

  const promin::gpu::DeviceHandle device = promin::gpu::open_device();
  promin::Renderer renderer(*device, scene);
  promin::View view;
  view.camera = promin::frame_scene(scene, 1.0F);
  view.size = {64, 64};
  const promin::RenderResult before = renderer.render(view);

  const promin::WorkDone done = renderer.work_done();
  scene.lights[0].position = {-3, 5, 2};
  renderer.set_lights(scene.lights);
  const promin::RenderResult after = renderer.render(view);
  const promin::WorkDone now = renderer.work_done();
  const bool is_rebuilt = now.trees_built != done.trees_built ||
                          now.geometry_bytes_uploaded != done.geometry_bytes_uploaded ||
                          now.pipelines_compiled != done.pipelines_compiled;

  promin::Caster caster(*device, scene);
  const std::vector<promin::Ray> rays = {{{0, 5, 0}, 0, {0, -1, 0}}};
  std::vector<promin::Hit> hits(rays.size());
  caster.cast(rays, hits);
  // This ray goes through the ball and the edge that the floor's triangles share.
  std::vector<int32_t> counts(rays.size());
  caster.count(rays, counts);
  size_t listed = 0;
  caster.list(rays, [&](const promin::HitList& list) { listed += list.hits.size(); });

  // The plugin writes pictures. The library must find it wherever this program lies.
  if (argument_count > 1) promin::write_image(arguments[1], after.image);
  const bool is_written = argument_count < 2 || promin::read_image(arguments[1]).size == view.size;

  // The program can catch a failure of the library by its type.
  bool is_caught = false;
  view.size = {0, 0};
  try {
    renderer.render(view);
  } catch (const promin::UsageError& error) {
    is_caught = error.problems().size() == 1;
  }

  const bool is_right = !is_rebuilt && is_written && is_caught && before.image.pixels != after.image.pixels &&
                        hits[0].object == 1 && hits[0].t == 3.0F && counts[0] == 3 && listed == 3;
  std::puts(is_right ? "the library works" : "the library does not do what it says");
  return is_right ? 0 : 1;
}
