// SPDX-License-Identifier: Apache-2.0
// The metrics of a server, for Prometheus. Names, types and units are in metrics.cpp and
// in every scrape; no label identifies a caller.
//
//   Metrics metrics("0.1.0", "2");
//   metrics.call_ended("GenerateMesh", grpc::StatusCode::OK, 0.25);
//   metrics.add_queue("calls", [&] { return QueueStats{.waiting = 3, .running = 4}; });
//   std::cout << metrics.text();
//
// Cost: an atomic addition or a short lock, at the end of calls and once per
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

// The state of a queue at the moment of a scrape.
struct QueueStats {
  double waiting = 0;
  double running = 0;
  double pausing = 0;
  double admitted_bytes = 0;  // memory with which the running jobs were admitted
};

// Why the front closes connections: see connection_rules.h and connection_table.h.
inline constexpr const char* kClosingCauses[] = {
    "calls_without_end", "connections", "continuations", "descriptors", "frames",
    "header_block",      "load",        "pings",         "resets",      "unexpected_frame"};

class Metrics {
 public:
  Metrics(std::string_view version, std::string_view engine_version);

  // Counts a call of weft's services, including refused ones. `method` is as in the .proto.
  void call_ended(std::string_view method, grpc::StatusCode code, double seconds);

  // The time from acceptance to the begin of work.
  void waited(double seconds) { queue_seconds_.Observe(seconds); }
  // The engine's time on a mesh that it finished, without waiting for readers.
  void refined(double seconds) { refine_seconds_.Observe(seconds); }
  // The time from the call to its first chunk.
  void first_chunk(double seconds) { first_chunk_seconds_.Observe(seconds); }
  // Counts a chunk that was handed to a stream; its message has `bytes` bytes.
  void chunk_sent(std::uint64_t bytes) { streamed_bytes_.Increment(static_cast<double>(bytes)); }
  // Counts the triangles of a chunk that the engine made, for a call or a job.
  void triangles_made(std::uint64_t count) { triangles_.Increment(static_cast<double>(count)); }

  // Counts a job's new state, on a server with a store. `state` is in lower case: queued, running,
  // succeeded, failed or cancelled.
  void job_became(std::string_view state);
  // Counts a connection that was closed for what its client did, or to make room. `cause` is as in
  // the log.
  void connection_closed(std::string_view cause);
  void cache_hit() { cache_hits_.Increment(); }
  void cache_missed() { cache_misses_.Increment(); }
  // Counts leases that ran out. Each is found by only one server of a store.
  void leases_lost(std::uint64_t count) { leases_lost_.Increment(static_cast<double>(count)); }

  // Counts an attempt at a callback. `outcome` is as in the log: delivered, put_off or failed.
  void callback_sent(std::string_view outcome);

  // Counts stored chunks that were found damaged.
  void chunk_damaged() { damaged_chunks_.Increment(); }

  // `stats` is called at every scrape, on the scraping thread, until the metrics are destroyed or
  // scraping ends.
  void add_queue(std::string name, std::function<QueueStats()> stats);

  // The connections over TCP that are open, asked as `stats` of a queue is.
  void set_connections(std::function<double()> open);

  // The text format of Prometheus, version 0.0.4.
  std::string text() const;

 private:
  struct Queue {
    std::string name;
    std::function<QueueStats()> stats;
  };

  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Family<prometheus::Histogram>& request_seconds_;
  prometheus::Family<prometheus::Counter>& jobs_;
  prometheus::Family<prometheus::Counter>& connections_closed_;
  prometheus::Histogram& queue_seconds_;
  prometheus::Histogram& refine_seconds_;
  prometheus::Histogram& first_chunk_seconds_;
  prometheus::Counter& triangles_;
  prometheus::Counter& streamed_bytes_;
  prometheus::Counter& cache_hits_;
  prometheus::Counter& cache_misses_;
  prometheus::Counter& leases_lost_;
  prometheus::Counter& damaged_chunks_;
  prometheus::Family<prometheus::Counter>& callbacks_;

  mutable std::mutex mutex_;  // guards the two below
  std::vector<Queue> queues_;
  std::function<double()> connections_ = [] { return 0.0; };
};

}  // namespace weft::server
