// SPDX-License-Identifier: Apache-2.0
#include "server/observe/metrics.h"

#include <prometheus/gauge.h>
#include <prometheus/text_serializer.h>

#include <sstream>
#include <utility>

#include "server/observe/process_metrics.h"
#include "server/wire/errors.h"

namespace weft::server {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Histogram;
using prometheus::Registry;

// From a small mesh over a unix socket to the longest job: two or three buckets per factor of ten.
const Histogram::BucketBoundaries kSeconds = {0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
                                              0.25,  0.5,    1,     2.5,  5,     10,   30,
                                              60,    120,    300,   600,  1800,  3600};

Family<Counter>& counters(Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Counter& counter(Registry& registry, const char* name, const char* help) {
  return counters(registry, name, help).Add({});
}

Family<Histogram>& histograms(Registry& registry, const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

Histogram& histogram(Registry& registry, const char* name, const char* help) {
  return histograms(registry, name, help).Add({}, kSeconds);
}

prometheus::MetricFamily gauge_family(const char* name, const char* help) {
  return {name, help, prometheus::MetricType::Gauge, {}};
}

void add_gauge(prometheus::MetricFamily& family, const std::string& queue, double value) {
  prometheus::ClientMetric metric;
  metric.label = {{"queue", queue}};
  metric.gauge.value = value;
  family.metric.push_back(std::move(metric));
}

}  // namespace

Metrics::Metrics(std::string_view version, std::string_view engine_version)
    : requests_(counters(registry_, "weft_requests_total", "Calls that have ended")),
      request_seconds_(
          histograms(registry_, "weft_request_seconds", "From a call to the end of its answer")),
      jobs_(counters(registry_, "weft_jobs_total",
                     "Jobs that reached a state; jobs that share a mesh count once as running")),
      connections_closed_(
          counters(registry_, "weft_connections_closed_total",
                   "Connections closed for what their clients did, or to make room for others")),
      queue_seconds_(histogram(registry_, "weft_queue_seconds",
                               "From being accepted to the start of the work")),
      refine_seconds_(histogram(registry_, "weft_refine_seconds",
                                "The engine's time on a mesh, without waiting for readers")),
      first_chunk_seconds_(histogram(registry_, "weft_first_chunk_seconds",
                                     "From a call to the first chunk of its mesh")),
      triangles_(counter(registry_, "weft_triangles_total",
                         "Triangles that the engine has made, for calls and jobs")),
      streamed_bytes_(counter(registry_, "weft_streamed_bytes_total",
                              "Bytes of messages with chunks that were given to streams")),
      cache_hits_(counter(registry_, "weft_cache_hits_total",
                          "Requests answered with a mesh that was kept, or is being made")),
      cache_misses_(
          counter(registry_, "weft_cache_misses_total", "Requests whose mesh had to be made")),
      leases_lost_(
          counter(registry_, "weft_leases_lost_total",
                  "Attempts at a mesh whose lease ran out, because their worker was lost or hung")),
      damaged_chunks_(counter(registry_, "weft_damaged_chunks_total",
                              "Stored chunks that were found to have other bytes than were put")),
      callbacks_(counters(registry_, "weft_callbacks_total",
                          "Attempts to tell a client's URL of the end of a job")) {
  // So that the first of each shows as an increase, too.
  for (const char* cause : kClosingCauses) connections_closed_.Add({{"cause", cause}});
  for (const char* state : {"queued", "running", "succeeded", "failed", "cancelled"})
    jobs_.Add({{"state", state}});
  for (const char* outcome : {"delivered", "put_off", "failed"})
    callbacks_.Add({{"outcome", outcome}});
  prometheus::BuildGauge()
      .Name("weft_build_info")
      .Help("Always 1; the versions are in the labels")
      .Register(registry_)
      .Add({{"version", std::string(version)}, {"engine", std::string(engine_version)}})
      .Set(1);
}

void Metrics::call_ended(std::string_view method, grpc::StatusCode code, double seconds) {
  const std::string name(method);
  requests_.Add({{"method", name}, {"code", std::string(code_name(code))}}).Increment();
  request_seconds_.Add({{"method", name}}, kSeconds).Observe(seconds);
}

void Metrics::job_became(std::string_view state) {
  jobs_.Add({{"state", std::string(state)}}).Increment();
}

void Metrics::callback_sent(std::string_view outcome) {
  callbacks_.Add({{"outcome", std::string(outcome)}}).Increment();
}

void Metrics::connection_closed(std::string_view cause) {
  connections_closed_.Add({{"cause", std::string(cause)}}).Increment();
}

void Metrics::set_connections(std::function<double()> open) {
  std::lock_guard lock(mutex_);
  connections_ = std::move(open);
}

void Metrics::add_queue(std::string name, std::function<QueueStats()> stats) {
  std::lock_guard lock(mutex_);
  queues_.push_back({std::move(name), std::move(stats)});
}

std::string Metrics::text() const {
  std::vector<Queue> queues;
  std::function<double()> open;
  {
    std::lock_guard lock(mutex_);
    queues = queues_;
    open = connections_;
  }
  auto connections = gauge_family("weft_connections", "Connections over TCP that are open");
  connections.metric.emplace_back().gauge.value = open();
  auto waiting = gauge_family("weft_queue_length", "Calls or jobs that wait for their turn");
  auto running = gauge_family("weft_running_jobs", "Calls or jobs at work");
  auto pausing =
      gauge_family("weft_pausing_jobs", "Calls or jobs that wait for the reader of their mesh");
  auto bytes =
      gauge_family("weft_admission_bytes", "Memory that calls or jobs at work were admitted with");
  for (const Queue& queue : queues) {
    const QueueStats stats = queue.stats();
    add_gauge(waiting, queue.name, stats.waiting);
    add_gauge(running, queue.name, stats.running);
    add_gauge(pausing, queue.name, stats.pausing);
    add_gauge(bytes, queue.name, stats.admitted_bytes);
  }
  std::vector<prometheus::MetricFamily> families = registry_.Collect();
  for (auto* family : {&connections, &waiting, &running, &pausing, &bytes})
    families.push_back(std::move(*family));
  for (auto& family : process_metrics()) families.push_back(std::move(family));
  std::ostringstream out;
  prometheus::TextSerializer().Serialize(out, families);
  return std::move(out).str();
}

}  // namespace weft::server
