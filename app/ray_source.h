// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "jobs/job.h"
#include "promin/ray.h"

namespace promin::app {

/// The rays of a job. It serves several threads.
class RaySource {
 public:
  virtual ~RaySource() = default;
  virtual uint64_t count() const = 0;
  /// Reads as many rays as fit in `rays`, from the one of this number on; they are there. Their origins lose the
  /// scene's center. Throws InputError, also where they have changed since describe().
  virtual void read(uint64_t first, std::span<Ray> rays, const dvec3& center) = 0;
  /// What the job's manifest tells of them. Throws InputError.
  virtual jobs::InputFile describe() = 0;
  /// Has the job's folder, now that it is there, keep what describe() took long for.
  virtual void remember() {}
};

/// Rays of a NumPy file, whose hash a job's folder may know. Throws InputError.
std::shared_ptr<RaySource> open_rays(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace promin::app
