// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/parse_number.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little,
              "rays and hits have the same layout in the file as in memory");

constexpr std::string_view kMagic = "\x93NUMPY";
/// The largest size of a header in bytes. No array of numbers has a larger header.
constexpr uint32_t kMaxHeaderBytes = 1U << 16;
constexpr const char* kCure =
    "save it with numpy.save(file, numpy.ascontiguousarray(rays, '<f4')), or '<f8', with rays of shape (N, 8)";

/// Returns the entries of a Python dictionary of literals with string keys, each value as written; a .npy header
/// contains such a dictionary. Returns nullopt if the text is not such a dictionary.
std::optional<std::map<std::string_view, std::string_view>> parse_dictionary(std::string_view text) {
  std::map<std::string_view, std::string_view> entries;
  size_t at = 0;
  const auto skip_spaces = [&] {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\n')) ++at;
  };
  const auto take = [&](char expected) {
    skip_spaces();
    if (at >= text.size() || text[at] != expected) return false;
    ++at;
    return true;
  };
  if (!take('{')) return std::nullopt;
  while (!take('}')) {
    skip_spaces();
    const char quote = at < text.size() ? text[at] : '\0';
    if (quote != '\'' && quote != '"') return std::nullopt;
    const size_t key_end = text.find(quote, at + 1);
    if (key_end == std::string_view::npos) return std::nullopt;
    const std::string_view key = text.substr(at + 1, key_end - at - 1);
    at = key_end + 1;
    if (!take(':')) return std::nullopt;
    skip_spaces();
    // The value ends at a comma or brace that is outside the value's own brackets.
    const size_t first = at;
    for (int depth = 0; at < text.size() && (depth > 0 || (text[at] != ',' && text[at] != '}')); ++at) {
      if (text[at] == '(' || text[at] == '[') ++depth;
      if (text[at] == ')' || text[at] == ']') --depth;
    }
    if (!entries.emplace(key, text.substr(first, at - first)).second) return std::nullopt;
    if (!take(',') && (at >= text.size() || text[at] != '}')) return std::nullopt;
  }
  skip_spaces();
  return at == text.size() ? std::optional(entries) : std::nullopt;
}

/// Reads N from "(N, 8)", with any spacing.
std::optional<uint64_t> parse_shape(std::string_view text) {
  std::string tight;
  for (const char c : text) {
    if (c != ' ') tight += c;
  }
  if (tight.empty() || tight[0] != '(') return std::nullopt;
  std::string_view tail = std::string_view(tight).substr(1);
  const std::optional<uint64_t> count = take_number<uint64_t>(tail);
  return tail == ",8)" || tail == ",8,)" ? count : std::nullopt;
}

/// Returns a text of the file for a message, without characters that move a terminal's cursor and not longer than a
/// line.
std::string make_printable(std::string_view text) {
  constexpr size_t kMost = 60;
  std::string quoted(text.substr(0, kMost));
  std::replace_if(
      quoted.begin(), quoted.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kMost ? quoted + "..." : quoted;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

struct RayArray {
  uint64_t count = 0;
  uint64_t ray_bytes = 0;
};

/// Reads the number of rays and the size of their numbers from the header's dictionary.
RayArray parse_header(std::string_view header, const fs::path& file) {
  const auto entries = parse_dictionary(header);
  if (!entries || !entries->contains("descr") || !entries->contains("fortran_order") || !entries->contains("shape")) {
    throw InputError({"rays.header", "the header is damaged", file.string(), kCure});
  }
  const std::string_view type = trim(entries->at("descr"));
  const bool is_double = type == "'<f8'" || type == "\"<f8\"";
  if (!is_double && type != "'<f4'" && type != "\"<f4\"") {
    throw InputError(
        {"rays.type", "the array's type is " + make_printable(type) + ", not '<f4' or '<f8'", file.string(), kCure});
  }
  if (trim(entries->at("fortran_order")) != "False") {
    throw InputError({"rays.order", "the array is in Fortran order", file.string(), kCure});
  }
  const std::optional<uint64_t> count = parse_shape(entries->at("shape"));
  if (!count) {
    throw InputError({"rays.shape",
                      "the array's shape is " + make_printable(trim(entries->at("shape"))) + ", not (N, 8)",
                      file.string(), kCure});
  }
  return {*count, 8 * (is_double ? sizeof(double) : sizeof(float))};
}

/// Returns the header of an array with this number of rows and at least this number of bytes. `type` has the form of
/// numpy.dtype.descr. `columns` is the text of the shape after the number of rows.
std::string make_header(std::string_view type, uint64_t rows, std::string_view columns, size_t least_bytes = 0) {
  std::string dictionary("{'descr': ");
  dictionary.append(type).append(", 'fortran_order': False, 'shape': (");
  dictionary.append(std::to_string(rows)).append(columns).append("), }");
  // Magic, version and length take 10 bytes; the data begins at a multiple of 64.
  const size_t padding = 64 - (10 + dictionary.size() + 1) % 64;
  dictionary.append(padding, ' ');
  if (10 + dictionary.size() + 1 < least_bytes) dictionary.append(least_bytes - (10 + dictionary.size() + 1), ' ');
  dictionary += '\n';
  std::string header(kMagic);
  header += '\x01';
  header += '\x00';
  header += static_cast<char>(dictionary.size() & 0xFF);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

/// Returns the space for the header of an array whose number of rows is not known yet.
size_t largest_header(std::string_view type) {
  return make_header(type, std::numeric_limits<uint64_t>::max(), ",").size();
}

constexpr std::string_view kHitType =
    "[('t', '<f4'), ('object', '<i4'), ('primitive', '<i4'), ('u', '<f4'), ('v', '<f4'), ('normal', '<f4', (3,))]";

}  // namespace

RayReader::RayReader(const fs::path& file) : file_(file) {
  if (!fs::is_regular_file(find_input(file)))
    throw InputError({"file.kind", "the file is not a regular file", file.string(), "use a .npy file"});
  std::error_code error;
  const uint64_t file_bytes = fs::file_size(file, error);
  stream_.open(file, std::ios::binary);
  if (!stream_ || error)
    throw InputError({"file.open", "the file cannot be opened", file.string(), "check its permissions"});

  std::array<char, 12> head{};
  stream_.read(head.data(), 8);
  const char version = head[6];
  if (!stream_ || std::string_view(head.data(), kMagic.size()) != kMagic || version < 1 || version > 3) {
    throw InputError({"rays.kind", "the file is not a NumPy array", file.string(), kCure});
  }
  const std::streamsize length_bytes = version == 1 ? 2 : 4;
  stream_.read(head.data() + 8, length_bytes);
  uint32_t header_bytes = 0;
  std::memcpy(&header_bytes, head.data() + 8, static_cast<size_t>(length_bytes));
  if (!stream_ || header_bytes > kMaxHeaderBytes)
    throw InputError({"rays.header", "the header is damaged", file.string(), kCure});
  std::string header(header_bytes, '\0');
  if (!stream_.read(header.data(), header_bytes)) {
    throw InputError({"rays.short", "the file ends within its header", file.string(), kCure});
  }
  const RayArray array = parse_header(header, file);
  count_ = array.count;
  ray_bytes_ = array.ray_bytes;
  begin_ = stream_.tellg();
  const uint64_t data_bytes = file_bytes - (8 + static_cast<uint64_t>(length_bytes) + header_bytes);
  if (data_bytes % ray_bytes_ != 0 || data_bytes / ray_bytes_ != count_) {
    throw InputError({"rays.short",
                      "the header declares " + std::to_string(count_) + " rays, but the file contains " +
                          std::to_string(data_bytes) + " bytes of rays, with " + std::to_string(ray_bytes_) +
                          " bytes per ray",
                      file.string(), "write the file again with NumPy"});
  }
}

void RayReader::seek(uint64_t ray) {
  stream_.seekg(begin_ + static_cast<std::streamoff>(ray * ray_bytes_));
}

void RayReader::read(std::span<Ray> rays, const dvec3& center) {
  if (ray_bytes_ > sizeof(Ray)) return convert<double>(rays, center);
  if (center != dvec3(0.0)) return convert<float>(rays, center);
  read_bytes(std::as_writable_bytes(rays));
}

template <typename Number>
void RayReader::convert(std::span<Ray> rays, const dvec3& center) {
  constexpr size_t kMostAtOnce = 4096;
  std::vector<std::array<Number, 8>> rows(std::min(rays.size(), kMostAtOnce));
  for (; !rays.empty(); rays = rays.subspan(rows.size())) {
    rows.resize(std::min(rays.size(), rows.size()));
    read_bytes(std::as_writable_bytes(std::span(rows)));
    for (size_t i = 0; i < rows.size(); ++i) {
      const auto& row = rows[i];
      rays[i] = {dvec3(row[0], row[1], row[2]) - center, static_cast<float>(row[3]), vec3(row[4], row[5], row[6]),
                 static_cast<float>(row[7])};
    }
  }
}

void RayReader::read_bytes(std::span<std::byte> bytes) {
  if (bytes.empty()) return;
  if (!stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    throw InputError({"file.read", "the file cannot be read to its end", file_.string(), "check the disk"});
  }
}

void write_rays(const fs::path& file, std::span<const Ray> rays) {
  const std::string header = make_header("'<f4'", rays.size(), ", 8");
  write_file(file, {std::as_bytes(std::span(header)), std::as_bytes(rays)});
}

ArrayWriter::ArrayWriter(const fs::path& file, std::string_view type, std::optional<uint64_t> count)
    : target_(file), output_(file), stream_(output_.temporary(), std::ios::binary), type_(type), count_(count) {
  const std::string header =
      count ? make_header(type_, *count, ",") : make_header(type_, 0, ",", largest_header(type_));
  stream_.write(header.data(), static_cast<std::streamsize>(header.size()));
  check();
}

void ArrayWriter::write(std::span<const std::byte> bytes, uint64_t count) {
  written_ += count;
  assert(!count_ || written_ <= *count_);
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  check();
}

void ArrayWriter::finish() {
  assert(!count_ || written_ == *count_);
  if (!count_) {
    const std::string header = make_header(type_, written_, ",", largest_header(type_));
    stream_.seekp(0);
    stream_.write(header.data(), static_cast<std::streamsize>(header.size()));
  }
  stream_.close();
  check();
}

void ArrayWriter::commit() {
  finish();
  output_.commit();
}

void ArrayWriter::commit_together(std::initializer_list<ArrayWriter*> writers) {
  std::vector<AtomicFile*> files;
  for (ArrayWriter* writer : writers) {
    writer->finish();
    files.push_back(&writer->output_);
  }
  AtomicFile::commit_together(files);
}

void ArrayWriter::check() const {
  if (stream_) return;
  throw RunError({"file.write", std::string("the output file cannot be written (") + std::strerror(errno) + ")",
                  target_.string(), "check the disk and permissions"});
}

HitWriter::HitWriter(const fs::path& file, std::optional<uint64_t> count) : ArrayWriter(file, kHitType, count) {}

CountWriter::CountWriter(const fs::path& file, uint64_t count) : ArrayWriter(file, "'<i4'", count) {}

OffsetWriter::OffsetWriter(const fs::path& file, uint64_t count) : ArrayWriter(file, "'<u8'", count) {}

}  // namespace promin
