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

/// Returns a word of the file for messages: in double quotes and shortened to a line.
std::string quote(std::string_view word);

/// The warning of a scene that shows nothing.
inline constexpr std::string_view kNothingToDraw = "the scene contains nothing to draw";

/// A fault of a file that does not affect its geometry. The loader repairs it; a strict loader refuses the file.
struct Fault {
  /// The kind of the problem.
  ProblemCode code;
  /// The problem, without words of the file: faults with the same `what` and `repair` share one warning.
  std::string what;
  /// The wrong word or number of the file; may be empty. The warning shows the value of the first fault.
  std::string value = {};
  /// The place in the file, in the form of the argument of LoadReport::refuse().
  std::string place = {};
  /// The fix that the author of the file can make.
  std::string cure = {};
  /// The repair that the loader makes, as a sentence: "promin omits the face".
  std::string repair = {};
};

/// Collects a loader's problems, which end the load, and warnings about a file. Each problem and each warning is stored
/// once, however often it occurs.
class LoadReport {
 public:
  explicit LoadReport(std::filesystem::path file, bool is_strict = false, std::filesystem::path root = {},
                      const dvec3& center = dvec3(0.0))
      : file_(std::move(file)), is_strict_(is_strict), root_(std::move(root)), center_(center) {}

  const std::filesystem::path& file() const { return file_; }
  /// Returns LoadOptions::root.
  const std::filesystem::path& root() const { return root_; }
  /// Returns an empty report about the same file, for an attempt. Problems in the new report do not refuse the file.
  LoadReport make_attempt() const { return LoadReport(file_, false, root_); }

  /// Returns the point that is subtracted from coordinates in double before they are rounded to fp32 (Scene::center).
  const dvec3& center() const { return center_; }
  /// Records that the file stores its coordinates in fp32, so they were rounded when it was written.
  void note_rounded_coordinates() { has_rounded_coordinates_ = true; }
  bool has_rounded_coordinates() const { return has_rounded_coordinates_; }

  /// Refuses the file. `place` is a place in the file: a JSON path or a line; empty for the file as a whole. Control
  /// characters from the file become '?', so that each message stays on its line.
  void refuse(ProblemCode code, const std::string& what, const std::string& place, const std::string& cure);
  /// Refuses the file because of a fault. The fault's `repair` is not used.
  void refuse(const Fault& fault);
  void warn(const std::string& sentence);
  /// Warns, like repair(), of a feature that the format allows and the loader cannot show. A strict report does not
  /// refuse it.
  void warn(const Fault& fault);
  /// Warns once for all faults of a kind. The warning has the place of the first fault and the number of the others:
  /// "line 12: a face has fewer than 3 corners, and 11 more; promin omits the face". A strict report refuses each
  /// fault.
  void repair(const Fault& fault);

  /// Records that a visible part of the scene cannot be drawn.
  void lose_geometry() { has_lost_geometry_ = true; }
  bool has_lost_geometry() const { return has_lost_geometry_; }

  /// Records a file before it is read or is found to be missing.
  void add_source(const std::filesystem::path& file);
  const std::vector<SourceFile>& sources() const { return sources_; }

  /// Returns the first fault because of which the file was refused, if any.
  const std::optional<Fault>& refused_fault() const { return refused_fault_; }

  /// Throws InputError with all problems so far, if there are any.
  void throw_if_refused() const;

  /// Returns the warnings in the order in which each was first found.
  std::vector<std::string> warnings() const;

 private:
  /// The sentence of a warning. For a kind of faults it is the sentence of the first fault, with the number of faults.
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
  /// For each kind of faults, given by `what` and `repair`, the index of its warning in warnings_.
  std::map<std::pair<std::string, std::string>, size_t> kinds_;
  std::vector<SourceFile> sources_;
  std::set<std::string> said_;
};

}  // namespace promin
