// SPDX-License-Identifier: Apache-2.0
#include "server/job_queue.h"

#include <algorithm>
#include <utility>

namespace weft::server {
namespace {

constexpr int kMostPasses = 64;

}  // namespace

JobQueue::JobQueue(const Options& options) : options_(options), idle_(options.workers) {
  workers_.reserve(options.workers + options.workers_for_light);
  for (std::size_t i = 0; i < options.workers; ++i)
    workers_.emplace_back([this] { work(Lane::kMain); });
  for (std::size_t i = 0; i < options.workers_for_light; ++i)
    workers_.emplace_back([this] { work(Lane::kLight); });
}

JobQueue::~JobQueue() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    turns_.clear();
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

bool JobQueue::push(std::shared_ptr<Job> job, Ticket ticket) {
  {
    std::lock_guard lock(mutex_);
    if (waiting_ >= idle_ + options_.capacity) return false;
    auto client = std::find_if(turns_.begin(), turns_.end(),
                               [&](const Client& c) { return c.name == ticket.client; });
    if (client == turns_.end())
      client = turns_.insert(turns_.end(), Client{std::move(ticket.client), {}});
    client->jobs.push_back({std::move(job), ticket.weight});
    ++waiting_;
  }
  // Not one alone: it might be a worker for light jobs, and this a heavy one.
  options_.workers_for_light == 0 ? changed_.notify_one() : changed_.notify_all();
  return true;
}

bool JobQueue::remove(const Job& job) {
  std::lock_guard lock(mutex_);
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    const auto found =
        std::find_if(client->jobs.begin(), client->jobs.end(),
                     [&](const Waiting& waiting) { return waiting.job.get() == &job; });
    if (found == client->jobs.end()) continue;
    client->jobs.erase(found);
    --waiting_;
    if (client->jobs.empty()) turns_.erase(client);
    return true;
  }
  return false;
}

void JobQueue::notify() {
  { std::lock_guard lock(mutex_); }  // no worker is between looking and waiting
  changed_.notify_all();
}

std::size_t JobQueue::waiting() const {
  std::lock_guard lock(mutex_);
  return waiting_;
}

std::size_t JobQueue::running() const {
  std::lock_guard lock(mutex_);
  return running_;
}

// REQUIRES: mutex_ is held.
JobQueue::Turn JobQueue::next(Lane lane) {
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    std::size_t place = 0;
    if (lane == Lane::kLight) {
      const auto light =
          std::find_if(client->jobs.begin(), client->jobs.end(),
                       [this](const Waiting& w) { return w.weight <= options_.light; });
      if (light == client->jobs.end()) continue;
      place = static_cast<std::size_t>(light - client->jobs.begin());
    }
    if (Turn turn = take(client, place); turn.job) return turn;
    if (++client->jobs[place].passed_over > kMostPasses) break;
  }
  return {};
}

// The job at this place of the client's, where there is memory for it; the client's next turn is
// the last one then.
JobQueue::Turn JobQueue::take(std::list<Client>::iterator client, std::size_t place) {
  Turn turn;
  if (options_.gate != nullptr) {
    auto share = options_.gate->take(client->jobs[place].weight);
    if (!share) return {};
    turn.share = std::move(*share);
  }
  turn.job = std::move(client->jobs[place].job);
  client->jobs.erase(client->jobs.begin() + static_cast<std::ptrdiff_t>(place));
  --waiting_;
  if (client->jobs.empty())
    turns_.erase(client);
  else
    turns_.splice(turns_.end(), turns_, client);
  return turn;
}

void JobQueue::work(Lane lane) {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    Turn turn = next(lane);
    if (!turn.job) {
      changed_.wait(lock);
      continue;
    }
    if (lane == Lane::kMain) --idle_;
    ++running_;
    lock.unlock();
    turn.job->run(lane);
    turn = {};
    lock.lock();
    if (lane == Lane::kMain) ++idle_;
    --running_;
  }
}

}  // namespace weft::server
