// SPDX-License-Identifier: Apache-2.0
// The memory budget that runs share, and with them the requests that wait for a run and the meshes
// that wait for a reader. It counts bytes, and allocates nothing.
//
//   MemoryBudget budget({.capacity = 8 << 30}, [&] { queue.memory_released(); });
//   if (auto reservation = budget.reserve({.estimate = 9 << 20})) {  // before the run begins
//     reservation->grow_to(40 << 20, poll);  // the run needs more than estimated: may wait
//   }                                        // releases all bytes
//
// A run begins if the bytes of its estimate are free, and reserves more as it grows; if no more are
// free, it waits until other runs release some. If all runs wait, the one that exceeds its estimate
// most is cancelled, of several such the youngest. So a request with too low an estimate ends
// before those whose estimate was right. What a run could have only without its own request is
// refused, because nobody else would release it.
//
// `light_reserve` bytes are kept for runs that begin as light ones: heavy runs can neither begin
// nor grow in it. A client that has reserved `max_per_client` or more cannot begin another run.
//
// Law: the sum of all reservations never exceeds the capacity. Law: a run begins if there is no
// other, however high its estimate: it then gets all of the capacity. Requests never take the last
// byte, which it begins with, except one that is alone, until `check_fits` has judged it.
// Units: bytes. Thread-safety: every function may be called from any thread; one thread at a time
// makes, moves or ends a Reservation, several may grow it. A budget outlives its reservations.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "server/run/mutex.h"
#include "weft/error.h"

namespace weft::server {

class MemoryBudget {
  struct Entry;

 public:
  struct Options {
    std::uint64_t capacity = std::numeric_limits<std::int64_t>::max();
    std::uint64_t light_reserve = 0;
    std::uint64_t max_per_client = std::numeric_limits<std::int64_t>::max();
  };

  // What the bytes hold.
  enum class Purpose : std::uint8_t {
    kRun,
    kInput,   // a request before its run: it does not grow, and no client's limit bounds it
    kOutput,  // a mesh that waits for its reader: it does not grow, but counts for its client
  };

  struct Request {
    std::uint64_t estimate = 0;
    std::string client{};
    bool light = false;
    Purpose purpose = Purpose::kRun;
    std::uint64_t input = 0;  // of a run: what its request holds in a reservation of its own
  };

  // Releases its bytes when it ends.
  class Reservation {
   public:
    Reservation() = default;  // empty
    Reservation(Reservation&& other) noexcept
        : budget_(std::exchange(other.budget_, nullptr)), entry_(other.entry_) {}
    Reservation& operator=(Reservation&& other) noexcept {
      std::swap(budget_, other.budget_);
      std::swap(entry_, other.entry_);
      return *this;
    }
    ~Reservation() {
      if (budget_ != nullptr) budget_->release(entry_);
    }

    // False: empty. It has 0 bytes, and every change of it succeeds without effect.
    explicit operator bool() const { return budget_ != nullptr; }
    std::uint64_t bytes() const;

    // Returns once the reservation has at least `bytes`; it gets kStep at a time while that much is
    // free. If it must wait, it calls `poll` every 20 ms, without a lock; an error that this
    // returns ends the wait. Errors: those of `check_fits`, with the run's input, kOutOfMemory if
    // this run was cancelled because all runs waited, those of `poll`.
    std::optional<Error> grow_to(std::uint64_t bytes,
                                 const std::function<std::optional<Error>()>& poll);
    // Releases the bytes beyond `bytes`.
    void shrink_to(std::uint64_t bytes);
    // The run turned out heavy: its bytes no longer count for the light reserve.
    void reclassify_as_heavy();
    // The run has ended; the bytes hold its mesh until it is read.
    void reclassify_as_output();
    // Whether the run waits for something else that only the end of other runs releases, such as a
    // slot: it then counts as waiting for memory, but is not the one that is cancelled.
    void mark_blocked(bool blocked);

   private:
    friend class MemoryBudget;
    Reservation(MemoryBudget& budget, std::list<Entry>::iterator entry)
        : budget_(&budget), entry_(entry) {}

    MemoryBudget* budget_ = nullptr;
    std::list<Entry>::iterator entry_{};
  };

  static constexpr std::uint64_t kStep = std::uint64_t{16} << 20;

  // `on_release` is called, on any thread and without a lock, after bytes were released.
  MemoryBudget(const Options& options, std::function<void()> on_release)
      : options_(options), on_release_(std::move(on_release)) {}

  // Returns nullopt if `request.estimate` bytes are not free, or the client has its maximum. A
  // request that is alone gets what there is.
  std::optional<Reservation> reserve(const Request& request);

  // Returns kLimitExceeded if a run of `bytes` bytes would not fit beside its request of `input`
  // bytes, though there were nothing else.
  std::optional<Error> check_fits(std::uint64_t bytes, std::uint64_t input) const;
  std::uint64_t capacity() const { return options_.capacity; }
  // Whether the client has less than its maximum.
  bool has_share(const std::string& client) const;

  // The highest estimate with which a light or a heavy run of some client may begin now.
  std::uint64_t max_estimate(bool light) const;
  std::uint64_t reserved() const;
  // The number of runs that wait for memory.
  std::size_t waiting() const;

 private:
  struct Entry {
    Request request;
    std::uint64_t bytes;
    int waiting_threads = 0;
    std::uint64_t wanted = 0;  // bytes, while a thread waits
    bool cancelled = false;
    bool blocked = false;

    bool is_run() const { return request.purpose == Purpose::kRun; }
    bool is_of_client() const { return request.purpose != Purpose::kInput; }
  };

  bool has_share_now(const std::string& client) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool fits(const Request& request) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::uint64_t free_for(bool light) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::uint64_t max_estimate_for(bool light) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void add(Entry& entry, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void remove(Entry& entry, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool try_grow(Entry& entry, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void cancel_one_if_all_wait() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  std::optional<Error> grow(Entry& entry, std::uint64_t bytes,
                            const std::function<std::optional<Error>()>& poll);
  void shrink(Entry& entry, std::uint64_t bytes);
  void release(std::list<Entry>::iterator entry);

  const Options options_;
  const std::function<void()> on_release_;
  std::condition_variable changed_;
  mutable Mutex mutex_;
  std::list<Entry> entries_ ABSL_GUARDED_BY(mutex_);  // the oldest first
  std::map<std::string, std::uint64_t> of_clients_ ABSL_GUARDED_BY(mutex_);
  std::uint64_t reserved_ ABSL_GUARDED_BY(mutex_) = 0;
  std::uint64_t reserved_by_light_ ABSL_GUARDED_BY(mutex_) = 0;
  std::size_t runs_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace weft::server
