// SPDX-License-Identifier: Apache-2.0
// Tells ThreadSanitizer what gRPC guarantees of a reactor. Callbacks see what was written before
// the reactor was given to gRPC, by returning it from a handler or by starting an operation; OnDone
// sees what callbacks have written; and a thread that has waited for the server to shut down sees
// what OnDone has written. ThreadSanitizer cannot see that itself, because Debian builds gRPC
// without it. In other builds these functions do nothing.
//
//   give_to_grpc(this);
//   StartWrite(&message);
//   ...
//   void OnWriteDone(bool) override { take_from_grpc(this); ... }
#pragma once

#ifdef WEFT_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

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
