// SPDX-License-Identifier: Apache-2.0
#include "client/call/server_error.h"

#include <cmath>
#include <optional>
#include <string_view>

#include "client/call/address.h"
#include "client/call/request_rows.h"
#include "files/base/text.h"
#include "files/base/value_of.h"
#include "files/message/domain_message.h"
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
       "its certificate is not signed by a CA that weft trusts: --tls-ca FILE adds the CA"},
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

// The point of the plane that the message names.
std::optional<Point> place_of(const google::rpc::ErrorInfo& info) {
  const auto coordinate = [&info](const char* key) -> std::optional<double> {
    const auto found = info.metadata().find(key);
    return found == info.metadata().end() ? std::nullopt : value_of<double>(found->second);
  };
  const auto x = coordinate("x");
  const auto y = coordinate("y");
  if (!x || !y) return std::nullopt;
  return Point{*x, *y};
}

// Where places in the plane are on the globe.
std::string on_the_globe(const google::rpc::ErrorInfo& info, const DomainProjection& projection) {
  std::string text = "\n  places are in metres of " + projection.name();
  const auto place = place_of(info);
  const Point lonlat = place ? projection.named_place(*place) : Point{};
  if (!place || !std::isfinite(lonlat.x) || !std::isfinite(lonlat.y)) return text;
  return text + "; this one is at longitude " + shortest(lonlat.x) + ", latitude " +
         shortest(lonlat.y);
}

}  // namespace

std::string reason_of(const google::rpc::Status& status) {
  const google::rpc::ErrorInfo info = info_of(status);
  std::string text = code_name(status.code());
  if (!info.reason().empty()) text += " (" + harmless(info.reason()) + ")";
  return text;
}

google::rpc::Status rich_status(const grpc::Status& status) {
  google::rpc::Status rich;
  // Malformed details count as none.
  if (!rich.ParseFromString(status.error_details())) rich.Clear();
  rich.set_code(status.error_code());
  rich.set_message(status.error_message());
  return rich;
}

Error error_of(const google::rpc::Status& status, const std::string& subject,
               const RequestOrigin& origin) {
  std::string message = subject + " " + reason_of(status);
  google::rpc::BadRequest bad_request;
  for (const auto& detail : status.details())
    if (detail.Is<google::rpc::BadRequest>()) detail.UnpackTo(&bad_request);
  std::string what;  // the message, after the option that it is about
  for (const auto& violation : bad_request.field_violations()) {
    const std::string option =
        origin.options != nullptr ? option_of(violation.field(), *origin.options) : "";
    if (!option.empty()) {
      what = option + ": ";
      continue;
    }
    message += "\n  field " + harmless(violation.field());
    if (origin.domain != nullptr)
      if (const std::string place = locate_field(violation.field(), *origin.domain); !place.empty())
        message += ", at " + place;
  }
  what += status.message();
  if (!what.empty()) {
    // On lines of their own, so that a caret under an expression stays in its column.
    message += "\n  ";
    for (const char c : harmless(what)) {
      message += c;
      if (c == '\n') message += "  ";
    }
  }
  const google::rpc::ErrorInfo info = info_of(status);
  if (info.reason() == "BOUNDS_NOT_MET")
    message += std::string("\n  ") +
               (origin.options != nullptr && origin.options->from_manifest ? "" : "--") +
               "allow-unrefined takes such a mesh all the same";
  if (origin.projection != nullptr &&
      (place_of(info) || status.code() == google::rpc::INVALID_ARGUMENT))
    message += on_the_globe(info, *origin.projection);
  if (status.code() == google::rpc::UNAVAILABLE) message += connection_hint(status.message());
  const bool valid = status.code() >= 1 && status.code() <= 16;
  return {valid ? exit_code_of_status(status.code()) : ExitCode::kInternal, std::move(message)};
}

Error error_of(const grpc::Status& status, const std::string& address,
               const RequestOrigin& origin) {
  Error error = error_of(rich_status(status), "the server " + address + " answers", origin);
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE)
    if (const std::string proxy = proxy_of(address); !proxy.empty())
      error.message += "\n  it was called through " + proxy;
  return error;
}

}  // namespace weft::client
