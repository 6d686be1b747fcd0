// SPDX-License-Identifier: Apache-2.0
#include "server/front/probe.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <pthread.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <csignal>
#include <memory>
#include <optional>
#include <utility>

#include "server/front/frames.h"
#include "server/net/listen.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using milliseconds = std::chrono::milliseconds;

// What a client says first: its preface, and settings without a value.
std::string greeting() {
  return std::string(kClientPreface) + std::string("\0\0\0\4\0\0\0\0\0", 9);
}

// Blocks for no longer than this.
void be_patient(int socket, milliseconds patience) {
  const timeval time{.tv_sec = patience.count() / 1000, .tv_usec = patience.count() % 1000 * 1000};
  for (const int each : {SO_RCVTIMEO, SO_SNDTIMEO})
    ::setsockopt(socket, SOL_SOCKET, each, &time, sizeof time);
}

// A byte, or the end.
bool hears(int socket) {
  const std::string words = greeting();
  if (::send(socket, words.data(), words.size(), MSG_NOSIGNAL) < 0) return errno != EAGAIN;
  char byte = 0;
  return ::recv(socket, &byte, 1, 0) >= 0 || errno == ECONNRESET;
}

// Any answer to the begin of a handshake: a server may want a certificate that nobody has here.
bool hears_encrypted(int socket) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()),
                                                                  &SSL_CTX_free);
  const std::unique_ptr<SSL, decltype(&SSL_free)> ssl(SSL_new(context.get()), &SSL_free);
  if (ssl == nullptr) return true;  // no memory: that is not the address's fault
  SSL_set_fd(ssl.get(), socket);
  ERR_clear_error();
  (void)SSL_connect(ssl.get());
  return BIO_number_read(SSL_get_rbio(ssl.get())) > 0 || !BIO_should_retry(SSL_get_rbio(ssl.get()));
}

template <class Socket, class Endpoint>
bool ask(const Endpoint& where, bool encrypted, milliseconds patience) {
  asio::io_context io;
  Socket socket(io);
  error_code error;
  socket.open(where.protocol(), error);
  if (error) return true;  // no descriptor, or a family that this machine has not: not its fault
  be_patient(socket.native_handle(), patience);
  socket.connect(where, error);
  if (error) return false;
  return encrypted ? hears_encrypted(socket.native_handle()) : hears(socket.native_handle());
}

}  // namespace

bool answers(const std::string& address, bool encrypted, milliseconds patience) {
  using Local = asio::local::stream_protocol;
  if (is_unix(address))
    return ask<Local::socket>(Local::endpoint(address.substr(address.find(':') + 1)), false,
                              patience);
  const auto where = split_host_port(address);
  if (!where) return false;
  asio::io_context io;
  error_code error;
  const auto found =
      tcp::resolver(io).resolve(where->host, where->port, tcp::resolver::numeric_service, error);
  if (error || found.empty()) return true;  // the name server's fault
  tcp::endpoint endpoint = found.begin()->endpoint();
  if (endpoint.address().is_unspecified())
    endpoint.address(endpoint.address().is_v4()
                         ? asio::ip::address(asio::ip::address_v4::loopback())
                         : asio::ip::address_v6::loopback());
  return ask<tcp::socket>(endpoint, encrypted, patience);
}

Probe::Probe(ProbeOptions options, Logger log)
    : options_(std::move(options)),
      log_(std::move(log)),
      failures_(options_.addresses.size()),
      thread_([this] {
        sigset_t all;  // OpenSSL's writes may raise SIGPIPE
        sigfillset(&all);
        pthread_sigmask(SIG_BLOCK, &all, nullptr);
        ask_until_stopped();
      }) {}

void Probe::stop() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Probe::ask_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, options_.interval, [this] { return stopping_; })) {
    lock.unlock();
    ask_all();
    lock.lock();
  }
}

void Probe::ask_all() {
  for (std::size_t i = 0; i < failures_.size(); ++i) {
    const std::string& address = options_.addresses[i];
    if (answers(address, options_.encrypted, options_.patience)) {
      if (std::exchange(failures_[i], 0) < kSilentAfter) continue;
      --silent_;
      log_->info("event=address_answers address={}", log_value(address));
      continue;
    }
    const int failures = ++failures_[i];
    if (failures == kSilentAfter) {
      ++silent_;
      log_->error("event=address_silent address={} failures={}", log_value(address), failures);
    }
    if (failures < kLostAfter || std::exchange(lost_, true)) continue;
    log_->error("event=address_lost address={} failures={}", log_value(address), failures);
    options_.lost(address);
  }
}

}  // namespace weft::server
