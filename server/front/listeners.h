// SPDX-License-Identifier: Apache-2.0
// TCP sockets that listen at an address.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace weft::server {

// One for each address of the host, all with one port: HOST:PORT, where port 0 is any free one.
// Listens for IPv6, too, if the host is 0.0.0.0. No other process may listen at the same port. The
// error says what is wrong with the address.
tl::expected<std::vector<boost::asio::ip::tcp::acceptor>, std::string> listen_at(
    const std::string& address, boost::asio::io_context& io);

}  // namespace weft::server
