// SPDX-License-Identifier: Apache-2.0
#include "server/console/call_headers.h"

#include <grpc/grpc.h>

#include <cctype>
#include <string_view>
#include <utility>

#include "server/console/request_rules.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

bool is_legal(const std::string& key, const std::string& value) {
  const auto slice = [](const std::string& text) {
    return grpc_slice_from_static_buffer(text.data(), text.size());
  };
  return grpc_header_key_is_legal(slice(key)) != 0 &&
         (key.ends_with("-bin") || grpc_header_nonbin_value_is_legal(slice(value)) != 0);
}

}  // namespace

std::optional<Metadata> metadata_in(const Headers& request) {
  Metadata metadata;
  for (const auto& field : request) {
    std::string name = lower_case(view(field.name_string()));
    if (!is_metadata(name)) continue;
    std::string value(view(field.value()));
    if (name.ends_with("-bin")) {
      auto bytes = from_base64(value);
      if (!bytes) return std::nullopt;
      value = std::move(*bytes);
    }
    if (!is_legal(name, value)) return std::nullopt;
    metadata.emplace_back(std::move(name), std::move(value));
  }
  return metadata;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

tl::expected<CallHeaders, Refusal> read_call_headers(const Headers& request) {
  CallHeaders headers;
  const std::string type = lower_case(view(request[http::field::content_type]));
  headers.is_text =
      type == "application/grpc-web-text" || type == "application/grpc-web-text+proto";
  if (!headers.is_text && type != "application/grpc-web" && type != "application/grpc-web+proto")
    return tl::unexpected(Refusal{http::status::unsupported_media_type,
                                  "the content type of a call must be application/grpc-web+proto "
                                  "or application/grpc-web-text+proto"});
  if (const std::string_view timeout = view(request["grpc-timeout"]); !timeout.empty()) {
    const auto time = parse_timeout(timeout);
    if (!time)
      return tl::unexpected(Refusal{http::status::bad_request, "grpc-timeout is malformed"});
    headers.deadline = std::chrono::system_clock::now() +
                       std::chrono::duration_cast<std::chrono::system_clock::duration>(*time);
  }
  auto metadata = metadata_in(request);
  if (!metadata) return tl::unexpected(Refusal{http::status::bad_request, kNoMetadata});
  headers.metadata = std::move(*metadata);
  return headers;
}

}  // namespace weft::server
