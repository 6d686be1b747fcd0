// SPDX-License-Identifier: Apache-2.0
// What the headers of a call say: how its frames come, until when, and which metadata go with it.
#pragma once

#include <boost/beast/http/status.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "server/console/frames.h"
#include "server/console/pages.h"

namespace weft::server {

struct CallHeaders {
  bool is_text = false;  // frames in base64, both ways
  std::optional<std::chrono::system_clock::time_point> deadline{};
  Metadata metadata{};  // with legal keys and values
};

struct Refusal {
  boost::beast::http::status status;
  std::string why;  // a sentence without its end
};

// Those of the headers that are metadata of a call; nullopt if one cannot be.
std::optional<Metadata> metadata_in(const Headers& request);
inline constexpr const char* kNoMetadata = "a header cannot be metadata of a call";

tl::expected<CallHeaders, Refusal> read_call_headers(const Headers& request);

std::string lower_case(std::string_view text);

}  // namespace weft::server
