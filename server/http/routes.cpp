// SPDX-License-Identifier: Apache-2.0
#include "server/http/routes.h"

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

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

using Purpose = MeshExchange::Purpose;

struct Route {
  RouteText text;
  http::verb method;
  // `word` stands for the part of the path in braces.
  Opened (*open)(ExchangeParts& parts, const Route& route, const Query& query,
                 const std::string& word, Visit& visit);
};

template <Purpose kPurpose>
Opened open_mesh(ExchangeParts& parts, const Route& route, const Query& query,
                 const std::string& word, Visit& visit) {
  auto opened = MeshExchange::open(parts, kPurpose, route.text.uses, query, word, visit);
  if (opened) return std::move(*opened);
  parts.refusals.note(visit.client, opened.error());
  return tl::unexpected(problem_page(opened.error()));
}

// A call about the job that the word names.
template <class Request, class Response>
UnaryCall job_call(const char* method, const std::string& word) {
  Request request;
  if constexpr (requires { request.set_id(word); }) request.set_id(word);
  return {method, request.SerializeAsString(), std::make_unique<Response>()};
}

Opened open_calls(ExchangeParts& parts, std::vector<UnaryCall> calls, Visit& visit) {
  return std::make_shared<CallExchange>(parts, std::move(calls), std::move(visit.metadata),
                                        std::move(visit.answers_to));
}

template <class Request, class Response>
Opened open_call(ExchangeParts& parts, const char* method, const std::string& word, Visit& visit) {
  std::vector<UnaryCall> calls;
  calls.push_back(job_call<Request, Response>(method, word));
  return open_calls(parts, std::move(calls), visit);
}

Opened open_info(ExchangeParts& parts, const Route&, const Query&, const std::string& word,
                 Visit& visit) {
  return open_call<v1::GetServerInfoRequest, v1::GetServerInfoResponse>(
      parts, "/weft.v1.MeshService/GetServerInfo", word, visit);
}

Opened open_jobs(ExchangeParts& parts, const Route&, const Query&, const std::string& word,
                 Visit& visit) {
  return open_call<v1::ListJobsRequest, v1::ListJobsResponse>(parts, "/weft.v1.JobService/ListJobs",
                                                              word, visit);
}

Opened open_job(ExchangeParts& parts, const Route&, const Query&, const std::string& word,
                Visit& visit) {
  return open_call<v1::GetJobRequest, v1::GetJobResponse>(parts, "/weft.v1.JobService/GetJob", word,
                                                          visit);
}

// A job that has not ended is ended first.
Opened open_deletion(ExchangeParts& parts, const Route&, const Query&, const std::string& word,
                     Visit& visit) {
  std::vector<UnaryCall> calls;
  calls.push_back(
      job_call<v1::CancelJobRequest, v1::CancelJobResponse>("/weft.v1.JobService/CancelJob", word));
  calls.push_back(
      job_call<v1::DeleteJobRequest, v1::DeleteJobResponse>("/weft.v1.JobService/DeleteJob", word));
  return open_calls(parts, std::move(calls), visit);
}

Opened open_description(ExchangeParts&, const Route&, const Query&, const std::string&, Visit&);

constexpr auto kDomain = static_cast<ParameterUses>(ParameterUse::kDomain);
constexpr auto kFile = static_cast<ParameterUses>(ParameterUse::kFile);
constexpr auto kWaiting = static_cast<ParameterUses>(ParameterUse::kWaiting);
constexpr auto kJob = static_cast<ParameterUses>(ParameterUse::kJob);
constexpr auto kArrival = static_cast<ParameterUses>(ParameterUse::kArrival);
constexpr auto kMesh = kDomain | kFile | kWaiting | kArrival;

constexpr Route kRoutes[] = {
    {{"put", "/v1/mesh", "Makes the mesh of the domain in the body", kMesh, true},
     http::verb::put,
     open_mesh<Purpose::kMesh>},
    {{"post", "/v1/mesh", "Makes the mesh of the domain in the body", kMesh, true},
     http::verb::post,
     open_mesh<Purpose::kMesh>},
    {{"put", "/v1/mesh/{name}", "The same for a file of that name", kMesh, true},
     http::verb::put,
     open_mesh<Purpose::kMesh>},
    {{"post", "/v1/mesh/{name}", "The same for a file of that name", kMesh, true},
     http::verb::post,
     open_mesh<Purpose::kMesh>},
    {{"post", "/v1/lint", "Finds the faults of the domain in the body", kDomain},
     http::verb::post,
     open_mesh<Purpose::kLint>},
    {{"post", "/v1/domain", "The domain in the body as a weft.v1.Domain, and its faults", kDomain},
     http::verb::post,
     open_mesh<Purpose::kDomain>},
    {{"post", "/v1/domain/{name}", "The same for a file of that name", kDomain},
     http::verb::post,
     open_mesh<Purpose::kDomain>},
    {{"post", "/v1/jobs", "Makes a job of the domain in the body", kDomain | kJob},
     http::verb::post,
     open_mesh<Purpose::kJob>},
    {{"get", "/v1/jobs", "The youngest jobs of the client, 100 at most"},
     http::verb::get,
     open_jobs},
    {{"get", "/v1/jobs/{id}", "A job, as it is now"}, http::verb::get, open_job},
    {{"delete", "/v1/jobs/{id}", "Ends a job, and deletes it"}, http::verb::delete_, open_deletion},
    {{"get", "/v1/jobs/{id}/mesh", "The mesh of a job that succeeded", kFile | kWaiting, true},
     http::verb::get,
     open_mesh<Purpose::kStored>},
    {{"get", "/v1/info", "Versions and limits of the server"}, http::verb::get, open_info},
    {{"get", "/v1/openapi.json", "This description"}, http::verb::get, open_description},
    {{"get", "/", "This description"}, http::verb::get, open_description},
};

Opened open_description(ExchangeParts&, const Route&, const Query&, const std::string&, Visit&) {
  static const std::string text = [] {
    std::vector<RouteText> texts;
    for (const Route& route : kRoutes) texts.push_back(route.text);
    return openapi(texts);
  }();
  return tl::unexpected(make_page(http::status::ok, "application/json", text));
}

// What stands in the path for the part of the route in braces, or "" if there is none; nullopt if
// the path is not that of the route. Such a part is not empty, and has no slash.
std::optional<std::string> word_in(std::string_view path, std::string_view route) {
  const auto brace = route.find('{');
  if (brace == route.npos) return path == route ? std::optional<std::string>("") : std::nullopt;
  const std::string_view end = route.substr(route.find('}') + 1);
  if (!path.starts_with(route.substr(0, brace)) || !path.ends_with(end) ||
      path.size() <= brace + end.size())
    return std::nullopt;
  const std::string_view word = path.substr(brace, path.size() - brace - end.size());
  return word.find('/') == word.npos ? std::optional<std::string>(word) : std::nullopt;
}

class AllRoutes final : public Routes {
 public:
  AllRoutes(SessionContext& context, const RouteOptions& options)
      : workers_(options.threads),
        meshes_(std::make_shared<Meshes>(options.meshes, options.file_bytes, options.client_share,
                                         workers_)),
        parts_{context, options.memory, options.folder, *meshes_, RefusalLog(options.log)} {}
  ~AllRoutes() override {
    workers_.finish();
    meshes_->close();
  }

  Opened open(Visit visit) override {
    const auto target = parse_target(visit.target);
    if (!target)
      return refuse(
          {.status = 400,
           .reason = "MALFORMED_REQUEST",
           .detail =
               "the target is not UTF-8 with percent signs before two hexadecimal digits each"});
    std::string allowed;
    for (const Route& route : kRoutes) {
      const auto word = word_in(target->path, route.text.path);
      if (!word) continue;
      if (route.method == visit.method)
        return route.open(parts_, route, target->query, *word, visit);
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
