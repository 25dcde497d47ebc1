// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/job_manifest.h"

#include <fstream>
#include <iterator>

#include "core/file.h"
#include "promin/error.h"
#include "work/jobs/results_version.h"

namespace promin::work {

namespace fs = std::filesystem;

jobs::Manifest begin_manifest(std::string_view kind, const std::vector<std::pair<std::string, std::string>>& bits) {
  jobs::Manifest manifest;
  manifest.kind = kind;
  manifest.options = {{"results version", std::to_string(kResultsVersion)}};
  manifest.options.insert(manifest.options.end(), bits.begin(), bits.end());
  return manifest;
}

void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources) {
  for (const SourceFile& source : sources) {
    if (!source.stamp) continue;
    manifest.files.push_back(jobs::describe_input(source.file));
    if (stamp_of(source.file) == source.stamp) continue;
    throw InputError({"file.changed", "the file changed while it was read", source.file.string(), "try again"});
  }
}

fs::path spec_file(const jobs::Job& job) {
  return job.folder() / "spec.json";
}

void write_job_spec(const jobs::Job& job, const std::string& text) {
  write_text_file(spec_file(job), text);
}

std::optional<std::string> read_job_spec(const jobs::Job& job) {
  std::ifstream stream(spec_file(job), std::ios::binary);
  if (!stream) return {};
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace promin::work
