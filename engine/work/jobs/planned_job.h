// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "jobs/job.h"
#include "promin/device.h"
#include "promin/progress.h"
#include "work/jobs/compare_pieces.h"

namespace promin::work {

/// The kinds of jobs that specifications describe. Their pieces are parts of pictures, and hits of rays.
inline constexpr std::string_view kPictureJob = "render";
inline constexpr std::string_view kRayJob = "cast";

/// Makes the pieces of a planned job. It opens the resources for this once. Only one thread at a time may use it. The
/// plan and the device must outlive it.
class PieceMaker {
 public:
  virtual ~PieceMaker() = default;
  /// Makes a piece. Throws RunError, Cancelled if `progress` returns false, and InputError if an input has changed
  /// meanwhile.
  virtual jobs::Content make(size_t piece, const ProgressCallback& progress) = 0;
};

/// A job that a specification describes. Its inputs are read and hashed, but no device is open.
class PlannedJob {
 public:
  virtual ~PlannedJob() = default;

  const jobs::Manifest& manifest() const { return manifest_; }
  /// Returns the text of a specification from which plan_job() plans the same job in any folder (write_spec_of_pieces).
  const std::string& spec() const { return spec_; }
  /// Opens the resources for making about this number of pieces on a device. The tree comes from shared_tree_file(),
  /// and the call may wait for it. It calls `progress` meanwhile and throws Cancelled if `progress` returns false.
  virtual std::unique_ptr<PieceMaker> open(const gpu::Device& device, size_t pieces,
                                           const ProgressCallback& progress) = 0;
  /// Compares an existing piece with the same piece made again. Messages name the piece's file. Throws InputError if
  /// they are not the same piece.
  virtual PieceDifference compare(size_t piece, const jobs::Content& there, const jobs::Content& anew,
                                  const std::filesystem::path& file) = 0;
  /// Stores data in the job's folder that saves other processes time. To be called after the folder is created.
  virtual void remember() {}

 protected:
  jobs::Manifest manifest_;
  std::string spec_;
};

}  // namespace promin::work
