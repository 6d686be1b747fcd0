// SPDX-License-Identifier: Apache-2.0
#include "server/console/pages.h"

#include <utility>

namespace weft::server {
namespace {

namespace http = boost::beast::http;

constexpr std::string_view kPlainText = "text/plain; charset=utf-8";

// The page runs, shows and fetches only the application's own files, and no other site shows it in
// a frame. Pictures to download and to copy are made in the page.
constexpr std::string_view kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; worker-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

}  // namespace

void secure(Headers& response) {
  response.set("Content-Security-Policy", view(kContentSecurityPolicy));
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("X-Frame-Options", "DENY");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
}

void allow_origin(const OriginRules& rules, PageOrigin origin, const Headers& request,
                  Headers& response) {
  if (!rules.origins.empty()) response.set(http::field::vary, "Origin, Accept-Encoding");
  if (origin != PageOrigin::kListed) return;
  response.set(http::field::access_control_allow_origin, request[http::field::origin]);
  response.set(http::field::access_control_expose_headers,
               "grpc-status, grpc-message, grpc-status-details-bin");
  response.set("Cross-Origin-Resource-Policy", "cross-origin");
}

Response make_page(http::status status, std::string_view type, std::string body) {
  Response response;
  response.version(11);
  response.result(status);
  response.set(http::field::content_type, view(type));
  response.body() = std::move(body);
  return response;
}

Response refusal(http::status status, const std::string& why) {
  Response response = make_page(status, kPlainText, why + "\n");
  if (status == http::status::method_not_allowed)
    response.set(http::field::allow, "GET, HEAD, POST, OPTIONS");
  return response;
}

std::optional<Response> asset_page(std::span<const Asset> assets, std::string_view target,
                                   const Headers& request) {
  const std::string_view path = target.substr(0, target.find_first_of("?#"));
  if (assets.empty() && path == "/")
    return make_page(http::status::ok, kPlainText,
                     "This weftd was built without the console's pages, and serves gRPC-Web only. "
                     "A build with npm has them: see WEFT_CONSOLE of its CMake.\n");
  const Asset* const asset = find_asset(assets, path);
  if (asset == nullptr) return std::nullopt;
  const bool current = view(request[http::field::if_none_match]) == asset->etag;
  const bool gzip = accepts_gzip(view(request[http::field::accept_encoding]));
  Response response =
      make_page(current ? http::status::not_modified : http::status::ok, asset->type,
                current ? std::string()
                : gzip  ? std::string(asset->gzip)
                        : inflated(*asset));
  response.set(http::field::etag, view(asset->etag));
  response.set(http::field::vary, "Accept-Encoding");
  response.set(http::field::cache_control,
               asset->immutable ? "public, max-age=31536000, immutable" : "no-cache");
  if (gzip && !current) response.set(http::field::content_encoding, "gzip");
  return response;
}

Response preflight_answer(PageOrigin origin, const Headers& request) {
  Response response = make_page(http::status::no_content, kPlainText, "");
  if (origin == PageOrigin::kListed) {
    response.set(http::field::access_control_allow_methods, "GET, HEAD, POST, PUT, DELETE");
    response.set(http::field::access_control_allow_headers,
                 request[http::field::access_control_request_headers]);
    response.set(http::field::access_control_max_age, "7200");
  }
  return response;
}

}  // namespace weft::server
