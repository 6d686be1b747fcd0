// SPDX-License-Identifier: Apache-2.0
// A small web server for those who watch: GET /metrics for Prometheus, GET /healthz for whoever
// sends calls here (200 while the server takes them, 503 while it drains).
//
// One thread, one request to a connection. A request that is not there when patience ends, or has
// more than 8 KiB, ends its connection, and so does an answer that is not read by then. A
// connection beyond the limit, which is at least 1, closes the one that has been open longest.
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
  // `address` is HOST:PORT, port 0 for any that is free. Both pages are called on a thread of the
  // endpoint's until it is destroyed. The error names the address.
  static tl::expected<std::unique_ptr<MetricsEndpoint>, std::string> start(
      const std::string& address, MetricsPages pages, EndpointLimits limits = {});
  ~MetricsEndpoint();

  // As bound.
  const std::string& address() const { return address_; }

 private:
  class Listener;
  explicit MetricsEndpoint(std::unique_ptr<Listener> listener, std::string address);

  std::unique_ptr<Listener> listener_;
  std::string address_;
};

}  // namespace weft::server
