// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace promin::jobs {

/// A file that the pieces of a job hang on.
struct InputFile {
  /// Without its folder.
  std::string name;
  uint64_t size_bytes = 0;
  std::string sha256;
};
/// Reads it for its hash. Throws InputError.
InputFile describe_input(const std::filesystem::path& file);

/// What a job is: all that its pieces hang on. Jobs of equal manifests have equal pieces, to the bit.
struct Manifest {
  /// What the pieces are: "render", "cast".
  std::string kind;
  /// Name and value of whatever else decides their bytes, the program's version too.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<InputFile> files;
  /// Names of the pieces, all different, of letters, digits, '_' and '-'; by their numbers.
  std::vector<std::string> pieces;
};

/// What a piece is made of: what its maker says of it, a text, and its bytes.
struct Content {
  std::string description;
  std::vector<std::byte> bytes;
};

enum class PieceState {
  kMissing,
  /// Whole, of this job and as it was written.
  kDone,
  /// There, but cut, damaged or of another job.
  kBad,
};

/// Who makes pieces, for the ledger.
struct Maker {
  /// Device and driver in words.
  std::string made_on;
  /// The hash of its answers to fixed questions (app/fingerprint.h); empty where it was not asked.
  std::string fingerprint;
};

/// What is told of a piece once it is written.
struct Receipt {
  size_t number = 0;
  std::string name;
  /// Of the piece's bytes, without its description.
  std::string sha256;
  uint64_t size_bytes = 0;
  /// What making it took.
  double ms = 0.0;
  Maker maker;
  /// The program's.
  std::string version;
  std::string host;
  int64_t pid = 0;
};

/// Work in pieces in a folder: `job.json`, which is the manifest, a file for each piece in `pieces`, and in `ledger`
/// what happened to them, by those who made them. The folder alone tells what is done: whoever was ended, by whatever,
/// goes on from there, and several may work on one job, on any machines that see the folder. A piece that two make is
/// written twice, the same. The ledger informs and decides nothing. docs/jobs.md has the formats of all of it.
class Job {
 public:
  /// Makes the folder, or goes on with what is in it. Throws UsageError where that is another job, which says what
  /// differs; InputError where its manifest is damaged; RunError where it cannot be written.
  static Job create(const std::filesystem::path& folder, const Manifest& manifest);
  /// A job that there is. Throws InputError.
  static Job open(const std::filesystem::path& folder);

  /// Throws UsageError where this is not the job of that manifest, which says what differs.
  void check_same(const Manifest& manifest) const;

  const Manifest& manifest() const { return manifest_; }
  /// SHA-256 of the manifest.
  const std::string& id() const { return id_; }
  const std::filesystem::path& folder() const { return folder_; }
  size_t piece_count() const { return manifest_.pieces.size(); }
  std::filesystem::path file_of(size_t piece) const;

  /// What the disk tells: reads the piece whole. `why` is told what is bad about it: "is cut".
  PieceState state_of(size_t piece, std::string* why = nullptr) const;
  /// Throws InputError where the piece is missing or bad.
  Content read(size_t piece) const;
  /// Writes a piece, and its receipt to the ledger. Throws RunError; the piece is there whole, or as it was before.
  Receipt write(size_t piece, const Content& content, double ms, const Maker& maker) const;

  // Further lines of the ledger. A piece that was begun, and of which its maker says no more, was its maker's end.

  /// Throws RunError where the disk takes no line, as it will take no piece then.
  void tell_begun(size_t piece, const Maker& maker) const;
  /// That no piece came of it, for this reason. It is not told where the disk takes no line.
  void tell_failed(size_t piece, const Maker& maker, const std::string& why) const;
  /// That its maker was asked to stop. The same.
  void tell_stopped(size_t piece, const Maker& maker) const;
  /// Removes what writers have left behind that were ended on this machine.
  void clear_leftovers() const;

 private:
  Job(std::filesystem::path folder, Manifest manifest);
  std::filesystem::path ledger_file() const;

  std::filesystem::path folder_;
  Manifest manifest_;
  std::string id_;
};

/// A share of the pieces of a job: those whose number is `index` more than a multiple of `count`.
struct Share {
  size_t index = 0;
  size_t count = 1;

  bool is_all() const { return count == 1; }
};

/// A piece that is about to be made.
struct NextPiece {
  size_t number = 0;
  /// Of those of the share that are to be made, how many come before it, and all.
  size_t before = 0;
  size_t total = 0;
  /// What is bad about it where it is there: "is cut".
  std::string why;
};

/// Makes a piece, whatever there is of it, and tells the ledger. Throws what `make` does and what Job::write does.
Receipt make_piece(const Job& job, size_t piece, const Maker& maker, const std::function<Content(size_t piece)>& make);

/// Is told of each piece before it is made; whether to go on.
using BeforePiece = std::function<bool(const NextPiece& next)>;

/// Makes the pieces of a share that are not done, in their order. `make` returns a piece's content by its number.
/// Returns how many it has made; fewer than there were to make where `before` has said so.
size_t run_share(const Job& job, const Share& share, const Maker& maker, const BeforePiece& before,
                 const std::function<Content(size_t piece)>& make);

/// The pieces of a share that are not done.
std::vector<size_t> find_missing(const Job& job, const Share& share = {});
/// Of these pieces those that are not done.
std::vector<size_t> keep_missing(const Job& job, std::vector<size_t> pieces);

}  // namespace promin::jobs
