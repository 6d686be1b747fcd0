// SPDX-License-Identifier: Apache-2.0
#include "server/admission/work_queue.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "server/admission/client_share.h"

namespace weft::server {
namespace {

constexpr RunPlaces::Kind kKind = RunPlaces::Kind::kCall;
constexpr int kMostPasses = 64;
// How often an item that waits for another place asks whether it is to end.
constexpr std::chrono::milliseconds kAsk{50};

}  // namespace

WorkQueue::WorkQueue(const Options& options)
    : options_(options),
      capacity_of_client_(share_of(options.capacity, options.client_share)),
      own_places_({.places = options.workers,
                   .light = options.workers_for_light,
                   .client_share = options.client_share}),
      places_(options.places != nullptr ? *options.places : own_places_),
      mutex_(places_.mutex),
      distrust_(options.distrust) {
  std::lock_guard lock(mutex_);
  for (const Lane lane : {Lane::kMain, Lane::kLight}) {
    while (workers_of(lane).threads < places_.places(lane)) add_worker(lane);
  }
  places_.on_free(kKind, [this] {
    place_for_moving_.notify_all();
    main_.idle.notify_all();
    light_.idle.notify_all();
  });
}

WorkQueue::~WorkQueue() {
  std::vector<std::thread> threads;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;  // so that there are no more threads
    places_.on_free(kKind, {});
    for (const Lane lane : {Lane::kMain, Lane::kLight}) places_.set_waits(lane, kKind, false);
    turns_.clear();
    threads.swap(threads_);
  }
  main_.idle.notify_all();
  light_.idle.notify_all();
  place_for_moving_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

void WorkQueue::add_worker(Lane lane) {
  threads_.emplace_back([this, lane] { work(lane); });
  ++workers_of(lane).threads;
}

void WorkQueue::add_worker_if_short(Lane lane) {
  const Workers& workers = workers_of(lane);
  try {
    if (workers.threads < places_.places(lane) + workers.pausing && !stopping_) add_worker(lane);
  } catch (const std::exception&) {
    // No thread, or no memory for one: the place stays empty until the item that pauses goes on.
  }
}

void WorkQueue::begin(const Place& place) {
  places_.begin(place.lane_, kKind, place.client_);
  ++workers_of(place.lane_).running;
}

void WorkQueue::end(const Place& place) {
  places_.end(place.lane_, kKind, place.client_);
  --workers_of(place.lane_).running;
}

// Items that move come first. Wakes one worker only, because the place is enough for one.
void WorkQueue::place_is_free(Lane lane) {
  if (lane == Lane::kMain && !moving_.empty())
    place_for_moving_.notify_all();
  else
    workers_of(lane).idle.notify_one();
}

void WorkQueue::pause(Place& place) {
  std::lock_guard lock(mutex_);
  end(place);
  ++workers_of(place.lane_).pausing;
  add_worker_if_short(place.lane_);
  place_is_free(place.lane_);
}

void WorkQueue::go_on(Place& place) {
  std::lock_guard lock(mutex_);
  --workers_of(place.lane_).pausing;
  begin(place);
}

void WorkQueue::Place::leave_light_lane(const std::function<bool()>& stopped) {
  queue_.leave_light_lane(*this, stopped);
}

void WorkQueue::leave_light_lane(Place& place, const std::function<bool()>& stopped) {
  place.share_.turn_heavy();
  std::unique_lock lock(mutex_);
  if (place.lane_ == Lane::kMain) return;
  if (options_.client_share < 1) distrust_.turned_out_heavy(place.client_, Distrust::Clock::now());
  end(place);
  ++light_.pausing;
  ++lent_;
  add_worker_if_short(Lane::kLight);
  place_is_free(Lane::kLight);
  place.lane_ = Lane::kMain;
  const auto self = moving_.insert(moving_.end(), &place);
  place.share_.set_parked(true);  // those in the places may wait for the memory of this one
  while (next_moving() != &place && !stopping_) {
    place_for_moving_.wait_for(lock, kAsk);
    lock.unlock();
    const bool stop = stopped();
    lock.lock();
    if (stop) break;
  }
  place.share_.set_parked(false);
  moving_.erase(self);
  begin(place);
  // Another place may be free, which nobody looked at because of this one.
  place_for_moving_.notify_all();
  main_.idle.notify_all();
}

// The first item that may have a main place now.
WorkQueue::Place* WorkQueue::next_moving() {
  const auto next = first_moving_with_share();
  if (next == moving_.end()) return nullptr;
  if (may_begin(Lane::kMain)) return *next;
  places_.set_waits(Lane::kMain, kKind, true);
  return nullptr;
}

std::list<WorkQueue::Place*>::const_iterator WorkQueue::first_moving_with_share() const {
  return std::ranges::find_if(moving_, [this](const Place* place) {
    return places_.has_share(Lane::kMain, place->client_);
  });
}

bool WorkQueue::moving_wait_for_place() const {
  return first_moving_with_share() != moving_.end() && !may_begin(Lane::kMain);
}

std::size_t WorkQueue::moving_of(const std::string& client) const {
  return static_cast<std::size_t>(
      std::count_if(moving_.begin(), moving_.end(),
                    [&](const Place* place) { return place->client_ == client; }));
}

WorkQueue::Pushed WorkQueue::push(std::shared_ptr<Item> item, Ticket ticket) {
  {
    std::lock_guard lock(mutex_);
    const std::size_t idle = places_.places(Lane::kMain) -
                             std::min(places_.running(Lane::kMain), places_.places(Lane::kMain));
    auto client = std::find_if(turns_.begin(), turns_.end(),
                               [&](const Client& c) { return c.name == ticket.client; });
    const std::size_t of_client =
        (client != turns_.end() ? client->items.size() : 0) + moving_of(ticket.client);
    const bool has_room_of_its_own = options_.client_share < 1 && of_client == 0;
    if (waiting_ + moving_.size() >= idle + options_.capacity * (has_room_of_its_own ? 2 : 1))
      return Pushed::kQueueFull;
    if (of_client >= std::min(idle, places_.of_client(Lane::kMain)) + capacity_of_client_)
      return Pushed::kClientFull;
    if (client == turns_.end())
      client = turns_.insert(turns_.end(), Client{std::move(ticket.client), {}});
    client->items.push_back({std::move(item), ticket.estimate});
    ++waiting_;
    wake_for_one(Lane::kMain);
    if (has_light_lane() && ticket.estimate <= options_.light) wake_for_one(Lane::kLight);
  }
  return Pushed::kYes;
}

bool WorkQueue::remove(const Item& item) {
  std::lock_guard lock(mutex_);
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    const auto found =
        std::find_if(client->items.begin(), client->items.end(),
                     [&](const Waiting& waiting) { return waiting.item.get() == &item; });
    if (found == client->items.end()) continue;
    client->items.erase(found);
    --waiting_;
    if (client->items.empty()) turns_.erase(client);
    return true;
  }
  return false;
}

void WorkQueue::notify() {
  { std::lock_guard lock(mutex_); }  // no worker is between its check and its wait now
  main_.idle.notify_all();
  light_.idle.notify_all();
}

std::size_t WorkQueue::waiting() const {
  std::lock_guard lock(mutex_);
  return waiting_ + moving_.size();
}

std::size_t WorkQueue::running() const {
  std::lock_guard lock(mutex_);
  return main_.running + light_.running;
}

// Threads that items which have left the light lane took with them do not count.
std::size_t WorkQueue::pausing() const {
  std::lock_guard lock(mutex_);
  return main_.pausing + light_.pausing - lent_;
}

// An item came that may want a place of this lane.
void WorkQueue::wake_for_one(Lane lane) {
  if (may_begin(lane))
    workers_of(lane).idle.notify_one();
  else
    places_.set_waits(lane, kKind, true);
}

// Gives the place an item, if there is one that may begin.
bool WorkQueue::next(Place& place) {
  if (place.lane_ == Lane::kMain && (next_moving() != nullptr || moving_wait_for_place()))
    return false;
  bool waits = false;
  const bool found = find_next(place, waits);
  places_.set_waits(place.lane_, kKind, waits);
  return found;
}

// `waits` becomes true if nothing but a place is missing.
bool WorkQueue::find_next(Place& place, bool& waits) {
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    if (!places_.has_share(place.lane_, client->name)) continue;
    std::size_t index = 0;
    if (place.lane_ == Lane::kLight) {
      if (distrust_.holds_for(client->name, Distrust::Clock::now())) continue;
      const auto light =
          std::find_if(client->items.begin(), client->items.end(),
                       [this](const Waiting& w) { return w.estimate <= options_.light; });
      if (light == client->items.end()) continue;
      index = static_cast<std::size_t>(light - client->items.begin());
    }
    if (!may_begin(place.lane_)) {
      waits = true;
      return false;
    }
    if (take(place, client, index)) return true;
    if (++client->items[index].passed_over > kMostPasses) break;
  }
  return false;
}

// Gives the place to the client's item of this index if there is memory for it. The client's next
// turn is then the last one.
bool WorkQueue::take(Place& place, std::list<Client>::iterator client, std::size_t index) {
  const Waiting& waiting = client->items[index];
  if (options_.gate != nullptr) {
    auto share = options_.gate->take({.estimate = waiting.estimate,
                                      .client = client->name,
                                      .light = waiting.estimate <= options_.light});
    if (!share) return false;
    place.share_ = std::move(*share);
  }
  place.item_ = waiting.item;
  place.client_ = client->name;
  client->items.erase(client->items.begin() + static_cast<std::ptrdiff_t>(index));
  --waiting_;
  if (client->items.empty())
    turns_.erase(client);
  else
    turns_.splice(turns_.end(), turns_, client);
  return true;
}

void WorkQueue::work(Lane lane) {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    Place place(*this, lane);
    if (!next(place)) {
      workers_of(lane).idle.wait_for(lock, RunPlaces::kTurn);
      continue;
    }
    begin(place);
    lock.unlock();
    place.item_->run(place);
    place.item_.reset();
    place.share_ = {};
    lock.lock();
    end(place);
    if (place.lane_ != lane) {
      --light_.pausing;
      --lent_;
    }
    // The worker itself looks for the next item of its own lane.
    if (place.lane_ != lane || !moving_.empty()) place_is_free(Lane::kMain);
  }
}

}  // namespace weft::server
