// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/spec_job.h"

#include <fmt/format.h>

#include "promin/error.h"
#include "work/jobs/cast_job.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/render_job.h"
#include "work/pictures/frame_plan.h"
#include "work/pictures/picture_run.h"
#include "work/spec/check_spec.h"
#include "work/spec/spec_json.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;

/// Changes the specification to that of a process that works in this folder.
template <typename Spec>
Spec set_in(Spec spec, const fs::path& folder) {
  spec.job.folder = folder;
  // The output files are named later, when the pieces are merged.
  spec.job.share = jobs::Share{};
  return spec;
}

}  // namespace

std::unique_ptr<PlannedJob> plan_job(RenderSpec spec, const fs::path& folder, const Messages& messages) {
  spec = set_in(std::move(spec), folder);
  spec.pictures.clear();
  check_render_spec(spec);
  return plan_pictures(spec, prepare_pictures(spec, plan_frames(spec), messages), messages);
}

std::unique_ptr<PlannedJob> plan_job(CastSpec spec, const fs::path& folder, const Messages& messages,
                                     std::shared_ptr<RaySource> rays) {
  spec = set_in(std::move(spec), folder);
  spec.output.reset();
  spec.offsets.reset();
  check_cast_spec(spec);
  return plan_rays(spec, messages, std::move(rays));
}

void refuse_kind(const std::string& kind) {
  throw UsageError(
      {"job.command.unknown", fmt::format("the command \"{}\" cannot be a job", kind), "", "use render or cast"});
}

std::unique_ptr<PlannedJob> plan_job_of_text(const std::string& kind, const std::string& text, const fs::path& file,
                                             const fs::path& folder, const Messages& messages,
                                             std::shared_ptr<RaySource> rays) {
  if (kind == kPictureJob) {
    if (rays != nullptr) throw UsageError({"job.rays.none", "a job of pictures has no rays", "", "remove the rays"});
    return plan_job(parse_spec<RenderSpec>(text, file), folder, messages);
  }
  if (kind == kRayJob) return plan_job(parse_spec<CastSpec>(text, file), folder, messages, std::move(rays));
  refuse_kind(kind);
}

jobs::Job create_job(PlannedJob& planned, const fs::path& folder) {
  const jobs::Job job = jobs::Job::create(folder, planned.manifest());
  if (read_job_spec(job) != planned.spec()) write_job_spec(job, planned.spec());
  planned.remember();
  return job;
}

std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Messages& messages,
                                       std::shared_ptr<RaySource> rays) {
  const std::optional<std::string> text = read_job_spec(job);
  const std::string& kind = job.manifest().kind;
  if (!text || (kind != kPictureJob && kind != kRayJob)) {
    throw InputError({"job.spec.missing", "the file that says how to make the job's pieces is missing",
                      spec_file(job).string(), "run the job's command again"});
  }
  std::unique_ptr<PlannedJob> planned =
      plan_job_of_text(kind, *text, spec_file(job), job.folder(), messages, std::move(rays));
  job.check_same(planned->manifest());
  planned->remember();
  return planned;
}

}  // namespace promin::work
