// SPDX-License-Identifier: GPL-3.0-or-later
// Jobs wait their turn, first come, first served, and run on threads of their own: as many at once
// as there are workers, as many waiting as the capacity says.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace weft::server {

class JobQueue {
 public:
  class Job {
   public:
    virtual ~Job() = default;
    virtual void run() noexcept = 0;
  };

  JobQueue(std::size_t workers, std::size_t capacity);
  // Waits for the jobs that run; what waits is dropped.
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  // False where `capacity` jobs wait already.
  bool push(std::shared_ptr<Job> job);

  // Takes a job out that has not begun. False where it has begun, or was never here.
  bool remove(const Job& job);

  std::size_t capacity() const { return capacity_; }

  // At this moment.
  std::size_t waiting();
  std::size_t running();

 private:
  void work();

  const std::size_t capacity_;
  std::mutex mutex_;  // guards the four below
  std::condition_variable changed_;
  std::deque<std::shared_ptr<Job>> waiting_;
  std::size_t idle_ = 0;  // workers that wait for a job
  bool stopping_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace weft::server
