// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/source_file.h"
#include "promin/error.h"
#include "promin/math.h"

namespace promin {

/// A word of the file as messages show it: in double quotes, and no longer than a line.
std::string quote(std::string_view word);

/// A fault of a file that leaves its geometry in no doubt: the loader repairs it, and a strict one refuses the file.
struct Fault {
  /// What is wrong, without words of the file: faults with the same `what` and `repair` share one warning.
  std::string what;
  /// The word or number of the file that is wrong; may be empty. The warning shows that of the first fault.
  std::string value = {};
  /// Inside the file, as for LoadReport::refuse.
  std::string place = {};
  /// What the author of the file can do about it.
  std::string cure = {};
  /// What the loader does instead, as a sentence: "the face is left out".
  std::string repair = {};
};

/// What a loader reports about a file: problems, which end the load, and warnings. Each is kept once, however often it
/// occurs.
class LoadReport {
 public:
  explicit LoadReport(std::filesystem::path file, bool is_strict = false, std::filesystem::path root = {},
                      const dvec3& center = dvec3(0.0))
      : file_(std::move(file)), is_strict_(is_strict), root_(std::move(root)), center_(center) {}

  const std::filesystem::path& file() const { return file_; }
  /// LoadOptions::root.
  const std::filesystem::path& root() const { return root_; }
  /// An empty report about the same file, for what is tried: what it refuses does not refuse the file.
  LoadReport make_attempt() const { return LoadReport(file_, false, root_); }

  /// What coordinates of the file lose in double, before they are rounded to fp32 (Scene::center).
  const dvec3& center() const { return center_; }
  /// A loader's note that the file has its coordinates in fp32: they were rounded before they were written.
  void note_rounded_coordinates() { has_rounded_coordinates_ = true; }
  bool has_rounded_coordinates() const { return has_rounded_coordinates_; }

  /// `place` is inside the file: a JSON path or a line; empty for the file as a whole. Control characters that come
  /// from the file are made visible as '?', so that each message stays on its line.
  void refuse(const std::string& what, const std::string& place, const std::string& cure);
  /// Refuses a fault whose `repair` is not needed.
  void refuse(const Fault& fault);
  void warn(const std::string& sentence);
  /// Warns as repair() does of what the format allows and the loader cannot show: no report refuses it.
  void warn(const Fault& fault);
  /// Warns once for all faults of a kind, with the place of the first and the number of the others: "a face has fewer
  /// than 3 corners, line 12 and 11 more; the face is left out". A strict report refuses each instead.
  void repair(const Fault& fault);

  /// Is called where a part of the scene is to be seen and cannot be drawn.
  void lose_geometry() { has_lost_geometry_ = true; }
  bool has_lost_geometry() const { return has_lost_geometry_; }

  /// Is called for each file before it is read, or found missing.
  void add_source(const std::filesystem::path& file);
  const std::vector<SourceFile>& sources() const { return sources_; }

  /// The first that was refused as a fault, if any was.
  const std::optional<Fault>& refused_fault() const { return refused_fault_; }

  /// Throws InputError with all problems so far, if there are any.
  void throw_if_refused() const;

  /// In the order in which each was first found.
  std::vector<std::string> warnings() const;

 private:
  /// One sentence; of a kind of faults the first, and how many there are.
  struct Warning {
    std::string sentence;
    std::string repair;
    uint64_t fault_count = 0;
  };

  std::filesystem::path file_;
  bool is_strict_;
  bool has_lost_geometry_ = false;
  std::filesystem::path root_;
  dvec3 center_;
  std::optional<Fault> refused_fault_;
  bool has_rounded_coordinates_ = false;
  std::vector<Problem> problems_;
  size_t problem_count_ = 0;
  std::vector<Warning> warnings_;
  /// The index in warnings_ of each kind of faults, by its `what` and `repair`.
  std::map<std::pair<std::string, std::string>, size_t> kinds_;
  std::vector<SourceFile> sources_;
  std::set<std::string> said_;
};

}  // namespace promin
