// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <memory>
#include <mutex>
#include <span>

#include "bind.h"
#include "device.h"
#include "in_process.h"
#include "jobs/job.h"
#include "jobs/sha256.h"
#include "promin/error.h"
#include "watched.h"
#include "work/jobs/build_id.h"
#include "work/jobs/fingerprint.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/merge_job.h"
#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/jobs/spec_job.h"

namespace nb = nanobind;
namespace fs = std::filesystem;

namespace promin::python {
namespace {

using jobs::Job;
using Pairs = std::vector<std::pair<std::string, std::string>>;

/// Returns messages that show nothing: Python shows its own warnings, and no notes.
const work::Messages& no_messages() {
  static const work::Messages messages;
  return messages;
}

nb::dict describe_receipt(const jobs::Receipt& receipt) {
  nb::dict record;
  record["number"] = receipt.number;
  record["name"] = receipt.name;
  record["sha256"] = receipt.sha256;
  record["bytes"] = receipt.size_bytes;
  record["ms"] = receipt.ms;
  record["made_on"] = receipt.maker.made_on;
  record["fingerprint"] = receipt.maker.fingerprint;
  record["version"] = receipt.version;
  record["host"] = receipt.host;
  record["pid"] = receipt.pid;
  return record;
}

size_t check_piece(const Job& job, size_t piece) {
  if (piece < job.piece_count()) return piece;
  throw UsageError({"job.piece.unknown",
                    "the job has no piece " + std::to_string(piece) + " of " + std::to_string(job.piece_count()),
                    job.folder().string(), "name one from 0 on"});
}

/// Does the work without holding Python's lock.
template <typename Work>
auto unlocked(const Work& work) {
  const nb::gil_scoped_release release;
  return work();
}

std::string hash_of(const jobs::Content& content) {
  return jobs::Sha256().add(content.bytes).finish();
}

Job create_with(const fs::path& folder, const std::string& kind, const Pairs& options,
                const std::vector<fs::path>& files, const std::vector<std::string>& pieces) {
  return unlocked([&] {
    jobs::Manifest manifest{.kind = kind, .options = options, .files = {}, .pieces = pieces};
    for (const fs::path& file : files) manifest.files.push_back(jobs::describe_input(file));
    return Job::create(folder, manifest);
  });
}

nb::dict describe_job(const Job& job) {
  const jobs::Manifest& manifest = job.manifest();
  nb::list files;
  for (const jobs::InputFile& file : manifest.files) {
    files.append(nb::make_tuple(file.name, file.size_bytes, file.sha256));
  }
  nb::dict record;
  record["id"] = job.id();
  record["kind"] = manifest.kind;
  record["options"] = nb::cast(manifest.options);
  record["files"] = files;
  record["pieces"] = nb::cast(manifest.pieces);
  return record;
}

/// Returns "done", "missing" or "bad", and the fault of a bad piece.
std::pair<std::string, std::string> state_of(const Job& job, size_t piece) {
  return unlocked([&]() -> std::pair<std::string, std::string> {
    std::string why;
    switch (job.state_of(check_piece(job, piece), &why)) {
      case jobs::PieceState::kDone:
        return {"done", ""};
      case jobs::PieceState::kMissing:
        return {"missing", ""};
      case jobs::PieceState::kBad:
        break;
    }
    return {"bad", why};
  });
}

nb::tuple read(const Job& job, size_t piece) {
  const jobs::Content content = unlocked([&] { return job.read(check_piece(job, piece)); });
  return nb::make_tuple(content.description, nb::bytes(content.bytes.data(), content.bytes.size()));
}

nb::dict write_piece(const Job& job, size_t piece, const std::string& description, const nb::bytes& data, double ms,
                     const std::string& made_on, const std::string& fingerprint) {
  jobs::Content content{description, {}};
  content.bytes.resize(data.size());
  // An empty array may have no address.
  if (data.size() > 0) std::memcpy(content.bytes.data(), data.c_str(), data.size());
  return describe_receipt(unlocked([&] {
    return job.write(check_piece(job, piece), content, ms, {made_on, fingerprint});
  }));
}

void merge(const Job& job, const std::vector<fs::path>& outputs, bool is_mixed,
           const std::optional<std::vector<uint32_t>>& frames, const nb::object& progress) {
  run_watched(progress, [&](const ProgressCallback& tell) { work::merge_job(job, outputs, tell, is_mixed, frames); });
}

void check_outputs(const Job& job, const std::vector<fs::path>& outputs) {
  unlocked([&] { work::check_job_files(job, outputs); });
}

/// A job that was read and checked. The objects that open its pieces share it.
using Plan = std::shared_ptr<work::PlannedJob>;

struct SharedPlan {
  Plan plan;
};

/// Rays from Python: an object with the attributes count, name, size_bytes and sha256, and a method read(first, count)
/// that returns N x 8 float32. Each call takes Python's lock.
class PythonRays : public work::RaySource {
 public:
  explicit PythonRays(nb::object source)
      : source_(std::move(source)), count_(nb::cast<uint64_t>(source_.attr("count"))) {}
  ~PythonRays() override {
    const nb::gil_scoped_acquire acquire;
    source_.reset();
  }
  uint64_t count() const override { return count_; }
  void read(uint64_t first, std::span<Ray> rays, const dvec3& center) override {
    if (rays.empty()) return;
    const nb::gil_scoped_acquire acquire;
    const auto read = nb::cast<RayArray>(source_.attr("read")(first, rays.size()));
    if (read.shape(0) != rays.size()) {
      throw InputError({"rays.short",
                        "the rays end at " + std::to_string(first + read.shape(0)) + " of " + std::to_string(count_),
                        nb::cast<std::string>(source_.attr("name")), "give as many as when the job was created"});
    }
    std::memcpy(rays.data(), read.data(), rays.size_bytes());
    if (center == dvec3(0.0)) return;
    for (Ray& ray : rays) ray.origin = vec3(dvec3(ray.origin) - center);
  }
  jobs::InputFile describe() override {
    const nb::gil_scoped_acquire acquire;
    return {nb::cast<std::string>(source_.attr("name")), nb::cast<uint64_t>(source_.attr("size_bytes")),
            nb::cast<std::string>(source_.attr("sha256"))};
  }

 private:
  using RayArray = nb::ndarray<const float, nb::shape<-1, 8>, nb::c_contig, nb::device::cpu>;

  nb::object source_;
  uint64_t count_;
};

std::shared_ptr<work::RaySource> take_rays(const nb::object& source) {
  return source.is_none() ? nullptr : std::make_shared<PythonRays>(source);
}

/// Plans the job of a specification, given as text. Relative names of files refer to the current folder.
SharedPlan plan_job(const std::string& kind, const std::string& text, const fs::path& folder,
                    const nb::object& source) {
  Plan plan;
  run_watched(nb::none(), [&, rays = take_rays(source)](const ProgressCallback&) {
    plan = work::plan_job_of_text(kind, text, "spec", folder, no_messages(), rays);
  });
  return {plan};
}

SharedPlan plan_again(const Job& job, const nb::object& source) {
  Plan plan;
  run_watched(nb::none(), [&, rays = take_rays(source)](const ProgressCallback&) {
    plan = work::plan_again(job, no_messages(), rays);
  });
  return {plan};
}

/// Returns the SHA-256 and the size of a piece that is done; otherwise None.
std::optional<std::pair<std::string, uint64_t>> stored(const Job& job, size_t piece) {
  return unlocked([&]() -> std::optional<std::pair<std::string, uint64_t>> {
    try {
      const jobs::Content content = job.read(check_piece(job, piece));
      return std::pair(hash_of(content), uint64_t{content.bytes.size()});
    } catch (const InputError&) {
      return {};
    }
  });
}

Job create(const SharedPlan& shared, const fs::path& folder) {
  return unlocked([&] { return work::create_job(*shared.plan, folder); });
}

/// Makes the pieces of one job. One thread at a time may use it.
class Runner {
 public:
  Runner(std::shared_ptr<OpenDevice> device, const SharedPlan& shared, Job job)
      : device_(std::move(device)), plan_(shared.plan), job_(std::move(job)) {
    const gpu::Device& open = device_->get();
    made_on_ = work::driver_of(gpu::info_of(open));
    std::unique_ptr<work::PieceMaker> maker;
    run_watched(nb::none(), [&](const ProgressCallback& tell) { maker = plan_->open(open, job_.piece_count(), tell); });
    maker_.emplace(std::move(maker));
  }

  nb::dict run(size_t piece, const std::string& fingerprint, const nb::object& progress) {
    check_piece(job_, piece);
    work::PieceMaker& maker = maker_->get();
    std::optional<jobs::Receipt> receipt;
    run_watched(progress, [&](const ProgressCallback& tell) {
      const auto lock = lock_watched(mutex_, tell);
      const jobs::Maker own{made_on_, fingerprint, work::build_id()};
      const auto make = [&](size_t number) { return maker.make(number, tell); };
      if (!is_checked_) jobs::check_build(job_, own, make);
      is_checked_ = true;
      receipt = jobs::make_piece(job_, piece, own, make);
    });
    return describe_receipt(*receipt);
  }

  std::string recompute(size_t piece, const nb::object& progress) {
    check_piece(job_, piece);
    work::PieceMaker& maker = maker_->get();
    std::string hash;
    run_watched(progress, [&](const ProgressCallback& tell) {
      const auto lock = lock_watched(mutex_, tell);
      hash = hash_of(maker.make(piece, tell));
    });
    return hash;
  }

  nb::dict compare(size_t piece, const nb::object& progress) {
    check_piece(job_, piece);
    work::PieceMaker& maker = maker_->get();
    bool is_equal = false;
    work::PieceDifference difference;
    run_watched(progress, [&](const ProgressCallback& tell) {
      const auto lock = lock_watched(mutex_, tell);
      const jobs::Content there = job_.read(piece);
      const jobs::Content anew = maker.make(piece, tell);
      is_equal = there.bytes == anew.bytes;
      if (!is_equal) difference = plan_->compare(piece, there, anew, job_.file_of(piece));
    });
    nb::dict record;
    record["is_equal"] = is_equal;
    record["is_within"] = is_equal || difference.is_within_bounds();
    record["largest"] = difference.largest;
    record["mismatches"] = difference.mismatches;
    record["count"] = difference.count;
    return record;
  }

  const std::string& made_on() const { return made_on_; }

 private:
  // Declared before the maker, because the maker must be destroyed first.
  std::shared_ptr<OpenDevice> device_;
  Plan plan_;
  Job job_;
  std::string made_on_;
  std::optional<InProcess<std::unique_ptr<work::PieceMaker>>> maker_;
  std::timed_mutex mutex_;
  /// True after the check that this build may make pieces of the job.
  bool is_checked_ = false;
};

std::string fingerprint_of(const OpenDevice& device) {
  const gpu::Device& open = device.get();
  std::string fingerprint;
  run_watched(nb::none(), [&](const ProgressCallback&) { fingerprint = work::fingerprint_of(open); });
  return fingerprint;
}

}  // namespace

void bind_jobs(nb::module_& module) {
  nb::class_<Job>(module, "Job")
      .def_static("create_with", &create_with)
      .def_static("open", [](const fs::path& folder) { return unlocked([&] { return Job::open(folder); }); })
      .def("describe", [](const Job& job) { return describe_job(job); })
      .def("spec", [](const Job& job) { return work::read_job_spec(job); })
      .def("file_of",
           [](const Job& job, size_t piece) {
             // Decoded like os.fsdecode, because the folder's name need not be UTF-8.
             return nb::steal<nb::str>(PyUnicode_DecodeFSDefault(job.file_of(check_piece(job, piece)).c_str()));
           })
      .def("state_of", &state_of)
      .def("sha256", [](const Job& job,
                        size_t piece) { return unlocked([&] { return hash_of(job.read(check_piece(job, piece))); }); })
      .def("stored", &stored)
      .def("read", &read)
      .def("write", &write_piece)
      .def("tell_begun",
           [](const Job& job, size_t piece, const std::string& made_on, const std::string& fingerprint) {
             job.tell_begun(check_piece(job, piece), {made_on, fingerprint});
           })
      .def("tell_failed",
           [](const Job& job, size_t piece, const std::string& made_on, const std::string& fingerprint,
              const std::string& why) {
             job.tell_failed(check_piece(job, piece), {made_on, fingerprint}, why);
           })
      .def("tell_stopped",
           [](const Job& job, size_t piece, const std::string& made_on, const std::string& fingerprint) {
             job.tell_stopped(check_piece(job, piece), {made_on, fingerprint});
           })
      .def("clear_leftovers", &Job::clear_leftovers)
      .def("check_outputs", &check_outputs)
      .def("merge", &merge, nb::arg("outputs"), nb::arg("is_mixed"), nb::arg("frames").none(),
           nb::arg("progress").none());
  module.def("fingerprint_of", &fingerprint_of);
  nb::class_<SharedPlan>(module, "PlannedJob")
      .def_static("plan", &plan_job, nb::arg("kind"), nb::arg("spec"), nb::arg("folder"), nb::arg("rays").none())
      .def_static("plan_again", &plan_again, nb::arg("job"), nb::arg("rays").none())
      .def("create", &create);
  nb::class_<Runner>(module, "Runner")
      .def(nb::init<std::shared_ptr<OpenDevice>, const SharedPlan&, Job>())
      .def("made_on", &Runner::made_on)
      .def("run", &Runner::run, nb::arg("piece"), nb::arg("fingerprint"), nb::arg("progress").none())
      .def("recompute", &Runner::recompute, nb::arg("piece"), nb::arg("progress").none())
      .def("compare", &Runner::compare, nb::arg("piece"), nb::arg("progress").none());
}

}  // namespace promin::python
