// SPDX-License-Identifier: Apache-2.0
#include "server/net/tokens.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/sha.h>

#include "server/net/table_lines.h"

namespace weft::server {
namespace {

// Of 64 characters, 16 have 96 bits.
constexpr std::size_t kShortestToken = 16;

using Digest = std::array<unsigned char, SHA256_DIGEST_LENGTH>;

Digest sha256_of(std::string_view text) {
  Digest digest;
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  return digest;
}

}  // namespace

tl::expected<TokenTable, std::string> TokenTable::parse(std::string_view text) {
  TokenTable table;
  for (const TableLine& line : table_lines(text)) {
    const auto bad = [&](const std::string& reason) { return bad_line(line, reason); };
    if (line.words.size() != 2) return bad("not of the form NAME TOKEN");
    const std::string_view name = line.words[0];
    const std::string_view token = line.words[1];
    if (const std::string fault = fault_of_name(name); !fault.empty()) return bad(fault);
    if (!visible_ascii(token)) return bad("a token is visible ASCII characters");
    if (token.size() < kShortestToken)
      return bad(fmt::format("the token has {} characters; the least is {}", token.size(),
                             kShortestToken));
    if (table.name_of(token)) return bad("the token is used twice");
    table.entries_.push_back({std::string(name), sha256_of(token)});
  }
  if (table.entries_.empty()) return tl::unexpected(std::string("it holds no token"));
  return table;
}

std::optional<std::string> TokenTable::name_of(std::string_view token) const {
  return name_of_digest(digest_of(token));
}

std::string TokenTable::digest_of(std::string_view token) {
  const Digest digest = sha256_of(token);
  return {digest.begin(), digest.end()};
}

std::optional<std::string> TokenTable::name_of_digest(std::string_view digest) const {
  const Entry* found = nullptr;
  for (const Entry& entry : entries_)
    if (digest.size() == entry.digest.size() &&
        CRYPTO_memcmp(entry.digest.data(), digest.data(), digest.size()) == 0)
      found = &entry;
  if (found == nullptr) return std::nullopt;
  return found->name;
}

}  // namespace weft::server
