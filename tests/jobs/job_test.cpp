// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check jobs whose pieces are plain bytes: the folder alone tells the state, whatever happened to it.
#include "jobs/job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <sstream>
#include <tuple>

#include "core/file.h"
#include "jobs/known_hashes.h"
#include "jobs/sha256.h"
#include "promin/error.h"
#include "support/temp_folder.h"

namespace promin::jobs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace fs = std::filesystem;

Manifest make_manifest(size_t pieces = 5) {
  Manifest manifest{
      .kind = "bytes", .options = {{"results", "1"}, {"--spp", "4"}}, .files = {{"a.gltf", 12, "ab"}}, .pieces = {}};
  for (size_t i = 0; i < pieces; ++i) manifest.pieces.push_back("part" + std::to_string(i));
  return manifest;
}

const Maker kMaker{"here", "print", "one"};

Content make_content(size_t piece) {
  Content content{"number " + std::to_string(piece), {}};
  for (size_t i = 0; i < 1000 + piece; ++i) content.bytes.push_back(static_cast<std::byte>(i * (piece + 3)));
  return content;
}

class JobTest : public TempFolder {
 protected:
  /// Returns the pieces that were made, and stores the bad pieces in bad_.
  std::vector<size_t> run(const Job& job, const Share& share = {}) {
    std::vector<size_t> made;
    bad_.clear();
    run_share(
        job, share, kMaker,
        [&](const NextPiece& next) {
          if (!next.why.empty()) bad_.push_back(std::to_string(next.number) + " " + next.why);
          return true;
        },
        [&](size_t piece) {
          made.push_back(piece);
          return make_content(piece);
        });
    return made;
  }

  std::string read(const fs::path& file) const {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }
  void write(const fs::path& file, const std::string& text) const { std::ofstream(file, std::ios::binary) << text; }

  /// Returns the sentence of the exception that a call throws.
  template <typename Exception, typename Call>
  static std::string refusal_of(const Call& call) {
    try {
      call();
    } catch (const Exception& error) {
      return list_problems(error);
    }
    return "";
  }

  /// The folder of the job, which does not exist yet.
  fs::path job_folder_ = folder_ / "job";
  std::vector<std::string> bad_;
};

TEST(Sha256Test, IsThatOfTheStandard) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256().add("a").add("bc").finish(), sha256_of("abc"));
}

TEST_F(JobTest, WhatIsDoneIsNotMadeAgain) {
  const Job job = Job::create(job_folder_, make_manifest());
  EXPECT_EQ(find_missing(job).size(), 5U);
  EXPECT_THAT(run(job, {1, 2}), ElementsAre(1, 3));
  EXPECT_THAT(run(job, {1, 2}), IsEmpty());
  EXPECT_THAT(find_missing(job, {1, 2}), IsEmpty());
  EXPECT_THAT(run(Job::create(job_folder_, make_manifest())), ElementsAre(0, 2, 4));
  const Job again = Job::open(job_folder_);
  EXPECT_EQ(again.id(), job.id());
  EXPECT_EQ(again.manifest().options, job.manifest().options);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(again.read(i).bytes, make_content(i).bytes);
    EXPECT_EQ(again.read(i).description, make_content(i).description);
  }
}

TEST_F(JobTest, SharesEachHaveTheirOwn) {
  const Job job = Job::create(job_folder_, make_manifest(10));
  EXPECT_THAT(run(job, {0, 3}), ElementsAre(0, 3, 6, 9));
  EXPECT_THAT(run(job, {2, 3}), ElementsAre(2, 5, 8));
  EXPECT_THAT(run(job, {7, 20}), ElementsAre(7));
  EXPECT_THAT(run(job, {15, 20}), IsEmpty());
}

TEST_F(JobTest, WhatIsBadIsNamedAndMadeAnew) {
  const Job job = Job::create(job_folder_, make_manifest(6));
  run(job);
  const std::string whole = read(job.file_of(0));
  std::string flipped = whole;
  flipped.back() = static_cast<char>(flipped.back() ^ 1);
  write(job.file_of(0), flipped);
  write(job.file_of(1), read(job.file_of(1)).substr(0, 900));
  write(job.file_of(2), "");
  fs::copy_file(job.file_of(4), job.file_of(3), fs::copy_options::overwrite_existing);
  // The checksum also covers the text that describes the piece.
  std::string renumbered = read(job.file_of(5));
  renumbered.replace(renumbered.find("number 5"), 8, "number 6");
  write(job.file_of(5), renumbered);
  EXPECT_EQ(job.state_of(0), PieceState::kBad);
  EXPECT_THAT(refusal_of<InputError>([&] { job.read(0); }), HasProblem("job.piece.damaged"));
  EXPECT_THAT(find_missing(job), ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(run(job), ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(bad_, ElementsAre("0 the piece is damaged", "1 the piece is incomplete", "2 the file is empty",
                                "3 the file contains another piece", "5 the piece is damaged"));
  EXPECT_EQ(read(job.file_of(0)), whole);
  EXPECT_THAT(find_missing(job), IsEmpty());
}

TEST_F(JobTest, PiecesOfAnotherJobAreForeign) {
  const Job job = Job::create(job_folder_, make_manifest());
  run(job);
  Manifest other = make_manifest();
  other.options[1].second = "8";
  const fs::path second = folder_ / "other";
  const Job foreign = Job::create(second, other);
  EXPECT_NE(foreign.id(), job.id());
  fs::copy_file(job.file_of(2), foreign.file_of(2));
  std::string why;
  EXPECT_EQ(foreign.state_of(2, &why), PieceState::kBad);
  EXPECT_EQ(why, "the piece belongs to another job");
}

TEST_F(JobTest, AFolderOfAnotherJobIsRefusedWithWhatDiffers) {
  Job::create(job_folder_, make_manifest());
  const std::pair<void (*)(Manifest&), const char*> cases[] = {
      {[](Manifest& m) { m.options[1].second = "8"; }, "its --spp is \"4\", but now it is \"8\""},
      {[](Manifest& m) { m.options.pop_back(); },
       "its --spp is \"4\", but now it is not given or has its default value"},
      {[](Manifest& m) { m.options.emplace_back("--crop", "0 0 1 1"); },
       "its --crop is not given or has its default value, but now it is \"0 0 1 1\""},
      {[](Manifest& m) { m.options[0].second = "2"; }, "its results is \"1\", but now it is \"2\""},
      {[](Manifest& m) { m.files[0].sha256 = "cd"; }, "the file \"a.gltf\" has changed since"},
      {[](Manifest& m) { m.files[0].name = "b.gltf"; }, "its file is \"a.gltf\", but now it is \"b.gltf\""},
      {[](Manifest& m) { m.files.clear(); }, "it has the file \"a.gltf\" as well"},
      {[](Manifest& m) { m.pieces.pop_back(); }, "it has 5 pieces, but the number is now 4"},
      {[](Manifest& m) { m.pieces[3] = "other"; }, "its piece part3 is called other now"},
      {[](Manifest& m) { m.kind = "rays"; }, "its kind is \"bytes\""}};
  for (const auto& [change, sentence] : cases) {
    Manifest other = make_manifest();
    change(other);
    EXPECT_THAT(refusal_of<UsageError>([&] { Job::create(job_folder_, other); }),
                AllOf(HasProblem("job.other"), HasSubstr(sentence)));
  }
}

TEST_F(JobTest, FoldersWithoutAJobAreRefused) {
  EXPECT_THAT(refusal_of<InputError>([&] { Job::open(job_folder_); }), HasProblem("job.folder.missing"));
  fs::create_directories(job_folder_);
  EXPECT_THAT(refusal_of<InputError>([&] { Job::open(job_folder_); }), HasProblem("job.missing"));
  write(job_folder_ / "letter.txt", "dear");
  EXPECT_THAT(refusal_of<UsageError>([&] { Job::create(job_folder_, make_manifest()); }),
              HasProblem("job.folder.used"));
  EXPECT_EQ(read(job_folder_ / "letter.txt"), "dear");
  for (const char* text : {"{", "[]", R"({"promin_job": 1})", R"({"promin_job": 3})"}) {
    write(job_folder_ / "job.json", text);
    EXPECT_NE(refusal_of<InputError>([&] { Job::open(job_folder_); }), "") << text;
    EXPECT_NE(refusal_of<InputError>([&] { Job::create(job_folder_, make_manifest()); }), "") << text;
  }
}

TEST_F(JobTest, AFolderOfAnOlderVersionIsRefusedAndSaysSo) {
  Job::create(job_folder_, make_manifest());
  std::string text = read(job_folder_ / "job.json");
  const std::string format = "\"promin_job\": 3";
  ASSERT_NE(text.find(format), std::string::npos);
  for (const auto& [other, sentence] : {std::pair("\"promin_job\": 2", "was made by an older version of promin"),
                                        std::pair("\"promin_job\": 4", "was made by another version of promin")}) {
    std::string changed = text;
    changed.replace(changed.find(format), format.size(), other);
    write(job_folder_ / "job.json", changed);
    EXPECT_THAT(refusal_of<InputError>([&] { Job::open(job_folder_); }), HasSubstr(sentence));
    EXPECT_THAT(refusal_of<InputError>([&] { Job::create(job_folder_, make_manifest()); }), HasSubstr(sentence));
  }
}

TEST_F(JobTest, AnotherBuildFirstMakesOnePieceAgain) {
  const Job job = Job::create(job_folder_, make_manifest());
  make_piece(job, 2, kMaker, make_content);
  ASSERT_TRUE(job.maker_of(2));
  EXPECT_EQ(job.maker_of(2)->build, "one");
  EXPECT_EQ(job.maker_of(0), std::nullopt);
  std::vector<size_t> made;
  const auto make_as = [&](std::byte more) {
    return [&made, more](size_t piece) {
      made.push_back(piece);
      Content content = make_content(piece);
      content.bytes.front() ^= more;
      return content;
    };
  };
  const auto equal = make_as(std::byte{0});
  const auto other = make_as(std::byte{1});
  EXPECT_EQ(check_build(job, kMaker, other), std::nullopt) << "its own pieces need no proof";
  EXPECT_EQ(check_build(job, {"here", "print", "two"}, equal), 2U);
  EXPECT_EQ(check_build(job, {"here", "", "two"}, equal), 2U) << "without a fingerprint";
  EXPECT_EQ(check_build(job, {"elsewhere", "print", "two"}, other), std::nullopt) << "other devices have other bits";
  EXPECT_EQ(check_build(job, {"here", "other", "two"}, other), std::nullopt);
  EXPECT_THAT(made, ElementsAre(2U, 2U));
  EXPECT_THAT(
      refusal_of<UsageError>([&] {
        check_build(job, {"here", "print", "two"}, other);
      }),
      HasSubstr("were made by another build of promin, and this build computes different bits for piece part2"));
  // After a build has made a piece, further processes of this build need not make it again as a proof.
  make_piece(job, 0, {"here", "print", "two"}, make_content);
  EXPECT_EQ(check_build(job, {"here", "print", "two"}, other), std::nullopt);
  // A bad piece is not a proof.
  write(job.file_of(0), read(job.file_of(0)) + "more");
  write(job.file_of(2), read(job.file_of(2)) + "more");
  EXPECT_EQ(check_build(job, {"here", "print", "three"}, other), std::nullopt);
}

// Many processes of a queue do this, and one was killed before it had begun.
TEST_F(JobTest, SeveralMayBeginAtOnce) {
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    try {
      for (int k = 0; k < 50; ++k) Job::create(job_folder_ / std::to_string(k), make_manifest());
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      _exit(1);
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  fs::create_directories(job_folder_ / "begun");
  write(job_folder_ / "begun" / ("job.tmp99999999-" + host_name() + ".json"), "{");
  EXPECT_NO_THROW(Job::create(job_folder_ / "begun", make_manifest()));
}

TEST_F(JobTest, AManifestThatWasChangedByHandIsDamaged) {
  Job::create(job_folder_, make_manifest());
  std::string text = read(job_folder_ / "job.json");
  text.replace(text.find(" \"options\""), 1, "  ");
  write(job_folder_ / "job.json", text);
  EXPECT_THAT(refusal_of<InputError>([&] { Job::open(job_folder_); }), HasProblem("job.manifest.damaged"));
  write(job_folder_ / "job.json", "");
  EXPECT_THAT(refusal_of<InputError>([&] { Job::open(job_folder_); }), HasProblem("job.manifest.damaged"));
}

TEST_F(JobTest, LeftoversOfTheDeadAreCleared) {
  const Job job = Job::create(job_folder_, make_manifest());
  const fs::path dead = job_folder_ / "pieces" / ("part0.tmp99999999-" + host_name() + ".piece");
  write(dead, "half");
  run(job);
  EXPECT_FALSE(fs::exists(dead));
}

TEST_F(JobTest, TheLedgerTellsWhatBeginsAndWhatCameOfIt) {
  const Job job = Job::create(job_folder_, make_manifest());
  const Receipt receipt = make_piece(job, 1, kMaker, make_content);
  const Content content = make_content(1);
  EXPECT_EQ(receipt.sha256, Sha256().add(content.bytes).finish());
  EXPECT_EQ(std::tuple(receipt.number, receipt.name, receipt.size_bytes, receipt.version),
            std::tuple(1U, "part1", content.bytes.size(), PROMIN_VERSION));
  EXPECT_THROW(make_piece(job, 2, kMaker,
                          [](size_t) -> Content {
                            throw RunError({"device.lost", "the device is gone", "", ""});
                          }),
               RunError);
  EXPECT_THROW(make_piece(job, 3, kMaker, [](size_t) -> Content { throw Cancelled(); }), Cancelled);
  std::vector<fs::path> ledgers(fs::directory_iterator(job_folder_ / "ledger"), fs::directory_iterator());
  ASSERT_EQ(ledgers.size(), 1U);
  EXPECT_EQ(ledgers[0].filename(), host_name() + "-" + std::to_string(getpid()) + ".jsonl");
  std::ifstream ledger(ledgers[0]);
  std::vector<std::string> lines;
  for (std::string line; std::getline(ledger, line);) lines.push_back(line);
  const std::string maker = R"("made_on":"here","fingerprint":"print")";
  EXPECT_THAT(
      lines, ElementsAre(AllOf(HasSubstr(R"({"event":"begun","number":1,"piece":"part1","time_s":)"), HasSubstr(maker)),
                         AllOf(HasSubstr(R"({"event":"done","number":1,"piece":"part1","time_s":)"), HasSubstr(maker),
                               HasSubstr("\"sha256\":\"" + receipt.sha256 + "\",\"size_bytes\":1001,\"ms\":"),
                               HasSubstr("\"pid\":" + std::to_string(getpid()))),
                         HasSubstr(R"("event":"begun","number":2)"),
                         AllOf(HasSubstr(R"("event":"failed","number":2)"), HasSubstr(R"("why":"the device is gone")")),
                         HasSubstr(R"("event":"begun","number":3)"), HasSubstr(R"("event":"stopped","number":3)")));
}

// A process whose disk is full before the piece begins makes no piece.
TEST_F(JobTest, WhereNoLineCanBeWrittenNoPieceIsMade) {
  const Job job = Job::create(job_folder_, make_manifest());
  fs::create_directories(job_folder_ / "ledger" / (host_name() + "-" + std::to_string(getpid()) + ".jsonl"));
  EXPECT_THROW(run(job), RunError);
  EXPECT_EQ(find_missing(job).size(), 5U);
}

TEST_F(JobTest, HashesOfFilesAreKnownByTheirStamps) {
  const fs::path file = folder_ / "rays.npy";
  write(file, "many rays");
  KnownHashes first(folder_);
  EXPECT_EQ(first.describe(file).sha256, sha256_of("many rays"));
  first.save();
  // The job uses the stored hash and does not read the file, so it accepts a hash that was written by hand.
  std::string kept = read(folder_ / "hashes.json");
  kept.replace(kept.find(sha256_of("many rays")), 64, std::string(64, 'a'));
  write(folder_ / "hashes.json", kept);
  EXPECT_EQ(KnownHashes(folder_).describe(file).sha256, std::string(64, 'a'));
  write(file, "other rays");
  EXPECT_EQ(KnownHashes(folder_).describe(file).sha256, sha256_of("other rays"));
  for (const char* damaged : {"{", "[]", R"({"a": {}})", ""}) {
    write(folder_ / "hashes.json", damaged);
    EXPECT_EQ(KnownHashes(folder_).describe(file).sha256, sha256_of("other rays")) << damaged;
  }
}

// A process that stops in the middle has written nothing of its current piece.
TEST_F(JobTest, WhatMakesNoPieceLeavesNone) {
  const Job job = Job::create(job_folder_, make_manifest());
  const auto fails_at_2 = [](size_t piece) {
    if (piece == 2) throw RunError({"device.lost", "the device is gone", "here", "try again"});
    return make_content(piece);
  };
  EXPECT_THROW(run_share(
                   job, {}, kMaker, [](const NextPiece&) { return true; }, fails_at_2),
               RunError);
  EXPECT_THAT(find_missing(job), ElementsAre(2, 3, 4));
  EXPECT_EQ(run_share(
                job, {}, kMaker, [](const NextPiece& next) { return next.number < 3; }, make_content),
            1U);
  EXPECT_THAT(find_missing(job), ElementsAre(3, 4));
}

}  // namespace
}  // namespace promin::jobs
