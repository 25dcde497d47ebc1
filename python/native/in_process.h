// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <utility>

#include "errors.h"

namespace promin::python {

/// Something of a device, which a fork has no part in: `get` throws ForkError there, and there it is never ended, as
/// the driver's threads and locks are those of another process. Owner is a pointer that owns.
template <typename Owner>
class InProcess {
 public:
  explicit InProcess(Owner owner) : owner_(std::move(owner)) {}
  ~InProcess() {
    if (getpid() != process_) static_cast<void>(new Owner(std::move(owner_)));
  }
  InProcess(const InProcess&) = delete;
  InProcess& operator=(const InProcess&) = delete;

  auto& get() const {
    if (getpid() != process_) throw ForkError();
    return *owner_;
  }

 private:
  Owner owner_;
  pid_t process_ = getpid();
};

}  // namespace promin::python
