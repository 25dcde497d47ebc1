// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/embree.h"

#if PROMIN_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "promin/error.h"

namespace promin::measure {
namespace {

/// The number of rays that a thread takes at a time.
constexpr size_t kChunkRays = 4096;
constexpr size_t kPacketRays = 8;

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using BuiltScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;

Device open_embree() {
  Device device(rtcNewDevice(nullptr));
  if (!device) throw RunError({"embree.start", "Embree does not start", "rtcNewDevice", "look for its requirements"});
  return device;
}

RTCRay ray_of(const Ray& ray) {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.tnear = std::max(ray.tmin, 0.0F);
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tfar = ray.tmax;
  result.mask = ~0U;
  return result;
}

/// The functions of Embree 3 and 4 take different arguments besides the rays.
#if PROMIN_EMBREE_MAJOR >= 4
struct Calls {
  RTCIntersectArguments intersect_arguments;
  RTCOccludedArguments occluded_arguments;
  explicit Calls(bool is_coherent) {
    rtcInitIntersectArguments(&intersect_arguments);
    rtcInitOccludedArguments(&occluded_arguments);
    if (!is_coherent) return;
    intersect_arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    occluded_arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_arguments); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_arguments); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &intersect_arguments);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &rays, &occluded_arguments);
  }
};
#else
struct Calls {
  RTCIntersectContext context;
  explicit Calls(bool is_coherent) {
    rtcInitIntersectContext(&context);
    if (is_coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context, &rays); }
  void occluded(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &context, &rays); }
};
#endif

Hit occlusion_of(float tfar) {
  Hit hit;
  if (tfar < 0.0F) hit.t = 0.0F;
  return hit;
}

/// Returns the object of a hit: an instance, or a geometry that is no instance.
int32_t object_of(unsigned geometry, unsigned instance) {
  return static_cast<int32_t>(instance == RTC_INVALID_GEOMETRY_ID ? geometry : instance);
}

void cast_singly(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits, HitQuery query) {
  Calls calls(false);
  for (size_t i = 0; i < rays.size(); ++i) {
    RTCRayHit request{};
    request.ray = ray_of(rays[i]);
    if (query == HitQuery::kAny) {
      calls.occluded(scene, request.ray);
      hits[i] = occlusion_of(request.ray.tfar);
      continue;
    }
    request.hit.geomID = request.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    calls.intersect(scene, request);
    hits[i] = {};
    if (request.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    hits[i] = {request.ray.tfar,
               object_of(request.hit.geomID, request.hit.instID[0]),
               static_cast<int32_t>(request.hit.primID),
               request.hit.u,
               request.hit.v,
               {request.hit.Ng_x, request.hit.Ng_y, request.hit.Ng_z}};
  }
}

void cast_packets(RTCScene scene, std::span<const Ray> rays, std::span<Hit> hits, HitQuery query, bool is_coherent) {
  Calls calls(is_coherent);
  for (size_t first = 0; first < rays.size(); first += kPacketRays) {
    const size_t count = std::min(kPacketRays, rays.size() - first);
    alignas(32) std::array<int, kPacketRays> valid{};
    RTCRayHit8 request{};
    for (size_t i = 0; i < count; ++i) {
      const RTCRay ray = ray_of(rays[first + i]);
      valid[i] = -1;
      request.ray.org_x[i] = ray.org_x;
      request.ray.org_y[i] = ray.org_y;
      request.ray.org_z[i] = ray.org_z;
      request.ray.tnear[i] = ray.tnear;
      request.ray.dir_x[i] = ray.dir_x;
      request.ray.dir_y[i] = ray.dir_y;
      request.ray.dir_z[i] = ray.dir_z;
      request.ray.tfar[i] = ray.tfar;
      request.ray.mask[i] = ray.mask;
      request.hit.geomID[i] = request.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (query == HitQuery::kAny) {
      calls.occluded(valid.data(), scene, request.ray);
      for (size_t i = 0; i < count; ++i) hits[first + i] = occlusion_of(request.ray.tfar[i]);
      continue;
    }
    calls.intersect(valid.data(), scene, request);
    for (size_t i = 0; i < count; ++i) {
      hits[first + i] = {};
      if (request.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hits[first + i] = {request.ray.tfar[i],
                         object_of(request.hit.geomID[i], request.hit.instID[0][i]),
                         static_cast<int32_t>(request.hit.primID[i]),
                         request.hit.u[i],
                         request.hit.v[i],
                         {request.hit.Ng_x[i], request.hit.Ng_y[i], request.hit.Ng_z[i]}};
    }
  }
}

class Caster final : public EmbreeCaster {
 public:
  explicit Caster(const world::Scene& scene) : source_(scene), device_(open_embree()) {
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* bytes, ssize_t change, bool /*post*/) {
          static_cast<std::atomic<int64_t>*>(bytes)->fetch_add(change);
          return true;
        },
        &bytes_);
    scene_ = fill_scene();
    rtcCommitScene(scene_.get());
    check();
  }

  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query, EmbreeCall call) override {
    const bool is_coherent = query == HitQuery::kAny || has_common_origin(rays);
    const Stopwatch casting;
    for_each_index((rays.size() + kChunkRays - 1) / kChunkRays, 0, [&](size_t chunk) {
      const size_t first = chunk * kChunkRays;
      const size_t count = std::min(kChunkRays, rays.size() - first);
      if (call == EmbreeCall::kSingle) {
        cast_singly(scene_.get(), rays.subspan(first, count), hits.subspan(first, count), query);
      } else {
        cast_packets(scene_.get(), rays.subspan(first, count), hits.subspan(first, count), query, is_coherent);
      }
    });
    return casting.ms();
  }

  double time_build() override {
    commit_ms_ = 0.0;
    const BuiltScene scene = fill_scene();
    const Stopwatch building;
    rtcCommitScene(scene.get());
    const double time_ms = building.ms();
    check();
    return commit_ms_ + time_ms;
  }

  int64_t size_bytes() const override { return bytes_.load(); }

 private:
  static bool has_common_origin(std::span<const Ray> rays) {
    return std::all_of(rays.begin(), rays.end(), [&](const Ray& ray) { return ray.origin == rays.front().origin; });
  }

  /// Returns a scene with copies of the triangles, whose tree is not yet built. The trees of meshes that instances
  /// share are built.
  BuiltScene fill_scene() {
    BuiltScene scene(rtcNewScene(device_.get()));
    for (size_t i = 0; i < source_.objects.size(); ++i) {
      if (const auto* mesh = std::get_if<Mesh>(&source_.objects[i].shape)) attach(*mesh, i, scene.get());
    }
    std::vector<BuiltScene> shared;
    for (const Mesh& mesh : source_.meshes) {
      shared.emplace_back(rtcNewScene(device_.get()));
      attach(mesh, 0, shared.back().get());
      const Stopwatch building;
      rtcCommitScene(shared.back().get());
      commit_ms_ += building.ms();
    }
    for (const world::Instance& instance : source_.instances) {
      const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, shared[instance.mesh].get());
      const glm::mat3 turn(glm::inverse(dmat3(instance.map.object_from_world)));
      const glm::mat4x3 place(turn[0], turn[1], turn[2], instance.map.origin);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &place);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(scene.get(), geometry, instance.object);
      rtcReleaseGeometry(geometry);
    }
    check();
    return scene;
  }

  void attach(const Mesh& mesh, size_t number, RTCScene scene) const {
    if (mesh.triangles.empty()) return;
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    copy(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, std::as_bytes(std::span(mesh.positions)), sizeof(vec3));
    copy(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, std::as_bytes(std::span(mesh.triangles)), sizeof(uvec3));
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(number));
    rtcReleaseGeometry(geometry);
  }

  static void copy(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::span<const std::byte> bytes,
                   size_t stride) {
    void* target = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, bytes.size() / stride);
    if (target != nullptr) std::memcpy(target, bytes.data(), bytes.size());
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error == RTC_ERROR_NONE) return;
    throw RunError({"embree.failed", "Embree reports error " + std::to_string(error), source_.file.string(),
                    "try a smaller scene"});
  }

  const world::Scene& source_;
  /// The number of bytes that Embree has allocated.
  std::atomic<int64_t> bytes_ = 0;
  Device device_;
  BuiltScene scene_;
  /// The time for the trees of meshes that instances share.
  double commit_ms_ = 0.0;
};

}  // namespace

std::string embree_version() {
  const Device device = open_embree();
  const auto number = rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_VERSION);
  return "Embree " + std::to_string(number / 10000) + "." + std::to_string(number / 100 % 100) + "." +
         std::to_string(number % 100) + ", build quality medium, no scene flags";
}

std::unique_ptr<EmbreeCaster> make_embree_caster(const world::Scene& scene) {
  const bool has_meshes_alone =
      std::all_of(scene.objects.begin(), scene.objects.end(), [](const world::Object& object) {
        return std::holds_alternative<Mesh>(object.shape) || std::holds_alternative<world::NotDrawn>(object.shape);
      });
  return has_meshes_alone ? std::make_unique<Caster>(scene) : nullptr;
}

}  // namespace promin::measure
