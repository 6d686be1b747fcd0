// SPDX-License-Identifier: Apache-2.0
// A small web server for monitoring: GET /metrics for Prometheus, GET /healthz for load balancers
// (200 while the server accepts calls, 503 while it drains or one of its addresses is silent).
//
// It has one thread, and serves one request per connection. A connection is closed if its request
// is not complete within the time limit or has more than 8 KiB, or if its reply is not read in
// time. A connection beyond the limit, which is at least 1, closes the one that has been open
// longest.
//
//   auto endpoint = MetricsEndpoint::start("127.0.0.1:0", {.metrics = ..., .healthy = ...});
//   if (!endpoint) return complain(endpoint.error());
//   ... (*endpoint)->address() ...
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <tl/expected.hpp>

namespace weft::server {

struct MetricsPages {
  std::function<std::string()> metrics;
  std::function<bool()> healthy;
};

struct EndpointLimits {
  std::chrono::milliseconds patience = std::chrono::seconds(10);
  int connections = 64;
};

class MetricsEndpoint {
 public:
  // `address` is HOST:PORT, with port 0 for any free port. Both pages are made by callbacks on a
  // thread of the endpoint until it is destroyed. The error names the address.
  static tl::expected<std::unique_ptr<MetricsEndpoint>, std::string> start(
      const std::string& address, MetricsPages pages, EndpointLimits limits = {});
  ~MetricsEndpoint();

  // The bound address.
  const std::string& address() const { return address_; }

 private:
  class Listener;
  explicit MetricsEndpoint(std::unique_ptr<Listener> listener, std::string address);

  std::unique_ptr<Listener> listener_;
  std::string address_;
};

}  // namespace weft::server
