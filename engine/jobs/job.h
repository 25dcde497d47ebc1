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

/// A file on which the pieces of a job depend.
struct InputFile {
  /// Name of the file without its folder.
  std::string name;
  uint64_t size_bytes = 0;
  std::string sha256;
};
/// Reads and hashes a file and returns its description. Throws InputError.
InputFile describe_input(const std::filesystem::path& file);

/// All inputs of a job's pieces. Jobs with equal manifests have equal pieces, bit for bit.
struct Manifest {
  /// The kind of the pieces: "render" or "cast".
  std::string kind;
  /// Names and values of all other inputs that affect the pieces' bytes.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<InputFile> files;
  /// Names of the pieces, indexed by their numbers. All names differ and consist of letters, digits, '_' and '-'.
  std::vector<std::string> pieces;
};

/// The content of a piece: a text from its maker, and its bytes.
struct Content {
  std::string description;
  std::vector<std::byte> bytes;
};

enum class PieceState {
  kMissing,
  /// The piece is complete, undamaged and belongs to this job.
  kDone,
  /// The piece exists, but is incomplete, damaged or belongs to another job.
  kBad,
};

/// The maker of pieces, as recorded in the ledger.
struct Maker {
  /// Device and driver, in readable form.
  std::string made_on;
  /// Hash of the maker's results for a fixed test (work/jobs/fingerprint.h); empty if the test was not run.
  std::string fingerprint;
  /// The build of the maker's program (work/jobs/build_id.h); empty for pieces that a function makes.
  std::string build = {};

  bool operator==(const Maker&) const = default;
};

/// The record of a piece that was written.
struct Receipt {
  size_t number = 0;
  std::string name;
  /// SHA-256 of the piece's bytes, without its description.
  std::string sha256;
  uint64_t size_bytes = 0;
  /// Time that the piece took, in milliseconds.
  double ms = 0.0;
  Maker maker;
  /// Version of the program that made the piece.
  std::string version;
  std::string host;
  int64_t pid = 0;
};

/// Work that is divided into pieces and kept in a folder: the manifest `job.json`, a file for each piece in `pieces`,
/// and the events recorded by makers in `ledger`. Only the folder determines which pieces are done. However the work
/// was interrupted, it continues from the folder. Several processes may work on one job, on all machines that can
/// access the folder. A piece that two processes make is written twice with the same bytes. The ledger is only
/// information. docs/jobs.md describes the formats.
class Job {
 public:
  /// Creates the folder, or continues the job in it. Throws UsageError with the difference if the folder contains
  /// another job, InputError if its manifest is damaged, and RunError if the folder cannot be written.
  static Job create(const std::filesystem::path& folder, const Manifest& manifest);
  /// Opens an existing job. Throws InputError.
  static Job open(const std::filesystem::path& folder);

  /// Throws UsageError with the difference if this job has another manifest.
  void check_same(const Manifest& manifest) const;

  const Manifest& manifest() const { return manifest_; }
  /// Returns the SHA-256 of the manifest.
  const std::string& id() const { return id_; }
  const std::filesystem::path& folder() const { return folder_; }
  size_t piece_count() const { return manifest_.pieces.size(); }
  std::filesystem::path file_of(size_t piece) const;

  /// Reads a whole piece and returns its state. `why` receives the fault of a bad piece: "the piece is incomplete".
  PieceState state_of(size_t piece, std::string* why = nullptr) const;
  /// Reads a piece. Throws InputError if it is missing or bad.
  Content read(size_t piece) const;
  /// Returns the maker of a piece, read from the beginning of the piece's file; nullopt if the piece is missing or bad.
  std::optional<Maker> maker_of(size_t piece) const;
  /// Writes a piece, and its receipt to the ledger. Throws RunError; the piece is then either complete or unchanged.
  Receipt write(size_t piece, const Content& content, double ms, const Maker& maker) const;

  // The following functions write further lines of the ledger. If a piece was begun and no further line follows, its
  // maker has died or is still working.

  /// Records the start of a piece. Throws RunError if the line cannot be written, because the piece could not be
  /// written either.
  void tell_begun(size_t piece, const Maker& maker) const;
  /// Records that making the piece failed, with the reason. Ignores failures to write the line.
  void tell_failed(size_t piece, const Maker& maker, const std::string& why) const;
  /// Records that the maker of a piece was asked to stop. Ignores failures to write the line.
  void tell_stopped(size_t piece, const Maker& maker) const;
  /// Removes temporary files of writers that were killed on this machine.
  void clear_leftovers() const;

 private:
  Job(std::filesystem::path folder, Manifest manifest);
  std::filesystem::path ledger_file() const;

  std::filesystem::path folder_;
  Manifest manifest_;
  std::string id_;
};

/// A share of the pieces of a job: the pieces whose number divided by `count` leaves the remainder `index`.
struct Share {
  size_t index = 0;
  size_t count = 1;

  bool is_all() const { return count == 1; }
};

/// A piece that is about to be made.
struct NextPiece {
  size_t number = 0;
  /// Number of missing pieces of the share before this one, and number of all missing pieces of the share.
  size_t before = 0;
  size_t total = 0;
  /// The fault of an existing bad piece: "the piece is incomplete".
  std::string why;
};

/// Makes a piece, even if it exists, and records it in the ledger. Throws the same errors as `make` and Job::write().
Receipt make_piece(const Job& job, size_t piece, const Maker& maker, const std::function<Content(size_t piece)>& make);

/// A function that is called before each piece is made. It returns whether to continue.
using BeforePiece = std::function<bool(const NextPiece& next)>;

/// Makes the missing pieces of a share in their order. `make` returns the content of the piece with a number. Returns
/// the number of pieces that were made, which is smaller than the number of missing pieces if `before` returned false.
size_t run_share(const Job& job, const Share& share, const Maker& maker, const BeforePiece& before,
                 const std::function<Content(size_t piece)>& make);

/// Checks that this maker's build may make pieces of the job. If another build has made pieces on the same device, and
/// this build has made none, the function makes one finished piece again, writes nothing, and returns the piece's
/// number. Throws UsageError if the bytes differ, because the pieces of the two builds must not be mixed.
std::optional<size_t> check_build(const Job& job, const Maker& maker, const std::function<Content(size_t piece)>& make);

/// Returns the pieces of a share that are not done.
std::vector<size_t> find_missing(const Job& job, const Share& share = {});
/// Returns the pieces of this list that are not done.
std::vector<size_t> keep_missing(const Job& job, std::vector<size_t> pieces);

}  // namespace promin::jobs
