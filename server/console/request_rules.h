// SPDX-License-Identifier: Apache-2.0
// What a request may be, judged by its headers alone.
//
// A page of another site can make a browser send requests here. These rules keep such a page from
// calling:
//   - a call needs a content type that a browser sends across sites only after a preflight, which
//     is refused unless --console-origin names the page's origin;
//   - an `Origin` other than the console's own is refused, unless it is one of those;
//   - without TLS, a `Host` is refused that the page's owner could have pointed at this machine
//     ("DNS rebinding"): one that is neither an address, nor `localhost`, nor named by --console or
//     --console-origin. With TLS the certificate does the same.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

enum class PageOrigin {
  kOwn,      // a page of this console, or no page at all
  kListed,   // one of --console-origin
  kForeign,  // any other
};

struct OriginRules {
  bool tls = false;
  std::string host{};                  // of the address, without port and brackets
  std::vector<std::string> origins{};  // SCHEME://HOST[:PORT], as browsers write them

  // `host` is the header.
  bool knows_host(std::string_view host) const;
  // `origin` is the header, empty if there is none.
  PageOrigin judge(std::string_view origin, std::string_view host) const;
};

// Whether this is SCHEME://HOST[:PORT] with http or https, in lower case, without a path.
bool is_origin(std::string_view text);

// Whether a header is metadata of the call: not those of HTTP and of the browser, nor those that
// gRPC or the console itself set. The name is in lower case.
bool is_metadata(std::string_view name);

// The time in a `grpc-timeout` header: up to 8 digits and a unit. nullopt if it is malformed.
std::optional<std::chrono::nanoseconds> parse_timeout(std::string_view text);

// Whether this is /package.Service/Method.
bool is_method_path(std::string_view path);

// Whether one of the codings in an `accept-encoding` header is gzip, and not with weight 0.
bool accepts_gzip(std::string_view header);

}  // namespace weft::server
