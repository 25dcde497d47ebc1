// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "merge_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <memory>

#include "console.h"
#include "image/open_pictures.h"
#include "jobs/job.h"
#include "outputs.h"
#include "picture_job.h"
#include "promin/error.h"

namespace promin::app {
namespace {

struct MergeOptions {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> pictures;
  bool is_quiet = false;
};

void merge(const MergeOptions& options) {
  check_pictures(options.pictures);
  check_outputs({}, options.pictures, {});
  find_pictures();
  const jobs::Job job = jobs::Job::open(options.folder);
  if (job.manifest().kind != kPictureJob) {
    throw InputError({fmt::format("the job is no pictures but \"{}\"", job.manifest().kind), options.folder.string(),
                      "name the folder of promin render --job"});
  }
  merge_pictures(job, options.pictures);
  if (!options.is_quiet) fmt::print("{} pieces: {}\n", job.piece_count(), fmt::join(names_of(options.pictures), ", "));
}

}  // namespace

Command add_merge_command(CLI::App& program) {
  CLI::App& command = add_command(program, "merge", "Make the pictures of a job from its pieces");
  const auto options = std::make_shared<MergeOptions>();
  OptionTable table(command);
  table.add_required("DIR", "", "Folder of promin render --job",
                     [=](const OptionValues& w) { options->folder = w.text(); });
  table.add_required_repeated(
      "-o,--output", "FILE",
      "Picture to write: .exr (linear float) or .png (sRGB, 8 bit); of frames with #### in place "
      "of their number; repeatable",
      [=](const OptionValues& w) { options->pictures.assign(w.all().begin(), w.all().end()); });
  table.add_flag("--quiet", "Print nothing but errors", options->is_quiet);
  return {&command, [options] { merge(*options); }};
}

}  // namespace promin::app
