// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <filesystem>
#include <fstream>

#include "commands/merge_command.h"
#include "core/file.h"
#include "jobs/job.h"
#include "messages/message_cases.h"
#include "options/job_words.h"
#include "output/console.h"
#include "output/run_program.h"
#include "promin/ray.h"
#include "rays/npy.h"
#include "work/jobs/job_manifest.h"
#include "work/jobs/merge_hits.h"
#include "work/jobs/merge_job.h"
#include "work/jobs/missing_pieces.h"
#include "work/jobs/picture_part.h"
#include "work/jobs/picture_pieces.h"
#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/jobs/spec_job.h"
#include "work/spec/spec_json.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using jobs::Content;
using jobs::Job;
using jobs::Manifest;

/// Makes a job of two pieces in the folder "job".
Job make_job(const std::string& kind = "bytes", const std::vector<std::string>& pieces = {"part0", "part1"}) {
  return Job::create("job", Manifest{.kind = kind, .options = {{"--spp", "4"}}, .files = {}, .pieces = pieces});
}

Content bytes_of(const std::string& description, size_t count) {
  return {description, std::vector<std::byte>(count)};
}

void write_piece(const Job& job, size_t piece, const Content& content) {
  job.write(piece, content, 1.0, {});
}

/// Reads the first piece after a change of its file.
MessageCase spoil_piece(std::string_view code, const std::function<void(std::string& bytes)>& fault) {
  return {code, [=] {
            const Job job = make_job();
            write_piece(job, 0, bytes_of("words", 100));
            const std::vector<std::byte> bytes = read_file(job.file_of(0));
            std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
            fault(text);
            write_case(job.file_of(0), text);
            static_cast<void>(job.read(0));
          }};
}

work::PicturePart make_row(uint32_t row, const std::string& driver) {
  work::PicturePart part;
  part.full_size = uvec2(1, 2);
  part.window = {{0, 0}, {1, 2}};
  part.part = {{0, row}, {1, row + 1}};
  part.metadata = {{"driver", driver}};
  part.image = {{1, 1}, {vec3(0.5F)}};
  return part;
}

/// Merges a picture of two parts.
MessageCase merge_parts(std::string_view code, const work::PicturePart& first, const work::PicturePart& second) {
  return {code, [=] {
            const Job job = make_job("render");
            write_piece(job, 0, encode_part(first));
            write_piece(job, 1, encode_part(second));
            static_cast<void>(work::merge_job(job, {"a.exr"}, {}, false, std::nullopt));
          }};
}

/// Merges the hits of two pieces, which have one ray each.
MessageCase merge_rays(std::string_view code, int second_ray, const std::string& second_driver) {
  return {code, [=] {
            const Job job = make_job("cast");
            const auto content = [](const std::string& driver, int ray) {
              return bytes_of(R"({"driver": ")" + driver + R"(", "query": "nearest", "first_ray": )" +
                                  std::to_string(ray) + R"(, "rays": 1})",
                              sizeof(Hit));
            };
            write_piece(job, 0, content("A", 0));
            write_piece(job, 1, content(second_driver, second_ray));
            static_cast<void>(work::merge_job(job, {"a.npy"}, {}, false, std::nullopt));
          }};
}

std::vector<MessageCase> cases_of_folders() {
  return {
      {"job.folder.missing", [] { Job::open("none"); }},
      {"job.missing",
       [] {
         fs::create_directory("job");
         Job::open("job");
       }},
      {"job.folder.used",
       [] {
         fs::create_directory("job");
         write_case("job/a.txt", "x");
         make_job();
       }},
      {"job.manifest.damaged",
       [] {
         make_job();
         write_case("job/job.json", "{");
         make_job();
       }},
      {"job.version",
       [] {
         make_job();
         const std::vector<std::byte> bytes = read_file("job/job.json");
         std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
         const std::string key = "\"promin_job\": ";
         text.insert(text.find(key) + key.size(), 1, '9');
         write_case("job/job.json", text);
         make_job();
       }},
      {"job.version.old",
       [] {
         make_job();
         const std::vector<std::byte> bytes = read_file("job/job.json");
         std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
         const std::string key = "\"promin_job\": ";
         text[text.find(key) + key.size()] = '1';
         write_case("job/job.json", text);
         make_job();
       }},
      {"job.build",
       [] {
         const Job job = make_job();
         job.write(0, bytes_of("words", 100), 1.0, {"a device", "", "one"});
         jobs::check_build(job, {"a device", "", "another"}, [](size_t) { return bytes_of("words", 99); });
       }},
      {"job.other",
       [] {
         make_job();
         make_job("bytes", {"part0"});
       }},
      {"file.name",
       [] {
         write_case("caf\xe9.txt", "x");
         static_cast<void>(jobs::describe_input("caf\xe9.txt"));
       }},
      {"file.changed",
       [] {
         write_case("a.obj", "one");
         const SourceFile source{"a.obj", stamp_of("a.obj")};
         write_case("a.obj", "another");
         Manifest manifest;
         work::add_scene_files(manifest, {source});
       }},
      {"job.pieces.missing", [] { work::check_whole(make_job()); }},
      {"job.kind.unknown", [] { work::check_job_files(make_job(), {}, std::nullopt); }},
      {"job.pieces.many",
       [] {
         static_cast<void>(
             work::cut_picture({{0, 0}, {4, 4}}, {.pieces = 9, .tiles = {}, .folder = {}, .share = {}}, 1));
       }},
      {"job.pieces.many",
       [] {
         static_cast<void>(work::cut_picture({{0, 0}, {1 << 15, 1 << 15}},
                                             {.pieces = {}, .tiles = uvec2(1 << 15), .folder = {}, .share = {}}, 1));
       }},
  };
}

std::vector<MessageCase> cases_of_pieces() {
  work::PicturePart larger = make_row(1, "A");
  larger.full_size = uvec2(1, 3);
  work::PicturePart bare = make_row(1, "A");
  bare.metadata.clear();
  return {
      {"file.missing", [] { static_cast<void>(make_job().read(0)); }},
      spoil_piece("job.piece.cut", [](std::string& bytes) { bytes.resize(10); }),
      spoil_piece("job.piece.cut", [](std::string& bytes) { bytes.pop_back(); }),
      spoil_piece("job.piece.damaged", [](std::string& bytes) { bytes.back() = 'x'; }),
      {"job.piece.other",
       [] {
         const Job job = make_job();
         write_piece(job, 0, bytes_of("words", 100));
         fs::copy_file(job.file_of(0), job.file_of(1));
         static_cast<void>(job.read(1));
       }},
      {"job.piece.kind", [] { static_cast<void>(work::decode_part(bytes_of("words", 1), "a.piece")); }},
      {"job.piece.kind",
       [] {
         const Job job = make_job("cast", {"part0"});
         write_piece(job, 0, bytes_of("words", 1));
         static_cast<void>(work::merge_job(job, {"a.npy"}, {}, false, std::nullopt));
       }},
      merge_parts("job.piece.other", make_row(0, "A"), larger),
      merge_parts("job.piece.other", make_row(0, "A"), bare),
      merge_parts("job.device.other", make_row(0, "A"), make_row(1, "B")),
      merge_rays("job.piece.order", 7, "A"),
      merge_rays("job.device.other", 1, "B"),
      {"job.outputs.count",
       [] {
         const Job job = make_job("cast");
         work::write_job_spec(job, R"({"promin_cast_spec": 1, "scene": "a.obj", "rays": "rays.npy"})");
         work::check_merged_hits(job, {"a.npy", "b.npy"});
       }},
      {"job.frame.missing",
       [] {
         const Job job = make_job("render", work::name_pieces({0U, 1U}, {{{0, 0}, {1, 1}}}));
         static_cast<void>(work::number_pictures(job, {"a.####.exr"}, std::vector<uint32_t>{7}));
       }},
      {"output.frames.one",
       [] {
         const Job job = make_job("render", work::name_pieces({0U, 1U}, {{{0, 0}, {1, 1}}}));
         work::check_job_files(job, {"a.exr"}, std::nullopt);
       }},
      {"job.frames.none",
       [] { static_cast<void>(work::merge_job(make_job("cast"), {"a.npy"}, {}, false, std::vector<uint32_t>{7})); }},
  };
}

std::vector<MessageCase> cases_of_commands() {
  static const app::Console console(app::Verbosity::kQuiet);
  return {
      {"job.command.unknown", [] { app::spec_of_words("dance", {}, app::OutputWords::kAllowed); }},
      {"job.argument.wrong",
       [] {
         app::spec_of_words("render", {"a.obj", "--help"}, app::OutputWords::kAllowed);
       }},
      {"job.argument.wrong",
       [] {
         app::spec_of_words("render", {"a.obj", "--job", "b"}, app::OutputWords::kAllowed);
       }},
      {"job.rays.none",
       [] {
         write_rays("rays.npy", std::vector<Ray>(1));
         work::plan_job_of_text("render", "", "spec.json", "job", console, work::open_rays("rays.npy", "job"));
       }},
      {"job.spec.missing", [] { work::plan_again(make_job("render"), console); }},
      {"spec.format", [] { work::parse_spec<work::RenderSpec>("{}", "a.json"); }},
      {"spec.member.unknown",
       [] { work::parse_spec<work::RenderSpec>(R"({"promin_render_spec": 1, "spq": 4})", "a.json"); }},
      {"spec.member.value",
       [] { work::parse_spec<work::RenderSpec>(R"({"promin_render_spec": 1, "spp": "four"})", "a.json"); }},
      {"spec.file.name",
       [] {
         work::CastSpec spec;
         spec.rays = "caf\xe9.npy";
         static_cast<void>(work::write_spec(spec));
       }},
      {"job.offsets.none",
       [] {
         make_job("render");
         const char* const words[] = {"promin", "merge", "job", "-o", "a.exr", "--offsets", "a.npy"};
         app::run_command("promin", "", {app::add_merge_command}, 7, words);
       }},
  };
}

}  // namespace

std::vector<MessageCase> cases_of_jobs() {
  std::vector<MessageCase> all = cases_of_folders();
  for (const auto& cases : {cases_of_pieces(), cases_of_commands()}) all.insert(all.end(), cases.begin(), cases.end());
  return all;
}

}  // namespace promin
