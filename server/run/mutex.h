// SPDX-License-Identifier: Apache-2.0
// std::mutex, whose use Clang checks: with -Wthread-safety it warns of an access to what is
// ABSL_GUARDED_BY a mutex while this is not locked.
//
//   Mutex mutex;
//   int count ABSL_GUARDED_BY(mutex) = 0;
//   ...
//   MutexLock lock(mutex);
//   while (count == 0) changed.wait(lock.native());
//
// A predicate, as std::condition_variable takes it, is a function of its own to Clang, which holds
// nothing. So waits are loops.
#pragma once

#include <absl/base/thread_annotations.h>

#include <mutex>

namespace weft::server {

class ABSL_LOCKABLE Mutex {
 private:
  friend class MutexLock;
  std::mutex mutex_;
};

// Holds the mutex while it lives, except between unlock() and lock().
class ABSL_SCOPED_LOCKABLE MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) ABSL_EXCLUSIVE_LOCK_FUNCTION(mutex) : lock_(mutex.mutex_) {}
  ~MutexLock() ABSL_UNLOCK_FUNCTION() {}
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void lock() ABSL_EXCLUSIVE_LOCK_FUNCTION() { lock_.lock(); }
  void unlock() ABSL_UNLOCK_FUNCTION() { lock_.unlock(); }

  // For a condition variable to wait with.
  std::unique_lock<std::mutex>& native() { return lock_; }

 private:
  std::unique_lock<std::mutex> lock_;
};

}  // namespace weft::server
