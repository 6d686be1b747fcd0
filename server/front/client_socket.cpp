// SPDX-License-Identifier: Apache-2.0
#include "server/front/client_socket.h"

#include <openssl/err.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <new>
#include <utility>

#include "server/net/peer.h"

namespace weft::server {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

constexpr std::size_t kDiscard = std::size_t{16} << 20;

int as_int(std::size_t bytes) {
  return static_cast<int>(std::min<std::size_t>(bytes, std::numeric_limits<int>::max()));
}

}  // namespace

ClientSocket::ClientSocket(tcp::socket socket, std::shared_ptr<ssl::context> tls)
    : socket_(std::move(socket)), context_(std::move(tls)) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  if (context_ == nullptr) return;
  ssl_.reset(SSL_new(context_->native_handle()));
  if (ssl_ == nullptr || SSL_set_fd(ssl_.get(), socket_.native_handle()) != 1)
    throw std::bad_alloc();
  SSL_set_accept_state(ssl_.get());
  SSL_set_mode(ssl_.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER |
                               SSL_MODE_RELEASE_BUFFERS);
}

ClientSocket::Outcome ClientSocket::handshake() {
  if (ssl_ == nullptr) return Outcome::kDone;
  ERR_clear_error();
  return outcome_of(SSL_do_handshake(ssl_.get())).outcome;
}

ClientSocket::Moved ClientSocket::read(char* to, std::size_t most) {
  if (ssl_ != nullptr) {
    ERR_clear_error();
    return outcome_of(SSL_read(ssl_.get(), to, as_int(most)));
  }
  const ssize_t got = ::recv(socket_.native_handle(), to, most, MSG_DONTWAIT);
  if (got > 0) return {Outcome::kDone, static_cast<std::size_t>(got)};
  const bool later = got < 0 && (errno == EAGAIN || errno == EINTR);
  return {later ? Outcome::kReads : Outcome::kClosed};
}

ClientSocket::Moved ClientSocket::write(const char* bytes, std::size_t count) {
  if (ssl_ != nullptr) {
    ERR_clear_error();
    return outcome_of(SSL_write(ssl_.get(), bytes, as_int(count)));
  }
  const ssize_t sent = ::send(socket_.native_handle(), bytes, count, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent > 0) return {Outcome::kDone, static_cast<std::size_t>(sent)};
  const bool later = sent < 0 && (errno == EAGAIN || errno == EINTR);
  return {later ? Outcome::kWrites : Outcome::kClosed};
}

std::string ClientSocket::certificate_name() const {
  return ssl_ == nullptr ? "" : name_in_certificate(ssl_.get());
}

void ClientSocket::move_to(boost::asio::io_context& io) {
  error_code error;
  const tcp protocol = socket_.local_endpoint(error).protocol();
  const int descriptor = socket_.release(error);
  if (error) return;
  tcp::socket moved(io);
  moved.assign(protocol, descriptor, error);
  socket_ = std::move(moved);
}

void ClientSocket::close() {
  if (ssl_ != nullptr && SSL_is_init_finished(ssl_.get()) == 1) {
    ERR_clear_error();
    (void)SSL_shutdown(ssl_.get());
  }
  error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_both, ignored);
  // What has arrived and is not read would reset the connection, and what was written be lost.
  (void)::recv(socket_.native_handle(), nullptr, kDiscard, MSG_TRUNC | MSG_DONTWAIT);
  socket_.close(ignored);
}

ClientSocket::Moved ClientSocket::outcome_of(int result) {
  if (result > 0) return {Outcome::kDone, static_cast<std::size_t>(result)};
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return {Outcome::kReads};
    case SSL_ERROR_WANT_WRITE:
      return {Outcome::kWrites};
    default:
      return {Outcome::kClosed};
  }
}

}  // namespace weft::server
