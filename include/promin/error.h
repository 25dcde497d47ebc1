// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "promin/export.h"

namespace promin {

/// The caller's setting that a problem concerns. Programs use it to name their own option for that setting.
enum class Setting {
  /// No setting.
  kNone,
  /// View::max_depth.
  kDepth,
  /// The selection of gpu::open_device.
  kDevice,
  /// The builder of RendererOptions and CasterOptions.
  kBuilder,
  /// RendererOptions::texture_bytes.
  kTextureMemory,
};

/// Describes one problem in words for people.
struct PROMIN_EXPORT Problem {
  /// What is wrong.
  std::string what;
  /// Where: a file, a JSON path, a line, a member of a Scene. May be empty.
  std::string where;
  /// What to do about it. May be empty.
  std::string cure;
  /// The setting that `where` or `cure` refers to.
  Setting setting = Setting::kNone;

  /// Returns "WHAT, WHERE; CURE" on one line, without empty parts. Control characters become question marks.
  std::string sentence() const;
};

/// Base class of promin's exceptions; promin also throws std::bad_alloc. what() is the sentence of the first problem
/// and, if there are several, their number; the other sentences follow, each on an indented line. Any thread may throw
/// and catch it, also across the boundary of a shared library.
class PROMIN_EXPORT Error : public std::runtime_error {
 public:
  /// A failure for one reason.
  explicit Error(const Problem& problem) : Error(std::vector<Problem>{problem}) {}
  /// A failure for several reasons.
  explicit Error(const std::vector<Problem>& problems);

  /// The reasons, at least one.
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// An argument is wrong; the programs exit with code 2.
struct PROMIN_EXPORT UsageError : Error {
  using Error::Error;
};

/// A scene, ray or BVH file or a picture to read is bad, or a scene in memory; the programs exit with code 3.
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
  /// Its only problem is the word "cancelled".
  Cancelled() : Error(Problem{"cancelled", "", ""}) {}
};

/// Something failed while running: input or output, memory, a lost device; the programs exit with code 1.
struct PROMIN_EXPORT RunError : Error {
  using Error::Error;
};

}  // namespace promin
