// SPDX-License-Identifier: Apache-2.0
// The one queue of runs, of calls and of stored jobs alike, and the threads on which they run. A
// run begins when it has a slot and a reservation of the memory that it is expected to take.
//
// Clients that have waiting runs take turns (round robin), so none can starve another; a client's
// own runs begin first come, first served. One client has at most its share of the waiting runs, of
// the slots and of the memory. A run for which no memory is free is bypassed by all that begin
// meanwhile, also by its client's own and those of the source, 64 times at most: after that only
// light slots are given away until enough runs have ended for it to begin. Each of these does, and
// what could not begin then either is refused at once.
//
// Slots have a priority class. Light slots are for light runs only, whatever else their client has
// in the queue: a mesh of a millisecond does not wait for meshes that take seconds. A run that
// turns out heavy leaves its light slot at once, and goes on when it has a heavy one
// (Slot::promote). If clients are identified, its client has no light slots for a while
// (distrust.h): otherwise two clients whose heavy runs look light would keep both light slots from
// all others.
//
// A run that waits for the reader of its mesh leaves its slot to another run (Pause). So a client
// that reads nothing keeps memory, but no slot.
//
// Runs that wait elsewhere, such as in a store, come from a Source, in turns with those that wait
// here. It is called only when a slot is free, so that a run that cannot begin here may begin on
// another server.
//
//   RunQueue queue({.slots = 4, .light_slots = 2, .capacity = 64, .max_light_estimate = 16 << 20});
//   const auto run = [](RunQueue::Slot& slot) { ... };
//   if (auto refusal = queue.push({.client = "ann", .estimate = 9 << 20}, run)) return *refusal;
//
// Law: no more runs compute at once than there are slots, except those that go on after a Pause,
// and one that borrows the slot of a source that does not answer.
//
// Units: bytes. Errors: kQueueFull; kLimitExceeded for what can never begin.
// Thread-safety: every function may be called from any thread, those of a Slot by its run alone.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/run/distrust.h"
#include "server/run/memory_budget.h"
#include "server/run/mutex.h"
#include "server/wire/failure.h"

namespace weft::server {

class RunQueue {
 public:
  enum class PriorityClass : std::uint8_t { kHeavy, kLight };

  class Slot;
  using Work = std::function<void(Slot&)>;  // of a run; throws nothing

  class Source {
   public:
    virtual ~Source() = default;
    // Looks for a run that may begin in the slot, and runs it once Slot::admit has accepted it.
    // Called on the queue's threads, by one at a time until then.
    virtual void run_next(Slot& slot) noexcept = 0;
  };

  struct Options {
    std::size_t slots = 1;
    std::size_t light_slots = 0;           // on top of the others
    std::size_t capacity = 0;              // runs that may wait
    std::uint64_t max_light_estimate = 0;  // a run with a higher estimate is heavy
    MemoryBudget* memory = nullptr;        // outlives the queue; null: memory is not bounded
    // The fraction of the capacity, and of the slots of each class, that one client may have; at
    // least one of each. Below 1, one of two or more slots is always left to other clients.
    double client_share = 1;
    // How long a client whose run turned out heavy has no light slot the first time; unused if
    // client_share is 1.
    std::chrono::milliseconds distrust{10'000};
  };

  struct Ticket {
    std::string client{};         // empty: not identified, so its slots are not bounded
    std::uint64_t estimate = 0;   // bytes of memory
    const void* owner = nullptr;  // by which a run that waits here can be removed
    std::uint64_t least = 0;      // bytes without which the run cannot begin to work
    std::uint64_t input = 0;      // bytes that its request holds in `memory`
  };

  // The right to compute, which a run has from its begin to its end.
  class Slot {
   public:
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

    PriorityClass priority() const { return priority_; }
    // Whether the run was estimated to be light, in a slot of either class, and was not promoted.
    bool is_light() const { return is_light_; }
    // The run's memory; empty if memory is not bounded.
    MemoryBudget::Reservation& memory() { return reservation_; }

    // Makes the run and its memory heavy. If the slot is light, another run may have it at once;
    // waits then for a heavy slot, or until `stopped`, which is called 20 times a second, returns
    // true. REQUIRES: one thread of the run calls it.
    void promote(const std::function<bool()>& stopped);

    // For a Source: the highest estimate of a run that may begin here, the clients that may have no
    // more slots of this class, and the run that it found. `admit` returns false if another run has
    // taken the slot, the client's share or the memory meanwhile. REQUIRES: memory is bounded.
    std::uint64_t max_estimate() const;
    std::vector<std::string> full_clients();
    bool admit(const Ticket& ticket);

   private:
    friend class RunQueue;
    explicit Slot(RunQueue& queue) : queue_(queue) {}

    RunQueue& queue_;
    PriorityClass priority_ = PriorityClass::kLight;
    bool is_light_ = false;
    bool pushed_ = false;
    Work work_;  // if pushed
    std::string client_;
    MemoryBudget::Reservation reservation_;
  };

  // While it lives, its run waits, and another run may have the slot. When it ends, the run goes on
  // at once: for a while, more runs may compute than there are slots.
  class Pause {
   public:
    explicit Pause(Slot& slot);
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Slot& slot_;
  };

  explicit RunQueue(const Options& options);
  // Stops.
  ~RunQueue() { stop(); }

  // Drops the runs that wait, and returns when those that have begun have ended.
  void stop();

  // Refuses with kLimitExceeded if the least that the run takes does not fit into the memory beside
  // its request, with kQueueFull if `capacity` runs wait already, or the client's share of that. If
  // client_share is below 1, a client without a waiting run is refused only if twice the capacity
  // waits: so a few clients that fill the queue do not shut out the others.
  std::optional<Failure> push(Ticket ticket, Work work);

  // Removes the owner's run, which has not begun; returns false if there is none. REQUIRES: not
  // null.
  bool remove(const void* owner);

  // There is at most one source. It is asked whenever it may have a run: after each wake(), and
  // when one of its runs has ended. detach() returns once all of its runs have ended.
  void attach(Source& source);
  void wake();
  void detach();

  // Call when memory was released: runs that wait for it may begin.
  void memory_released();

  // The numbers of runs that were pushed. A run that pauses is not running; one that is promoted
  // waits until it has a heavy slot.
  struct Stats {
    std::size_t waiting = 0;
    std::size_t running = 0;
    std::size_t pausing = 0;
  };
  Stats stats() const;

 private:
  struct Waiting {
    Ticket ticket;
    Work work;
    bool lacks_memory = false;  // when it was last looked at
    int bypass_count = 0;       // runs that have begun since then
  };
  struct Client {
    std::string name;
    std::deque<Waiting> runs;  // never empty
  };

  struct Slots {
    std::size_t count;
    std::size_t of_client;
    std::size_t running = 0;                          // pushed runs and runs of the source
    std::map<std::string, std::size_t> running_of{};  // per client, none is 0
    bool last_was_pushed = true;                      // the run that began last
    bool may_be_more = false;                         // the source may have another run
    bool left_out = false;                            // some clients were full at its last call
  };

  void work();
  void add_thread_if_short() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void begin(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void end(const Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void leave(const Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool next(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool ask_source(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool next_pushed(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool may_try(const Slot& slot, const Client& client) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool begin_one_of(Client& client, Slot& slot, bool only_starving)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void count_bypass() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool somebody_starves(const Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool assign(Slot& slot, const Ticket& ticket) const;
  bool has_slot(PriorityClass priority) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool has_share(PriorityClass priority, const std::string& client)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  const Slot* next_promoted() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Slots& of(PriorityClass priority) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return priority == PriorityClass::kHeavy ? heavy_ : light_;
  }
  bool is_light(std::uint64_t estimate) const {
    return options_.light_slots > 0 && estimate <= options_.max_light_estimate;
  }

  const Options options_;
  const std::size_t capacity_of_client_;

  mutable Mutex mutex_;
  Slots heavy_ ABSL_GUARDED_BY(mutex_);
  Slots light_ ABSL_GUARDED_BY(mutex_);
  std::list<Client> round_robin_ ABSL_GUARDED_BY(mutex_);  // the next client first
  std::list<Slot*> promoted_ ABSL_GUARDED_BY(mutex_);      // that wait for a heavy slot
  Distrust distrust_ ABSL_GUARDED_BY(mutex_);
  Stats stats_ ABSL_GUARDED_BY(mutex_);
  Source* source_ ABSL_GUARDED_BY(mutex_) = nullptr;
  std::size_t of_source_ ABSL_GUARDED_BY(mutex_) = 0;    // threads that are in the source
  const Slot* asked_ ABSL_GUARDED_BY(mutex_) = nullptr;  // for which it looks for a run
  std::chrono::steady_clock::time_point asked_since_ ABSL_GUARDED_BY(mutex_);
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  // At most one for each slot, the source, and each run that pauses or is promoted.
  std::vector<std::thread> threads_ ABSL_GUARDED_BY(mutex_);
  std::condition_variable idle_;            // threads without a run
  std::condition_variable heavy_slot_;      // runs that wait for one
  std::condition_variable left_by_source_;  // calls of detach
};

}  // namespace weft::server
