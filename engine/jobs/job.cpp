// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "jobs/job.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <variant>

#include "core/file.h"
#include "core/json_text.h"
#include "core/stopwatch.h"
#include "core/utf8.h"
#include "jobs/sha256.h"
#include "promin/error.h"

namespace promin::jobs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Version of the format of manifests and pieces.
constexpr int kFormat = 3;
constexpr std::string_view kMagic = "promin piece 3";
/// The largest size of a piece's header in bytes; real headers are much shorter.
constexpr size_t kMostHeaderBytes = 1U << 20;

Json json_of(const Manifest& manifest) {
  Json options = Json::object();
  for (const auto& [name, value] : manifest.options) options[name] = value;
  Json files = Json::array();
  for (const InputFile& file : manifest.files) {
    files.push_back({{"name", file.name}, {"size_bytes", file.size_bytes}, {"sha256", file.sha256}});
  }
  return {{"promin_job", kFormat},
          {"kind", manifest.kind},
          {"options", options},
          {"files", files},
          {"pieces", manifest.pieces}};
}

Manifest manifest_of(const Json& json) {
  Manifest manifest;
  manifest.kind = json.at("kind").get<std::string>();
  for (const auto& [name, value] : json.at("options").items()) {
    manifest.options.emplace_back(name, value.get<std::string>());
  }
  for (const Json& file : json.at("files")) {
    manifest.files.push_back({file.at("name"), file.at("size_bytes"), file.at("sha256")});
  }
  manifest.pieces = json.at("pieces").get<std::vector<std::string>>();
  return manifest;
}

/// Returns whether all names can be names of pieces. Names become file names, so names in an untrusted folder must not
/// refer to files outside it.
bool has_names_of_pieces(const Manifest& manifest) {
  constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !manifest.pieces.empty() && std::ranges::all_of(manifest.pieces, [&](const std::string& name) {
    return !name.empty() && name.find_first_not_of(kAllowed) == std::string::npos;
  });
}

fs::path manifest_file(const fs::path& folder) {
  return folder / "job.json";
}

std::string text_of(const Manifest& manifest) {
  return json_text(json_of(manifest), 1) + "\n";
}

/// Reads the manifest of a folder that has one. Throws InputError.
Manifest read_manifest(const fs::path& folder) {
  const fs::path file = manifest_file(folder);
  const char* cure = "use another folder, or remove this one";
  const InputError damaged(
      {"job.manifest.damaged", "the file is not the manifest of a job, or it is damaged", file.string(), cure});
  std::error_code none;
  if (fs::is_empty(file, none)) throw damaged;
  const std::vector<std::byte> bytes = read_file(file);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    const Json json = read_ordered_json(text);
    const int format = json.at("promin_job").get<int>();
    if (format < kFormat) {
      throw InputError({"job.version.old",
                        "the job was made by an older version of promin, which this version cannot continue",
                        file.string(), "make a new job in another folder, or remove this one"});
    }
    if (format != kFormat) {
      throw InputError({"job.version", "the job was made by another version of promin", file.string(), cure});
    }
    Manifest manifest = manifest_of(json);
    // If a user has edited the manifest, it no longer matches its pieces.
    if (text_of(manifest) == text && has_names_of_pieces(manifest)) return manifest;
  } catch (const nlohmann::json::exception&) {
  }
  throw damaged;
}

std::string shown(const std::string& value) {
  return value.empty() ? "nothing" : "\"" + value + "\"";
}

/// The text for an option that a manifest does not contain. Manifests omit options with their default values.
constexpr std::string_view kLeftOut = "is not given or has its default value";

/// Returns the first difference of two jobs, as a sentence.
std::string find_difference(const Manifest& there, const Manifest& wanted) {
  if (there.kind != wanted.kind) return "its kind is " + shown(there.kind);
  const auto value_of = [](const Manifest& manifest, const std::string& name) -> std::optional<std::string> {
    for (const auto& [key, value] : manifest.options) {
      if (key == name) return value;
    }
    return {};
  };
  for (const auto& [name, value] : wanted.options) {
    const std::optional<std::string> other = value_of(there, name);
    if (!other) return fmt::format("its {} {}, but now it is {}", name, kLeftOut, shown(value));
    if (*other != value) return fmt::format("its {} is {}, but now it is {}", name, shown(*other), shown(value));
  }
  for (const auto& [name, value] : there.options) {
    if (!value_of(wanted, name)) return fmt::format("its {} is {}, but now it {}", name, shown(value), kLeftOut);
  }
  for (size_t i = 0; i < std::max(there.files.size(), wanted.files.size()); ++i) {
    if (i >= there.files.size()) return fmt::format("it lacks the file {}", shown(wanted.files[i].name));
    if (i >= wanted.files.size()) return fmt::format("it has the file {} as well", shown(there.files[i].name));
    if (there.files[i].name != wanted.files[i].name) {
      return fmt::format("its file is {}, but now it is {}", shown(there.files[i].name), shown(wanted.files[i].name));
    }
    if (there.files[i].sha256 != wanted.files[i].sha256) {
      return fmt::format("the file {} has changed since", shown(wanted.files[i].name));
    }
  }
  if (there.pieces.size() != wanted.pieces.size()) {
    return fmt::format("it has {} pieces, but the number is now {}", there.pieces.size(), wanted.pieces.size());
  }
  const auto [own, other] = std::ranges::mismatch(there.pieces, wanted.pieces);
  return fmt::format("its piece {} is called {} now", *own, *other);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return;
  refuse_lost_folder(folder);
  throw RunError({"folder.create", "the folder cannot be created (" + error.message() + ")", folder.string(),
                  "check the disk and permissions"});
}

/// Returns whether the folder contains files that no job creates.
bool has_strangers(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("job.") && name != "pieces" && name != "ledger") return true;
  }
  return false;
}

/// Flushes the entry of a new file in its folder to the disk.
void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

/// The header of a piece, a line of JSON, and the position where the piece's bytes begin.
struct Header {
  Json json;
  size_t begin = 0;
};

std::optional<Header> read_header(std::string_view text) {
  const size_t end_of_magic = text.find('\n');
  if (text.substr(0, end_of_magic) != kMagic) return {};
  const size_t end = text.substr(0, kMostHeaderBytes).find('\n', end_of_magic + 1);
  if (end == std::string_view::npos) return {};
  Json json = read_ordered_json_or_discard(text.substr(end_of_magic + 1, end - end_of_magic - 1));
  if (!json.is_object()) return {};
  return Header{std::move(json), end + 1};
}

std::string hash_of(std::span<const std::byte> bytes) {
  return Sha256().add(bytes).finish();
}

/// Reads the first two lines of a piece.
std::optional<Header> read_header_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string magic;
  std::string line;
  if (!std::getline(stream, magic) || !std::getline(stream, line)) return {};
  return read_header(magic + "\n" + line + "\n");
}

/// The content of a piece, or a description of its fault without the place and without advice.
using Reading = std::variant<Content, Problem>;

Reading read_piece(const fs::path& file, const std::string& job, const std::string& name) {
  std::vector<std::byte> bytes;
  try {
    bytes = read_file(file);
  } catch (const InputError& error) {
    return error.problems().front();
  }
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::optional<Header> header = read_header(text);
  if (!header) return Problem{"job.piece.cut", "the file is not a piece of a job, or it is incomplete", "", ""};
  const auto word = [&](const char* key) { return header->json.value(key, std::string()); };
  try {
    if (word("job") != job) return Problem{"job.piece.other", "the piece belongs to another job", "", ""};
    if (word("piece") != name) return Problem{"job.piece.other", "the file contains another piece", "", ""};
    Content content{word("description"), {bytes.begin() + static_cast<std::ptrdiff_t>(header->begin), bytes.end()}};
    if (content.bytes.size() != header->json.value("size_bytes", uint64_t{0}))
      return Problem{"job.piece.cut", "the piece is incomplete", "", ""};
    if (word("description_sha256") != sha256_of(content.description))
      return Problem{"job.piece.damaged", "the piece is damaged", "", ""};
    if (word("sha256") != hash_of(content.bytes)) return Problem{"job.piece.damaged", "the piece is damaged", "", ""};
    return content;
  } catch (const nlohmann::json::exception&) {
    return Problem{"job.piece.damaged", "the piece is damaged", "", ""};
  }
}

/// Appends a line to a file, completely or not at all. No other process writes the file.
void append_line(const fs::path& file, const std::string& line, bool reaches_disk) {
  // Only one thread at a time writes, because a thread that fails removes what it has written.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const off_t end = descriptor >= 0 ? lseek(descriptor, 0, SEEK_END) : -1;
  bool is_written = end >= 0 && ::write(descriptor, line.data(), line.size()) == ssize_t(line.size());
  if (is_written && reaches_disk) is_written = fsync(descriptor) == 0;
  const int error = errno;
  if (!is_written && end >= 0) static_cast<void>(ftruncate(descriptor, end));
  if (descriptor >= 0) close(descriptor);
  if (is_written) return;
  throw RunError({"file.write", std::string("the ledger cannot be written (") + std::strerror(error) + ")",
                  file.string(), "check the disk and permissions"});
}

/// Returns the time in seconds since 1970.
double now_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Starts a line of the ledger with its common members.
Json begin_line(const char* event, size_t piece, const Manifest& manifest, const Maker& maker) {
  Json line = {{"event", event}, {"number", piece}, {"piece", manifest.pieces[piece]}, {"time_s", now_s()}};
  line["made_on"] = maker.made_on;
  line["fingerprint"] = maker.fingerprint;
  return line;
}

std::string text_of_line(const Json& line) {
  return json_text(line) + "\n";
}

/// Returns the version of the maker of pieces: if the job states the version of a function, that version, otherwise
/// promin's.
std::string version_of(const Manifest& manifest) {
  for (const auto& [name, value] : manifest.options) {
    if (name == "version") return value;
  }
  return PROMIN_VERSION;
}

/// Returns whether two makers are expected to give the same bits if they use the same build. Programs compute no
/// fingerprint, so an empty fingerprint is not compared.
bool is_same_device(const Maker& a, const Maker& b) {
  const bool may_differ = !a.fingerprint.empty() && !b.fingerprint.empty() && a.fingerprint != b.fingerprint;
  return a.made_on == b.made_on && !may_differ;
}

/// Returns a finished piece that another build has made on this maker's device; nullopt if there is none, or if this
/// build has made pieces of the job, because it has then passed check_build().
std::optional<size_t> find_piece_of_other_build(const Job& job, const Maker& maker) {
  std::optional<size_t> found;
  for (size_t piece = 0; piece < job.piece_count(); ++piece) {
    const std::optional<Maker> other = job.maker_of(piece);
    if (!other || !is_same_device(*other, maker)) continue;
    if (other->build == maker.build) return {};
    if (!found && job.state_of(piece) == PieceState::kDone) found = piece;
  }
  return found;
}

}  // namespace

InputFile describe_input(const fs::path& file) {
  const std::string path = fs::absolute(file).string();
  if (to_utf8(path) != path) {
    throw InputError({"file.name", "the name of the file or of its folder is not UTF-8, so a job cannot record it",
                      file.string(), "rename the file or the folder"});
  }
  const std::string hash = sha256_of_file(file);
  return {file.filename().string(), fs::file_size(file), hash};
}

Job::Job(fs::path folder, Manifest manifest)
    : folder_(std::move(folder)), manifest_(std::move(manifest)), id_(sha256_of(text_of(manifest_))) {}

Job Job::create(const fs::path& folder, const Manifest& manifest) {
  make_folder(folder);
  promin::clear_leftovers(folder);
  std::error_code error;
  // Other processes may create the same job at the same time. They write the same bytes.
  if (has_strangers(folder) && !fs::exists(manifest_file(folder), error)) {
    throw UsageError(
        {"job.folder.used", "the folder has files but no job", folder.string(), "use a new or an empty folder"});
  }
  if (!fs::exists(manifest_file(folder), error)) {
    write_text_file(manifest_file(folder), text_of(manifest));
    flush_folder(folder);
  }
  const Job job(folder, read_manifest(folder));
  job.check_same(manifest);
  make_folder(folder / "pieces");
  make_folder(folder / "ledger");
  return job;
}

Job Job::open(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    refuse_lost_folder(folder);
    throw InputError(
        {"job.folder.missing", "the folder does not exist", folder.string(), "give the folder that --job created"});
  }
  if (!fs::exists(manifest_file(folder), error)) {
    throw InputError(
        {"job.missing", "there is no job in the folder", folder.string(), "give the folder that --job created"});
  }
  return {folder, read_manifest(folder)};
}

void Job::check_same(const Manifest& manifest) const {
  if (text_of(manifest_) == text_of(manifest)) return;
  throw UsageError({"job.other", "the folder belongs to another job: " + find_difference(manifest_, manifest),
                    folder_.string(), "use another folder, or the same options and files as that job"});
}

fs::path Job::ledger_file() const {
  return folder_ / "ledger" / fmt::format("{}-{}.jsonl", host_name(), getpid());
}

fs::path Job::file_of(size_t piece) const {
  return folder_ / "pieces" / (manifest_.pieces[piece] + ".piece");
}

PieceState Job::state_of(size_t piece, std::string* why) const {
  std::error_code error;
  if (!fs::exists(file_of(piece), error)) return PieceState::kMissing;
  const Reading reading = read_piece(file_of(piece), id_, manifest_.pieces[piece]);
  const Problem* fault = std::get_if<Problem>(&reading);
  if (fault == nullptr) return PieceState::kDone;
  if (why != nullptr) *why = fault->what;
  return PieceState::kBad;
}

Content Job::read(size_t piece) const {
  Reading reading = read_piece(file_of(piece), id_, manifest_.pieces[piece]);
  if (Content* content = std::get_if<Content>(&reading)) return std::move(*content);
  const Problem& fault = std::get<Problem>(reading);
  throw InputError({fault.code, fault.what, file_of(piece).string(), "run the job again to make this piece again"});
}

std::optional<Maker> Job::maker_of(size_t piece) const {
  const std::optional<Header> header = read_header_of(file_of(piece));
  if (!header) return {};
  try {
    if (header->json.value("job", std::string()) != id_) return {};
    const auto word = [&](const char* key) { return header->json.value(key, std::string()); };
    return Maker{word("made_on"), word("fingerprint"), word("build")};
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

Receipt Job::write(size_t piece, const Content& content, double ms, const Maker& maker) const {
  Receipt receipt{.number = piece,
                  .name = manifest_.pieces[piece],
                  .sha256 = hash_of(content.bytes),
                  .size_bytes = content.bytes.size(),
                  .ms = ms,
                  .maker = maker,
                  .version = version_of(manifest_),
                  .host = host_name(),
                  .pid = getpid()};
  const Json header = {{"job", id_},
                       {"piece", receipt.name},
                       {"made_on", maker.made_on},
                       {"fingerprint", maker.fingerprint},
                       {"build", maker.build},
                       {"size_bytes", receipt.size_bytes},
                       {"sha256", receipt.sha256},
                       {"description", content.description},
                       {"description_sha256", sha256_of(content.description)}};
  const std::string head = fmt::format("{}\n{}\n", kMagic, json_text(header));
  write_file(file_of(piece), {std::as_bytes(std::span(head)), content.bytes});
  flush_folder(folder_ / "pieces");
  Json line = begin_line("done", piece, manifest_, maker);
  line.update({{"sha256", receipt.sha256},
               {"size_bytes", receipt.size_bytes},
               {"ms", ms},
               {"version", receipt.version},
               {"build", maker.build},
               {"host", receipt.host},
               {"pid", receipt.pid}});
  append_line(ledger_file(), text_of_line(line), true);
  return receipt;
}

void Job::tell_begun(size_t piece, const Maker& maker) const {
  append_line(ledger_file(), text_of_line(begin_line("begun", piece, manifest_, maker)), false);
}

void Job::tell_failed(size_t piece, const Maker& maker, const std::string& why) const {
  Json line = begin_line("failed", piece, manifest_, maker);
  line["why"] = why;
  try {
    append_line(ledger_file(), text_of_line(line), true);
  } catch (const RunError&) {
  }
}

void Job::tell_stopped(size_t piece, const Maker& maker) const {
  try {
    append_line(ledger_file(), text_of_line(begin_line("stopped", piece, manifest_, maker)), false);
  } catch (const RunError&) {
  }
}

void Job::clear_leftovers() const {
  promin::clear_leftovers(folder_ / "pieces");
}

Receipt make_piece(const Job& job, size_t piece, const Maker& maker, const std::function<Content(size_t piece)>& make) {
  job.tell_begun(piece, maker);
  try {
    const Stopwatch making;
    const Content content = make(piece);
    return job.write(piece, content, making.ms(), maker);
  } catch (const Cancelled&) {
    job.tell_stopped(piece, maker);
    throw;
  } catch (const std::exception& error) {
    job.tell_failed(piece, maker, error.what());
    throw;
  }
}

size_t run_share(const Job& job, const Share& share, const Maker& maker, const BeforePiece& before,
                 const std::function<Content(size_t piece)>& make) {
  job.clear_leftovers();
  const std::vector<size_t> missing = find_missing(job, share);
  size_t made = 0;
  for (size_t i = 0; i < missing.size(); ++i) {
    const size_t piece = missing[i];
    std::string why;
    // Another process may have made the piece meanwhile.
    if (job.state_of(piece, &why) == PieceState::kDone) continue;
    if (!before({piece, i, missing.size(), why})) return made;
    make_piece(job, piece, maker, make);
    ++made;
  }
  return made;
}

std::optional<size_t> check_build(const Job& job, const Maker& maker,
                                  const std::function<Content(size_t piece)>& make) {
  const std::optional<size_t> piece = find_piece_of_other_build(job, maker);
  if (!piece || make(*piece).bytes == job.read(*piece).bytes) return piece;
  throw UsageError(
      {"job.build",
       fmt::format(
           "the job's pieces were made by another build of promin, and this build computes different bits for piece {}",
           job.manifest().pieces[*piece]),
       job.folder().string(), "continue with the first build, or use another folder"});
}

std::vector<size_t> find_missing(const Job& job, const Share& share) {
  std::vector<size_t> pieces;
  for (size_t piece = share.index; piece < job.piece_count(); piece += share.count) pieces.push_back(piece);
  return keep_missing(job, std::move(pieces));
}

std::vector<size_t> keep_missing(const Job& job, std::vector<size_t> pieces) {
  std::erase_if(pieces, [&](size_t piece) { return job.state_of(piece) == PieceState::kDone; });
  return pieces;
}

}  // namespace promin::jobs
