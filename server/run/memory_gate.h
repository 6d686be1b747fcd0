// SPDX-License-Identifier: Apache-2.0
// The memory budget that runs, and requests that wait for one, share.
//
//   MemoryGate gate({.capacity = 8 << 30}, [&] { queue.notify(); });
//   if (auto share = gate.take({.estimate = 9 << 20})) {     // before the run begins
//     share->grow_to(40 << 20, poll);                        // as it turns out to need more; waits
//   }                                                        // the share goes back with its end
//
// A run begins if its estimate is free, and takes more as it grows; if no more is free, it waits
// until other runs give memory back. If all runs wait, the one that exceeds its estimate most is
// cancelled, of several such the youngest. So a request with too low an estimate ends before those
// whose estimate was right.
//
// A part (`for_light`) is kept for runs that begin as light ones: heavy ones can neither begin nor
// grow in it. A client that holds `of_client` or more cannot begin another run.
//
// Law: what all hold together never passes the capacity. Law: a run begins if there is no other,
// however high its estimate: it then gets all of the capacity.
// Thread-safety: every function may be called from any thread; one thread at a time takes, moves or
// ends a Share, several may grow it. A gate outlives its shares.
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

class MemoryGate {
  struct Entry;

 public:
  struct Options {
    std::uint64_t capacity = std::numeric_limits<std::int64_t>::max();
    std::uint64_t for_light = 0;
    std::uint64_t of_client = std::numeric_limits<std::int64_t>::max();
  };

  struct Ask {
    std::uint64_t estimate = 0;  // bytes
    std::string client{};
    bool light = false;
    // A request that waits for its run. It does not grow, and nobody waits for its end.
    bool request = false;
    // What waits for a reader. It does not grow, either, but is a part of its client's.
    bool reader = false;

    bool is_run() const { return !request && !reader; }
  };

  class Share {
   public:
    Share() = default;  // of nothing
    Share(Share&& other) noexcept
        : gate_(std::exchange(other.gate_, nullptr)), entry_(other.entry_) {}
    Share& operator=(Share&& other) noexcept {
      std::swap(gate_, other.gate_);
      std::swap(entry_, other.entry_);
      return *this;
    }
    ~Share() {
      if (gate_ != nullptr) gate_->give_back(entry_);
    }

    // None: there is no gate, or nothing was taken.
    explicit operator bool() const { return gate_ != nullptr; }
    std::uint64_t bytes() const;

    // Nothing once the share has `bytes`; it gets kStep at a time where so much is free. Otherwise
    // waits, and calls `poll` every kPoll, without a lock: what that returns ends the wait. Errors:
    // kLimitExceeded if there is not so much in all, kOutOfMemory if the run is to end.
    std::optional<Error> grow_to(std::uint64_t bytes,
                                 const std::function<std::optional<Error>()>& poll);
    // Gives back what it has beyond `bytes`.
    void shrink_to(std::uint64_t bytes);
    // The run is not what it was taken for.
    void turn_heavy();
    // Whether the run waits for something that only the end of other runs gives it, such as a
    // place: it counts as one that waits for memory, and is not the one that is ended.
    void set_parked(bool parked);
    // The run has ended; what it still has waits for a reader.
    void turn_reader();

   private:
    friend class MemoryGate;
    Share(MemoryGate& gate, std::list<Entry>::iterator entry) : gate_(&gate), entry_(entry) {}

    MemoryGate* gate_ = nullptr;
    std::list<Entry>::iterator entry_{};
  };

  static constexpr std::uint64_t kStep = std::uint64_t{16} << 20;

  // `on_room` is called, on any thread and without a lock, when bytes were given back.
  MemoryGate(const Options& options, std::function<void()> on_room)
      : options_(options), on_room_(std::move(on_room)) {}

  // nullopt if `ask.estimate` bytes are not free.
  std::optional<Share> take(const Ask& ask);

  // The highest estimate of a heavy run that may begin now, whoever asks.
  std::uint64_t room() const;
  // Of a run of this kind.
  std::uint64_t room(bool light) const;
  std::uint64_t taken() const;
  // Runs that wait for memory.
  std::size_t waiting() const;

 private:
  struct Entry {
    Ask ask;
    std::uint64_t bytes;
    int waiting = 0;  // threads
    std::uint64_t wanted = 0;
    bool ended = false;  // it was told to end
    bool parked = false;
  };

  std::uint64_t free_for(bool light) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::uint64_t room_for(bool light) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void add(Entry& entry, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void remove(Entry& entry, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool try_grow(Entry& entry, std::uint64_t bytes) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void end_one_if_all_wait() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  std::optional<Error> grow(Entry& entry, std::uint64_t bytes,
                            const std::function<std::optional<Error>()>& poll);
  void shrink(Entry& entry, std::uint64_t bytes);
  void give_back(std::list<Entry>::iterator entry);

  const Options options_;
  const std::function<void()> on_room_;
  std::condition_variable changed_;
  mutable Mutex mutex_;
  std::list<Entry> entries_ ABSL_GUARDED_BY(mutex_);  // the oldest first
  std::map<std::string, std::uint64_t> of_clients_ ABSL_GUARDED_BY(mutex_);
  std::uint64_t taken_ ABSL_GUARDED_BY(mutex_) = 0;
  std::uint64_t taken_by_light_ ABSL_GUARDED_BY(mutex_) = 0;
  std::size_t runs_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace weft::server
