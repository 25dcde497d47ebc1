// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/ray_source.h"

#include <mutex>
#include <optional>

#include "core/file.h"
#include "jobs/known_hashes.h"
#include "promin/error.h"
#include "rays/npy.h"

namespace promin::work {
namespace {

class RayFile : public RaySource {
 public:
  RayFile(const std::filesystem::path& file, const std::filesystem::path& folder)
      : file_(file), stamp_(stamp_of(file)), reader_(file), hashes_(folder) {}

  uint64_t count() const override { return reader_.count(); }
  void read(uint64_t first, std::span<Ray> rays, const dvec3& center) override {
    if (stamp_of(file_) != stamp_) {
      throw InputError({"file.changed", "the file changed after the job's rays were first read", file_.string(),
                        "restore the file, or use another folder for the job"});
    }
    const std::lock_guard lock(mutex_);
    reader_.seek(first);
    reader_.read(rays, center);
  }
  jobs::InputFile describe() override { return hashes_.describe(file_); }
  void remember() override { hashes_.save(); }

 private:
  std::filesystem::path file_;
  // The stamp is taken before the reader is opened, so that the data read is not older than the stamp.
  std::optional<FileStamp> stamp_;
  RayReader reader_;
  std::mutex mutex_;
  jobs::KnownHashes hashes_;
};

}  // namespace

std::shared_ptr<RaySource> open_rays(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return std::make_shared<RayFile>(file, folder);
}

}  // namespace promin::work
