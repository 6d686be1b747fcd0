// SPDX-License-Identifier: Apache-2.0
// Who is at the other end of a browser's connection, spelled as gRPC spells it.
#pragma once

#include <openssl/ssl.h>

#include <boost/asio/ip/tcp.hpp>
#include <string>

namespace weft::server {

// "ipv4:127.0.0.1:4711", "ipv6:%5B::1%5D:4711"; "unknown" if the connection is gone.
std::string peer_of(const boost::asio::ip::tcp::socket& socket);

// The subject's common name, otherwise its first alternative name of a host; empty if there is no
// certificate, or if it was not verified.
std::string name_in_certificate(SSL* connection);

}  // namespace weft::server
