// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "jobs/job.h"
#include "promin/ray.h"

namespace promin::work {

/// The rays of a job. Several threads may use it.
class RaySource {
 public:
  virtual ~RaySource() = default;
  virtual uint64_t count() const = 0;
  /// Fills `rays` with rays from this index on; all of them must exist. The scene's center is subtracted from their
  /// origins. Throws InputError, also if the rays have changed since describe().
  virtual void read(uint64_t first, std::span<Ray> rays, const dvec3& center) = 0;
  /// Returns a description of the rays for the job's manifest. Throws InputError.
  virtual jobs::InputFile describe() = 0;
  /// Stores the result of describe() in the job's folder to save time. To be called after the folder is created.
  virtual void remember() {}
};

/// Opens the rays of a NumPy file. The file's hash may be cached in the job's folder. Throws InputError.
std::shared_ptr<RaySource> open_rays(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace promin::work
