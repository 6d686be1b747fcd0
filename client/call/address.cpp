// SPDX-License-Identifier: Apache-2.0
#include "client/call/address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <string_view>

#include "client/base/files.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

std::string host_of(const std::string& address) {
  std::string host = address.substr(0, address.rfind(':'));
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  return host;
}

// The first that is set, even if it is empty.
const char* first_of(std::initializer_list<const char*> variables, const char** name) {
  for (const char* variable : variables) {
    *name = variable;
    if (const char* value = std::getenv(variable)) return value;
  }
  return nullptr;
}

// Whether the host ends with a part of a list with commas.
bool is_excepted(std::string_view host, std::string_view list) {
  while (!list.empty()) {
    std::string_view part = list.substr(0, list.find(','));
    list.remove_prefix(std::min(part.size() + 1, list.size()));
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    if (!part.empty() && host.ends_with(part)) return true;
  }
  return false;
}

}  // namespace

bool is_local(const std::string& address) {
  if (address.starts_with("unix:") || address.starts_with("unix-abstract:")) return true;
  const std::string host = host_of(address);
  in_addr v4{};
  if (::inet_pton(AF_INET, host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == 127;
  in6_addr v6{};
  if (::inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6);
  return host == "localhost";
}

// As gRPC chooses it: src/core/ext/filters/client_channel/http_proxy.cc.
std::string proxy_of(const std::string& address) {
  if (is_local(address)) return "";
  const char* variable = nullptr;
  const char* proxy = first_of({"grpc_proxy", "https_proxy", "http_proxy"}, &variable);
  if (proxy == nullptr || *proxy == '\0') return "";
  const char* ignored = nullptr;
  if (const char* list = first_of({"no_grpc_proxy", "no_proxy"}, &ignored))
    if (is_excepted(host_of(address), list)) return "";
  std::string_view name = proxy;
  if (const auto scheme = name.find("://"); scheme != std::string_view::npos)
    name.remove_prefix(scheme + 3);
  name = name.substr(0, name.find('/'));
  if (const auto user = name.rfind('@'); user != std::string_view::npos)
    name.remove_prefix(user + 1);
  return "the proxy " + harmless(std::string(name)) + ", which " + variable + " names";
}

}  // namespace weft::client
