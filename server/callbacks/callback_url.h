// SPDX-License-Identifier: Apache-2.0
// A URL that is told of the end of a job.
//
//   const auto url = CallbackUrl::parse("https://example.org/hook?of=weft");
//   url->host == "example.org", url->port == "443", url->target == "/hook?of=weft"
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace weft::server {

struct CallbackUrl {
  bool tls = false;
  std::string host{};    // in lower case; an IPv6 address without brackets
  std::string port{};    // a number
  std::string target{};  // path and query

  // http or https, visible ASCII, at most 2048 bytes, without user and fragment. What an address
  // stands for is not judged here, whatever its form: see address_rules.h. The error ends a
  // sentence that the URL begins.
  static tl::expected<CallbackUrl, std::string> parse(std::string_view text);

  // As the header Host has it.
  std::string authority() const;
  // HOST:PORT.
  std::string place() const;
};

}  // namespace weft::server
