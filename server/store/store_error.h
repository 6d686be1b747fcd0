// SPDX-License-Identifier: Apache-2.0
// The errors of a store.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace weft::server {

enum class StoreErrorKind {
  kUnavailable,  // no connection, a time-out, a restart: the same call may succeed later
  kFull,         // the disk is full
  kBroken,  // the data is damaged or of another version, or there is no library to read it with
};

struct StoreError {
  StoreErrorKind kind = StoreErrorKind::kUnavailable;
  std::string message;
};

template <class T>
using StoreResult = tl::expected<T, StoreError>;

}  // namespace weft::server
