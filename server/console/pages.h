// SPDX-License-Identifier: Apache-2.0
// Responses to what is no call: the application's files, refusals, and what other origins ask
// before they call.
#pragma once

#include <boost/beast/core/string_type.hpp>
#include <boost/beast/http/fields.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/status.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "server/console/assets.h"
#include "server/console/request_rules.h"

namespace weft::server {

using Response = boost::beast::http::response<boost::beast::http::string_body>;
using Headers = boost::beast::http::fields;

inline std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}
inline boost::beast::string_view view(std::string_view text) {
  return {text.data(), text.size()};
}

// The headers that keep pages from doing what the application does not.
void secure(Headers& response);

// Lets the page that asked read the response, if --console-origin names its origin. `origin`: of
// the request.
void allow_origin(const OriginRules& rules, PageOrigin origin, const Headers& request,
                  Headers& response);

Response make_page(boost::beast::http::status status, std::string_view type, std::string body);

// A refusal: `why` is a sentence without its end.
Response refusal(boost::beast::http::status status, const std::string& why);

// The file that a target names, or that it has not changed; nullopt if there is none.
std::optional<Response> asset_page(std::span<const Asset> assets, std::string_view target,
                                   const Headers& request);

// To a browser that asks whether a page of another origin may call.
Response preflight_answer(PageOrigin origin, const Headers& request);

}  // namespace weft::server
