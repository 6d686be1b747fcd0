// SPDX-License-Identifier: Apache-2.0
#include "server/observe/metrics_endpoint.h"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
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

#include "server/net/listen.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

constexpr std::chrono::milliseconds kBreather{100};
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

  error_code listen(const tcp::endpoint& where) {
    error_code error;
    acceptor_.open(where.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(where, error);
    if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
    if (error) return error;
    port_ = acceptor_.local_endpoint(error).port();
    accept();
    thread_ = std::thread([this] { context_.run(); });
    return error;
  }
  int port() const { return port_; }

 private:
  void accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
      if (error) return rest();
      // An honest client was answered long ago.
      if (open_.size() >= static_cast<std::size_t>(limits_.connections)) {
        open_.front()->close();
        open_.splice(open_.end(), open_, open_.begin());  // not closed again while it ends
      }
      std::make_shared<Connection>(std::move(socket), pages_, limits_.patience, open_)->start();
      accept();
    });
  }
  // If descriptors have run out, trying again at once would keep a processor busy.
  void rest() {
    timer_.expires_after(kBreather);
    timer_.async_wait([this](error_code) { accept(); });
  }

  const MetricsPages pages_;
  const EndpointLimits limits_;
  // The one that is open longest comes first. Used by the thread only, and at last when the context
  // is destroyed.
  std::list<Connection*> open_;
  int port_ = 0;
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::steady_timer timer_{context_};
  std::thread thread_;
};

tl::expected<std::unique_ptr<MetricsEndpoint>, std::string> MetricsEndpoint::start(
    const std::string& address, MetricsPages pages, EndpointLimits limits) {
  const auto refuse = [&address](const std::string& reason) {
    return tl::unexpected(fmt::format("cannot show metrics on {}: {}", address, reason));
  };
  const auto where = split_host_port(address);
  if (!where) return refuse("not of the form HOST:PORT");
  asio::io_context lookup;
  error_code error;
  const auto found = tcp::resolver(lookup).resolve(
      where->host, where->port, tcp::resolver::passive | tcp::resolver::numeric_service, error);
  if (error || found.empty()) return refuse(error.message());
  auto listener = std::make_unique<Listener>(std::move(pages), limits);
  if (error = listener->listen(found.begin()->endpoint()); error) return refuse(error.message());
  std::string bound = bound_address(address, listener->port());
  return std::unique_ptr<MetricsEndpoint>(
      new MetricsEndpoint(std::move(listener), std::move(bound)));
}

MetricsEndpoint::MetricsEndpoint(std::unique_ptr<Listener> listener, std::string address)
    : listener_(std::move(listener)), address_(std::move(address)) {}

MetricsEndpoint::~MetricsEndpoint() = default;

}  // namespace weft::server
