// SPDX-License-Identifier: Apache-2.0
// The one queue of runs, of calls and of stored jobs alike, and the threads on which they work. A
// run begins once there is a slot for it and the memory that it is expected to take.
//
// Turns go round the clients that have runs waiting, so none can starve another; a client's own
// runs begin first come, first served. A client has at most its share of what may wait, of the
// slots and of the memory. A run for which there is no memory is passed over, 64 times at most:
// after that the ones behind it wait with it.
//
// Some slots are for light runs only, and of those whatever their client sent before: a mesh of a
// millisecond does not wait for the queue of meshes that take seconds. A run that turns out heavy
// leaves such a slot at once, and goes on when there is a heavy one (Slot::promote). Where clients
// are told apart, its client has no light slots for a while (distrust.h): otherwise two clients
// whose heavy work looks light would keep both slots from all others.
//
// A run that waits for whoever reads its mesh leaves its slot to another one (Pause). So a client
// that reads nothing holds memory, but nobody's turn.
//
// Runs that wait elsewhere, such as in a store, come from a Source, in turns with those that wait
// here. It is asked only once there is a slot, so that what does not run here may run on another
// server.
//
//   RunQueue queue({.slots = 4, .light_slots = 2, .capacity = 64, .light = 16 << 20});
//   if (auto refusal = queue.push(run, {.client = "ann", .estimate = 9 << 20})) return *refusal;
//
// Law: no more runs compute at once than there are slots, but for those that go on after a Pause.
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
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/run/distrust.h"
#include "server/run/memory_gate.h"
#include "server/run/mutex.h"
#include "server/wire/errors.h"

namespace weft::server {

class RunQueue {
 public:
  enum class Priority : std::uint8_t { kHeavy, kLight };

  class Slot;

  class Item {
   public:
    virtual ~Item() = default;
    virtual void run(Slot& slot) noexcept = 0;
  };

  class Source {
   public:
    virtual ~Source() = default;
    // Looks for a run that may have the slot, and runs it once Slot::admit has taken it. Called on
    // the queue's threads, by one at a time until then.
    virtual void run_next(Slot& slot) noexcept = 0;
  };

  struct Options {
    std::size_t slots = 1;
    std::size_t light_slots = 0;  // on top of the others
    std::size_t capacity = 0;     // runs that may wait
    std::uint64_t light = 0;      // memory estimate, in bytes, up to which a run is light
    MemoryGate* gate = nullptr;   // outlives the queue; null: memory is not looked at
    // The fraction of the capacity, and of the slots of each priority, that one client may have; at
    // least one of each. Below 1, others have at least one slot where there are two.
    double client_share = 1;
    // How long a client whose run turned out heavy has no light slot the first time, if its share
    // is below 1.
    std::chrono::milliseconds distrust{10'000};
  };

  struct Ticket {
    std::string client{};        // empty: nobody's, so that no share of the slots bounds it
    std::uint64_t estimate = 0;  // bytes of memory
  };

  // Where a run works.
  class Slot {
   public:
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

    Priority priority() const { return priority_; }
    // Whether the run is judged light, in whichever slot, and was not promoted.
    bool is_light() const { return is_light_; }
    // What the run began with; of nothing without a gate.
    MemoryGate::Share& memory() { return share_; }

    // The run is not light, nor is its memory. A light slot goes to another run at once; waits
    // until there is a heavy one, but no longer than until `stopped`, which is asked a few times a
    // second. Call on one thread, if the run is light.
    void promote(const std::function<bool()>& stopped);

    // For a Source: the highest estimate of a run that may begin here, the clients that may have no
    // more such slots, and the run that it found. False: the slot, the client's share or the memory
    // has gone to another run meanwhile. REQUIRES: there is a gate.
    std::uint64_t room() const;
    std::vector<std::string> full_clients();
    bool admit(const Ticket& ticket);

   private:
    friend class RunQueue;
    explicit Slot(RunQueue& queue) : queue_(queue) {}

    RunQueue& queue_;
    Priority priority_ = Priority::kLight;
    bool is_light_ = false;
    std::shared_ptr<Item> item_;  // of a run that was pushed
    bool pushed_ = false;
    std::string client_;
    MemoryGate::Share share_;
  };

  // While it lives, a run waits for somebody else, and another may have its slot. When it ends the
  // run goes on at once: for a while, more runs work than there are slots.
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
  RunQueue(const RunQueue&) = delete;
  RunQueue& operator=(const RunQueue&) = delete;

  // Waits for the runs that have begun; those that wait are dropped.
  void stop();

  // Refuses with kQueueFull if `capacity` runs wait already, or the client's share of that. Where
  // clients are told apart, one of whom nothing waits is refused only if twice the capacity waits:
  // so a few clients who fill the queue shut out no other.
  std::optional<Failure> push(std::shared_ptr<Item> item, Ticket ticket);
  // REQUIRES: the function does not throw.
  std::optional<Failure> push(std::string client, std::function<void()> function);

  // Takes a run out that has not begun. False if it has begun, or was never here.
  bool remove(const Item& item);

  // There is one source at most. It is asked whenever there may be a run: after each wake(), and
  // when one of its runs has ended. detach() returns once none of its runs is left.
  void attach(Source& source);
  void wake();
  void detach();

  // The gate has room again.
  void notify();

  // Of the runs that were pushed. One that pauses is not running; one that is promoted waits until
  // it has its other slot.
  struct Figures {
    std::size_t waiting = 0;
    std::size_t running = 0;
    std::size_t pausing = 0;
  };
  Figures figures() const;

 private:
  struct Waiting {
    std::shared_ptr<Item> item;
    std::uint64_t estimate;
    int passed_over = 0;
  };
  struct Client {
    std::string name;
    std::deque<Waiting> items;  // never empty
  };
  using Turn = std::list<Client>::iterator;

  struct Slots {
    std::size_t count;
    std::size_t of_client;
    std::size_t running = 0;                          // of pushed runs and of the source
    std::map<std::string, std::size_t> running_of{};  // per client, none is 0
    bool last_was_pushed = true;                      // of the runs that began
    bool may_be_more = false;                         // runs of the source
    bool left_out = false;                            // clients, when it was asked last
  };

  void work();
  void add_thread() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void add_thread_if_short() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void slot_is_free() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void begin(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void end(const Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool next(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool ask_source(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool next_pushed(Slot& slot) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool take(Slot& slot, Turn client, std::size_t index) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::optional<MemoryGate::Share> reserve(const Ticket& ticket) const;
  bool has_slot(Priority priority) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool has_share(Priority priority, const std::string& client)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  const Slot* next_promoted() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Slots& of(Priority priority) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return priority == Priority::kHeavy ? heavy_ : light_;
  }
  bool is_light(std::uint64_t estimate) const {
    return options_.light_slots > 0 && estimate <= options_.light;
  }

  const Options options_;
  const std::size_t capacity_of_client_;

  mutable Mutex mutex_;
  Slots heavy_ ABSL_GUARDED_BY(mutex_);
  Slots light_ ABSL_GUARDED_BY(mutex_);
  std::list<Client> turns_ ABSL_GUARDED_BY(mutex_);    // whose turn it is comes first
  std::list<Slot*> promoted_ ABSL_GUARDED_BY(mutex_);  // that wait for a heavy slot
  Distrust distrust_ ABSL_GUARDED_BY(mutex_);
  Figures figures_ ABSL_GUARDED_BY(mutex_);
  Source* source_ ABSL_GUARDED_BY(mutex_) = nullptr;
  std::size_t of_source_ ABSL_GUARDED_BY(mutex_) = 0;    // threads that are in the source
  const Slot* asked_ ABSL_GUARDED_BY(mutex_) = nullptr;  // for which it looks for a run
  std::chrono::steady_clock::time_point asked_since_ ABSL_GUARDED_BY(mutex_);
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  // As many as slots, the source, and runs that pause or wait for another slot, at most, ever.
  std::vector<std::thread> threads_ ABSL_GUARDED_BY(mutex_);
  std::condition_variable idle_;            // threads without a run
  std::condition_variable heavy_slot_;      // runs that wait for one
  std::condition_variable left_by_source_;  // whoever detaches
};

}  // namespace weft::server
