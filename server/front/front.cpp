// SPDX-License-Identifier: Apache-2.0
#include "server/front/front.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <exception>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "server/front/arrival.h"
#include "server/front/relay.h"
#include "server/net/acceptor.h"
#include "server/net/peer.h"
#include "server/net/tls_context.h"
#include "server/observe/bounded_log.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{20};  // for the handshake and the preface
constexpr std::chrono::milliseconds kTick{100};
constexpr std::uint64_t kLinesPerSecond = 20;
// What a client sends waits in the relay rather than in the pair of sockets: a connection that is
// closed for its frames leaves few of them to gRPC.
constexpr int kInnerBytes = 32 << 10;

// A descriptor that is given up when there are no others.
class Spare {
 public:
  Spare() { take(); }
  ~Spare() { give_up(); }
  Spare(const Spare&) = delete;
  Spare& operator=(const Spare&) = delete;
  void take() {
    if (descriptor_ < 0) descriptor_ = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  }
  void give_up() {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  }

 private:
  int descriptor_ = -1;
};

// The relay's end, which has this name, and gRPC's; nullopt if there are no descriptors.
std::optional<std::array<int, 2>> named_pair(const std::string& name) {
  std::array<int, 2> ends;
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    return std::nullopt;
  sockaddr_un own{};
  own.sun_family = AF_UNIX;
  name.copy(own.sun_path + 1, sizeof own.sun_path - 1);  // after a 0: an abstract name
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  ::setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &kInnerBytes, sizeof kInnerBytes);
  if (::bind(ends[0], reinterpret_cast<const sockaddr*>(&own), length) == 0) return ends;
  for (const int end : ends) ::close(end);
  return std::nullopt;
}

}  // namespace

class Front::Door {
 public:
  Door(const FrontOptions& options, ConnectionTable& table, Logger log, OnClosed on_closed)
      : table_(table),
        on_closed_(std::move(on_closed)),
        log_(std::move(log)),
        closings_(log_, "connection_closed", kLinesPerSecond),
        context_{
            .table = table,
            .rules = {.max_resets = options.max_resets},
            .closed = [this](const std::string& peer, const ConnectionRules::Violation& violation) {
              closed(peer, violation);
            }} {
    for (unsigned i = 0; i < options.lanes; ++i) lanes_.push_back(std::make_unique<Lane>());
  }
  ~Door() {
    stop_accepting();
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  tl::expected<void, std::string> listen(const FrontOptions& options) {
    if (!options.tls.certificate.empty()) {
      auto tls = TlsContext::open(options.tls, TlsProtocol::kHttp2, log_);
      if (!tls) return tl::unexpected(tls.error());
      tls_ = std::move(*tls);
    }
    for (const std::string& address : options.listen) {
      auto acceptor = Acceptor::listen(address, io_);
      if (!acceptor)
        return tl::unexpected(fmt::format("cannot listen on {}: {}", address, acceptor.error()));
      ports_.push_back((*acceptor)->port());
      acceptors_.push_back(std::move(*acceptor));
    }
    return {};
  }
  const std::vector<int>& ports() const { return ports_; }

  void start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc) {
    grpc_ = std::move(grpc);
    for (const auto& each : acceptors_)
      each->start([this](tcp::socket socket) { welcome(std::move(socket)); },
                  [this](tcp::acceptor& listening) { refuse_next(listening); });
    tick();
    thread_ = std::thread([this] {
      sigset_t all;  // OpenSSL's writes may raise SIGPIPE
      sigfillset(&all);
      pthread_sigmask(SIG_BLOCK, &all, nullptr);
      io_.run();
    });
  }

  void reload() {
    asio::post(io_, [this] {
      if (tls_) tls_->reload();
    });
  }

  void stop_accepting() {
    if (!thread_.joinable() || stopped_.exchange(true)) return;
    std::promise<void> done;
    asio::post(io_, [&] {
      for (const auto& each : acceptors_) each->close();
      timer_.cancel();
      for (const auto& each : Arrival::List(arrivals_)) each->close();
      done.set_value();
    });
    done.get_future().wait();
  }

  void finish(Clock::time_point end) {
    for (const auto& lane : lanes_) lane->finish(end);
  }

 private:
  // Whoever waits is told by the end of the connection that descriptors have run out.
  void refuse_next(tcp::acceptor& listening) {
    spare_.give_up();
    error_code error;
    listening.non_blocking(true, error);
    { const tcp::socket refused = listening.accept(error); }
    spare_.take();
    if (!error) closed("unknown", {"descriptors", 0});
  }

  void welcome(tcp::socket socket) {
    std::string peer = peer_of(socket);
    const auto arrival = std::make_shared<Arrival>(
        ClientSocket(std::move(socket), tls_ ? tls_->current() : nullptr), arrivals_, ready_);
    auto connection =
        table_.enter(peer, [this, peer, weak = std::weak_ptr(arrival)](const char* cause) {
          closed(peer, {cause, 0});
          asio::post(io_, [weak] {
            if (const auto arrival = weak.lock()) arrival->close();
          });
        });
    if (connection == nullptr) return closed(peer, {kCauseConnections, 0});
    arrival->start(std::move(connection));
  }

  void hand_over(ClientSocket client, std::shared_ptr<ConnectionTable::Connection> connection) {
    const std::string name = table_.next_name();
    const auto ends = named_pair(name);
    if (!ends) return closed(connection->peer(), {"descriptors", 0});
    std::string certificate_name = client.certificate_name();
    const auto relay = Relay::make({std::move(client), (*ends)[0], connection}, context_,
                                   *lanes_[next_lane_++ % lanes_.size()]);
    const bool stays =
        table_.hand_over(connection, {.name = name,
                                      .certificate_name = std::move(certificate_name),
                                      .close = [weak = std::weak_ptr(relay)](const char* cause) {
                                        if (const auto open = weak.lock())
                                          open->close_for({cause, 0});
                                      }});
    if (!stays) return (void)::close((*ends)[1]);
    grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
    parameters.fd = (*ends)[1];
    grpc_->HandleNewConnection(&parameters);
    relay->start();
  }

  void closed(const std::string& peer, const ConnectionRules::Violation& violation) {
    closed_some_ = true;
    on_closed_(violation.cause);
    if (closings_.allow())
      log_->warn("event=connection_closed peer={} cause={} most={}", log_value(peer),
                 violation.cause, violation.most);
  }

  void tick() {
    timer_.expires_after(kTick);
    timer_.async_wait([this](error_code error) {
      if (error) return;
      while (!arrivals_.empty() && Clock::now() - arrivals_.front()->since() > kPatience)
        std::shared_ptr(arrivals_.front())->close();
      closings_.flush_suppressed();
      table_.pass_time(Clock::now());
      if (closed_some_.exchange(false)) malloc_trim(0);  // thousands of calls lie scattered in it
      tick();
    });
  }

  asio::io_context io_{1};  // outlives sockets that lanes have not taken yet
  std::vector<std::unique_ptr<Lane>> lanes_;
  ConnectionTable& table_;
  const OnClosed on_closed_;
  const Logger log_;
  BoundedLog closings_;
  const RelayContext context_;
  std::atomic<bool> closed_some_{false};  // since the last tick
  std::optional<TlsContext> tls_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc_;
  std::vector<int> ports_;
  Spare spare_;
  Arrival::List arrivals_;
  const Arrival::Ready ready_ = [this](ClientSocket client,
                                       std::shared_ptr<ConnectionTable::Connection> connection) {
    hand_over(std::move(client), std::move(connection));
  };
  std::atomic<bool> stopped_{false};
  std::size_t next_lane_ = 0;
  std::vector<std::unique_ptr<Acceptor>> acceptors_;
  asio::steady_timer timer_{io_};
  std::thread thread_;
};

tl::expected<std::unique_ptr<Front>, std::string> Front::open(const FrontOptions& options,
                                                              ConnectionTable& table, Logger log,
                                                              OnClosed on_closed) {
  auto door = std::make_unique<Door>(options, table, std::move(log), std::move(on_closed));
  if (auto listening = door->listen(options); !listening) return tl::unexpected(listening.error());
  return std::unique_ptr<Front>(new Front(std::move(door)));
}

Front::Front(std::unique_ptr<Door> door) : door_(std::move(door)) {}

Front::~Front() = default;

const std::vector<int>& Front::ports() const {
  return door_->ports();
}

void Front::start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> grpc) {
  door_->start(std::move(grpc));
}

void Front::reload() {
  door_->reload();
}

void Front::stop_accepting() {
  door_->stop_accepting();
}

void Front::finish(Clock::time_point end) {
  door_->finish(end);
}

}  // namespace weft::server
