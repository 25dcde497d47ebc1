// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/merge_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <optional>

#include "commands/job_run.h"
#include "core/count_of.h"
#include "jobs/job.h"
#include "output/console.h"
#include "output/outputs.h"
#include "promin/error.h"
#include "work/jobs/merge_job.h"
#include "work/jobs/planned_job.h"

namespace promin::app {
namespace {

struct MergeOptions {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;
  std::optional<std::filesystem::path> offsets;
  bool is_quiet = false;
};

void merge(const MergeOptions& options) {
  std::vector<std::filesystem::path> files = options.files;
  if (options.offsets) files.push_back(*options.offsets);
  const jobs::Job job = jobs::Job::open(options.folder);
  if (options.offsets && job.manifest().kind == kPictureJob) {
    throw UsageError({"job.offsets.none", "--offsets needs a job of rays, but this is a job of pictures",
                      job.folder().string(), "remove --offsets"});
  }
  check_job_files(job, files);
  check_outputs({}, files, {});
  const std::string made = merge_job_deferring(job, files);
  if (!options.is_quiet) fmt::print("{}: {}\n", count_of(job.piece_count(), "piece"), made);
}

}  // namespace

Command add_merge_command(CLI::App& program) {
  CLI::App& command = add_command(program, "merge", "Combine the pieces of a job and write its files");
  const auto options = std::make_shared<MergeOptions>();
  OptionTable table(command);
  table.add_required("DIR", "", "Folder that promin render --job or promin cast --job has created",
                     [=](const OptionValues& w) { options->folder = w.text(); });
  table.add_required_repeated(
      "-o,--output", "FILE",
      "File to write: .exr (linear float) or .png (sRGB, 8 bit) for pictures, .mp4, .webm, .gif "
      "or .png for a film, .npy for hits. #### in a name stands for the frame number. You may repeat this option",
      [=](const OptionValues& w) { options->files.assign(w.all().begin(), w.all().end()); });
  table.add("--offsets", "OFFSETS.npy",
            "For a job of promin cast --all: file for the indices at which the hits of each ray begin",
            [=](const OptionValues& w) { options->offsets = w.text(); });
  table.add_flag("--quiet", "Print only errors", options->is_quiet);
  return {&command, [options] { merge(*options); }};
}

}  // namespace promin::app
