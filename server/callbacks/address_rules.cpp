// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/address_rules.h"

#include <algorithm>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>

namespace weft::server {
namespace {

namespace ip = boost::asio::ip;

constexpr int kBitsOfMapped = 96;

AddressBytes bytes_of(const ip::address& address) {
  return address.is_v4() ? ip::make_address_v6(ip::v4_mapped, address.to_v4()).to_bytes()
                         : address.to_v6().to_bytes();
}

bool is_v4(const AddressBytes& bytes) {
  return ip::address_v6(bytes).is_v4_mapped();
}

std::vector<Network> networks(std::initializer_list<const char*> cidrs) {
  std::vector<Network> all;
  for (const char* cidr : cidrs) all.push_back(Network::parse(cidr).value());
  return all;
}

bool any_has(const std::vector<Network>& networks, const AddressBytes& address) {
  return std::ranges::any_of(networks, [&](const Network& each) { return each.has(address); });
}

// Of IPv6, global addresses lie in 2000::/3 alone; tunnels (Teredo, 6to4) end in other addresses.
bool is_public(const AddressBytes& address) {
  static const std::vector<Network> special =
      networks({"0.0.0.0/8",       "10.0.0.0/8",        "100.64.0.0/10",   "127.0.0.0/8",
                "169.254.0.0/16",  "172.16.0.0/12",     "192.0.0.0/24",    "192.0.2.0/24",
                "192.31.196.0/24", "192.52.193.0/24",   "192.88.99.0/24",  "192.168.0.0/16",
                "192.175.48.0/24", "198.18.0.0/15",     "198.51.100.0/24", "203.0.113.0/24",
                "224.0.0.0/4",     "240.0.0.0/4",       "2001::/23",       "2001:db8::/32",
                "2002::/16",       "2620:4f:8000::/48", "3fff::/20"});
  static const Network global = Network::parse("2000::/3").value();
  return (is_v4(address) || global.has(address)) && !any_has(special, address);
}

// The address of IPv4 that a translator (NAT64) passes on to; otherwise the address itself.
AddressBytes translated(AddressBytes address) {
  static const Network translator = Network::parse("64:ff9b::/96").value();
  if (!translator.has(address)) return address;
  std::fill(address.begin(), address.begin() + 10, 0);
  address[10] = address[11] = 0xff;
  return address;
}

}  // namespace

std::optional<Network> Network::parse(const std::string& cidr) {
  boost::system::error_code error;
  if (const auto v4 = ip::make_network_v4(cidr, error); !error)
    return Network{bytes_of(v4.network()), kBitsOfMapped + v4.prefix_length()};
  if (const auto v6 = ip::make_network_v6(cidr, error); !error)
    return Network{bytes_of(v6.network()), v6.prefix_length()};
  return std::nullopt;
}

bool Network::has(const AddressBytes& address) const {
  if (is_v4(address) != is_v4(bytes)) return false;
  for (int bit = 0; bit < bits; bit += 8) {
    const auto mask = static_cast<unsigned char>(0xff00 >> std::min(bits - bit, 8));
    const auto at = static_cast<std::size_t>(bit / 8);
    if (((address[at] ^ bytes[at]) & mask) != 0) return false;
  }
  return true;
}

bool AddressRules::may_reach(const ip::address& address) const {
  const AddressBytes bytes = bytes_of(address);
  return any_has(allowed_, bytes) || is_public(translated(bytes));
}

}  // namespace weft::server
