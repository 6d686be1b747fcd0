// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/job_queue.h"

#include <algorithm>
#include <utility>

namespace weft::server {

JobQueue::JobQueue(std::size_t workers, std::size_t capacity)
    : capacity_(capacity), idle_(workers) {
  workers_.reserve(workers);
  for (std::size_t i = 0; i < workers; ++i) workers_.emplace_back([this] { work(); });
}

JobQueue::~JobQueue() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

bool JobQueue::push(std::shared_ptr<Job> job) {
  {
    std::lock_guard lock(mutex_);
    if (waiting_.size() >= idle_ + capacity_) return false;
    waiting_.push_back(std::move(job));
  }
  changed_.notify_one();
  return true;
}

bool JobQueue::remove(const Job& job) {
  std::lock_guard lock(mutex_);
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const auto& waiting) { return waiting.get() == &job; });
  if (found == waiting_.end()) return false;
  waiting_.erase(found);
  return true;
}

std::size_t JobQueue::waiting() {
  std::lock_guard lock(mutex_);
  return waiting_.size();
}

std::size_t JobQueue::running() {
  std::lock_guard lock(mutex_);
  return workers_.size() - idle_;
}

void JobQueue::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    std::shared_ptr<Job> job = std::move(waiting_.front());
    waiting_.pop_front();
    --idle_;
    lock.unlock();
    job->run();
    job.reset();
    lock.lock();
    ++idle_;
  }
}

}  // namespace weft::server
