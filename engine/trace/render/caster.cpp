// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/caster.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <optional>
#include <ranges>
#include <tuple>
#include <vector>

#include "core/parallel.h"
#include "core/shared_progress.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "promin/validate.h"
#include "rays/ray_order.h"
#include "rays/ray_tiles.h"
#include "scene/features.h"
#include "trace/kernels/ray_kernel.h"
#include "trace/render/caster_access.h"
#include "trace/render/copied_hits.h"
#include "trace/render/move_instances.h"

namespace promin {
namespace {

using layout::HitRecord;
using layout::RayRecord;

/// The smallest number of rays for which a thread is worth its cost.
constexpr size_t kRaysOfThread = 16384;
/// Number of rays by which prefetching is ahead. In a scattered order, waiting for memory takes longer than everything
/// else.
constexpr size_t kFetchedAhead = 32;

/// Rays in the order in which they are traced.
struct OrderedRays {
  std::span<const Ray> rays;
  /// The indices of the rays in the order of tracing; empty if they are traced in the given order.
  std::span<const uint32_t> permutation;

  /// Returns the index of the i-th ray to trace.
  size_t place_of(size_t i) const { return permutation.empty() ? i : permutation[i]; }
  /// Calls fetch(place) for a ray some places after ray i.
  template <typename Fetch>
  void fetch_ahead(size_t i, const Fetch& fetch) const {
    if (i + kFetchedAhead < permutation.size()) fetch(permutation[i + kFetchedAhead]);
  }
};

/// Returns a callback that converts the progress of `count` rays from `first` on to a fraction of all rays.
ProgressCallback part_of(const ProgressCallback& progress, size_t first, size_t count, size_t all) {
  if (!progress) return {};
  return [&progress, first, count, all](double fraction) {
    return progress((static_cast<double>(first) + fraction * static_cast<double>(count)) / static_cast<double>(all));
  };
}

/// Returns a power of two that scales the direction into the shader's range (shaders/trace/make_ray.glsl); usually it
/// is 1.
float scale_of(const vec3& direction) {
  // The code uses neither max_abs_component nor glm::abs: the calls of std::fmax in the first took a seventh of the
  // time of `promin cast`, and the second is compiled to a branch for each sign, which the processor cannot predict.
  const float size = std::max(std::max(std::fabs(direction.x), std::fabs(direction.y)), std::fabs(direction.z));
  if (size > 0.0F && size < 0x1p-126F) return 0x1p64F;
  if (size >= 0x1p127F && std::isfinite(size)) return 0x1p-64F;
  return 1.0F;
}

RayRecord record_of(const Ray& ray, float scale) {
  // The product tmin * direction does not change. The scaled tmin may round to 0 here; hit_of() then decides.
  return {vec4(ray.origin, ray.tmin / scale), vec4(ray.direction * scale, ray.tmax / scale)};
}

/// Fills the ray records, in the order of tracing, on all cores. Returns whether the direction of any ray is scaled.
bool fill_requests(const OrderedRays& ordered, std::span<RayRecord> requests) {
  std::atomic<bool> is_any_scaled = false;
  for_each_chunk(requests.size(), kRaysOfThread, 0, [&](size_t begin, size_t end) {
    bool is_scaled = false;
    for (size_t i = begin; i < end; ++i) {
      ordered.fetch_ahead(i, [&](size_t place) { __builtin_prefetch(&ordered.rays[place]); });
      const Ray& ray = ordered.rays[ordered.place_of(i)];
      const float scale = scale_of(ray.direction);
      is_scaled = is_scaled || scale != 1.0F;
      requests[i] = record_of(ray, scale);
    }
    if (is_scaled) is_any_scaled = true;
  });
  return is_any_scaled;
}

[[noreturn]] void throw_too_many(const world::Scene& scene) {
  throw RunError({"scene.size.limit", "the instances of the scene have more primitives than there are numbers for hits",
                  scene.file.string(), "use fewer, because hits have numbers below 4294967295"});
}

Hit hit_at(float t, const HitRecord& record, const PrimitiveNumbers& numbers) {
  const PrimitiveId id = primitive_of_order(numbers, record.a.y);
  Hit hit;
  hit.t = t;
  hit.object = static_cast<int32_t>(id.object);
  hit.primitive = static_cast<int32_t>(id.primitive);
  const vec2 weights(std::bit_cast<float>(record.a.z), std::bit_cast<float>(record.a.w));
  const vec2 of_triangle = weights_of_triangle(numbers, record.a.y, id.object, weights);
  hit.u = of_triangle.x;
  hit.v = of_triangle.y;
  hit.normal = {std::bit_cast<float>(record.b.x), std::bit_cast<float>(record.b.y), std::bit_cast<float>(record.b.z)};
  return hit;
}

/// Returns the hit of a record. `scaled` is the ray, or null if its direction is not scaled. Without scaling, the
/// device has compared t with the given tmin and tmax.
Hit hit_of(const HitRecord& record, const Ray* scaled, HitQuery query, const PrimitiveNumbers& numbers) {
  Hit hit;
  if (record.a.y == layout::NO_ORDER) return hit;
  if (query == HitQuery::kAny) {
    hit.t = 0.0F;
    return hit;
  }
  auto t = std::bit_cast<float>(record.a.x);
  if (scaled != nullptr) {
    t *= scale_of(scaled->direction);
    if (!(t > scaled->tmin && t < scaled->tmax)) return hit;
  }
  return hit_at(t, record, numbers);
}

/// Sorts a ray's crossings from the device into the order of hits. Returns the number of crossings that remain, at the
/// front. A primitive that the tree references twice may occur twice, and some crossings have no t in the given units;
/// both are dropped.
size_t sort_crossings(std::span<HitRecord> crossings, const Ray& ray) {
  const float scale = scale_of(ray.direction);
  const auto t_of = [](const HitRecord& crossing) { return std::bit_cast<float>(crossing.a.x); };
  size_t count = crossings.size();
  if (scale != 1.0F) {
    for (HitRecord& crossing : crossings) crossing.a.x = std::bit_cast<uint32_t>(t_of(crossing) * scale);
    const auto end = std::remove_if(crossings.begin(), crossings.end(), [&](const HitRecord& crossing) {
      return !(t_of(crossing) > ray.tmin && t_of(crossing) < ray.tmax);
    });
    count = static_cast<size_t>(end - crossings.begin());
  }
  // A solid has two crossings, which may have the same t. The entry comes first.
  const auto key_of = [&](const HitRecord& crossing) { return std::tuple(t_of(crossing), crossing.a.y, crossing.b.w); };
  const auto end = crossings.begin() + static_cast<ptrdiff_t>(count);
  std::sort(crossings.begin(), end, [&](const HitRecord& a, const HitRecord& b) { return key_of(a) < key_of(b); });
  const auto is_same = [&](const HitRecord& a, const HitRecord& b) { return key_of(a) == key_of(b); };
  return static_cast<size_t>(std::unique(crossings.begin(), end, is_same) - crossings.begin());
}

}  // namespace

// This struct is hidden, although the class around it is not (promin/export.h).
struct __attribute__((visibility("hidden"))) Caster::Impl {
  Impl(const gpu::Device& the_device, const SceneToPack& the_scene, const TunedCasterOptions& options)
      : device(the_device),
        spirv(options.spirv.begin(), options.spirv.end()),
        builder(options.builder),
        instancing(options.instances),
        material_count(the_scene->materials.size()) {
    PackedScene packed = pack_scene_by(options, the_scene);
    if (packed.numbers.are_instances_whole) throw_too_many(*the_scene);
    the_scene.free_geometry();
    stats.warnings = packed.warnings;
    const Stopwatch uploading;
    scene = upload_scene(device, packed);
    stats.upload_ms = uploading.ms();
    take(packed);
  }

  /// Takes the host's data of a packed scene that has been uploaded.
  void take(PackedScene& packed) {
    stats.bvh = packed.bvh;
    stats.bvh_ms = packed.bvh_ms;
    stats.device_bytes = scene->size_bytes();
    stats.degenerate_triangles = packed.degenerate_count;
    features |= packed.features.common_with(primitive_features());
    stats.features = feature_names(features);
    numbers = std::move(packed.numbers);
    // The device has the data of instances. They are restored when they move. A copy of the packed scene still needs
    // them.
    if (packed.upper.use_count() == 1) packed.upper->forget();
    upper = std::move(packed.upper);
    copies = CopiedHits(packed.copies, numbers);
    cube = cube_of(packed.tree_bounds);
    // The tree refers to each primitive at least once.
    repeats_primitives = packed.references.size() > packed.bounded_count;
  }

  void set_pose(const world::Scene& posed) {
    const uint64_t version = scene->version();
    if (!posed.instances.empty() && move_to_pose(posed, copies.empty(), instanced_hash, numbers, upper, *scene, {})) {
      return take_move(version);
    }
    const FeatureMask features_before = features;
    PackedScene packed = posed.instances.empty() ? pack_pose(posed, builder, TreeOfPose::kRefitted, kept_tree)
                                                 : pack_scene(posed, builder);
    if (packed.numbers.are_instances_whole) throw_too_many(posed);
    packed.stack_size = std::max(packed.stack_size, scene->stack_size());
    const Stopwatch uploading;
    const bool has_space = scene->has_space_for(packed);
    if (has_space) {
      scene->set_geometry(packed, {});
    } else {
      scene = upload_scene(device, packed);
    }
    stats.upload_ms = uploading.ms();
    take(packed);
    update_kernels(!has_space || scene->version() != version || features != features_before);
  }

  static SceneCube cube_of(const vec4& tree_bounds) { return {vec3(tree_bounds), tree_bounds.w}; }

  void set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object) {
    const uint64_t version = scene->version();
    move_instances(world_from_object, numbers, upper, *scene);
    take_move(version);
  }

  /// Updates what depends on the upper level. `version` is that of the scene before the move.
  void take_move(uint64_t version) {
    cube = cube_of(scene->constants().tree_bounds);
    update_kernels(scene->version() != version);
  }

  /// Updates the kernels after the scene has changed.
  void update_kernels(bool must_bind) {
    for (std::optional<RayKernel>& kernel : kernels | std::views::join) {
      if (!kernel) continue;
      if (must_bind) {
        // It is made again when it is needed.
        kernel.reset();
      } else {
        kernel->take_constants();
      }
    }
  }

  enum class Order { kAsGiven, kInPackets, kSorted };
  /// Returns the order of tracing. If a tree references primitives more than once, a packet can test a primitive more
  /// often than each of its rays alone would, and the counts of the first pass would not match. Such trees are traced
  /// ray by ray.
  Order order_for(HitQuery query, std::span<const Ray> rays) const {
    const bool takes_packets = device.profile().ray_packet_size > 1;
    const bool sorts_rays = device.profile().sorts_rays;
    if (!takes_packets && !sorts_rays) return Order::kAsGiven;
    if (!are_side_by_side(rays, cube)) return sorts_rays ? Order::kSorted : Order::kAsGiven;
    const bool goes_alone = asks_for_crossings(query) && repeats_primitives;
    return takes_packets && !goes_alone ? Order::kInPackets : Order::kAsGiven;
  }

  OrderedRays put_in_order(std::span<const Ray> rays, Order order) {
    if (order == Order::kInPackets) return {rays, tiler.tile(rays, cube)};
    if (order == Order::kSorted) return {rays, sorter.sort(rays, cube)};
    return {rays, {}};
  }

  RayKernel& kernel_for(HitQuery query, Order order) {
    const bool is_packet = order == Order::kInPackets;
    std::optional<RayKernel>& kernel = kernels[static_cast<size_t>(query)][is_packet ? 1 : 0];
    if (!kernel) {
      RayKernelOptions options;
      options.features = features;
      options.query = query;
      options.packet_size = is_packet ? device.profile().ray_packet_size : 1;
      if (!asks_for_crossings(query)) options.spirv = spirv;
      kernel.emplace(device, scene, options);
      stats.pipeline_ms += kernel->pipeline_ms();
    }
    return *kernel;
  }

  /// Traces at most RayKernel::kMaxRays rays, for every query except kAll. `make` computes each answer, on all cores,
  /// from the ray's record and the ray. The ray is null if no direction is scaled.
  template <typename Answer, typename Make>
  double trace(std::span<const Ray> rays, std::span<Answer> answers, HitQuery query, Order order,
               const ProgressCallback& progress, const Make& make) {
    const Stopwatch ordering;
    const OrderedRays ordered = put_in_order(rays, order);
    const double ordering_ms = ordering.ms();
    bool is_any_scaled = false;
    const auto fill = [&](std::span<RayRecord> asked) { is_any_scaled = fill_requests(ordered, asked); };
    const auto take = [&](std::span<const HitRecord> told) {
      for_each_chunk(told.size(), kRaysOfThread, 0, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
          ordered.fetch_ahead(i, [&](size_t place) { __builtin_prefetch(&answers[place], 1); });
          const size_t place = ordered.place_of(i);
          answers[place] = make(told[i], is_any_scaled ? &rays[place] : nullptr);
        }
      });
    };
    return ordering_ms + kernel_for(query, order).run(rays.size(), fill, take, progress);
  }

  /// Traces any number of rays in the same way.
  template <typename Answer, typename Make>
  double trace_all(std::span<const Ray> rays, std::span<Answer> answers, HitQuery query,
                   const ProgressCallback& progress, const Make& make) {
    double time_ms = 0.0;
    for (size_t first = 0; first < rays.size(); first += RayKernel::kMaxRays) {
      const size_t count = std::min(RayKernel::kMaxRays, rays.size() - first);
      const std::span<const Ray> part = rays.subspan(first, count);
      time_ms += trace(part, answers.subspan(first, count), query, order_for(query, part),
                       part_of(progress, first, count, rays.size()), make);
      tell_progress(progress, static_cast<double>(first + count) / static_cast<double>(rays.size()));
    }
    return time_ms;
  }

  /// Returns whether counts must be computed from lists, because the device counts crossings that sort_crossings drops.
  bool counts_by_lists(std::span<const Ray> rays) const {
    if (repeats_primitives || !copies.empty()) return true;
    std::atomic<bool> is_any_scaled = false;
    for_each_chunk(rays.size(), kRaysOfThread, 0, [&](size_t begin, size_t end) {
      const auto part = rays.subspan(begin, end - begin);
      if (!is_any_scaled && std::ranges::any_of(part, [](const Ray& ray) { return scale_of(ray.direction) != 1.0F; })) {
        is_any_scaled = true;
      }
    });
    return is_any_scaled;
  }

  /// Fills list_offsets and list_hits for rays with these counts. All of their hits must fit.
  double list(std::span<const Ray> rays, std::span<const uint32_t> counts, Order order,
              const ProgressCallback& progress) {
    const Stopwatch ordering;
    // Rays without crossings are not traced again.
    asked_rays.clear();
    asked_places.clear();
    uint64_t total = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      if (counts[i] == 0) continue;
      asked_rays.push_back(rays[i]);
      asked_places.push_back(static_cast<uint32_t>(i));
      total += counts[i];
    }
    const OrderedRays ordered = put_in_order(asked_rays, order);
    double time_ms = ordering.ms();
    requests.resize(asked_rays.size());
    fill_requests(ordered, requests);
    asked_counts.resize(asked_rays.size());
    first_records.resize(asked_rays.size());
    records.resize(total);
    for (size_t i = 0, first = 0; i < asked_rays.size(); ++i) {
      const size_t place = ordered.place_of(i);
      asked_counts[i] = counts[asked_places[place]];
      first_records[place] = first;
      first += asked_counts[i];
    }
    if (!asked_rays.empty()) {
      time_ms += kernel_for(HitQuery::kAll, order).list(requests, asked_counts, records, progress);
    }

    const Stopwatch finishing;
    const auto crossings_of = [&](size_t i) {
      return std::span(records).subspan(first_records[i], counts[asked_places[i]]);
    };
    constexpr size_t kChunkSize = 4096;
    kept_counts.resize(asked_rays.size());
    for_each_chunk(asked_rays.size(), kChunkSize, 0, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        kept_counts[i] = static_cast<uint32_t>(sort_crossings(crossings_of(i), asked_rays[i]));
      }
    });
    list_offsets.assign(rays.size() + 1, 0);
    for (size_t i = 0; i < asked_rays.size(); ++i) list_offsets[asked_places[i] + 1] = kept_counts[i];
    for (size_t i = 0; i < rays.size(); ++i) list_offsets[i + 1] += list_offsets[i];
    list_hits.resize(list_offsets.back());
    for_each_chunk(asked_rays.size(), kChunkSize, 0, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const std::span<const HitRecord> crossings = crossings_of(i).first(kept_counts[i]);
        const auto first = static_cast<size_t>(list_offsets[asked_places[i]]);
        for (size_t k = 0; k < crossings.size(); ++k) {
          list_hits[first + k] = hit_at(std::bit_cast<float>(crossings[k].a.x), crossings[k], numbers);
        }
      }
    });
    return time_ms + finishing.ms();
  }

  const gpu::Device& device;
  /// A copy of the SPIR-V, because kernels are compiled when they are needed.
  std::vector<uint32_t> spirv;
  std::shared_ptr<DeviceScene> scene;
  PrimitiveNumbers numbers;
  std::shared_ptr<const UpperLevel> upper;
  std::string builder;
  Instancing instancing;
  size_t material_count;
  /// The hash of a scene with instances (hash_instanced), if it is known.
  std::optional<uint64_t> instanced_hash;
  /// The tree for other poses.
  KeptTree kept_tree;
  CopiedHits copies;
  FeatureMask features;
  SetupStats stats;
  SceneCube cube;
  /// True if a ray may cross a primitive twice in the tree.
  bool repeats_primitives = false;
  /// The kernels, indexed by HitQuery, and by whether they trace packets.
  std::array<std::array<std::optional<RayKernel>, 2>, 4> kernels;
  RaySorter sorter;
  RayTiler tiler;
  /// Buffers of lists. `requests` and `records` are the current rays, in the order of tracing, and their records.
  /// `chunk_counts` are the device's counts for a chunk of rays. `asked_rays` are the rays of the current part that
  /// cross something, `asked_places` their places in the part, and `asked_counts` their numbers of crossings in the
  /// order of tracing. `first_records` are the places in `records` where their crossings begin, and `kept_counts` the
  /// numbers that are kept. The sink receives `list_offsets` and `list_hits`.
  std::vector<RayRecord> requests;
  std::vector<HitRecord> records;
  std::vector<uint32_t> chunk_counts;
  std::vector<Ray> asked_rays;
  std::vector<uint32_t> asked_places;
  std::vector<uint32_t> asked_counts;
  std::vector<size_t> first_records;
  std::vector<uint32_t> kept_counts;
  std::vector<uint64_t> list_offsets;
  UnsetVector<Hit> list_hits;
};

Caster::Caster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Caster::Caster(const gpu::Device& device, const Scene& scene, const CasterOptions& options) {
  throw_if_invalid(scene);
  impl_ = std::make_unique<Impl>(device, world::flatten(scene, world::Purpose::kHits, options.instances),
                                 TunedCasterOptions{options, {}});
}
Caster::~Caster() = default;
Caster::Caster(Caster&&) noexcept = default;
Caster& Caster::operator=(Caster&&) noexcept = default;

void Caster::prepare(HitQuery query, std::span<const Ray> rays) {
  const Impl::Order order = impl_->order_for(query, rays);
  if (!asks_for_crossings(query)) {
    impl_->kernel_for(query, order);
    return;
  }
  // Lists need counts, and some counts need lists.
  impl_->kernel_for(HitQuery::kCount, order);
  if (query == HitQuery::kAll || impl_->counts_by_lists(rays)) impl_->kernel_for(HitQuery::kAll, order);
}

double Caster::cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query, const ProgressCallback& progress) {
  if (rays.size() != hits.size()) {
    throw UsageError(
        {"rays.results",
         "the call gives " + std::to_string(hits.size()) + " hits for " + std::to_string(rays.size()) + " rays",
         "Caster::cast", "give as many hits as rays"});
  }
  if (query != HitQuery::kNearest && query != HitQuery::kAny) {
    throw UsageError({"rays.query", "cast() returns one hit per ray, neither a count nor a list", "Caster::cast",
                      "call Caster::count or Caster::list"});
  }
  return impl_->trace_all(rays, hits, query, progress, [&](const HitRecord& record, const Ray* scaled) {
    return hit_of(record, scaled, query, impl_->numbers);
  });
}

double Caster::occluded(std::span<const Ray> rays, std::span<bool> are_occluded, const ProgressCallback& progress) {
  if (rays.size() != are_occluded.size()) {
    throw UsageError({"rays.results",
                      "the call gives " + std::to_string(are_occluded.size()) + " results for " +
                          std::to_string(rays.size()) + " rays",
                      "Caster::occluded", "give as many results as rays"});
  }
  return impl_->trace_all(rays, are_occluded, HitQuery::kAny, progress,
                          [](const HitRecord& record, const Ray*) { return record.a.y != layout::NO_ORDER; });
}

double Caster::count(std::span<const Ray> rays, std::span<int32_t> counts, const ProgressCallback& progress) {
  if (rays.size() != counts.size()) {
    throw UsageError(
        {"rays.results",
         "the call gives " + std::to_string(counts.size()) + " counts for " + std::to_string(rays.size()) + " rays",
         "Caster::count", "give as many counts as rays"});
  }
  if (impl_->counts_by_lists(rays)) {
    const auto take = [&](const HitList& list) {
      for (size_t i = 0; i + 1 < list.offsets.size(); ++i) {
        counts[list.first_ray + i] = static_cast<int32_t>(list.offsets[i + 1] - list.offsets[i]);
      }
    };
    return list(rays, take, kListBytes, progress);
  }
  // No ray has 2^31 crossings, because a scene has fewer than 2^27 primitives, so the conversion is safe.
  return impl_->trace_all(rays, counts, HitQuery::kCount, progress,
                          [](const HitRecord& record, const Ray*) { return static_cast<int32_t>(record.a.x); });
}

double Caster::list(std::span<const Ray> rays, const HitListSink& sink, uint64_t budget_bytes,
                    const ProgressCallback& progress) {
  double time_ms = 0.0;
  for (size_t first = 0; first < rays.size(); first += RayKernel::kMaxRays) {
    const std::span<const Ray> chunk = rays.subspan(first, std::min(RayKernel::kMaxRays, rays.size() - first));
    std::vector<uint32_t>& counts = impl_->chunk_counts;
    counts.resize(chunk.size());
    const Impl::Order order = impl_->order_for(HitQuery::kAll, chunk);
    // No new progress is reported between these dispatches. The callback only decides whether to continue.
    time_ms += impl_->trace(chunk, std::span(counts), HitQuery::kCount, order, part_of(progress, first, 0, rays.size()),
                            [](const HitRecord& record, const Ray*) { return record.a.x; });
    // The number of rays that are listed together also depends on the device.
    const uint64_t most_listed = impl_->kernel_for(HitQuery::kAll, order).most_listed(chunk.size());
    const uint64_t most = std::min(budget_bytes / sizeof(Hit), most_listed);
    for (size_t begin = 0; begin < chunk.size();) {
      uint64_t total = counts[begin];
      size_t end = begin + 1;
      while (end < chunk.size() && total + counts[end] <= most) total += counts[end++];
      if (total > most_listed) {
        throw RunError({"rays.hits.many",
                        "the ray has " + std::to_string(total) + " hits, and a buffer of the device holds " +
                            std::to_string(most_listed),
                        "ray " + std::to_string(first + begin), "divide the ray into parts by tmin and tmax"});
      }
      time_ms += impl_->list(chunk.subspan(begin, end - begin), std::span(counts).subspan(begin, end - begin), order,
                             part_of(progress, first + begin, 0, rays.size()));
      const HitList list{first + begin, impl_->list_offsets, impl_->list_hits};
      if (impl_->copies.empty()) {
        sink(list);
      } else {
        impl_->copies.list(list, sink, budget_bytes);
      }
      tell_progress(progress, static_cast<double>(first + end) / static_cast<double>(rays.size()));
      begin = end;
    }
  }
  return time_ms;
}

void Caster::set_pose(const Scene& posed) {
  throw_if_invalid(posed);
  check_same_scene(posed, impl_->numbers.first_order.size() - 1, impl_->material_count);
  gpu::translate_vulkan_errors(
      [&] { impl_->set_pose(world::flatten(posed, world::Purpose::kHits, impl_->instancing)); });
}

void Caster::set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object) {
  gpu::translate_vulkan_errors([&] { impl_->set_transforms(world_from_object); });
}

Caster CasterAccess::make(const gpu::Device& device, const SceneToPack& scene, const TunedCasterOptions& options) {
  return Caster(std::make_unique<Caster::Impl>(device, scene, options));
}

const SetupStats& Caster::setup_stats() const {
  return impl_->stats;
}

}  // namespace promin
