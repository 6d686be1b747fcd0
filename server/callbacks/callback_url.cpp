// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callback_url.h"

#include <algorithm>
#include <boost/asio/ip/address_v6.hpp>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>

namespace weft::server {
namespace {

constexpr std::size_t kLongest = 2048;
constexpr std::size_t kLongestHost = 253;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool is_of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
}

// Takes the host out of HOST:PORT; ":PORT" or nothing is left.
std::optional<std::string> take_host(std::string_view& authority) {
  std::string_view host;
  if (authority.starts_with('[')) {
    const auto end = authority.find(']');
    if (end == authority.npos) return std::nullopt;
    host = authority.substr(1, end - 1);
    authority.remove_prefix(end + 1);
    boost::system::error_code error;
    boost::asio::ip::make_address_v6(std::string(host), error);
    if (error || host.find('%') != host.npos) return std::nullopt;
  } else {
    host = authority.substr(0, authority.find(':'));
    authority.remove_prefix(host.size());
    if (host.empty() || host.size() > kLongestHost || !std::ranges::all_of(host, is_of_a_name))
      return std::nullopt;
  }
  return lower(host);
}

bool is_port(std::string_view text) {
  std::uint16_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && stop == text.data() + text.size() && number != 0;
}

std::string bracketed(const std::string& host) {
  return host.find(':') == host.npos ? host : "[" + host + "]";
}

}  // namespace

tl::expected<CallbackUrl, std::string> CallbackUrl::parse(std::string_view text) {
  const auto bad = [](const char* why) { return tl::unexpected(std::string(why)); };
  if (text.size() > kLongest) return bad("has more than 2048 bytes");
  if (!std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7f; }))
    return bad("has characters that are not visible ASCII");
  const auto colon = text.find("://");
  const std::string scheme = lower(text.substr(0, std::min(colon, text.size())));
  if (colon == text.npos || (scheme != "http" && scheme != "https"))
    return bad("does not begin with http:// or https://");
  if (text.find('#') != text.npos) return bad("has a fragment");
  text.remove_prefix(colon + 3);
  std::string_view authority = text.substr(0, text.find_first_of("/?"));
  text.remove_prefix(authority.size());
  if (authority.find('@') != authority.npos) return bad("names a user");
  CallbackUrl url{.tls = scheme == "https"};
  auto host = take_host(authority);
  if (!host) return bad("has no host, or a malformed one");
  url.host = std::move(*host);
  url.port = url.tls ? "443" : "80";
  const bool has_port = authority.starts_with(':');
  if (has_port) url.port = authority.substr(1);
  if ((!authority.empty() && !has_port) || !is_port(url.port)) return bad("has a malformed port");
  url.target = (text.starts_with('/') ? "" : "/") + std::string(text);
  return url;
}

std::string CallbackUrl::authority() const {
  return port == (tls ? "443" : "80") ? bracketed(host) : place();
}

std::string CallbackUrl::place() const {
  return bracketed(host) + ":" + port;
}

}  // namespace weft::server
