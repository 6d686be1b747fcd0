// SPDX-License-Identifier: Apache-2.0
// What an address of a server says about the way to it. No name is looked up.
#pragma once

#include <string>

namespace weft::client {

// Whether what is sent there stays on this machine: a unix socket, a loopback address, localhost.
bool is_local(const std::string& address);

// The proxy through which gRPC reaches the address, and the variable of the environment that names
// it, as in "the proxy gate:3128, which http_proxy names"; without the user and the password that
// it may hold. Empty if there is none, as for all local addresses.
std::string proxy_of(const std::string& address);

}  // namespace weft::client
