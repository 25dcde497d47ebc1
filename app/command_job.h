// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "arguments.h"
#include "compare_pieces.h"
#include "console.h"
#include "formats/source_file.h"
#include "job_options.h"
#include "jobs/job.h"
#include "promin/device.h"
#include "promin/progress.h"
#include "ray_source.h"

namespace promin::app {

/// The words that a command was given, by given_options().
using GivenOptions = std::vector<std::pair<std::string, std::vector<std::string>>>;

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

/// The beginning of a command's manifest: kind, version, the hash of the program's sources, and the given options that
/// decide about bits.
jobs::Manifest begin_manifest(std::string_view kind, const GivenOptions& given);
/// Adds the files that a scene was loaded from. Throws InputError where one has changed since.
void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources);

/// Where all who work on a job find the tree of its scene by this builder, which the first of them puts there
/// (pack_scene_sharing).
std::filesystem::path shared_tree_file(const JobOptions& job, const std::string& builder);

/// What PlannedJob::arguments() is of a parsed command.
std::vector<std::string> keep_arguments(const CLI::App& command);

/// Plans the job of the kind "render" or "cast" by what the command of that name takes, without --output, --job,
/// --piece and what contradicts --job. `folder` is where it is, or will be. `rays` take the place of those of the file
/// that "cast" names, of which the name remains. Throws UsageError, InputError.
std::unique_ptr<PlannedJob> plan_job(const std::string& kind, const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder, const Console& console,
                                     std::shared_ptr<RaySource> rays = nullptr);

/// Makes the job's folder or goes on with what is in it, and keeps there by what arguments it was planned. Throws what
/// jobs::Job::create does.
jobs::Job create_job(PlannedJob& planned, const std::filesystem::path& folder);

/// Plans the job of a folder again, by what create_job has kept there. Throws InputError where it has kept nothing, or
/// an input is gone, and UsageError where the job would be another one today, as an input has changed.
std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Console& console,
                                       std::shared_ptr<RaySource> rays = nullptr);

/// The arguments that create_job has kept; nothing where it has not.
std::optional<std::vector<std::string>> read_arguments(const jobs::Job& job);

/// What the pieces of a job that are there were made on; empty where there is none.
std::string find_driver(const jobs::Job& job);

/// The device and its driver, in the words that find_driver has.
std::string driver_of(const gpu::DeviceInfo& device);

/// What differs about commands with --job.
struct JobSteps {
  std::function<gpu::DeviceHandle()> open_device;
  /// Makes the command's files of all pieces.
  std::function<void(const jobs::Job& job)> merge;
  /// These files, in words.
  std::string outputs;
};
/// Does what a command with --job does: makes the pieces of its share that are missing, and without --piece then the
/// files of them; and says so on standard output unless quiet. A signal ends it with the piece at hand. Throws
/// UsageError where the pieces that are there were made by another driver.
void run_job(PlannedJob& planned, const JobOptions& options, const JobSteps& steps, const Console& console);

/// Before the work: throws UsageError for files that merge_job does not make of this job, and for one that the job's
/// pieces hang on; the manifest tells these by name, size and hash, not by folder. Throws InputError for a job of
/// another kind. `frames`: of a path only these are to be made.
void check_job_files(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
                     const std::optional<std::vector<uint32_t>>& frames = std::nullopt);

/// Throws RunError where some of these pieces are missing or bad, and names a few.
void check_done(const jobs::Job& job, const std::vector<size_t>& pieces);
/// The same of all.
void check_whole(const jobs::Job& job);

/// Makes the files of a job of its pieces: pictures of the kind "render"; of "cast" the hits or counts, and of --all
/// the offsets as a second file. `is_mixed` is for rays alone (merge_hits), `frames` for pictures alone. Throws
/// Cancelled, and what check_job_files, merge_pictures and merge_hits do.
void merge_job(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs,
               const ProgressCallback& progress, bool is_mixed = false,
               const std::optional<std::vector<uint32_t>>& frames = std::nullopt);
/// The same for a program: a signal ends it, and leaves no file half written.
void merge_job_deferring(const jobs::Job& job, const std::vector<std::filesystem::path>& outputs);

}  // namespace promin::app
