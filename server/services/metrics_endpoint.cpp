// SPDX-License-Identifier: Apache-2.0
#include "server/services/metrics_endpoint.h"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <cstddef>
#include <exception>
#include <list>
#include <thread>
#include <utility>

#include "server/net/acceptor.h"
#include "server/net/beast.h"
#include "server/net/listen.h"

namespace weft::server {
namespace {

constexpr std::uint32_t kMaxRequestBytes = 8192;

using Response = http::response<http::string_body>;

Response answer(const MetricsPages& pages, http::verb method, beast::string_view target) {
  Response response;
  response.version(11);
  response.keep_alive(false);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  if (method != http::verb::get && method != http::verb::head) {
    response.result(http::status::method_not_allowed);
    response.set(http::field::allow, "GET, HEAD");
  } else if (target == "/metrics") {
    response.set(http::field::content_type, "text/plain; version=0.0.4; charset=utf-8");
    response.body() = pages.metrics();
  } else if (target == "/healthz") {
    const bool healthy = pages.healthy();
    if (!healthy) response.result(http::status::service_unavailable);
    response.body() = healthy ? "serving\n" : "not serving\n";
  } else {
    response.result(http::status::not_found);
    response.body() = "there are /metrics and /healthz\n";
  }
  response.prepare_payload();
  if (method == http::verb::head) response.body().clear();  // its headers stay
  return response;
}

// One connection. It lives as long as an operation is pending, and counts as open until it ends.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, const MetricsPages& pages, std::chrono::milliseconds patience,
             std::list<Connection*>& open)
      : stream_(std::move(socket)),
        pages_(pages),
        patience_(patience),
        open_(open),
        place_(open.insert(open.end(), this)) {
    parser_.header_limit(kMaxRequestBytes);
    parser_.body_limit(0);
  }
  ~Connection() { open_.erase(place_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start() {
    stream_.expires_after(patience_);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->respond();
                     });
  }

  // The connection ends once its pending operations have reported that.
  void close() { stream_.close(); }

 private:
  void respond() {
    try {
      response_ = answer(pages_, parser_.get().method(), parser_.get().target());
    } catch (const std::exception&) {
      return;  // out of memory: closes the connection
    }
    stream_.expires_after(patience_);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (!error)
                          self->stream_.socket().shutdown(tcp::socket::shutdown_both, error);
                      });
  }

  beast::tcp_stream stream_;
  const MetricsPages& pages_;
  const std::chrono::milliseconds patience_;
  std::list<Connection*>& open_;  // used by the thread of the endpoint only
  const std::list<Connection*>::iterator place_;
  beast::flat_buffer buffer_{kMaxRequestBytes};
  http::request_parser<http::empty_body> parser_;
  Response response_;
};

}  // namespace

class MetricsEndpoint::Listener {
 public:
  Listener(MetricsPages pages, const EndpointLimits& limits)
      : pages_(std::move(pages)), limits_(limits) {}
  ~Listener() {
    context_.stop();
    if (thread_.joinable()) thread_.join();
  }

  // The port.
  tl::expected<int, std::string> listen(const std::string& address) {
    auto acceptor = Acceptor::listen(address, context_);
    if (!acceptor) return tl::unexpected(acceptor.error());
    acceptor_ = std::move(*acceptor);
    acceptor_->start([this](tcp::socket socket) { open(std::move(socket)); });
    thread_ = std::thread([this] { context_.run(); });
    return acceptor_->port();
  }

 private:
  void open(tcp::socket socket) {
    // An honest client was answered long ago.
    if (open_.size() >= static_cast<std::size_t>(limits_.connections)) {
      open_.front()->close();
      open_.splice(open_.end(), open_, open_.begin());  // not closed again while it ends
    }
    std::make_shared<Connection>(std::move(socket), pages_, limits_.patience, open_)->start();
  }

  const MetricsPages pages_;
  const EndpointLimits limits_;
  // The one that is open longest comes first. Used by the thread only, and at last when the context
  // is destroyed.
  std::list<Connection*> open_;
  asio::io_context context_{1};
  std::unique_ptr<Acceptor> acceptor_;
  std::thread thread_;
};

tl::expected<std::unique_ptr<MetricsEndpoint>, std::string> MetricsEndpoint::start(
    const std::string& address, MetricsPages pages, EndpointLimits limits) {
  auto listener = std::make_unique<Listener>(std::move(pages), limits);
  const auto port = listener->listen(address);
  if (!port)
    return tl::unexpected(fmt::format("cannot show metrics on {}: {}", address, port.error()));
  return std::unique_ptr<MetricsEndpoint>(
      new MetricsEndpoint(std::move(listener), bound_address(address, *port)));
}

MetricsEndpoint::MetricsEndpoint(std::unique_ptr<Listener> listener, std::string address)
    : listener_(std::move(listener)), address_(std::move(address)) {}

MetricsEndpoint::~MetricsEndpoint() = default;

}  // namespace weft::server
