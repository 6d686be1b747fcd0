// SPDX-License-Identifier: Apache-2.0
#include "client/server_error.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>

#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace weft::client {
namespace {

std::string code_name(int code) {
  const std::string& name = google::rpc::Code_Name(static_cast<google::rpc::Code>(code));
  return name.empty() ? "status " + std::to_string(code) : name;
}

// A server's text goes to a terminal: no control characters but line feeds.
std::string harmless(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    out += (byte < 0x20 && c != '\n') || byte == 0x7f ? '?' : c;
  }
  return out;
}

}  // namespace

std::string locate_field(const std::string& field, const Domain& domain) {
  struct List {
    std::string_view prefix;
    const Provenance& places;
  };
  for (const auto& [prefix, places] :
       {List{"domain.points[", domain.point_places},
        List{"domain.segments[", domain.segment_places}, List{"domain.holes[", domain.hole_places},
        List{"domain.regions[", domain.region_places}}) {
    if (!field.starts_with(prefix)) continue;
    const char* digits = field.data() + prefix.size();
    const char* end = field.data() + field.size();
    std::size_t index = 0;
    const auto [stop, problem] = std::from_chars(digits, end, index);
    if (problem == std::errc() && stop != end && *stop == ']') return places.locate(index);
  }
  return "";
}

Error error_of(const grpc::Status& status, const std::string& address, const Domain* domain) {
  const int code = static_cast<int>(status.error_code());
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  google::rpc::BadRequest bad_request;
  if (details.ParseFromString(status.error_details())) {
    for (const auto& detail : details.details()) {
      if (detail.Is<google::rpc::ErrorInfo>()) detail.UnpackTo(&info);
      if (detail.Is<google::rpc::BadRequest>()) detail.UnpackTo(&bad_request);
    }
  }
  std::string message = "the server " + address + " answers " + code_name(code);
  if (!info.reason().empty()) message += " (" + harmless(info.reason()) + ")";
  for (const auto& violation : bad_request.field_violations()) {
    message += "\n  field " + harmless(violation.field());
    if (domain != nullptr)
      if (const std::string place = locate_field(violation.field(), *domain); !place.empty())
        message += ", at " + place;
  }
  if (!status.error_message().empty()) {
    // On lines of its own, so that a caret under an expression stays where it points.
    message += "\n  ";
    for (const char c : harmless(status.error_message())) {
      message += c;
      if (c == '\n') message += "  ";
    }
  }
  const bool valid = code >= 1 && code <= 16;
  return {valid ? exit_code_of_status(code) : ExitCode::kInternal, std::move(message)};
}

}  // namespace weft::client
