// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/tracing_options.h"

#include <fmt/ranges.h>

#include "options/arguments.h"
#include "options/load_options.h"
#include "promin/renderer.h"

namespace promin::app {
namespace {

constexpr uint32_t kMaxRepeats = 10000;
constexpr uint32_t kMaxThreads = 1024;

}  // namespace

void add_scene_argument(OptionTable& table, TracingOptions& options) {
  table.add_required("SCENE", "", "Scene file: .gltf, .glb, .obj, .ply, .stl or .nff",
                     [&](const OptionValues& w) { options.scene = w.text(); });
}

void add_device_option(OptionTable& table, std::optional<std::string>& device) {
  table.add(
      "--device", "NAME|INDEX",
      "Vulkan device: a part of its name, its index, or uuid: followed by its UUID. `promin devices --json` "
      "prints them",
      [&](const OptionValues& w) {
        if (w.text().empty())
          w.refuse("--device takes a part of a device's name, its index, or uuid: followed by its UUID, not \"\"");
        device = w.text();
      });
}

void add_instances_option(OptionTable& table, Instancing& instances) {
  table.add(
      "--instances", fmt::format("{}", fmt::join(instancing_names(), "|")),
      "Objects that share the triangles of their mesh: those that save much memory, no object, or all with meshes "
      "[auto]",
      [&](const OptionValues& w) { instances = w.name<Instancing>(instancing_names()); });
}

void add_tracing_options(OptionTable& table, TracingOptions& options) {
  add_device_option(table, options.device);
  table.add_flag("--no-cache", "Neither keep compiled kernels in ~/.cache/promin nor read them", options.has_no_cache);
  table.add("--threads", "N",
            fmt::format("Number of threads of the program and of a CPU device, 1 to {} [one per core]", kMaxThreads),
            [&](const OptionValues& w) { options.threads = w.whole(0, 1, kMaxThreads); });
  table.add("--builder", "NAME",
            fmt::format("BVH builder: {} [{}]", fmt::join(builder_names(), ", "), RendererOptions{}.builder),
            [&](const OptionValues& w) { options.builder = w.choice(builder_names()); });
  table.add("--bvh", "FILE.pbvh", "Read the BVH from a file that `promin-bvh build` wrote",
            [&](const OptionValues& w) { options.bvh = w.text(); });
  add_instances_option(table, options.instances);
  add_strict_option(table, options.load);
  add_root_option(table, options.load);
  add_motion_options(table, options.motion);
  table.add_flag("--quiet", "Print only errors", options.is_quiet);
  table.add_flag("-v,--verbose", "Print each step and how long it takes", options.is_verbose);
}

void add_measuring_options(OptionTable& table, TracingOptions& options) {
  table.add("--repeat", "N", "Trace N times and report the median time [1]",
            [&](const OptionValues& w) { options.repeat_count = w.whole(0, 1, kMaxRepeats); });
  table.add("--stats", "FILE.json", "Write counts and times as JSON",
            [&](const OptionValues& w) { options.stats = w.text(); });
}

}  // namespace promin::app
