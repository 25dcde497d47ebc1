// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/bvh_commands.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <filesystem>
#include <map>
#include <memory>

#include "bvh/find_tree_faults.h"
#include "bvh/read_node.h"
#include "core/file.h"
#include "core/stopwatch.h"
#include "device_scene/pack_scene.h"
#include "options/load_options.h"
#include "options/tracing_options.h"
#include "output/console.h"
#include "output/deferred_signals.h"
#include "output/outputs.h"
#include "output/progress.h"
#include "output/rows.h"
#include "output/work_names.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "work/pictures/load_posed.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace {

constexpr const char* kProgram = "promin-bvh";
constexpr uint32_t kMaxThreads = 1024;

struct BvhOptions {
  std::filesystem::path scene;
  LoadOptions load;
  MotionOptions motion;
  std::filesystem::path file;
  Instancing instances = Instancing::kAuto;
  std::string builder{builder_names().front()};
  /// Number of threads; 0 uses one thread per core.
  unsigned thread_count = 0;
  bool is_quiet = false;
  bool is_verbose = false;

  Verbosity verbosity() const { return verbosity_of(is_quiet, is_verbose); }
};

void add_scene_row(OptionTable& table, BvhOptions& options) {
  table.add_required("SCENE", "", "Scene file: .gltf, .glb, .obj, .ply, .stl or .nff",
                     [&](const OptionValues& w) { options.scene = w.text(); });
}

void add_file_row(OptionTable& table, BvhOptions& options) {
  table.add_required("FILE.pbvh", "", "BVH file that promin-bvh build has written",
                     [&](const OptionValues& w) { options.file = w.text(); });
}

void add_common_rows(OptionTable& table, BvhOptions& options) {
  add_strict_option(table, options.load);
  add_root_option(table, options.load);
  add_motion_options(table, options.motion);
  add_instances_option(table, options.instances);
  table.add("--threads", "N", fmt::format("Number of threads, 1 to {} [one per core]", kMaxThreads),
            [&](const OptionValues& w) { options.thread_count = w.whole(0, 1, kMaxThreads); });
  table.add_flag("--quiet", "Print only errors", options.is_quiet);
  table.add_flag("-v,--verbose", "Print each step and how long it takes", options.is_verbose);
}

Scene load(const BvhOptions& options, const Console& console) {
  const Stopwatch loading;
  check_motion_options(options.motion);
  std::vector<SourceFile> sources;
  Scene scene = load_posed(options.scene, options.load, options.motion, sources);
  for (const std::string& warning : scene.warnings) console.warn(options.scene.string() + ": " + warning);
  console.detail(fmt::format("loaded {}: {:.1f} ms", options.scene.string(), loading.ms()));
  return scene;
}

/// Returns the numbers of references and primitives of all trees.
std::string describe_references(std::span<const TreeView> trees) {
  size_t references = 0;
  size_t primitives = 0;
  for (const TreeView& tree : trees) {
    references += tree.references.size();
    primitives += tree.primitive_count;
  }
  return fmt::format("{} references to {} primitives", references, primitives);
}

void build(const BvhOptions& options) {
  if (lower_case_ending(options.file) != ".pbvh") {
    throw UsageError({"output.extension",
                      "the output's extension \"" + options.file.extension().string() + "\" is unknown",
                      options.file.string(), "use .pbvh"});
  }
  check_outputs({options.scene}, {options.file}, std::nullopt);
  const Console console(options.verbosity(), kProgram);
  const Scene scene = load(options, console);

  std::vector<GeometryTree> trees;
  const Stopwatch building;
  {
    Progress progress(console.is_quiet(), kProgram);
    trees = build_scene_trees(world::flatten(scene, world::Purpose::kHits, options.instances), options.builder,
                              {options.thread_count, progress.callback()});
  }
  const double build_ms = building.ms();
  std::vector<TreeView> views;
  for (const GeometryTree& tree : trees) {
    views.push_back(tree.view());
    console.detail(fmt::format("built {} nodes, depth {}, SAH cost {:.4g}", tree.stats.nodes, tree.stats.depth,
                               tree.stats.sah_cost));
  }

  const DeferredSignals while_writing;
  const Stopwatch writing;
  write_bvh_file(options.file, views);
  console.detail(fmt::format("wrote {}: {:.1f} ms", options.file.string(), writing.ms()));
  if (!console.is_quiet()) {
    const std::string cost = trees.size() > 1 ? fmt::format("in {} trees", trees.size())
                                              : fmt::format("SAH cost {:.4g}", trees.front().stats.sah_cost);
    fmt::print("{} by {}, {}, in {:.1f} ms: {}\n", describe_references(views), options.builder, cost, build_ms,
               options.file.string());
  }
}

/// Returns the numbers of leaves of each size.
std::string describe_leaf_sizes(const TreeView& tree) {
  std::map<uint32_t, uint64_t> counts;
  for (const layout::Node& node : tree.nodes) {
    for (uint32_t i = 0; i < layout::NODE_WIDTH; ++i) {
      const NodeChild child = child_of(node, i);
      if (child.kind == ChildKind::kLeaf) ++counts[child.count];
    }
  }
  std::vector<std::string> texts;
  for (const auto& [size, count] : counts) texts.push_back(fmt::format("{}: {}", size, count));
  return texts.empty() ? "none" : fmt::format("{}", fmt::join(texts, ", "));
}

std::string describe_memory(const TreeView& tree) {
  const auto per_primitive = [&](double bytes) { return bytes / std::max(1U, tree.primitive_count); };
  const auto nodes = static_cast<double>(tree.nodes.size_bytes());
  const double records =
      static_cast<double>(tree.references.size()) * (sizeof(layout::Primitive) + sizeof(layout::SurfaceRecord));
  return fmt::format("{:.1f} bytes per primitive on the device: {:.1f} of nodes, {:.1f} of the contents of leaves",
                     per_primitive(nodes + records), per_primitive(nodes), per_primitive(records));
}

void print_tree(const TreeView& tree) {
  print_row("builder", tree.stats.builder);
  print_row("primitives", std::to_string(tree.primitive_count));
  print_row("references",
            fmt::format("{} ({:.3f} a primitive)", tree.references.size(),
                        static_cast<double>(tree.references.size()) / std::max(1U, tree.primitive_count)));
  print_row("SAH cost", fmt::format("{:.6g}", tree.stats.sah_cost));
  print_row("depth", fmt::format("{}; the traversal stack takes {}", tree.stats.depth, tree.stack_size));
  print_row("nodes", fmt::format("{} of two children, {} of up to {} on the device",
                                 tree.stats.nodes - tree.stats.leaves, tree.nodes.size(), layout::NODE_WIDTH));
  print_row("leaves", fmt::format("{} (by size: {})", tree.stats.leaves, describe_leaf_sizes(tree)));
  print_row("memory", describe_memory(tree));
  print_row("geometry", fmt::format("{:016x}", tree.geometry_hash));
}

void print_bvh_info(const std::filesystem::path& path) {
  const BvhFile file(path);
  print_row("file", fmt::format("{}, {} bytes", path.string(), file.size_bytes()));
  const size_t count = file.trees().size();
  for (size_t i = 0; i < count; ++i) {
    // The trees of meshes that instances share follow the tree of all other primitives.
    if (count > 1) print_row("tree", i == 0 ? "of primitives without instances" : fmt::format("of mesh {}", i));
    print_tree(file.trees()[i]);
  }
}

void verify(const BvhOptions& options) {
  const Console console(options.verbosity(), kProgram);
  const Scene scene = load(options, console);
  const Stopwatch reading;
  const BvhFile file(options.file);
  console.detail(fmt::format("read {}: {:.1f} ms", options.file.string(), reading.ms()));
  TreeFaults faults;
  {
    Progress progress(console.is_quiet(), kProgram);
    faults = find_tree_faults(file, world::flatten(scene, world::Purpose::kHits, options.instances),
                              {options.thread_count, progress.callback()});
  }
  if (faults.count > 0) {
    throw InputError({"bvh.tree.wrong",
                      fmt::format("the tree is wrong in {} places, and the first is: {}", faults.count, faults.first),
                      options.file.string(), "build it again with promin-bvh build"});
  }
  if (console.is_quiet()) return;
  size_t nodes = 0;
  for (const TreeView& tree : file.trees()) nodes += tree.nodes.size();
  fmt::print("{} nodes, {}, no fault: {}\n", nodes, describe_references(file.trees()), options.file.string());
}

}  // namespace

Command add_build_command(CLI::App& program) {
  CLI::App& command = add_command(program, "build", "Build the BVH of a scene and write it to a file");
  const auto options = std::make_shared<BvhOptions>();
  OptionTable table(command);
  add_scene_row(table, *options);
  table.add_required("-o,--output", "FILE.pbvh", "BVH file to write",
                     [options](const OptionValues& w) { options->file = w.text(); });
  table.add("--builder", "NAME",
            fmt::format("BVH builder: {} [{}]", fmt::join(builder_names(), ", "), options->builder),
            [options](const OptionValues& w) { options->builder = w.choice(builder_names()); });
  add_common_rows(table, *options);
  return {&command, [options] { build(*options); }};
}

Command add_bvh_info_command(CLI::App& program) {
  CLI::App& command = add_command(program, "info", "Check a BVH file and describe its contents");
  const auto options = std::make_shared<BvhOptions>();
  OptionTable table(command);
  add_file_row(table, *options);
  return {&command, [options] { print_bvh_info(options->file); }};
}

Command add_verify_command(CLI::App& program) {
  CLI::App& command = add_command(
      program, "verify", "Check that a BVH file is complete and that its boxes contain the scene's primitives");
  const auto options = std::make_shared<BvhOptions>();
  OptionTable table(command);
  add_scene_row(table, *options);
  add_file_row(table, *options);
  add_common_rows(table, *options);
  return {&command, [options] { verify(*options); }};
}

}  // namespace promin::app
