// SPDX-License-Identifier: Apache-2.0
#include "client/call/address.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <map>
#include <string>

namespace weft::client {
namespace {

constexpr std::array kVariables = {"grpc_proxy", "https_proxy", "http_proxy", "no_grpc_proxy",
                                   "no_proxy"};

class ProxyOf : public testing::Test {
 protected:
  void SetUp() override { clear(); }
  void TearDown() override { clear(); }
  static void clear() {
    for (const char* variable : kVariables) ::unsetenv(variable);
  }
  static std::string proxy(const std::string& address,
                           const std::map<std::string, std::string>& variables) {
    clear();
    for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
    return proxy_of(address);
  }
};

TEST(IsLocal, IsTrueOfSocketsAndLoopbackAlone) {
  for (const char* address :
       {"unix:/s", "unix-abstract:s", "127.0.0.1:7421", "127.9.9.9:1", "[::1]:7421", "localhost:1"})
    EXPECT_TRUE(is_local(address)) << address;
  for (const char* address : {"10.0.0.1:1", "[2001:db8::1]:1", "localhost.example:1", "mesh:7421"})
    EXPECT_FALSE(is_local(address)) << address;
}

TEST_F(ProxyOf, NamesTheVariableAndNoPassword) {
  EXPECT_EQ(proxy("mesh:7421", {}), "");
  EXPECT_EQ(proxy("mesh:7421", {{"http_proxy", "http://user:secret@gate:3128/"}}),
            "the proxy gate:3128, which http_proxy names");
  EXPECT_EQ(proxy("mesh:7421", {{"http_proxy", "a:1"}, {"grpc_proxy", "b:2"}}),
            "the proxy b:2, which grpc_proxy names");
  EXPECT_EQ(proxy("mesh:7421", {{"http_proxy", "a:1"}, {"grpc_proxy", ""}}), "");
}

TEST_F(ProxyOf, IsEmptyForThisMachineAndForExceptions) {
  EXPECT_EQ(proxy("127.0.0.1:7421", {{"http_proxy", "gate:1"}}), "");
  EXPECT_EQ(proxy("unix:/s", {{"http_proxy", "gate:1"}}), "");
  EXPECT_EQ(proxy("mesh.lan:7421", {{"http_proxy", "gate:1"}, {"no_proxy", "a.test, .lan"}}), "");
  EXPECT_NE(proxy("mesh.lan:7421",
                  {{"http_proxy", "gate:1"}, {"no_grpc_proxy", "a.test"}, {"no_proxy", ".lan"}}),
            "");
}

}  // namespace
}  // namespace weft::client
