// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "promin/export.h"

namespace promin {

/// What of the caller's choices a problem speaks of, for programs that have a name of their own for it, as an option.
enum class Setting {
  /// Of none.
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

/// One thing that is wrong, in words for people.
struct PROMIN_EXPORT Problem {
  /// What is wrong.
  std::string what;
  /// Where: a file, a JSON path, a line, a member of a Scene. May be empty.
  std::string where;
  /// What to do about it. May be empty.
  std::string cure;
  /// What `where` or `cure` would have changed.
  Setting setting = Setting::kNone;

  /// "WHAT, WHERE; CURE" without the parts that are empty, in one line: control characters are question marks.
  std::string sentence() const;
};

/// Base of what promin throws; of the standard library's there is std::bad_alloc beside. what() is the first problem's
/// sentence, with the count where there are several, and the others after it, each on an indented line of its own. Any
/// thread may throw and catch it, across the border of a shared library too.
class PROMIN_EXPORT Error : public std::runtime_error {
 public:
  /// A failure for one reason.
  explicit Error(const Problem& problem) : Error(std::vector<Problem>{problem}) {}
  /// A failure for several reasons, the first first.
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

/// There is no usable Vulkan device, or none that was asked for; the programs exit with code 4.
struct PROMIN_EXPORT DeviceError : Error {
  using Error::Error;
};

/// Two pictures differ by more than was allowed; the programs exit with code 5.
struct PROMIN_EXPORT DifferenceError : Error {
  using Error::Error;
};

/// A ProgressCallback wanted an end (promin/progress.h). What was asked to do the work stays usable.
struct PROMIN_EXPORT Cancelled : Error {
  /// Its one problem says no more than that.
  Cancelled() : Error(Problem{"cancelled", "", ""}) {}
};

/// Something failed while running: input or output, memory, a lost device; the programs exit with code 1.
struct PROMIN_EXPORT RunError : Error {
  using Error::Error;
};

}  // namespace promin
