// SPDX-License-Identifier: Apache-2.0
// Bearer tokens and their names, from a file of lines `NAME TOKEN`. Empty lines and lines that
// begin with # are ignored; a name may have several tokens, so that one can replace another.
//
//   # /etc/weft/tokens
//   ann 3f9c0e...
//   ci  b81d77...
//
// Only digests of tokens are kept, and all of them are compared in constant time, so the time of a
// reply does not reveal how much of a token was right.
//
//   auto file = TokenFile::open("/etc/weft/tokens", log);
//   if (!file) return complain(file.error());
//   if (auto name = (*file)->table()->name_of(token)) ...
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "server/net/watched_file.h"

namespace weft::server {

class TokenTable {
 public:
  static constexpr const char* kHolds = "tokens";
  // The error names the line, and never repeats a token. A table without tokens is an error.
  static tl::expected<TokenTable, std::string> parse(std::string_view text);

  std::optional<std::string> name_of(std::string_view token) const;
  // The same of a token of which only the digest is known.
  std::optional<std::string> name_of_digest(std::string_view digest) const;
  static std::string digest_of(std::string_view token);  // 32 bytes
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::string name;
    std::array<unsigned char, 32> digest;
  };
  std::vector<Entry> entries_;
};

using TokenFile = WatchedFile<TokenTable>;

}  // namespace weft::server
