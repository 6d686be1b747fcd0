// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callbacks.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/files/support/temp_folder.h"

namespace weft::server {
namespace {

const std::string kSecret = "whsec_" + std::string(32, 'A');

std::unique_ptr<Callbacks> callbacks_of(const std::string& lines,
                                        std::vector<Network> allowed = {}) {
  const files::TempFolder folder;
  std::ofstream(folder / "secrets") << lines;
  auto opened =
      Callbacks::open({.clients = (folder / "secrets").string(), .allowed = std::move(allowed)},
                      make_logger("off"));
  EXPECT_TRUE(opened) << opened.error();
  return opened ? std::move(*opened) : nullptr;
}

std::string fault_of(const tl::expected<Callback, std::string>& callback) {
  return callback ? "" : callback.error();
}

TEST(Callbacks, AreForClientsWithASecret) {
  const auto callbacks = callbacks_of("ann " + kSecret + "\n");
  const auto anns = callbacks->accept("ann", "https://Hooks.example.org/weft");
  ASSERT_TRUE(anns) << anns.error();
  EXPECT_EQ(anns->url, "https://Hooks.example.org/weft");
  EXPECT_EQ(anns->place, "hooks.example.org:443");
  EXPECT_EQ(fault_of(callbacks->accept("eve", "https://hooks.example.org/")),
            "the server has no secret for callbacks of this client");
  EXPECT_EQ(callbacks->accept("eve", "")->url, "");
  EXPECT_EQ(callbacks->accept("ann", "")->url, "");
}

TEST(Callbacks, GoToTheClientsOwnUrlUnlessAJobNamesAnother) {
  const auto callbacks = callbacks_of("* " + kSecret + " https://example.org/all\n");
  EXPECT_EQ(callbacks->accept("", "")->url, "https://example.org/all");
  EXPECT_EQ(callbacks->accept("", "http://example.org/one")->url, "http://example.org/one");
}

TEST(Callbacks, ToAnAddressThatTheyMayNotReachAreRefusedAtOnce) {
  const auto callbacks =
      callbacks_of("* " + kSecret + "\n", {Network::parse("10.1.0.0/16").value()});
  EXPECT_EQ(fault_of(callbacks->accept("", "http://127.0.0.1/")),
            "notify names 127.0.0.1, which callbacks may not go to");
  EXPECT_EQ(fault_of(callbacks->accept("", "http://[::ffff:a9fe:a9fe]/")),
            "notify names ::ffff:a9fe:a9fe, which callbacks may not go to");
  EXPECT_EQ(fault_of(callbacks->accept("", "ftp://example.org/")),
            "notify does not begin with http:// or https://");
  EXPECT_EQ(fault_of(callbacks->accept("", "http://10.1.2.3/")), "");
}

TEST(Callbacks, AreSignedByEachSecretOfTheirClient) {
  const auto callbacks = callbacks_of("ann " + kSecret + "\nann whsec_" + std::string(32, 'B') +
                                      "\nbob " + kSecret + "\n");
  const std::string anns = callbacks->signatures("ann", "1", "2", "{}");
  const std::string bobs = callbacks->signatures("bob", "1", "2", "{}");
  EXPECT_TRUE(anns.starts_with(bobs + " v1,")) << anns;
  EXPECT_EQ(callbacks->signatures("eve", "1", "2", "{}"), "");
}

}  // namespace
}  // namespace weft::server
