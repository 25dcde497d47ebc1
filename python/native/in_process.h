// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <utility>

#include "errors.h"

namespace promin::python {

/// Owns an object of a device, which a fork of the process must not use. In a fork, `get` throws ForkError, and the
/// object is never destroyed, because the driver's threads and locks belong to the other process. Owner is an owning
/// pointer.
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
