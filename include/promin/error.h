// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "promin/export.h"

namespace promin {

/// The setting of the caller that a problem concerns. A program can name its own option for this setting in its
/// message.
enum class Setting {
  /// No setting.
  kNone,
  /// The setting View::max_depth.
  kDepth,
  /// The setting `selection` of gpu::open_device.
  kDevice,
  /// The setting `builder` of RendererOptions and CasterOptions.
  kBuilder,
  /// The setting RendererOptions::texture_bytes.
  kTextureMemory,
  /// The setting `instances` of RendererOptions and CasterOptions.
  kInstances,
};

/// The name of a kind of problem, for programs and tests: two to four words of lower-case letters, joined by dots, such
/// as "job.piece.cut". Codes do not change between versions; sentences may. A code of another form does not compile.
class ProblemCode {
 public:
  template <size_t kSize>
  consteval ProblemCode(const char (&code)[kSize])  // NOLINT(google-explicit-constructor)
      : text_(code, kSize - 1) {
    if (!is_code(text_)) throw "a code is two to four words of lower-case letters, joined by dots";
  }  ///< Creates a code from a string literal.

  constexpr std::string_view text() const { return text_; }  ///< Returns the code's words, joined by dots.
  /// Returns whether both codes have the same words.
  friend constexpr bool operator==(const ProblemCode& a, const ProblemCode& b) { return a.text_ == b.text_; }

 private:
  static consteval bool is_code(std::string_view text) {
    size_t dot_count = 0;
    char before = '.';
    for (const char c : text) {
      if (c == '.' ? before == '.' : c < 'a' || c > 'z') return false;
      if (c == '.') ++dot_count;
      before = c;
    }
    return before != '.' && dot_count >= 1 && dot_count <= 3;
  }

  std::string_view text_;
};

/// Describes one problem in words.
struct PROMIN_EXPORT Problem {
  /// The kind of the problem.
  ProblemCode code;
  /// The problem, as a sentence without its final full stop.
  std::string what;
  /// Where the problem is: a file, then ": " and a place in the file, such as a JSON path or a line; or a member of a
  /// Scene. May be empty.
  std::string where;
  /// The action by which the user can solve the problem. It may be empty.
  std::string cure;
  /// The setting that `where` or `cure` refers to.
  Setting setting = Setting::kNone;

  /// Returns "WHERE: WHAT; CURE" on one line, without empty parts: "scene.gltf: nodes[2].mesh: index 7 is out of range;
  /// use 0 to 3". Control characters become question marks.
  std::string sentence() const;
};

/// Base class of promin's exceptions; promin also throws std::bad_alloc. what() returns the sentence of the first
/// problem. If there are several problems, it adds their number and the other sentences, each on an indented line. Any
/// thread may throw and catch it, also across the boundary of a shared library.
class PROMIN_EXPORT Error : public std::runtime_error {
 public:
  /// Creates an error with one problem.
  explicit Error(const Problem& problem) : Error(std::vector<Problem>{problem}) {}
  /// Creates an error with several problems.
  explicit Error(const std::vector<Problem>& problems);

  /// Returns the problems; there is at least one.
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// An argument is wrong; the programs exit with code 2.
struct PROMIN_EXPORT UsageError : Error {
  using Error::Error;
};

/// A scene file, ray file, BVH file or input picture is invalid, or a scene in memory is; the programs exit with code
/// 3.
struct PROMIN_EXPORT InputError : Error {
  using Error::Error;
};

/// There is no usable Vulkan device, or the requested one is missing; the programs exit with code 4.
struct PROMIN_EXPORT DeviceError : Error {
  using Error::Error;
};

/// Two pictures differ by more than is allowed; the programs exit with code 5.
struct PROMIN_EXPORT DifferenceError : Error {
  using Error::Error;
};

/// A ProgressCallback returned false (promin/progress.h). The object that did the work stays usable.
struct PROMIN_EXPORT Cancelled : Error {
  /// Creates an error whose only problem is the word "cancelled".
  Cancelled() : Error(Problem{"work.cancelled", "cancelled", "", ""}) {}
};

/// Something failed while running: input or output, memory, a lost device; the programs exit with code 1.
struct PROMIN_EXPORT RunError : Error {
  using Error::Error;
};

}  // namespace promin
