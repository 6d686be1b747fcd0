// SPDX-License-Identifier: Apache-2.0
// Signatures of callbacks, as Standard Webhooks have them: HMAC-SHA256 over "ID.TIMESTAMP.BODY".
// Source: https://github.com/standard-webhooks/standard-webhooks, spec/standard-webhooks.md
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace weft::server {

// The key in a secret, "whsec_" and the base64 of 24 to 64 bytes. The error ends a sentence that
// the secret begins, and does not repeat it.
tl::expected<std::string, std::string> webhook_key(std::string_view secret);

// "v1,BASE64"; `timestamp` is in seconds since 1970.
std::string webhook_signature(std::string_view key, std::string_view id, std::string_view timestamp,
                              std::string_view body);

}  // namespace weft::server
