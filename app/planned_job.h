// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "compare_pieces.h"
#include "jobs/job.h"
#include "promin/device.h"
#include "promin/progress.h"

namespace promin::app {

/// Makes the pieces of a planned job, with what it has opened once. It serves one thread at a time, and the plan and
/// the device must outlive it.
class PieceMaker {
 public:
  virtual ~PieceMaker() = default;
  /// Throws RunError, Cancelled where `progress` says so, and InputError where an input has changed meanwhile.
  virtual jobs::Content make(size_t piece, const ProgressCallback& progress) = 0;
};

/// A job that a command line asks for: its inputs are read and hashed, and no device is open.
class PlannedJob {
 public:
  virtual ~PlannedJob() = default;

  const jobs::Manifest& manifest() const { return manifest_; }
  /// The words by which plan_job plans it again, from any folder: files have absolute paths, and what does not decide
  /// how pieces are made is left out.
  const std::vector<std::string>& arguments() const { return arguments_; }
  /// Opens what the device makes pieces with: about so many. The tree is that of shared_tree_file, which may be waited
  /// for. Throws Cancelled where `progress`, which is asked meanwhile, says so.
  virtual std::unique_ptr<PieceMaker> open(const gpu::Device& device, size_t pieces,
                                           const ProgressCallback& progress) = 0;
  /// How far apart a piece that is there and one made anew are, whose file it names in messages. Throws InputError
  /// where they are not of one piece.
  virtual PieceDifference compare(size_t piece, const jobs::Content& there, const jobs::Content& anew,
                                  const std::filesystem::path& file) = 0;
  /// Has the job's folder, now that it is there, keep what would cost others time to find out.
  virtual void remember() {}

 protected:
  jobs::Manifest manifest_;
  std::vector<std::string> arguments_;
};

}  // namespace promin::app
