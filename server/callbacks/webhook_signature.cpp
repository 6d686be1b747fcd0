// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/webhook_signature.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <array>
#include <stdexcept>

namespace weft::server {
namespace {

constexpr std::string_view kStart = "whsec_";
constexpr std::size_t kFewest = 24;
constexpr std::size_t kMost = 64;

const unsigned char* bytes_of(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

}  // namespace

tl::expected<std::string, std::string> webhook_key(std::string_view secret) {
  const auto bad = tl::unexpected(
      fmt::format("is not {} and the base64 of {} to {} bytes", kStart, kFewest, kMost));
  if (!secret.starts_with(kStart)) return bad;
  const std::string_view text = secret.substr(kStart.size());
  const std::size_t padding =
      text.ends_with("==") ? 2 : static_cast<std::size_t>(text.ends_with('='));
  if (text.size() % 4 != 0 || text.size() > 2 * kMost) return bad;
  std::string key(text.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(key.data()), bytes_of(text),
                                   static_cast<int>(text.size()));
  if (size < 0 || static_cast<std::size_t>(size) != key.size()) return bad;
  key.resize(key.size() - padding);
  if (key.size() < kFewest || key.size() > kMost) return bad;
  return key;
}

std::string webhook_signature(std::string_view key, std::string_view id, std::string_view timestamp,
                              std::string_view body) {
  const std::string content = fmt::format("{}.{}.{}", id, timestamp, body);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  if (HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), bytes_of(content),
           content.size(), digest.data(), &size) == nullptr)
    throw std::runtime_error("OpenSSL has no HMAC-SHA256");
  std::array<unsigned char, 64> text;  // 44, and an end
  const int length = EVP_EncodeBlock(text.data(), digest.data(), static_cast<int>(size));
  return fmt::format("v1,{}", std::string_view(reinterpret_cast<const char*>(text.data()),
                                               static_cast<std::size_t>(length)));
}

}  // namespace weft::server
