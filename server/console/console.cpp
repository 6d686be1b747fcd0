// SPDX-License-Identifier: Apache-2.0
#include "server/console/console.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <future>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "server/console/session.h"
#include "server/net/acceptor.h"
#include "server/net/drain_gate.h"
#include "server/net/listen.h"
#include "server/net/peer.h"
#include "server/net/tls_context.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenLooks{10};

}  // namespace

class Console::Listener {
 public:
  Listener(const ConsoleOptions& options, ConsoleParts parts, std::optional<TlsContext> tls)
      : most_connections_(options.connections),
        most_of_host_(connections_of_host(options.connections, parts.client_share)),
        log_(parts.log),
        channel_(std::move(parts.channel)),
        stub_(channel_),
        tls_(std::move(tls)),
        context_{.io = io_,
                 .stub = stub_,
                 .calls = calls_,
                 .authenticator = parts.authenticator,
                 .secret = std::move(parts.secret),
                 .assets = options.assets,
                 .metrics = std::move(parts.metrics),
                 .times = {options.header_timeout, options.idle_timeout, parts.body_timeout},
                 .patience = parts.patience,
                 .most_request_bytes = parts.most_request_bytes,
                 .budget = ByteBudget(parts.request_bytes, parts.client_share)} {
    routes_ = parts.routes(context_);
    context_.routes = routes_.get();
  }
  ~Listener() {
    stop(Clock::now(), Clock::now());
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  // Returns the address, as bound. Call before `start`.
  tl::expected<std::string, std::string> listen(const std::string& address, Door door) {
    auto acceptor = Acceptor::listen(address, io_);
    if (!acceptor) return tl::unexpected(acceptor.error());
    doors_.push_back(std::move(door));
    acceptors_.push_back(std::move(*acceptor));
    return bound_address(address, acceptors_.back()->port());
  }
  void start() {
    auto door = doors_.begin();
    for (const auto& acceptor : acceptors_)
      acceptor->start(
          [this, &through = *door++](tcp::socket socket) { open(std::move(socket), through); });
    thread_ = std::thread([this] { io_.run(); });
  }

  void reload() {
    asio::post(io_, [this] {
      if (tls_) tls_->reload();
    });
  }

  void stop(Clock::time_point end, Clock::time_point exchanges_end) {
    if (!thread_.joinable() || std::exchange(stopped_, true)) return;
    asio::post(io_, [this, end, exchanges_end] {
      for (const auto& acceptor : acceptors_) acceptor->close();
      context_.stopping = true;
      for (Session* const session : std::vector(context_.open.begin(), context_.open.end()))
        session->finish();
      stop_end_ = end;
      exchanges_end_ = exchanges_end;
      wait_for_sessions();
    });
    all_closed_.get_future().wait();
    calls_.wait_empty(std::chrono::hours(1));  // they are cancelled
  }

 private:
  void open(tcp::socket socket, const Door& door) {
    const std::string host = host_of_peer(peer_of(socket));
    const auto is_of_host = [&](const Session* session) { return session->host() == host; };
    const auto of_host = static_cast<std::size_t>(std::ranges::count_if(context_.open, is_of_host));
    if (of_host >= most_of_host_ || context_.open.size() >= most_connections_) {
      const auto longest = std::ranges::find_if(context_.open, [&](const Session* session) {
        return session->idle() && (of_host < most_of_host_ || is_of_host(session));
      });
      if (longest == context_.open.end()) return;
      (*longest)->close();
    }
    make_session(std::move(socket), tls_ ? tls_->current() : nullptr, door, context_)->start();
  }
  void wait_for_sessions() {
    for (Session* const session : std::vector(context_.open.begin(), context_.open.end()))
      if (Clock::now() >= (session->exchanging() ? exchanges_end_ : stop_end_)) session->close();
    if (context_.open.empty()) return all_closed_.set_value();
    timer_.expires_after(kBetweenLooks);
    timer_.async_wait([this](error_code) { wait_for_sessions(); });
  }

  const std::size_t most_connections_;
  const std::size_t most_of_host_;
  const Logger log_;
  const std::shared_ptr<grpc::Channel> channel_;
  BridgeStub stub_;
  std::optional<TlsContext> tls_;
  DrainGate calls_;  // calls that gRPC still has
  bool stopped_ = false;
  Clock::time_point stop_end_;
  Clock::time_point exchanges_end_;
  std::promise<void> all_closed_;  // after `stop`
  std::list<Door> doors_;
  SessionContext context_;  // used by sessions, which end with the io_context at the latest
  asio::io_context io_{1};
  // Keeps the thread running, because calls that were dropped may end there after the last session.
  const asio::executor_work_guard<asio::io_context::executor_type> work_{io_.get_executor()};
  std::unique_ptr<Routes> routes_;
  std::vector<std::unique_ptr<Acceptor>> acceptors_;  // one per door
  asio::steady_timer timer_{io_};
  std::thread thread_;
};

tl::expected<std::unique_ptr<Console>, std::string> Console::start(const ConsoleOptions& options,
                                                                   ConsoleParts parts) {
  const bool encrypts = !parts.tls.certificate.empty();
  std::optional<TlsContext> tls;
  if (encrypts) {
    auto opened = TlsContext::open(parts.tls, TlsProtocol::kHttp1, parts.log);
    if (!opened) return tl::unexpected(opened.error());
    tls = std::move(*opened);
  }
  const bool insecure = parts.insecure;
  auto console = std::unique_ptr<Console>(
      new Console(std::make_unique<Listener>(options, std::move(parts), std::move(tls))));
  const bool shared = options.http == options.address;
  const auto serve = [&](const std::string& address, Door door,
                         const char* what) -> tl::expected<std::string, std::string> {
    if (address.empty()) return "";
    const auto refuse = [&](const std::string& reason) {
      return tl::unexpected(fmt::format("cannot serve {} on {}: {}", what, address, reason));
    };
    const auto where = split_host_port(address);
    if (!where) return refuse("not of the form HOST:PORT");
    if (!encrypts && !insecure && !is_local(address))
      return refuse(
          "other machines can connect there, and it would be unencrypted: give --tls-cert and "
          "--tls-key, or --insecure to do it anyway");
    door.rules = {.tls = encrypts, .host = where->host, .origins = options.origins};
    auto bound = console->listener_->listen(address, std::move(door));
    return bound ? bound : refuse(bound.error());
  };
  const auto pages = serve(options.address, {.console = true}, "the console");
  if (!pages) return tl::unexpected(pages.error());
  const auto files = shared ? pages : serve(options.http, {}, "HTTP");
  if (!files) return tl::unexpected(files.error());
  console->address_ = *pages;
  console->http_address_ = *files;
  console->listener_->start();
  return console;
}

Console::Console(std::unique_ptr<Listener> listener) noexcept : listener_(std::move(listener)) {}

Console::~Console() = default;

void Console::reload() {
  listener_->reload();
}

void Console::stop(Clock::time_point end, Clock::time_point exchanges_end) {
  listener_->stop(end, exchanges_end);
}

}  // namespace weft::server
