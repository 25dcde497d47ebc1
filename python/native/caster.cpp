// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/caster.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <span>
#include <vector>

#include "bind.h"
#include "device.h"
#include "in_process.h"
#include "matrices.h"
#include "records.h"
#include "scene.h"
#include "setup_stats.h"
#include "watched.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

/// N rays in the layout of RAYS.npy.
using RayArray = nb::ndarray<const float, nb::shape<-1, 8>, nb::c_contig, nb::device::cpu>;
/// An array with a count for each ray.
using CountArray = nb::ndarray<int32_t, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
/// An array with the answer for each ray: whether it hits anything.
using AnswerArray = nb::ndarray<bool, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
/// N hits as bytes in the layout of HITS.npy, because nanobind accepts no structured arrays.
using HitArray = nb::ndarray<uint8_t, nb::shape<-1, sizeof(Hit)>, nb::c_contig, nb::device::cpu>;

std::span<const Ray> view(const RayArray& rays) {
  return {reinterpret_cast<const Ray*>(rays.data()), rays.shape(0)};
}

/// Returns the values as a NumPy array of bytes or numbers that owns them. Its shape is N x `width` or N.
template <typename Component, typename Value>
nb::object give(std::vector<Value> values, size_t width) {
  auto* owned = new std::vector<Value>(std::move(values));
  const nb::capsule owner(owned, [](void* data) noexcept { delete static_cast<std::vector<Value>*>(data); });
  const size_t shape[2] = {owned->size(), width};
  return nb::cast(nb::ndarray<nb::numpy, Component>(owned->data(), width == 1 ? 1 : 2, shape, owner));
}

class SharedCaster {
 public:
  SharedCaster(std::shared_ptr<OpenDevice> device, const Scene& scene, const std::string& builder,
               const std::optional<std::filesystem::path>& bvh, const std::string& instances,
               const nb::object& progress)
      : device_(std::move(device)) {
    const gpu::Device& open = device_->get();
    std::unique_ptr<Caster> caster;
    const auto choice = static_cast<Instancing>(find_name(instancing_names(), instances, "instances"));
    run_watched(progress, [&](const ProgressCallback& tell) {
      CasterOptions options;
      options.builder = builder;
      if (bvh) options.bvh = *bvh;
      options.instances = choice;
      options.progress = tell;
      caster = std::make_unique<Caster>(open, scene, options);
    });
    caster_.emplace(std::move(caster));
  }

  double cast(const RayArray& rays, const HitArray& hits, const nb::object& progress) {
    return run(progress, [&](Caster& caster, const ProgressCallback& tell) {
      return caster.cast(view(rays), {reinterpret_cast<Hit*>(hits.data()), hits.shape(0)}, HitQuery::kNearest, tell);
    });
  }

  double occluded(const RayArray& rays, const AnswerArray& answers, const nb::object& progress) {
    return run(progress, [&](Caster& caster, const ProgressCallback& tell) {
      return caster.occluded(view(rays), {answers.data(), answers.shape(0)}, tell);
    });
  }

  double count(const RayArray& rays, const CountArray& counts, const nb::object& progress) {
    return run(progress, [&](Caster& caster, const ProgressCallback& tell) {
      return caster.count(view(rays), {counts.data(), counts.shape(0)}, tell);
    });
  }

  /// Returns the splits and the hits. The splits are the offset of each ray's first hit, then the end of the last ray's
  /// hits. The hits are bytes. With a budget, the result holds only the first rays, as many as have hits of this many
  /// bytes, but at least one.
  nb::tuple list(const RayArray& rays, const std::optional<uint64_t>& budget_bytes, const nb::object& progress) {
    std::vector<int64_t> splits{0};
    std::vector<Hit> hits;
    struct IsEnough {};
    run(progress, [&](Caster& caster, const ProgressCallback& tell) {
      const auto take = [&](const HitList& part) {
        const auto before = static_cast<int64_t>(hits.size());
        for (const uint64_t end : part.offsets.subspan(1)) splits.push_back(before + static_cast<int64_t>(end));
        hits.insert(hits.end(), part.hits.begin(), part.hits.end());
        if (budget_bytes) throw IsEnough{};
      };
      try {
        return caster.list(view(rays), take, budget_bytes.value_or(Caster::kListBytes), tell);
      } catch (const IsEnough&) {
        return 0.0;
      }
    });
    return nb::make_tuple(give<int64_t>(std::move(splits), 1), give<uint8_t>(std::move(hits), sizeof(Hit)));
  }

  void set_pose(const Scene& posed) {
    run(nb::none(), [&](Caster& caster, const ProgressCallback&) {
      caster.set_pose(posed);
      return 0.0;
    });
  }

  void set_transforms(const std::vector<uint32_t>& objects, const Matrices& matrices) {
    const auto transforms = read_transforms(objects, matrices);
    run(nb::none(), [&](Caster& caster, const ProgressCallback&) {
      caster.set_transforms(transforms);
      return 0.0;
    });
  }

  nb::dict setup() const { return describe(caster_->get().setup_stats()); }

 private:
  /// Calls the caster and returns the result. Only one call runs at a time.
  template <typename Call>
  double run(const nb::object& progress, const Call& call) {
    Caster& caster = caster_->get();
    double time_ms = 0.0;
    run_watched(progress, [&](const ProgressCallback& tell) {
      const auto lock = lock_watched(mutex_, tell);
      time_ms = call(caster, tell);
    });
    return time_ms;
  }

  // Declared before the caster, because the caster must be destroyed first.
  std::shared_ptr<OpenDevice> device_;
  std::optional<InProcess<std::unique_ptr<Caster>>> caster_;
  std::timed_mutex mutex_;
};

}  // namespace

void bind_caster(nb::module_& module) {
  nb::class_<SharedCaster>(module, "Caster")
      .def(nb::init<std::shared_ptr<OpenDevice>, const Scene&, const std::string&,
                    const std::optional<std::filesystem::path>&, const std::string&, const nb::object&>(),
           nb::arg("device"), nb::arg("scene"), nb::arg("builder"), nb::arg("bvh").none(), nb::arg("instances"),
           nb::arg("progress").none())
      .def("cast", &SharedCaster::cast, nb::arg("rays").noconvert(), nb::arg("hits").noconvert(),
           nb::arg("progress").none())
      .def("occluded", &SharedCaster::occluded, nb::arg("rays").noconvert(), nb::arg("answers").noconvert(),
           nb::arg("progress").none())
      .def("count", &SharedCaster::count, nb::arg("rays").noconvert(), nb::arg("counts").noconvert(),
           nb::arg("progress").none())
      .def("list", &SharedCaster::list, nb::arg("rays").noconvert(), nb::arg("budget_bytes").none(),
           nb::arg("progress").none())
      .def("set_pose", &SharedCaster::set_pose, nb::arg("scene"))
      .def("set_transforms", &SharedCaster::set_transforms, nb::arg("objects"), nb::arg("matrices").noconvert())
      .def("setup", &SharedCaster::setup);
}

}  // namespace promin::python
