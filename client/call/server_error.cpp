// SPDX-License-Identifier: Apache-2.0
#include "client/call/server_error.h"

#include <charconv>
#include <cstddef>
#include <string_view>

#include "client/base/text.h"
#include "google/rpc/code.pb.h"
#include "google/rpc/error_details.pb.h"

namespace weft::client {
namespace {

std::string code_name(int code) {
  const std::string& name = google::rpc::Code_Name(static_cast<google::rpc::Code>(code));
  return name.empty() ? "status " + std::to_string(code) : name;
}

google::rpc::ErrorInfo info_of(const google::rpc::Status& status) {
  google::rpc::ErrorInfo info;
  for (const auto& detail : status.details())
    if (detail.Is<google::rpc::ErrorInfo>()) detail.UnpackTo(&info);
  return info;
}

// What to do about a connection that did not come about, by the text in which gRPC says why.
std::string connection_hint(std::string_view message) {
  struct Hint {
    std::string_view said;
    std::string_view hint;
  };
  constexpr Hint kHints[] = {
      {"certificate verify failed",
       "nobody whom weft trusts has signed its certificate: --tls-ca FILE names who has"},
      {"is not in peer certificate",
       "its certificate is for another name: --tls-server-name NAME gives that name"},
      {"wrong version number", "it does not encrypt: leave out --tls and --tls-ca"},
      {"andshake failed", "encryption failed: see --tls-ca, --tls-cert and --tls-key"},
      {"Socket closed", "if it encrypts, give --tls or --tls-ca FILE"}};
  if (message.find("failed to connect") == std::string_view::npos) return "";
  for (const auto& [said, hint] : kHints)
    if (message.find(said) != std::string_view::npos) return "\n  " + std::string(hint);
  return "";
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

std::string reason_of(const google::rpc::Status& status) {
  const google::rpc::ErrorInfo info = info_of(status);
  std::string text = code_name(status.code());
  if (!info.reason().empty()) text += " (" + harmless(info.reason()) + ")";
  return text;
}

google::rpc::Status rich_status(const grpc::Status& status) {
  google::rpc::Status rich;
  // Details that are garbage say nothing.
  if (!rich.ParseFromString(status.error_details())) rich.Clear();
  rich.set_code(status.error_code());
  rich.set_message(status.error_message());
  return rich;
}

Error error_of(const google::rpc::Status& status, const std::string& subject,
               const Domain* domain) {
  std::string message = subject + " " + reason_of(status);
  google::rpc::BadRequest bad_request;
  for (const auto& detail : status.details())
    if (detail.Is<google::rpc::BadRequest>()) detail.UnpackTo(&bad_request);
  for (const auto& violation : bad_request.field_violations()) {
    message += "\n  field " + harmless(violation.field());
    if (domain != nullptr)
      if (const std::string place = locate_field(violation.field(), *domain); !place.empty())
        message += ", at " + place;
  }
  if (!status.message().empty()) {
    // On lines of its own, so that a caret under an expression stays where it points.
    message += "\n  ";
    for (const char c : harmless(status.message())) {
      message += c;
      if (c == '\n') message += "  ";
    }
  }
  if (info_of(status).reason() == "BOUNDS_NOT_MET")
    message += "\n  --allow-unrefined takes such a mesh all the same";
  if (status.code() == google::rpc::UNAVAILABLE) message += connection_hint(status.message());
  const bool valid = status.code() >= 1 && status.code() <= 16;
  return {valid ? exit_code_of_status(status.code()) : ExitCode::kInternal, std::move(message)};
}

Error error_of(const grpc::Status& status, const std::string& address, const Domain* domain) {
  return error_of(rich_status(status), "the server " + address + " answers", domain);
}

}  // namespace weft::client
