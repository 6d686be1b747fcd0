// SPDX-License-Identifier: Apache-2.0
#include "server/front/relay.h"

#include <pthread.h>
#include <sys/socket.h>

#include <boost/asio/post.hpp>
#include <cerrno>
#include <csignal>
#include <exception>
#include <future>
#include <utility>

namespace weft::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Clock = ConnectionRules::Clock;
using Outcome = ClientSocket::Outcome;

// What one connection may move before others have their turn.
constexpr std::size_t kBytesFromClient = std::size_t{32} << 10;
constexpr std::size_t kBytesFromServer = std::size_t{256} << 10;
constexpr int kTurns = 4;
constexpr std::chrono::milliseconds kBetweenLooks{10};
constexpr std::chrono::milliseconds kBetweenRefreshes{100};
// How long gRPC has to hand over the calls of a connection that is closed.
constexpr std::chrono::seconds kLongestEnd{1};

bool would_wait() {
  return errno == EAGAIN || errno == EINTR;
}

}  // namespace

// ---- the lane ----

Lane::Lane() : scratch_(kBytesFromServer) {
  refresh_often();
  thread_ = std::thread([this] {
    sigset_t all;  // OpenSSL's writes may raise SIGPIPE
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    io_.run();
  });
}

Lane::~Lane() {
  finish(Clock::now());
  io_.stop();
  thread_.join();
}

void Lane::finish(Clock::time_point end) {
  const auto is_empty = [&] {
    std::promise<bool> empty;
    asio::post(io_, [&] {
      if (Clock::now() >= end)
        for (Relay* const each : std::vector(relays_.begin(), relays_.end()))
          each->close_to_server();
      empty.set_value(relays_.empty());
    });
    return empty.get_future().get();
  };
  while (!is_empty()) std::this_thread::sleep_for(kBetweenLooks);
}

void Lane::refresh_often() {
  timer_.expires_after(kBetweenRefreshes);
  timer_.async_wait([this](error_code error) {
    if (error) return;
    for (Relay* const each : std::vector(relays_.begin(), relays_.end())) each->refresh();
    refresh_often();
  });
}

// ---- one connection ----

Relay::Relay(Parts parts, const RelayContext& context, Lane& lane)
    : context_(context),
      lane_(lane),
      client_(std::move(parts.client)),
      inner_(lane.io(), asio::local::stream_protocol(), parts.inner),
      connection_(std::move(parts.connection)),
      rules_(context.rules, Clock::now()),
      to_server_(kClientPreface) {}

Relay::~Relay() = default;

std::shared_ptr<Relay> Relay::make(Parts parts, const RelayContext& context, Lane& lane) {
  return std::shared_ptr<Relay>(new Relay(std::move(parts), context, lane));
}

void Relay::start() {
  asio::post(lane_.io(), [self = shared_from_this()] {
    if (self->connection_ == nullptr) return;  // closed meanwhile
    self->client_.move_to(self->lane_.io());
    self->lane_.relays_.insert(self.get());
    self->go_on(&Relay::from_client);
    self->go_on(&Relay::from_server);
  });
}

void Relay::close_for(ConnectionRules::Violation violation) {
  asio::post(lane_.io(), [self = shared_from_this(), violation] { self->violate(violation); });
}

void Relay::from_client() {
  if (is_closed() || !pass_on(std::exchange(to_server_, {}))) return;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::string_view bytes = held_;
    if (!holds_) {
      const auto read = client_.read(lane_.scratch_.data(), kBytesFromClient);
      if (read.outcome == Outcome::kClosed) return close();
      if (read.outcome != Outcome::kDone) return wait_for_client(read.outcome, &Relay::from_client);
      bytes = {lane_.scratch_.data(), read.bytes};
    }
    lane_.passes_.clear();
    const auto received = rules_.received(bytes, lane_.passes_, Clock::now(), [this] {
      return context_.table.take_turn(*connection_);
    });
    holds_ = received.waits;
    held_ = std::string(received.waits ? received.rest : "");
    report();
    if (received.violation) return violate(*received.violation);
    if (!pass_on(lane_.passes_)) return;
    if (holds_)
      return context_.table.wait_for_turn(*connection_, [weak = weak_from_this()] {
        if (const auto self = weak.lock()) self->go_on(&Relay::from_client);
      });
  }
  go_on(&Relay::from_client);
}

bool Relay::pass_on(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent =
        ::send(inner_.native_handle(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (would_wait()) {
      to_server_ = bytes;
      wait(inner_, asio::socket_base::wait_write, &Relay::from_client);
      return false;
    } else {
      // gRPC has closed. What it still said is on its way to the client.
      return false;
    }
  }
  return true;
}

void Relay::from_server() {
  if (connection_ == nullptr || !send_back(std::exchange(to_client_, {}))) return;
  for (int turn = 0; turn < kTurns; ++turn) {
    const ssize_t got =
        ::recv(inner_.native_handle(), lane_.scratch_.data(), kBytesFromServer, MSG_DONTWAIT);
    if (got < 0 && would_wait())
      return wait(inner_, asio::socket_base::wait_read, &Relay::from_server);
    if (got <= 0) return close_to_server();
    const std::string_view bytes(lane_.scratch_.data(), static_cast<std::size_t>(got));
    rules_.sent(bytes);
    report();
    if (!send_back(bytes)) return;
  }
  go_on(&Relay::from_server);
}

bool Relay::send_back(std::string_view bytes) {
  while (!bytes.empty() && !is_closed()) {
    const auto sent = client_.write(bytes.data(), bytes.size());
    if (sent.outcome == Outcome::kClosed) {
      close();
      return true;
    }
    bytes.remove_prefix(sent.bytes);
    if (sent.outcome == Outcome::kDone) continue;
    to_client_ = bytes;
    wait_for_client(sent.outcome, &Relay::from_server);
    return false;
  }
  return true;
}

template <class Socket>
void Relay::wait(Socket& socket, asio::socket_base::wait_type what, Step then) {
  socket.async_wait(what, [self = shared_from_this(), then](error_code error) {
    if (!error) (self.get()->*then)();
  });
}

void Relay::wait_for_client(Outcome outcome, Step then) {
  wait(client_.socket(),
       outcome == Outcome::kReads ? asio::socket_base::wait_read : asio::socket_base::wait_write,
       then);
}

void Relay::go_on(Step step) {
  asio::post(lane_.io(), [self = shared_from_this(), step] { (self.get()->*step)(); });
}

void Relay::violate(const ConnectionRules::Violation& violation) {
  if (is_closed()) return;
  context_.closed(connection_->peer(), violation);
  if (to_client_.empty() && rules_.sent_whole_frames()) {
    const std::string last = calm_down(violation.cause);
    (void)client_.write(last.data(), last.size());
  }
  close();
}

void Relay::close() {
  if (is_closed()) return;
  closed_ = Clock::now();
  context_.table.retire(*connection_);
  to_server_ = {};
  to_client_ = {};
  held_ = {};
  client_.close();
  if (!context_.table.has_turns(*connection_)) return close_to_server();
  go_on(&Relay::from_server);  // which may have waited for the client
}

void Relay::close_to_server() {
  if (connection_ == nullptr) return;
  close();  // if it has not been
  if (connection_ == nullptr) return;
  lane_.relays_.erase(this);
  connection_.reset();
  error_code ignored;
  inner_.close(ignored);
}

void Relay::refresh() {
  rules_.pass_time(Clock::now());
  report();
  if (closed_ == Clock::time_point()) return;
  if (Clock::now() - closed_ > kLongestEnd || !context_.table.has_turns(*connection_))
    close_to_server();
}

void Relay::report() {
  const bool counts = !is_closed();
  context_.table.set_load(*connection_, {.open = counts ? rules_.open_streams() : 0,
                                         .resets = counts ? rules_.resets() : 0,
                                         .answered = rules_.answered()});
}

}  // namespace weft::server
