// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/stl/load_stl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "core/file.h"
#include "core/srgb.h"
#include "core/stand_in.h"
#include "formats/stl/text.h"
#include "formats/text_lines.h"
#include "promin/validate.h"
#include "scene/limits.h"

namespace promin {
namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are little-endian");

// Layout of a binary file: a header with any content, the number of facets, and then the facets. A facet has a normal,
// three corners and two bytes.
constexpr size_t kStlHeaderBytes = 80;
constexpr size_t kFirstFacet = kStlHeaderBytes + 4;
constexpr size_t kFacetBytes = 50;
constexpr size_t kNormalBytes = 12;
constexpr size_t kCornersBytes = 36;

template <class Number>
Number read_number(std::string_view file, size_t offset) {
  Number number{};
  std::memcpy(&number, file.data() + offset, sizeof(number));
  return number;
}

uint64_t facet_count(std::string_view file) {
  return read_number<uint32_t>(file, kStlHeaderBytes);
}

bool has_size_of_binary(std::string_view file) {
  return file.size() >= kFirstFacet && file.size() == kFirstFacet + kFacetBytes * facet_count(file);
}

/// Returns whether a file is a text. Text files begin with "solid", but so do the headers of some binary files. Binary
/// files contain zeros further on, at the latest in the number of facets, unless there are more than 16 million.
bool looks_like_text(std::string_view file) {
  const std::string_view begin = file.substr(0, kFirstFacet + kFacetBytes);
  if (begin.find('\0') != std::string_view::npos) return false;
  return is_stl_keyword(skip_to_text(begin).substr(0, 5), "solid");
}

/// The colours of a binary file's facets, which share the two bytes behind each facet, in one of two ways. VisCAM and
/// SolidView store 5 bits each of blue, green and red, from the lowest bit on, and set the highest bit if the colour is
/// valid. Magics stores red in the lowest bits, clears the highest bit if the colour is valid, and stores the colour of
/// all other facets in the header.
class FacetColors {
 public:
  FacetColors(std::string_view file, uint64_t count) : file_(file) {
    for (int i = 0; i < 32; ++i) linear_[static_cast<size_t>(i)] = static_cast<float>(srgb_to_linear(i / 31.0));
    for (uint64_t i = 0; i < count; ++i) {
      const uint16_t code = code_of(i);
      has_codes_ = has_codes_ || code != 0;
      has_marks_ = has_marks_ || (code & kMark) != 0;
    }
    const std::string_view header = file.substr(0, kStlHeaderBytes);
    const size_t mark = header.find(kDefault);
    is_magics_ = mark != std::string_view::npos && mark + kDefault.size() + 3 <= kStlHeaderBytes;
    if (!is_magics_) return;
    for (int i = 0; i < 3; ++i) {
      const auto code = static_cast<uint8_t>(header[mark + kDefault.size() + static_cast<size_t>(i)]);
      default_[i] = static_cast<float>(srgb_to_linear(code / 255.0));
    }
  }

  /// Returns whether facets have colours.
  bool exist() const { return is_magics_ || has_marks_; }
  /// Returns whether the bytes contain something other than colours.
  bool are_unknown() const { return has_codes_ && !exist(); }

  vec3 of(uint64_t facet) const {
    const uint16_t code = code_of(facet);
    // Programs that write no colours of facets set these bytes to 0.
    if (is_magics_ ? !has_codes_ || (code & kMark) != 0 : (code & kMark) == 0) return default_;
    const vec3 color(linear_[code & 31U], linear_[code >> 5 & 31U], linear_[code >> 10 & 31U]);
    return is_magics_ ? color : vec3(color.b, color.g, color.r);
  }

 private:
  static constexpr std::string_view kDefault = "COLOR=";
  static constexpr uint16_t kMark = 0x8000;

  uint16_t code_of(uint64_t facet) const {
    return read_number<uint16_t>(file_, kFirstFacet + kFacetBytes * facet + kNormalBytes + kCornersBytes);
  }

  std::string_view file_;
  /// Linear light for each code of 5 bits.
  std::array<float, 32> linear_{};
  bool is_magics_ = false;
  bool has_codes_ = false;
  bool has_marks_ = false;
  /// Colour of facets without a colour; white unless the header gives one.
  vec3 default_{1.0F};
};

StlSolid read_facets(std::string_view file, uint64_t count, LoadReport& report) {
  report.note_rounded_coordinates();
  const FacetColors colors(file, count);
  if (colors.are_unknown()) report.warn("the bytes after each facet are not colours and are ignored");
  StlSolid solid;
  solid.corners.reserve(3 * count);
  if (colors.exist()) solid.colors.reserve(count);
  for (uint64_t i = 0; i < count; ++i) {
    const auto corners = read_number<std::array<vec3, 3>>(file, kFirstFacet + kFacetBytes * i + kNormalBytes);
    if (!std::ranges::all_of(corners, [](const vec3& p) { return is_in_range(dvec3(p)); })) {
      report.repair({"stl.position.range", "a facet has a vertex coordinate that is not a number up to 1e15", "",
                     "facet " + std::to_string(i), "export the mesh again, in a larger unit of length",
                     "promin omits the facet"});
      continue;
    }
    for (const vec3& corner : corners) solid.corners.emplace_back(dvec3(corner) - report.center());
    if (colors.exist()) solid.colors.push_back(colors.of(i));
  }
  return solid;
}

std::vector<StlSolid> read_binary(std::string_view file, LoadReport& report) {
  if (file.size() < kFirstFacet) {
    report.refuse("stl.file.kind", "the file is not an STL file", "", "use a binary or text STL file");
    return {};
  }
  uint64_t count = facet_count(file);
  const uint64_t room = (file.size() - kFirstFacet) / kFacetBytes;
  // A program that writes to a pipe cannot go back to write the number of facets.
  const bool is_open = count == 0 || count == std::numeric_limits<uint32_t>::max();
  if (is_open && room > 0 && file.size() == kFirstFacet + kFacetBytes * room) {
    report.repair({"stl.count.missing", "the number of facets is missing", std::to_string(count), "",
                   "export the file again", "promin reads all facets in the file"});
    count = room;
  }
  if (count > room) {
    report.refuse("stl.file.short",
                  "the file declares " + std::to_string(count) + " facets, but has room for " + std::to_string(room),
                  "", "copy or export it again, because it is incomplete or not an STL file");
    return {};
  }
  if (file.size() > kFirstFacet + kFacetBytes * count) report.warn("bytes after the last facet are ignored");
  return {read_facets(file, count, report)};
}

Mesh make_mesh(StlSolid& solid) {
  Mesh mesh;
  mesh.positions = std::move(solid.corners);
  const auto count = static_cast<uint32_t>(mesh.positions.size() / 3);
  mesh.triangles.reserve(count);
  mesh.colors.reserve(3 * solid.colors.size());
  for (const vec3& color : solid.colors) mesh.colors.insert(mesh.colors.end(), 3, vec4(color, 1.0F));
  for (uint32_t i = 0; i < count; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  return mesh;
}

}  // namespace

Scene load_stl(const LoadOptions& /*options*/, LoadReport& report) {
  const std::vector<std::byte> bytes = read_file(report.file());
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::string_view text = without_zero_bytes_at_end(file);
  const bool is_text = !has_size_of_binary(file) && looks_like_text(text);
  std::vector<StlSolid> solids = is_text ? parse_stl_text(text, report) : read_binary(file, report);
  report.throw_if_refused();

  Scene scene;
  scene.file = report.file();
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
  for (StlSolid& solid : solids) {
    if (!solid.corners.empty()) scene.add(solid.name, make_mesh(solid));
  }
  scene.warnings = report.warnings();
  return scene;
}

}  // namespace promin
