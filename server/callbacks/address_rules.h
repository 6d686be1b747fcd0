// SPDX-License-Identifier: Apache-2.0
// Which addresses callbacks may go to: those of the public internet, and those of networks that the
// operator allows. A client chooses the URL, so an address that only this machine or its network
// reaches would let strangers make the server call what they cannot.
//
//   AddressRules rules;
//   rules.may_reach(make_address("127.0.0.1"));    // false; as are 10.1.2.3, 169.254.169.254, ::1,
//                                                  // ::ffff:127.0.0.1, 64:ff9b::7f00:1, fe80::1,
//                                                  ...
//   rules.allow(*Network::parse("10.20.0.0/16"));
//   rules.may_reach(make_address("10.20.0.7"));    // true
//
// Sources: the special-purpose registries of IANA for IPv4 and IPv6 (RFC 6890 and later).
#pragma once

#include <array>
#include <boost/asio/ip/address.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weft::server {

// IPv4 as IPv6 maps it, ::ffff:a.b.c.d.
using AddressBytes = std::array<unsigned char, 16>;

// A network by its CIDR.
struct Network {
  AddressBytes bytes{};
  int bits = 0;  // of the prefix, from 0 to 128

  // "10.0.0.0/8" or "fd00::/8".
  static std::optional<Network> parse(const std::string& cidr);
  // No network of IPv6 has addresses of IPv4.
  bool has(const AddressBytes& address) const;
};

class AddressRules {
 public:
  void allow(const Network& network) { allowed_.push_back(network); }
  bool may_reach(const boost::asio::ip::address& address) const;

 private:
  std::vector<Network> allowed_;
};

}  // namespace weft::server
