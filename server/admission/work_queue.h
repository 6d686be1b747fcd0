// SPDX-License-Identifier: Apache-2.0
// Items wait their turn and run on threads of their own: as many at once as there are places, which
// may be shared with runs of another kind, as many waiting as the capacity says.
//
// Turns go round the clients that have items waiting, so none can starve another; a client's own
// items run first come, first served. A client has at most its share of what may wait, and of the
// places. If memory is shared through a gate, an item that does not fit is passed over, 64 times at
// most: after that the ones behind it wait with it.
//
// Some places are for light items only, and of those whatever their client sent before: a mesh of a
// millisecond does not wait for the queue of meshes that take seconds. An item that turns out heavy
// leaves such a place at once, and goes on when there is one in the main lane
// (Place::leave_light_lane). Where clients are told apart, its client has none of these places for
// a while (distrust.h): otherwise two clients whose heavy work looks light would keep both places
// from all others.
//
// An item that waits for whoever reads its mesh leaves its place to another one (Pause). So a
// client that reads nothing holds memory, but nobody's turn.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/admission/distrust.h"
#include "server/admission/memory_gate.h"
#include "server/admission/run_places.h"

namespace weft::server {

class WorkQueue {
 public:
  using Lane = RunPlaces::Lane;

  class Place;

  class Item {
   public:
    virtual ~Item() = default;
    virtual void run(Place& place) noexcept = 0;
  };

  struct Options {
    std::size_t workers = 1;
    std::size_t workers_for_light = 0;  // on top of the others
    std::size_t capacity = 0;
    std::uint64_t light = 0;     // memory estimate, in bytes, up to which an item is light
    MemoryGate* gate = nullptr;  // outlives the queue; null: memory is not looked at
    // The fraction of the capacity, and of the places in each lane, that one client may have; at
    // least one of each. Below 1, others have at least one place where there are two.
    double client_share = 1;
    // Shared with runs of jobs; they outlive the queue. Null: places of its own, as the above says.
    RunPlaces* places = nullptr;
    // How long a client whose item turned out heavy has no place for light ones the first time, if
    // its share is below 1.
    std::chrono::milliseconds distrust{10'000};
  };

  struct Ticket {
    std::string client;
    std::uint64_t estimate = 0;  // bytes of memory
  };

  enum class Pushed { kYes, kQueueFull, kClientFull };

  // Where an item runs.
  class Place {
   public:
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    Lane lane() const { return lane_; }
    // What the item began with; of nothing without a gate.
    MemoryGate::Share& memory() { return share_; }

    // The item is not light, nor is its memory. A place in the light lane goes to another item at
    // once; waits until there is one in the main lane, but no longer than until `stopped`, which is
    // asked a few times a second. Call on one thread, if the lane is the light one.
    void leave_light_lane(const std::function<bool()>& stopped);

   private:
    friend class WorkQueue;
    Place(WorkQueue& queue, Lane lane) : queue_(queue), lane_(lane) {}

    WorkQueue& queue_;
    Lane lane_;
    std::string client_;
    std::shared_ptr<Item> item_;  // null: nobody's
    MemoryGate::Share share_;
  };

  // While it lives, a running item waits for somebody else, and another may have its place. When it
  // ends the item goes on at once: for a while, more items run than there are places.
  class Pause {
   public:
    explicit Pause(Place& place) : place_(place) { place_.queue_.pause(place_); }
    ~Pause() { place_.queue_.go_on(place_); }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Place& place_;
  };

  explicit WorkQueue(const Options& options);
  // Waits for the items that run; what waits is dropped.
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  // kQueueFull if `capacity` items wait already, kClientFull if the client's share of that do.
  // Where clients are told apart, one of whom nothing waits is refused only if twice the capacity
  // waits: so a few clients who fill the queue shut out no other.
  Pushed push(std::shared_ptr<Item> item, Ticket ticket);
  bool push(std::shared_ptr<Item> item) { return push(std::move(item), Ticket()) == Pushed::kYes; }

  // Takes an item out that has not begun. False if it has begun, or was never here.
  bool remove(const Item& item);

  // The gate has room again.
  void notify();

  bool has_light_lane() const { return places_.places(Lane::kLight) > 0; }
  std::size_t capacity() const { return options_.capacity; }
  std::size_t capacity_of_client() const { return capacity_of_client_; }
  // At this moment. An item that pauses is not running. One that has left the light lane waits
  // until it has its other place.
  std::size_t waiting() const;
  std::size_t running() const;
  std::size_t pausing() const;

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

  // The workers of a lane. There are as many threads as places and pausing items at most, ever. An
  // item that has left the light lane runs in the main one, and its thread pauses in the light one.
  struct Workers {
    std::size_t running = 0;
    std::size_t pausing = 0;
    std::size_t threads = 0;
    std::condition_variable idle{};
  };

  void pause(Place& place);
  void go_on(Place& place);
  void leave_light_lane(Place& place, const std::function<bool()>& stopped);
  // These with the lock held.
  void add_worker(Lane lane);
  void add_worker_if_short(Lane lane);
  void begin(const Place& place);
  void end(const Place& place);
  void place_is_free(Lane lane);
  bool next(Place& place);
  bool find_next(Place& place, bool& waits);
  void wake_for_one(Lane lane);
  bool take(Place& place, std::list<Client>::iterator client, std::size_t index);
  bool may_begin(Lane lane) const { return places_.is_free(lane, RunPlaces::Kind::kCall); }
  Place* next_moving();
  std::list<Place*>::const_iterator first_moving_with_share() const;
  bool moving_wait_for_place() const;
  std::size_t moving_of(const std::string& client) const;
  Workers& workers_of(Lane lane) { return lane == Lane::kMain ? main_ : light_; }
  const Workers& workers_of(Lane lane) const { return lane == Lane::kMain ? main_ : light_; }

  void work(Lane lane);

  const Options options_;
  const std::size_t capacity_of_client_;
  RunPlaces own_places_;
  RunPlaces& places_;
  std::mutex& mutex_;        // of the places; guards all below
  std::list<Client> turns_;  // whose turn it is comes first
  std::size_t waiting_ = 0;
  Distrust distrust_;
  std::list<Place*> moving_;  // from the light lane to the main one, the first first
  std::condition_variable place_for_moving_;
  Workers main_;
  Workers light_;
  std::size_t lent_ = 0;  // threads of the light lane that run items in the main one, or for it
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace weft::server
