// SPDX-License-Identifier: Apache-2.0
#include "server/console/request_rules.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "server/net/caller.h"

namespace weft::server {
namespace {

// Without the port and brackets; empty if it is malformed.
std::string_view host_of(std::string_view authority) {
  if (authority.starts_with('[')) {
    const auto end = authority.find(']');
    return end == std::string_view::npos ? std::string_view() : authority.substr(1, end - 1);
  }
  return authority.substr(0, authority.find(':'));
}

bool is_address(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  return ::inet_pton(AF_INET, host.c_str(), address.data()) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), address.data()) == 1;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

bool OriginRules::knows_host(std::string_view header) const {
  const std::string authority = lower(header);
  const std::string name(host_of(authority));
  if (name.empty()) return false;
  if (tls || is_address(name) || name == "localhost" || name == lower(host)) return true;
  return std::any_of(origins.begin(), origins.end(), [&](const std::string& origin) {
    return origin.substr(origin.find("//") + 2) == authority;
  });
}

PageOrigin OriginRules::judge(std::string_view origin, std::string_view host) const {
  if (origin.empty() || lower(origin) == (tls ? "https://" : "http://") + lower(host))
    return PageOrigin::kOwn;
  return std::find(origins.begin(), origins.end(), origin) != origins.end() ? PageOrigin::kListed
                                                                            : PageOrigin::kForeign;
}

bool is_origin(std::string_view text) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!text.starts_with(scheme)) continue;
    const std::string_view authority = text.substr(scheme.size());
    return !host_of(authority).empty() &&
           authority.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-._:[]") ==
               std::string_view::npos;
  }
  return false;
}

bool is_metadata(std::string_view name) {
  constexpr std::string_view kOfHttp[] = {"accept",
                                          "accept-charset",
                                          "accept-encoding",
                                          "accept-language",
                                          "cache-control",
                                          "connection",
                                          "content-length",
                                          "content-type",
                                          "cookie",
                                          "dnt",
                                          "expect",
                                          "forwarded",
                                          "host",
                                          "keep-alive",
                                          "origin",
                                          "pragma",
                                          "priority",
                                          "proxy-connection",
                                          "referer",
                                          "te",
                                          "trailer",
                                          "transfer-encoding",
                                          "upgrade",
                                          "upgrade-insecure-requests",
                                          "user-agent",
                                          "via",
                                          "x-grpc-web",
                                          "x-user-agent",
                                          "content-encoding",
                                          "proxy-authorization"};
  constexpr std::string_view kReserved[] = {"grpc-", "sec-", "access-control-", "weft-console-"};
  return std::find(std::begin(kOfHttp), std::end(kOfHttp), name) == std::end(kOfHttp) &&
         std::none_of(std::begin(kReserved), std::end(kReserved),
                      [&](std::string_view prefix) { return name.starts_with(prefix); });
}

std::optional<std::chrono::nanoseconds> parse_timeout(std::string_view text) {
  constexpr std::size_t kMaxDigits = 8;
  if (text.size() < 2 || text.size() > kMaxDigits + 1) return std::nullopt;
  std::int64_t count = 0;
  const char* const unit = text.data() + text.size() - 1;
  const auto [stop, error] = std::from_chars(text.data(), unit, count);
  if (error != std::errc() || stop != unit || count < 0) return std::nullopt;
  switch (*unit) {
    case 'H':
      // The clock cannot hold more, and nobody waits for so long.
      return std::chrono::hours(std::min<std::int64_t>(count, 24 * 365));
    case 'M':
      return std::chrono::minutes(std::min<std::int64_t>(count, 60 * 24 * 365));
    case 'S':
      return std::chrono::seconds(count);
    case 'm':
      return std::chrono::milliseconds(count);
    case 'u':
      return std::chrono::microseconds(count);
    case 'n':
      return std::chrono::nanoseconds(count);
    default:
      return std::nullopt;
  }
}

bool is_method_path(std::string_view path) {
  constexpr std::string_view kName =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  if (!path.starts_with('/')) return false;
  const auto slash = path.find('/', 1);
  if (slash == std::string_view::npos) return false;
  const std::string_view service = path.substr(1, slash - 1), method = path.substr(slash + 1);
  const auto named = [&](std::string_view text, const std::string& allowed) {
    return !text.empty() && text.find_first_not_of(allowed) == std::string_view::npos;
  };
  return named(service, std::string(kName) + '.') && named(method, std::string(kName));
}

bool accepts_gzip(std::string_view header) {
  while (!header.empty()) {
    const auto comma = header.find(',');
    const std::string_view coding = header.substr(0, comma);
    const auto semicolon = coding.find(';');
    if (lower(trimmed(coding.substr(0, semicolon))) == "gzip") {
      const std::string_view weight =
          semicolon == std::string_view::npos ? "" : trimmed(coding.substr(semicolon + 1));
      return weight.find_first_not_of("q=0. ") != std::string_view::npos || weight.empty();
    }
    header = comma == std::string_view::npos ? "" : header.substr(comma + 1);
  }
  return false;
}

}  // namespace weft::server
