// SPDX-License-Identifier: Apache-2.0
#include "server/http/routes.h"

#include <algorithm>
#include <span>
#include <utility>

#include "server/console/problem.h"
#include "server/http/call_exchange.h"
#include "server/http/exchange_parts.h"
#include "server/http/mesh_exchange.h"
#include "server/http/openapi.h"
#include "server/http/target.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;
using Opened = tl::expected<std::shared_ptr<Exchange>, Response>;

struct Route {
  RouteText text;
  http::verb method;
  Opened (*open)(ExchangeParts& parts, const Target& target, Visit& visit);
};

Opened open_mesh(ExchangeParts& parts, const Target& target, Visit& visit) {
  auto opened = MeshExchange::open(parts, target, visit);
  if (!opened) return tl::unexpected(problem_page(opened.error()));
  return std::move(*opened);
}

Opened open_info(ExchangeParts& parts, const Target&, Visit& visit) {
  return std::make_shared<CallExchange>(parts, "/weft.v1.MeshService/GetServerInfo", "",
                                        std::make_unique<v1::GetServerInfoResponse>(), visit);
}

Opened open_description(ExchangeParts&, const Target&, Visit&);

constexpr Route kRoutes[] = {
    {{"put", "/v1/mesh", "Makes the mesh of the domain in the body", RouteText::Answer::kMesh},
     http::verb::put,
     open_mesh},
    {{"post", "/v1/mesh", "Makes the mesh of the domain in the body", RouteText::Answer::kMesh},
     http::verb::post,
     open_mesh},
    {{"put", "/v1/mesh/{name}", "Makes the mesh of the domain in the body, a file of that name",
      RouteText::Answer::kMesh},
     http::verb::put,
     open_mesh},
    {{"post", "/v1/mesh/{name}", "Makes the mesh of the domain in the body, a file of that name",
      RouteText::Answer::kMesh},
     http::verb::post,
     open_mesh},
    {{"get", "/v1/info", "Versions and limits of the server"}, http::verb::get, open_info},
    {{"get", "/v1/openapi.json", "This description"}, http::verb::get, open_description},
    {{"get", "/", "This description"}, http::verb::get, open_description},
};

Opened open_description(ExchangeParts&, const Target&, Visit&) {
  static const std::string text = [] {
    std::vector<RouteText> texts;
    for (const Route& route : kRoutes) texts.push_back(route.text);
    return openapi(texts);
  }();
  return tl::unexpected(make_page(http::status::ok, "application/json", text));
}

// Whether the path is that of the route: a part in braces is any one part that is not empty.
bool matches(std::string_view path, std::string_view pattern) {
  const auto brace = std::min(pattern.find('{'), pattern.size());
  if (brace == pattern.size()) return path == pattern;
  if (!path.starts_with(pattern.substr(0, brace))) return false;
  path.remove_prefix(brace);
  pattern.remove_prefix(pattern.find('}', brace) + 1);
  const auto slash = std::min(path.find('/'), path.size());
  return slash > 0 && matches(path.substr(slash), pattern);
}

class AllRoutes final : public Routes {
 public:
  AllRoutes(SessionContext& context, const RouteOptions& options)
      : workers_(options.threads),
        meshes_(std::make_shared<Meshes>(options.meshes, options.client_share, workers_)),
        parts_{context, options.memory, options.folder, *meshes_} {}
  ~AllRoutes() override {
    workers_.finish();
    meshes_->close();
  }

  Opened open(Visit visit) override {
    const auto target = parse_target(visit.target);
    if (!target)
      return refuse({.status = 400,
                     .reason = "MALFORMED_REQUEST",
                     .detail = "a percent sign in the target is not followed by a byte"});
    std::string allowed;
    for (const Route& route : kRoutes) {
      if (!matches(target->path, route.text.path)) continue;
      if (route.method == visit.method) return route.open(parts_, *target, visit);
      allowed += (allowed.empty() ? "" : ", ") + std::string(view(http::to_string(route.method)));
    }
    if (allowed.empty())
      return refuse({.status = 404,
                     .reason = "NOT_FOUND",
                     .detail = "there is nothing at this path; / describes what there is"});
    Opened refused = refuse(
        {.status = 405, .reason = "METHOD_NOT_ALLOWED", .detail = "the path takes " + allowed});
    refused.error().set(http::field::allow, allowed);
    return refused;
  }

 private:
  static Opened refuse(const Problem& problem) { return tl::unexpected(problem_page(problem)); }

  Workers workers_;
  const std::shared_ptr<Meshes> meshes_;  // places may outlive this
  ExchangeParts parts_;
};

}  // namespace

std::string folder_fault(const std::filesystem::path& folder) {
  const auto file = files::open_unlinked(folder);
  return file ? "" : file.error().message;
}

std::unique_ptr<Routes> make_routes(SessionContext& context, const RouteOptions& options) {
  return std::make_unique<AllRoutes>(context, options);
}

}  // namespace weft::server
