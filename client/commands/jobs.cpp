// SPDX-License-Identifier: Apache-2.0
// `weft get`, `weft list`, `weft cancel` and `weft delete`: one question, one answer.
#include <functional>
#include <optional>

#include "client/commands/commands.h"
#include "client/commands/job_commands.h"
#include "client/report/job_text.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

Json jobs_json(const std::vector<v1::Job>& jobs) {
  Json list = Json::array();
  for (const v1::Job& job : jobs) list.push_back(job_json(job));
  return {{"jobs", std::move(list)}};
}

// Calls for every id, even if some calls fail.
Result<void> for_each(const std::vector<std::string>& ids, const std::stop_token& stop,
                      const std::function<Result<void>(const std::string&)>& call) {
  std::optional<Error> failed;
  for (const std::string& id : ids) {
    if (stop.stop_requested()) return fail(ExitCode::kInternal, "interrupted");
    const auto done = call(id);
    if (done) continue;
    if (!failed) {
      failed = done.error();
      if (ids.size() > 1) failed->message = "job " + in_quotes(id) + ": " + failed->message;
    } else {
      failed->message += "\njob " + in_quotes(id) + ": " + done.error().message;
    }
  }
  if (failed) return tl::unexpected(*failed);
  return {};
}

}  // namespace

Result<ExitCode> run_get(const JobOptions& options, std::stop_token stop) {
  auto server = JobServer::connect(options.calls, std::move(stop));
  if (!server) return tl::unexpected(server.error());
  const auto job = server->get(options.id);
  if (!job) return tl::unexpected(job.error());
  return print(options.json ? json_line(job_json(*job)) : job_text(*job));
}

Result<ExitCode> run_list(const ListOptions& options, std::stop_token stop) {
  auto server = JobServer::connect(options.calls, std::move(stop));
  if (!server) return tl::unexpected(server.error());
  const auto jobs = server->list(options.states, options.limit);
  if (!jobs) return tl::unexpected(jobs.error());
  return print(options.json ? json_line(jobs_json(*jobs)) : job_table(*jobs));
}

Result<ExitCode> run_cancel(const JobsOptions& options, std::stop_token stop) {
  auto server = JobServer::connect(options.calls, stop);
  if (!server) return tl::unexpected(server.error());
  std::vector<v1::Job> jobs;
  const auto done = for_each(options.ids, stop, [&](const std::string& id) -> Result<void> {
    auto job = server->cancel(id);
    if (!job) return tl::unexpected(job.error());
    jobs.push_back(std::move(*job));
    return {};
  });
  std::string text;
  for (const v1::Job& job : jobs) text += harmless(job.id()) + " " + state_name(job.state()) + "\n";
  const auto printed = print(options.json ? json_line(jobs_json(jobs)) : text);
  if (!done) return tl::unexpected(done.error());
  return printed;
}

Result<ExitCode> run_delete(const JobsOptions& options, std::stop_token stop) {
  auto server = JobServer::connect(options.calls, stop);
  if (!server) return tl::unexpected(server.error());
  std::string text;
  Json ids = Json::array();
  const auto done = for_each(options.ids, stop, [&](const std::string& id) -> Result<void> {
    auto removed = server->remove(id);
    if (!removed) return removed;
    text += id + " deleted\n";
    ids.push_back(id);
    return {};
  });
  const auto printed = print(options.json ? json_line({{"deleted", std::move(ids)}}) : text);
  if (!done) return tl::unexpected(done.error());
  return printed;
}

}  // namespace weft::client
