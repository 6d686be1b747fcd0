// SPDX-License-Identifier: Apache-2.0
// Tells ThreadSanitizer what gRPC guarantees of a reactor: what was done before it was given to
// gRPC, by returning it from a handler or by starting an operation, is seen by the callbacks of
// that; what callbacks have done is seen by OnDone; and what OnDone has done is seen by whoever has
// waited for the server to shut down. Debian builds gRPC without ThreadSanitizer, which therefore
// does not see it. In other builds nothing is left of this.
//
//   give_to_grpc(this);
//   StartWrite(&message);
//   ...
//   void OnWriteDone(bool) override { take_from_grpc(this); ... }
#pragma once

#include "engine/base/tsan_hints.h"

namespace weft::server {

inline void give_to_grpc([[maybe_unused]] void* reactor) {
#ifdef WEFT_THREAD_SANITIZER
  __tsan_release(reactor);
#endif
}

inline void take_from_grpc([[maybe_unused]] void* reactor) {
#ifdef WEFT_THREAD_SANITIZER
  __tsan_acquire(reactor);
#endif
}

}  // namespace weft::server
