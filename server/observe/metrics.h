// SPDX-License-Identifier: Apache-2.0
// What a server counts and measures, for Prometheus. Names, types and units are in metrics.cpp and
// in every scrape; no label tells who called.
//
//   Metrics metrics("0.1.0", "2");
//   metrics.call_ended("GenerateMesh", grpc::StatusCode::OK, 0.25);
//   metrics.add_queue("calls", [&] { return QueueFigures{.waiting = 3, .running = 4}; });
//   std::cout << metrics.text();
//
// Cost: an atomic addition or a lock that nobody holds for long, at the end of calls and once a
// chunk. Times are in seconds. Thread-safety: every function may be called from any thread.
#pragma once

#include <grpcpp/support/status_code_enum.h>
#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

// As they are at the moment of a scrape.
struct QueueFigures {
  double waiting = 0;
  double running = 0;
  double pausing = 0;
  double admitted_bytes = 0;  // memory that the running jobs were admitted with
};

class Metrics {
 public:
  Metrics(std::string_view version, std::string_view engine_version);

  // A call of weft's services, refused ones included. `method` as in the .proto.
  void call_ended(std::string_view method, grpc::StatusCode code, double seconds);

  // From being accepted to being worked on.
  void waited(double seconds) { queue_seconds_.Observe(seconds); }
  // The engine's time on a mesh that it finished, without waiting for readers.
  void refined(double seconds) { refine_seconds_.Observe(seconds); }
  // From the call to the first chunk that it is answered with.
  void first_chunk(double seconds) { first_chunk_seconds_.Observe(seconds); }
  // A chunk was handed to a stream; its message has so many bytes.
  void chunk_sent(std::uint64_t bytes) { streamed_bytes_.Increment(static_cast<double>(bytes)); }
  // The engine made a chunk of so many triangles, for a call or a job.
  void triangles_made(std::uint64_t count) { triangles_.Increment(static_cast<double>(count)); }

  // Jobs, of a server with a store. `state` in lower case: queued, running, succeeded, failed or
  // cancelled.
  void job_became(std::string_view state);
  void cache_hit() { cache_hits_.Increment(); }
  void cache_missed() { cache_misses_.Increment(); }
  // So many were found to have run out. One server of a store finds it, and only that one.
  void leases_lost(std::uint64_t count) { leases_lost_.Increment(static_cast<double>(count)); }

  // `figures` is called at every scrape, on the scraping thread, until the metrics are destroyed or
  // no one scrapes any more.
  void add_queue(std::string name, std::function<QueueFigures()> figures);

  // The text format of Prometheus, version 0.0.4.
  std::string text() const;

 private:
  struct Queue {
    std::string name;
    std::function<QueueFigures()> figures;
  };

  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Family<prometheus::Histogram>& request_seconds_;
  prometheus::Family<prometheus::Counter>& jobs_;
  prometheus::Histogram& queue_seconds_;
  prometheus::Histogram& refine_seconds_;
  prometheus::Histogram& first_chunk_seconds_;
  prometheus::Counter& triangles_;
  prometheus::Counter& streamed_bytes_;
  prometheus::Counter& cache_hits_;
  prometheus::Counter& cache_misses_;
  prometheus::Counter& leases_lost_;

  mutable std::mutex mutex_;  // guards the one below
  std::vector<Queue> queues_;
};

}  // namespace weft::server
