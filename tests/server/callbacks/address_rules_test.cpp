// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/address_rules.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

bool may_reach(const AddressRules& rules, const char* address) {
  return rules.may_reach(boost::asio::ip::make_address(address));
}

AddressRules allowing(std::initializer_list<const char*> cidrs) {
  AddressRules rules;
  for (const char* cidr : cidrs) rules.allow(Network::parse(cidr).value());
  return rules;
}

TEST(AddressRules, PublicAddressesMayBeReached) {
  for (const char* address :
       {"1.1.1.1", "8.8.8.8", "93.184.216.34", "172.15.255.255", "172.32.0.0", "100.63.255.255",
        "100.128.0.0", "192.167.255.255", "198.17.255.255", "198.20.0.0", "223.255.255.255",
        "169.253.255.255", "2606:4700::1111", "2a00:1450:4001::200e", "2001:4860:4860::8888",
        "::ffff:8.8.8.8", "64:ff9b::808:808"})
    EXPECT_TRUE(may_reach({}, address)) << address;
}

TEST(AddressRules, OtherAddressesMayNot) {
  for (const char* address : {"0.0.0.0",     "0.1.2.3",         "10.0.0.0",     "10.255.255.255",
                              "100.64.0.1",  "100.127.255.255", "127.0.0.1",    "127.255.255.254",
                              "169.254.0.1", "169.254.169.254", "172.16.0.1",   "172.31.255.255",
                              "192.0.0.8",   "192.0.2.1",       "192.88.99.1",  "192.168.0.1",
                              "198.18.0.1",  "198.19.255.255",  "198.51.100.1", "203.0.113.1",
                              "224.0.0.1",   "239.255.255.255", "240.0.0.1",    "255.255.255.255"})
    EXPECT_FALSE(may_reach({}, address)) << address;
  for (const char* address : {"::",
                              "::1",
                              "::2",
                              "fe80::1",
                              "fe80::a9fe:a9fe",
                              "febf::1",
                              "fec0::1",
                              "fc00::1",
                              "fd00:ec2::254",
                              "fdff::1",
                              "ff02::1",
                              "ff0e::1",
                              "100::1",
                              "2001:db8::1",
                              "2001::1",
                              "2001:0:4136:e378:8000:63bf:3fff:fdd2",
                              "2001:10::1",
                              "3fff::1",
                              "5f00::1",
                              "4000::1"})
    EXPECT_FALSE(may_reach({}, address)) << address;
}

// Each way in which IPv6 carries an address of IPv4.
TEST(AddressRules, AnAddressIsJudgedThroughItsDisguise) {
  for (const char* address :
       {"::ffff:127.0.0.1", "::ffff:7f00:1", "::ffff:169.254.169.254", "::ffff:10.0.0.1",
        "::ffff:0:0", "::127.0.0.1", "64:ff9b::127.0.0.1", "64:ff9b::a00:1", "64:ff9b::a9fe:a9fe",
        "64:ff9b:1::808:808", "2002:7f00:1::1", "2002:a00:1::", "2002:808:808::1"})
    EXPECT_FALSE(may_reach({}, address)) << address;
}

TEST(AddressRules, ANetworkIsAllowedByItsCidr) {
  const AddressRules rules = allowing({"127.0.0.0/8", "10.20.0.0/16", "fd00:1::/32"});
  for (const char* address :
       {"127.0.0.1", "::ffff:127.0.0.1", "10.20.0.0", "10.20.255.255", "fd00:1::5", "8.8.8.8"})
    EXPECT_TRUE(may_reach(rules, address)) << address;
  for (const char* address :
       {"10.19.255.255", "10.21.0.0", "169.254.169.254", "fd00:2::5", "::1", "64:ff9b::127.0.0.1"})
    EXPECT_FALSE(may_reach(rules, address)) << address;
}

TEST(AddressRules, ACidrMayEndWithinAByte) {
  const AddressRules rules = allowing({"10.128.0.0/9", "192.168.1.7/32"});
  EXPECT_TRUE(may_reach(rules, "10.128.0.0"));
  EXPECT_FALSE(may_reach(rules, "10.127.255.255"));
  EXPECT_TRUE(may_reach(rules, "192.168.1.7"));
  EXPECT_FALSE(may_reach(rules, "192.168.1.6"));
}

TEST(AddressRules, NetworksOfIpv6HaveNoAddressesOfIpv4) {
  const AddressRules rules = allowing({"::/0"});
  EXPECT_TRUE(may_reach(rules, "::1"));
  EXPECT_FALSE(may_reach(rules, "127.0.0.1"));
  EXPECT_FALSE(may_reach(allowing({"0.0.0.0/0"}), "::1"));
  EXPECT_TRUE(may_reach(allowing({"0.0.0.0/0"}), "127.0.0.1"));
}

TEST(AddressRules, WhatIsNoCidrIsNoNetwork) {
  for (const char* text : {"", "127.0.0.1", "127.0.0.0/33", "127.0.0.0/-1", "fd00::/129", "/8",
                           "localhost/8", "127.0.0.0/", "127.1/8", "fd00::/8x"})
    EXPECT_FALSE(Network::parse(text)) << text;
}

}  // namespace
}  // namespace weft::server
