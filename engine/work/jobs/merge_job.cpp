// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/merge_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "promin/error.h"
#include "work/jobs/merge_hits.h"
#include "work/jobs/merge_pictures.h"
#include "work/jobs/picture_pieces.h"
#include "work/jobs/planned_job.h"
#include "work/spec/render_spec.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

/// Returns whether a file is an input of the job, according to the manifest.
bool is_input(const jobs::Job& job, const fs::path& file) {
  return std::ranges::any_of(job.manifest().files, [&](const jobs::InputFile& input) {
    std::error_code none;
    return input.name == file.filename() && fs::file_size(file, none) == input.size_bytes && !none &&
           jobs::describe_input(file).sha256 == input.sha256;
  });
}

}  // namespace

void check_job_files(const jobs::Job& job, const std::vector<fs::path>& outputs,
                     const std::optional<std::vector<uint32_t>>& frames) {
  const std::string& kind = job.manifest().kind;
  if (kind == kPictureJob) {
    check_merged_pictures(job, outputs);
  } else if (kind == kRayJob) {
    check_merged_hits(job, outputs);
  } else {
    throw InputError(
        {"job.kind.unknown",
         fmt::format("the job's kind is \"{}\", which is neither the kind of promin render nor that of promin cast",
                     kind),
         job.folder().string(), "give a folder that promin render --job or promin cast --job created"});
  }
  for (const fs::path& output : kind == kPictureJob ? number_pictures(job, outputs, frames) : outputs) {
    if (!is_input(job, output)) continue;
    throw UsageError({"output.input", "the output would overwrite an input", output.string(), "use another file"});
  }
}

std::optional<PictureError> merge_job(const jobs::Job& job, const std::vector<fs::path>& outputs,
                                      const ProgressCallback& progress, bool is_mixed,
                                      const std::optional<std::vector<uint32_t>>& frames) {
  check_job_files(job, outputs, frames);
  if (job.manifest().kind == kPictureJob) return merge_pictures(job, outputs, progress, frames);
  if (frames)
    throw UsageError({"job.frames.none", "a job of rays has no frames", job.folder().string(), "remove the frames"});
  merge_hits(job, outputs, progress, is_mixed);
  return {};
}

}  // namespace promin::work
