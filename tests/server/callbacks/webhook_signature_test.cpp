// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/webhook_signature.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

// The example that libraries of Standard Webhooks are tested with.
TEST(WebhookSignature, IsThatOfTheStandard) {
  const auto key = webhook_key("whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw");
  ASSERT_TRUE(key) << key.error();
  EXPECT_EQ(webhook_signature(*key, "msg_p5jXN8AQM9LWM0D4loKWxJek", "1614265330",
                              R"({"test": 2432232314})"),
            "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=");
}

TEST(WebhookSignature, ASecretMayHavePadding) {
  const auto key = webhook_key("whsec_QUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQQ==");
  ASSERT_TRUE(key) << key.error();
  EXPECT_EQ(*key, std::string(25, 'A'));
  EXPECT_EQ(*webhook_key("whsec_QUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUE="), std::string(26, 'A'));
}

TEST(WebhookSignature, AnotherSecretIsRefusedAndNotRepeated) {
  for (const std::string& secret :
       {std::string(), std::string("whsec_"), std::string("MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"),
        std::string("whsec_MfKQ9r8GKYqrTwjUPD8ILPZI"),  // 18 bytes
        std::string("whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaS"),
        std::string("whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLa-_"), "whsec_" + std::string(88, 'A'),
        "whsec_" + std::string(4096, 'A')}) {
    const auto key = webhook_key(secret);
    ASSERT_FALSE(key) << secret;
    EXPECT_EQ(key.error(), "is not whsec_ and the base64 of 24 to 64 bytes");
  }
}

}  // namespace
}  // namespace weft::server
