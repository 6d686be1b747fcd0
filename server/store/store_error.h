// SPDX-License-Identifier: Apache-2.0
// What can go wrong with a store, whatever is in it.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace weft::server {

enum class StoreErrorKind {
  kUnavailable,  // no connection, a time-out, a restart: the same call may succeed later
  kFull,         // the disk is full
  kBroken,       // what is stored is not what was stored, or of a version that is not ours
};

struct StoreError {
  StoreErrorKind kind = StoreErrorKind::kUnavailable;
  std::string message;
};

template <class T>
using StoreResult = tl::expected<T, StoreError>;

}  // namespace weft::server
