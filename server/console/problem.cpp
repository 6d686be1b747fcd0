// SPDX-License-Identifier: Apache-2.0
#include "server/console/problem.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "server/wire/errors.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;
using Json = nlohmann::ordered_json;

constexpr unsigned kClientClosedRequest = 499;  // as nginx has it

// Seconds; as RetryInfo has it.
constexpr const char* kRetryAfter = "1";

std::string title_of(unsigned status) {
  if (status == kClientClosedRequest) return "Client Closed Request";
  return std::string(http::obsolete_reason(http::int_to_status(status)));
}

// Takes ":NUMBER" from the end of a text.
std::optional<unsigned> take_number(std::string_view& text) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos || colon + 1 == text.size()) return std::nullopt;
  unsigned number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  text.remove_suffix(text.size() - colon);
  return number;
}

// `place` is FILE, FILE:LINE or FILE:LINE:COLUMN.
void add_place(std::string_view place, Json& error) {
  error["place"] = place;
  const auto last = take_number(place);
  const auto before = last ? take_number(place) : std::nullopt;
  if (last) error["line"] = before ? *before : *last;
  if (before) error["column"] = *last;
}

unsigned status_of(grpc::StatusCode code, std::string_view reason) {
  if (reason == "LIMIT_EXCEEDED") return 413;
  if (reason == "BUDGET_EXCEEDED" || reason == "BOUNDS_NOT_MET") return 422;
  switch (code) {
    case grpc::INVALID_ARGUMENT:
    case grpc::OUT_OF_RANGE:
      return 400;
    case grpc::UNAUTHENTICATED:
      return 401;
    case grpc::PERMISSION_DENIED:
      return 403;
    case grpc::NOT_FOUND:
      return 404;
    case grpc::ALREADY_EXISTS:
    case grpc::ABORTED:
    case grpc::FAILED_PRECONDITION:
      return 409;
    case grpc::RESOURCE_EXHAUSTED:
      return 429;
    case grpc::CANCELLED:
      return kClientClosedRequest;
    case grpc::UNIMPLEMENTED:
      return 501;
    case grpc::UNAVAILABLE:
      return 503;
    case grpc::DEADLINE_EXCEEDED:
      return 504;
    default:
      return 500;
  }
}

}  // namespace

Response problem_page(const Problem& problem) {
  const std::string title = title_of(problem.status);
  Json json{{"type", "urn:weft:error:" + problem.reason},
            {"title", title},
            {"status", problem.status},
            {"reason", problem.reason},
            {"detail", problem.detail}};
  Json error = Json::object();
  if (!problem.field.empty()) error["field"] = problem.field;
  if (!problem.place.empty()) add_place(problem.place, error);
  if (!error.empty()) json["errors"] = Json::array({std::move(error)});
  Response response = make_page(http::status::ok, "application/problem+json",
                                json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  response.result(problem.status);
  response.reason(title);
  response.set(http::field::cache_control, "no-store");
  if (problem.retry) response.set(http::field::retry_after, kRetryAfter);
  if (problem.status == 401) response.set(http::field::www_authenticate, "Bearer");
  return response;
}

Problem problem_of(const grpc::Status& status) {
  Problem problem{.detail = status.error_message()};
  google::rpc::Status rich;
  if (rich.ParseFromString(status.error_details()))
    for (const auto& detail : rich.details()) {
      google::rpc::ErrorInfo info;
      google::rpc::BadRequest bad;
      if (detail.UnpackTo(&info)) problem.reason = info.reason();
      if (detail.UnpackTo(&bad) && bad.field_violations_size() > 0)
        problem.field = bad.field_violations(0).field();
      if (detail.Is<google::rpc::RetryInfo>()) problem.retry = true;
    }
  if (problem.reason.empty()) problem.reason = code_name(status.error_code());
  if (status.error_code() == grpc::UNIMPLEMENTED)
    problem.detail = "this server does not keep jobs: it has neither --data nor --store";
  problem.status = status_of(status.error_code(), problem.reason);
  return problem;
}

}  // namespace weft::server
