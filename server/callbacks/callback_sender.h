// SPDX-License-Identifier: Apache-2.0
// Sends the callbacks of a store: claims each that is due, sends it, and settles it, or puts it
// off, longer each time, for about a day. A callback that was sent while its server died is sent
// again: the header webhook-id, the id of the job, is the same each time.
//
//   CallbackSender sender({.callbacks = *callbacks, .store = *store, ...}, {});
//   store->on_change([&] { sender.wake(); });
//
// A receiver that does not answer keeps some threads busy, never all: there are bounds for each
// place and for each client.
//
// Thread-safety: `wake` and `stop` may be called from any thread.
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <thread>

#include "server/callbacks/callbacks.h"
#include "server/callbacks/post.h"
#include "server/observe/log.h"
#include "server/run/mutex.h"
#include "server/store/job_store.h"

namespace weft::server {

struct SenderOptions {
  std::size_t at_once = 16;  // callbacks
  std::size_t of_place = 4;  // of these, to one host and port
  std::size_t of_client = 12;
  // How long after an attempt that failed the next is, at least half of it: doubled each time, at
  // most kLongestCallbackDelay.
  std::chrono::milliseconds first_delay{1'000};
  PostLimits limits{};
};

// After so many attempts, 12 to 24 hours after the first, a callback has failed.
inline constexpr std::uint32_t kMaxCallbackAttempts = 36;

// The time from an attempt, counted from 1, to the next. `part` is from 0 to 1: those that failed
// together are not tried again together.
std::chrono::milliseconds callback_delay(std::chrono::milliseconds first, std::uint32_t attempt,
                                         double part);

class CallbackSender {
 public:
  // The first two outlive the sender.
  struct Parts {
    const Callbacks& callbacks;
    JobStore& store;
    Logger log;
    // Called for each attempt, on any thread: "delivered", "put_off" or "failed".
    std::function<void(const char* outcome)> count;
  };

  CallbackSender(Parts parts, const SenderOptions& options);
  ~CallbackSender() { stop(); }
  CallbackSender(const CallbackSender&) = delete;
  CallbackSender& operator=(const CallbackSender&) = delete;

  // Call when a job may have ended.
  void wake();
  // Claims nothing more, and puts off what is being sent.
  void stop();

 private:
  using Counts = std::map<std::string, std::size_t>;

  void claim_until_stopped();
  // Returns false if none is due, or no thread is free.
  bool claim_next();
  void send(const JobRecord& job, const std::string& place);
  Posted post(const JobRecord& job);
  void settle(const JobRecord& job, const std::string& place, const Posted& posted, double seconds);

  const Parts parts_;
  const SenderOptions options_;
  Poster poster_;

  Mutex mutex_;
  bool woken_ ABSL_GUARDED_BY(mutex_) = false;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::size_t sending_ ABSL_GUARDED_BY(mutex_) = 0;
  Counts of_places_ ABSL_GUARDED_BY(mutex_);
  Counts of_clients_ ABSL_GUARDED_BY(mutex_);
  std::mt19937 random_ ABSL_GUARDED_BY(mutex_){std::random_device{}()};
  std::condition_variable changed_;
  boost::asio::thread_pool threads_;
  std::thread claimer_;
};

}  // namespace weft::server
