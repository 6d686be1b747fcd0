// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callback_clients.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

const std::string kA = "whsec_" + std::string(32, 'A');
const std::string kB = "whsec_" + std::string(32, 'B');

TEST(CallbackClients, AClientHasItsSecretsAndItsUrl) {
  const auto table = CallbackClients::parse("# who\n\nann " + kA + " https://example.org/a\nann " +
                                            kB + " https://example.org/b\n bob " + kB + " \n");
  ASSERT_TRUE(table) << table.error();
  EXPECT_EQ(table->size(), 2u);
  const CallbackClient* ann = table->find("ann");
  ASSERT_NE(ann, nullptr);
  EXPECT_EQ(ann->keys.size(), 2u);
  EXPECT_EQ(ann->url, "https://example.org/a");
  ASSERT_NE(table->find("bob"), nullptr);
  EXPECT_EQ(table->find("bob")->url, "");
  EXPECT_EQ(table->find("eve"), nullptr);
  EXPECT_EQ(table->find(""), nullptr);
}

TEST(CallbackClients, AStarIsAllOthers) {
  const auto table = CallbackClients::parse("ann " + kA + "\n* " + kB + "\n");
  ASSERT_TRUE(table) << table.error();
  EXPECT_NE(table->find("ann"), table->find("*"));
  EXPECT_EQ(table->find(""), table->find("*"));
  EXPECT_EQ(table->find("eve"), table->find("*"));
}

TEST(CallbackClients, AFaultIsToldWithItsLineAndWithoutTheSecret) {
  const auto fault = [](const std::string& text) {
    const auto table = CallbackClients::parse(text);
    return table ? "" : table.error();
  };
  EXPECT_EQ(fault(""), "it holds no secret");
  EXPECT_EQ(fault("\nann\n"), "line 2: not of the form NAME SECRET or NAME SECRET URL");
  EXPECT_EQ(fault("ann " + kA + " http://example.org/ more"),
            "line 1: not of the form NAME SECRET or NAME SECRET URL");
  EXPECT_EQ(fault("ann hunter2"),
            "line 1: the secret is not whsec_ and the base64 of 24 to 64 bytes");
  EXPECT_EQ(fault("ann " + kA + " ftp://example.org/"),
            "line 1: the URL does not begin with http:// or https://");
  EXPECT_EQ(fault(std::string(129, 'n') + " " + kA),
            "line 1: a name is up to 128 visible ASCII characters");
}

}  // namespace
}  // namespace weft::server
