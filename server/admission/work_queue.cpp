// SPDX-License-Identifier: Apache-2.0
#include "server/admission/work_queue.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "server/admission/client_share.h"

namespace weft::server {
namespace {

constexpr int kMostPasses = 64;
// How often an item that waits for another place asks whether it is to end.
constexpr std::chrono::milliseconds kAsk{50};

}  // namespace

WorkQueue::WorkQueue(const Options& options)
    : options_(options),
      capacity_of_client_(share_of(options.capacity, options.client_share)),
      distrust_(options.distrust),
      main_{.places = options.workers,
            .of_client = share_of(options.workers, options.client_share)},
      light_{.places = options.workers_for_light,
             .of_client = share_of(options.workers_for_light, options.client_share)} {
  std::lock_guard lock(mutex_);
  for (const Lane lane : {Lane::kMain, Lane::kLight}) {
    while (workers_of(lane).threads < workers_of(lane).places) add_worker(lane);
  }
}

WorkQueue::~WorkQueue() {
  std::vector<std::thread> threads;
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;  // so that there are no more threads
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
    if (workers.threads < workers.places + workers.pausing && !stopping_) add_worker(lane);
  } catch (const std::exception&) {
    // No thread, or no memory for one: the place stays empty until the item that pauses goes on.
  }
}

void WorkQueue::begin(const Place& place) {
  Workers& workers = workers_of(place.lane_);
  ++workers.running;
  ++workers.running_of[place.client_];
}

void WorkQueue::end(const Place& place) {
  Workers& workers = workers_of(place.lane_);
  --workers.running;
  const auto of_client = workers.running_of.find(place.client_);
  if (--of_client->second == 0) workers.running_of.erase(of_client);
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

bool WorkQueue::has_place(Lane lane, const std::string& client) const {
  const Workers& workers = workers_of(lane);
  if (workers.running >= workers.places) return false;
  const auto of_client = workers.running_of.find(client);
  return of_client == workers.running_of.end() || of_client->second < workers.of_client;
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
WorkQueue::Place* WorkQueue::next_moving() const {
  for (Place* const place : moving_)
    if (has_place(Lane::kMain, place->client_)) return place;
  return nullptr;
}

std::size_t WorkQueue::moving_of(const std::string& client) const {
  return static_cast<std::size_t>(
      std::count_if(moving_.begin(), moving_.end(),
                    [&](const Place* place) { return place->client_ == client; }));
}

WorkQueue::Pushed WorkQueue::push(std::shared_ptr<Item> item, Ticket ticket) {
  {
    std::lock_guard lock(mutex_);
    const std::size_t idle = main_.places - std::min(main_.running, main_.places);
    auto client = std::find_if(turns_.begin(), turns_.end(),
                               [&](const Client& c) { return c.name == ticket.client; });
    const std::size_t of_client =
        (client != turns_.end() ? client->items.size() : 0) + moving_of(ticket.client);
    const bool has_room_of_its_own = options_.client_share < 1 && of_client == 0;
    if (waiting_ + moving_.size() >= idle + options_.capacity * (has_room_of_its_own ? 2 : 1))
      return Pushed::kQueueFull;
    if (of_client >= std::min(idle, main_.of_client) + capacity_of_client_)
      return Pushed::kClientFull;
    if (client == turns_.end())
      client = turns_.insert(turns_.end(), Client{std::move(ticket.client), {}});
    client->items.push_back({std::move(item), ticket.estimate});
    ++waiting_;
    if (main_.running < main_.places) main_.idle.notify_one();
    if (ticket.estimate <= options_.light && light_.running < light_.places)
      light_.idle.notify_one();
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

bool WorkQueue::next(Place& place) {
  if (place.lane_ == Lane::kMain && next_moving() != nullptr) return false;
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    if (!has_place(place.lane_, client->name)) continue;
    std::size_t index = 0;
    if (place.lane_ == Lane::kLight) {
      if (distrust_.holds_for(client->name, Distrust::Clock::now())) continue;
      const auto light =
          std::find_if(client->items.begin(), client->items.end(),
                       [this](const Waiting& w) { return w.estimate <= options_.light; });
      if (light == client->items.end()) continue;
      index = static_cast<std::size_t>(light - client->items.begin());
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
      workers_of(lane).idle.wait(lock);
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
