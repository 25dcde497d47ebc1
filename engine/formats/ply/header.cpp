// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/ply/header.h"

#include <algorithm>
#include <array>
#include <optional>

#include "formats/text_lines.h"

namespace promin {
namespace {

constexpr size_t kMaxNames = 1000;
constexpr std::string_view kEnd = "end_header";
constexpr std::string_view kTextureFile = "TextureFile";
const std::string kExportPly = "export the file again";

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 16> kTypes = {{{"char", PlyType::kInt8},
                                              {"int8", PlyType::kInt8},
                                              {"uchar", PlyType::kUint8},
                                              {"uint8", PlyType::kUint8},
                                              {"short", PlyType::kInt16},
                                              {"int16", PlyType::kInt16},
                                              {"ushort", PlyType::kUint16},
                                              {"uint16", PlyType::kUint16},
                                              {"int", PlyType::kInt32},
                                              {"int32", PlyType::kInt32},
                                              {"uint", PlyType::kUint32},
                                              {"uint32", PlyType::kUint32},
                                              {"float", PlyType::kFloat32},
                                              {"float32", PlyType::kFloat32},
                                              {"double", PlyType::kFloat64},
                                              {"float64", PlyType::kFloat64}}};

template <class Named>
const Named* find_named(const std::vector<Named>& all, std::string_view name) {
  const auto found = std::ranges::find(all, name, &Named::name);
  return found == all.end() ? nullptr : &*found;
}

/// Iterates over the lines of a header. The first byte of the rows after it may look like a line end, so a \n after a
/// \r belongs to the line only if the first line ends in this way.
class HeaderLines {
 public:
  explicit HeaderLines(std::string_view file) : file_(file) {
    const size_t first_end = std::min(file.find_first_of("\r\n"), file.size());
    const std::string_view end = file.substr(first_end, 2);
    ends_ = end == "\r\n" || !end.starts_with('\r') ? "\n" : "\r\n";
  }

  bool advance() {
    if (next_ >= file_.size()) return false;
    const size_t end = std::min(file_.find_first_of(ends_, next_), file_.size());
    line_ = trim(file_.substr(next_, end - next_));
    next_ = std::min(end + 1, file_.size());
    ++number_;
    return true;
  }

  /// Returns the current line without spaces around it.
  std::string_view line() const { return line_; }
  uint64_t number() const { return number_; }
  std::string place() const { return "line " + std::to_string(number_); }
  /// Returns the offset of the next line.
  size_t next() const { return next_; }

 private:
  std::string_view file_;
  /// The characters that end a line.
  std::string_view ends_;
  std::string_view line_;
  size_t next_ = 0;
  uint64_t number_ = 0;
};

class HeaderParser {
 public:
  HeaderParser(std::string_view file, LoadReport& report) : file_(file), lines_(file), report_(report) {}

  PlyHeader parse() {
    if (!lines_.advance() || without_byte_order_mark(lines_.line()) != "ply") {
      report_.refuse("ply.file.kind", "the first line is not \"ply\"", "", "use a PLY file");
      return {};
    }
    while (lines_.advance()) {
      if (lines_.line() == kEnd) {
        finish();
        return std::move(out_);
      }
      read_statement(lines_.line());
    }
    refuse("ply.header.short", "the header does not end", kExportPly);
    return {};
  }

 private:
  void refuse(ProblemCode code, const std::string& what, const std::string& cure) {
    report_.refuse(code, what, lines_.place(), cure);
  }

  void finish() {
    out_.size_bytes = lines_.next();
    out_.line_count = lines_.number();
    if (!has_format_) refuse("ply.header.format", "the header does not contain the format", kExportPly);
    check_counts(file_.size() - out_.size_bytes);
  }

  void read_statement(std::string_view line) {
    const std::string_view keyword = take_word(line);
    if (keyword == "format") {
      read_format(take_word(line));
    } else if (keyword == "element") {
      read_element(line);
    } else if (keyword == "property") {
      read_property(line);
    } else if (keyword == "comment") {
      read_comment(trim(line));
    } else if (!keyword.empty() && keyword != "obj_info") {
      report_.warn(quote(keyword) + " in " + lines_.place() + " of the header is ignored");
    }
  }

  /// Reads a comment. The name of a texture file is the rest of the line, because it may contain spaces.
  void read_comment(std::string_view text) {
    if (!text.starts_with(kTextureFile)) return;
    const std::string_view name = trim(text.substr(kTextureFile.size()));
    if (!name.empty() && has_room(out_.texture_files, "texture files")) out_.texture_files.emplace_back(name);
  }

  void read_format(std::string_view name) {
    has_format_ = true;
    if (name == "ascii") {
      out_.encoding = PlyEncoding::kText;
    } else if (name == "binary_little_endian") {
      out_.encoding = PlyEncoding::kLittleEndian;
    } else if (name == "binary_big_endian") {
      out_.encoding = PlyEncoding::kBigEndian;
    } else {
      refuse("ply.header.format", quote(name) + " is not a format of PLY",
             "use ascii, binary_little_endian or binary_big_endian");
    }
  }

  void read_element(std::string_view line) {
    const std::string_view name = take_word(line);
    const std::string_view word = take_word(line);
    const std::optional<int64_t> count = parse_integer(word);
    if (!count || *count < 0)
      refuse("ply.header.count", quote(word) + " is not a number of rows", "write \"element NAME COUNT\"");
    if (find_named(out_.elements, name) != nullptr)
      refuse("ply.header.twice", "there are two elements " + quote(name), kExportPly);
    if (!has_room(out_.elements, "elements")) return;
    out_.elements.push_back(
        {.name = std::string(name), .row_count = static_cast<uint64_t>(std::max(count.value_or(0), int64_t{0}))});
  }

  void read_property(std::string_view line) {
    if (out_.elements.empty()) return refuse("ply.header.order", "a property comes before any element", kExportPly);
    PlyProperty property;
    std::string_view type = take_word(line);
    property.is_list = type == "list";
    if (property.is_list) {
      property.count_type = read_type(take_word(line));
      type = take_word(line);
    }
    property.type = read_type(type);
    property.name = take_word(line);
    std::vector<PlyProperty>& properties = out_.elements.back().properties;
    if (find_named(properties, property.name) != nullptr) {
      refuse("ply.header.twice", "there are two properties " + quote(property.name), kExportPly);
    }
    if (has_room(properties, "properties")) properties.push_back(property);
  }

  /// Refuses names that occur twice. The number of names is limited, because each new name is compared with all others.
  template <class Named>
  bool has_room(const std::vector<Named>& all, const std::string& what) {
    if (all.size() < kMaxNames) return true;
    report_.refuse("ply.header.large", "the header has more than " + std::to_string(kMaxNames) + " " + what, "",
                   kExportPly);
    return false;
  }

  PlyType read_type(std::string_view name) {
    const auto found = std::ranges::find(kTypes, name, &TypeName::name);
    if (found != kTypes.end()) return found->type;
    refuse("ply.header.type", quote(name) + " is not a type of numbers",
           "use char, uchar, short, ushort, int, uint, float or double");
    return PlyType::kFloat32;
  }

  /// Checks the counts, so that a wrong header cannot cause large allocations.
  void check_counts(uint64_t room) {
    const bool is_text = out_.encoding == PlyEncoding::kText;
    // The last number of a text need not be followed by a space.
    if (is_text) ++room;
    for (const PlyElement& element : out_.elements) {
      uint64_t row_bytes = 0;
      for (const PlyProperty& property : element.properties) {
        // In a text file a number takes at least a digit and a space.
        row_bytes += is_text ? 2 : size_of(property.is_list ? property.count_type : property.type);
      }
      const uint64_t rows = row_bytes == 0 ? element.row_count : room / row_bytes;
      if (element.row_count > rows) {
        report_.refuse("ply.file.short",
                       "the header declares " + std::to_string(element.row_count) + " rows of " + quote(element.name) +
                           ", but the file has room for " + std::to_string(rows),
                       "", "copy or export it again, because it is incomplete");
        return;
      }
      room -= element.row_count * row_bytes;
    }
  }

  std::string_view file_;
  HeaderLines lines_;
  LoadReport& report_;
  PlyHeader out_;
  bool has_format_ = false;
};

}  // namespace

size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    default:
      return 8;
  }
}

const PlyElement* PlyHeader::find(std::string_view name) const {
  return find_named(elements, name);
}

PlyHeader parse_ply_header(std::string_view file, LoadReport& report) {
  return HeaderParser(file, report).parse();
}

}  // namespace promin
