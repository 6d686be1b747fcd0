// SPDX-License-Identifier: Apache-2.0
// Addresses to listen on: HOST:PORT (an IPv6 host in brackets, port 0 for any free one) or
// unix:PATH.
//
// gRPC does not say why it could not bind. `claim` checks beforehand, and says why.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace weft::server {

// Succeeds if a server may bind the address now; the error says why it may not. Removes a socket
// file on which no server listens; any other file is left alone.
tl::expected<void, std::string> claim(const std::string& address);

bool is_unix(std::string_view address);

struct HostPort {
  std::string host;  // without brackets
  std::string port;  // a number
};
std::optional<HostPort> split_host_port(const std::string& address);

// Whether traffic to the address stays on this machine: a unix: address, or a host that has only
// loopback addresses. False if the host is not found.
bool is_local(const std::string& address);

// The address with its port filled in.
std::string bound_address(const std::string& address, int port);

// Removes the socket file of a unix: address; does nothing for others.
void release(const std::string& address);

}  // namespace weft::server
