// SPDX-License-Identifier: Apache-2.0
#include "server/front/listeners.h"

#include <algorithm>
#include <boost/asio/ip/v6_only.hpp>
#include <utility>

#include "server/net/listen.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

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

}  // namespace

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

}  // namespace weft::server
