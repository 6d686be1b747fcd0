// SPDX-License-Identifier: Apache-2.0
// Jobs wait their turn and run on threads of their own: as many at once as there are workers, as
// many waiting as the capacity says.
//
// Turns go round the clients that have jobs waiting, so none can starve another; a client's own
// jobs run first come, first served. Where memory is promised through a gate, a job that does not
// fit is passed over, 64 times at most: after that the ones behind it wait with it.
//
// Some workers take light jobs only, and of those whatever their client sent before: a mesh of a
// millisecond does not wait for the queue of meshes that take seconds.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/memory_gate.h"

namespace weft::server {

class JobQueue {
 public:
  // Whose worker a job runs on.
  enum class Lane { kMain, kLight };

  class Job {
   public:
    virtual ~Job() = default;
    virtual void run(Lane lane) noexcept = 0;
  };

  struct Options {
    std::size_t workers = 1;
    std::size_t workers_for_light = 0;  // on top of the others
    std::size_t capacity = 0;
    std::uint64_t light = 0;     // weight, in bytes, up to which a job is light
    MemoryGate* gate = nullptr;  // outlives the queue; null: memory is not looked at
  };

  struct Ticket {
    std::string client;
    std::uint64_t weight = 0;  // bytes
  };

  explicit JobQueue(const Options& options);
  // Waits for the jobs that run; what waits is dropped.
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  // False where `capacity` jobs wait already.
  bool push(std::shared_ptr<Job> job, Ticket ticket);
  bool push(std::shared_ptr<Job> job) { return push(std::move(job), Ticket()); }

  // Takes a job out that has not begun. False where it has begun, or was never here.
  bool remove(const Job& job);

  // The gate has room again.
  void notify();

  std::size_t capacity() const { return options_.capacity; }
  // At this moment.
  std::size_t waiting() const;
  std::size_t running() const;

 private:
  struct Waiting {
    std::shared_ptr<Job> job;
    std::uint64_t weight;
    int passed_over = 0;
  };
  struct Client {
    std::string name;
    std::deque<Waiting> jobs;  // never empty
  };
  struct Turn {
    std::shared_ptr<Job> job;  // null: nobody's
    MemoryGate::Share share;
  };

  void work(Lane lane);
  Turn next(Lane lane);
  Turn take(std::list<Client>::iterator client, std::size_t place);

  const Options options_;
  mutable std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  std::list<Client> turns_;  // whose turn it is comes first
  std::size_t waiting_ = 0;
  std::size_t running_ = 0;
  std::size_t idle_;  // workers, for light jobs apart, that wait for a job
  bool stopping_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace weft::server
