// SPDX-License-Identifier: Apache-2.0
#include "server/net/acceptor.h"

#include <boost/asio/ip/v6_only.hpp>
#include <chrono>
#include <exception>
#include <utility>

#include "server/net/listen.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

constexpr std::chrono::milliseconds kBreather{100};

tl::expected<tcp::acceptor, error_code> listen_on(const tcp::endpoint& where,
                                                  asio::io_context& io) {
  tcp::acceptor acceptor(io);
  error_code error;
  const bool any = where.address().is_unspecified();
  acceptor.open(where.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && where.protocol() == tcp::v6()) acceptor.set_option(asio::ip::v6_only(!any), error);
  if (!error) acceptor.bind(where, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) return tl::unexpected(error);
  return acceptor;
}

tl::expected<std::vector<tcp::acceptor>, std::string> listen_at(const std::string& address,
                                                                asio::io_context& io) {
  const auto where = split_host_port(address);
  if (!where) return tl::unexpected(std::string("not of the form HOST:PORT"));
  error_code error;
  const auto found = tcp::resolver(io).resolve(
      where->host, where->port, tcp::resolver::passive | tcp::resolver::numeric_service, error);
  if (error) return tl::unexpected(error.message());
  std::vector<tcp::acceptor> acceptors;
  error = asio::error::address_family_not_supported;
  for (const auto& each : found) {
    tcp::endpoint endpoint = each.endpoint();
    if (!acceptors.empty()) endpoint.port(acceptors.front().local_endpoint().port());
    auto acceptor = tl::expected<tcp::acceptor, error_code>(tl::unexpected(error));
    if (endpoint.address() == asio::ip::address_v4::any())
      acceptor = listen_on({asio::ip::address_v6::any(), endpoint.port()}, io);
    if (!acceptor) acceptor = listen_on(endpoint, io);
    if (acceptor)
      acceptors.push_back(std::move(*acceptor));
    else
      error = acceptor.error();
  }
  if (acceptors.empty()) return tl::unexpected(error.message());
  return acceptors;
}

}  // namespace

tl::expected<std::unique_ptr<Acceptor>, std::string> Acceptor::listen(const std::string& address,
                                                                      asio::io_context& io) {
  auto sockets = listen_at(address, io);
  if (!sockets) return tl::unexpected(sockets.error());
  return std::unique_ptr<Acceptor>(new Acceptor(std::move(*sockets), io));
}

Acceptor::Acceptor(std::vector<tcp::acceptor> sockets, asio::io_context& io)
    : port_(sockets.front().local_endpoint().port()) {
  for (tcp::acceptor& each : sockets) sockets_.push_back({std::move(each), asio::steady_timer(io)});
}

void Acceptor::start(Welcome welcome, Exhausted exhausted) {
  welcome_ = std::move(welcome);
  exhausted_ = std::move(exhausted);
  for (Socket& each : sockets_) accept(each);
}

void Acceptor::close() {
  closed_ = true;
  for (Socket& each : sockets_) {
    error_code ignored;
    each.listening.close(ignored);
    each.breather.cancel();
  }
}

void Acceptor::accept(Socket& socket) {
  socket.listening.async_accept([this, &socket](error_code error, tcp::socket connection) {
    if (closed_) return;
    if (error) return rest(socket);
    try {
      welcome_(std::move(connection));
    } catch (const std::exception&) {
      // Out of memory: the connection is closed.
    }
    accept(socket);
  });
}

// Trying again at once would keep a processor busy.
void Acceptor::rest(Socket& socket) {
  exhausted_(socket.listening);
  socket.breather.expires_after(kBreather);
  socket.breather.async_wait([this, &socket](error_code) {
    if (!closed_) accept(socket);
  });
}

}  // namespace weft::server
