// SPDX-License-Identifier: Apache-2.0
#include "client/report/job_text.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/call/server_error.h"
#include "client/report/mesh_text.h"
#include "client/report/progress_bar.h"
#include "files/base/text.h"
#include "google/rpc/error_details.pb.h"

namespace weft::client {
namespace {

using google::protobuf::util::TimeUtil;

const char* stage_key(v1::Stage stage) {
  switch (stage) {
    case v1::STAGE_QUEUED:
      return "queued";
    case v1::STAGE_TRIANGULATE:
      return "triangulate";
    case v1::STAGE_SIZE:
      return "size";
    case v1::STAGE_REFINE:
      return "refine";
    case v1::STAGE_EMIT:
      return "emit";
    default:
      return "unknown";
  }
}

Json error_json(const google::rpc::Status& error) {
  google::rpc::ErrorInfo info;
  Json fields = Json::array();
  for (const auto& detail : error.details()) {
    if (detail.Is<google::rpc::ErrorInfo>()) detail.UnpackTo(&info);
    google::rpc::BadRequest bad;
    if (detail.Is<google::rpc::BadRequest>() && detail.UnpackTo(&bad))
      for (const auto& violation : bad.field_violations()) fields.push_back(violation.field());
  }
  return {{"code", error.code()},
          {"reason", info.reason()},
          {"fields", std::move(fields)},
          {"message", error.message()}};
}

const char* callback_state_name(v1::CallbackState state) {
  switch (state) {
    case v1::CALLBACK_STATE_PENDING:
      return "pending";
    case v1::CALLBACK_STATE_DELIVERED:
      return "delivered";
    case v1::CALLBACK_STATE_FAILED:
      return "failed";
    default:
      return "unknown";
  }
}

// A line of a table: columns as wide as their longest cell, two blanks between them.
using Row = std::vector<std::string>;

// Rows of one length.
std::string aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line.append(row[i]).append(widths[i] - row[i].size() + 2, ' ');
    text.append(line, 0, line.find_last_not_of(' ') + 1).append("\n");
  }
  return text;
}

// `named`: with its client.
Row row_of(const v1::Job& job, bool named) {
  Row row = {harmless(job.id()), state_name(job.state()), time_text(job.create_time()), "", ""};
  if (job.has_progress()) {
    row[3] = std::to_string(std::lround(100 * done_of(job.progress()))) + " %";
    row[4] = with_separators(job.progress().triangles());
  }
  if (job.has_summary()) row[4] = with_separators(job.summary().triangles());
  if (named) row.push_back(harmless(job.client()));
  row.push_back(job.has_error() ? reason_of(job.error()) : "");
  return row;
}

}  // namespace

const char* state_name(v1::JobState state) {
  switch (state) {
    case v1::JOB_STATE_QUEUED:
      return "queued";
    case v1::JOB_STATE_RUNNING:
      return "running";
    case v1::JOB_STATE_SUCCEEDED:
      return "succeeded";
    case v1::JOB_STATE_FAILED:
      return "failed";
    case v1::JOB_STATE_CANCELLED:
      return "cancelled";
    default:
      return "unknown";
  }
}

std::string time_text(const google::protobuf::Timestamp& time) {
  google::protobuf::Timestamp to_the_second;
  to_the_second.set_seconds(time.seconds());
  return TimeUtil::ToString(to_the_second);
}

Json job_json(const v1::Job& job) {
  Json json = {{"id", job.id()}};
  if (!job.request_id().empty()) json["request_id"] = job.request_id();
  json["state"] = state_name(job.state());
  if (job.has_create_time()) json["create_time"] = TimeUtil::ToString(job.create_time());
  if (job.has_start_time()) json["start_time"] = TimeUtil::ToString(job.start_time());
  if (job.has_end_time()) json["end_time"] = TimeUtil::ToString(job.end_time());
  json["attempts"] = job.attempts();
  if (!job.worker().empty()) json["worker"] = job.worker();
  if (!job.client().empty()) json["client"] = job.client();
  json["from_store"] = job.from_store();
  if (const v1::Callback& callback = job.callback(); job.has_callback())
    json["callback"] = {{"url", callback.url()},
                        {"state", callback_state_name(callback.state())},
                        {"attempts", callback.attempts()},
                        {"error", callback.error()}};
  if (const v1::Progress& progress = job.progress(); job.has_progress())
    json["progress"] = {{"stage", stage_key(progress.stage())},
                        {"triangles", progress.triangles()},
                        {"expected_triangles", progress.expected_triangles()},
                        {"elapsed_seconds", progress.elapsed_seconds()},
                        {"fraction", progress.fraction()}};
  if (job.has_error()) json["error"] = error_json(job.error());
  if (job.has_summary()) json["summary"] = summary_json(job.summary());
  for (const v1::SizeWarning& warning : job.summary().size_warnings())
    json["warnings"].push_back(warning.message());
  if (job.summary().has_outside()) json["warnings"].push_back(outside_warning(job.summary()));
  return json;
}

std::string job_text(const v1::Job& job) {
  std::string text;
  const auto row = [&text](const char* name, const std::string& value) {
    constexpr std::size_t kWidth = 11;
    std::string label = name;
    label.resize(kWidth, ' ');
    text += label;
    for (const char c : value) {
      text += c;
      if (c == '\n') text.append(kWidth, ' ');
    }
    text += '\n';
  };
  row("id", harmless(job.id()));
  if (!job.request_id().empty()) row("request id", harmless(job.request_id()));
  row("state", state_name(job.state()));
  if (job.has_create_time()) row("created", time_text(job.create_time()));
  if (job.has_start_time()) row("started", time_text(job.start_time()));
  if (job.has_end_time()) row("ended", time_text(job.end_time()));
  if (job.attempts() > 0) row("attempts", std::to_string(job.attempts()));
  if (!job.worker().empty()) row("worker", harmless(job.worker()));
  if (!job.client().empty()) row("client", harmless(job.client()));
  if (job.from_store()) row("from store", "the mesh was kept already");
  if (const v1::Callback& callback = job.callback(); job.has_callback()) {
    row("callback", callback_state_name(callback.state()) + (": " + harmless(callback.url())));
    if (!callback.error().empty())
      row("", "attempt " + std::to_string(callback.attempts()) + ": " + harmless(callback.error()));
  }
  if (job.has_progress()) row("progress", progress_text(job.progress(), false));
  if (job.has_error()) {
    row("error", reason_of(job.error()));
    if (!job.error().message().empty()) row("", harmless(job.error().message()));
  }
  if (job.has_summary()) {
    std::string mesh = summary_text(job.summary());
    mesh.pop_back();
    row("mesh", mesh);
    row("digest", hex(job.summary().sha256()));
  }
  return text;
}

std::string job_table(std::span<const v1::Job> jobs) {
  const bool named = std::any_of(jobs.begin(), jobs.end(),
                                 [](const v1::Job& job) { return !job.client().empty(); });
  Row heading = {"ID", "STATE", "CREATED", "DONE", "TRIANGLES"};
  if (named) heading.push_back("CLIENT");
  heading.push_back("ERROR");
  std::vector<Row> rows = {heading};
  for (const v1::Job& job : jobs) rows.push_back(row_of(job, named));
  return aligned(rows);
}

v1::Progress progress_of(const v1::Job& job) {
  v1::Progress progress = job.progress();
  if (job.state() == v1::JOB_STATE_QUEUED) progress.set_stage(v1::STAGE_QUEUED);
  return progress;
}

std::optional<Error> job_error(const v1::Job& job, const RequestOrigin& origin) {
  constexpr int kCancelled = 1;
  constexpr int kFailedPrecondition = 9;
  const std::string name = "the job " + harmless(job.id());
  switch (job.state()) {
    case v1::JOB_STATE_SUCCEEDED:
      return std::nullopt;
    case v1::JOB_STATE_FAILED:
      return error_of(job.error(), name + " failed with", origin);
    case v1::JOB_STATE_CANCELLED:
      return Error{exit_code_of_status(kCancelled), name + " was cancelled"};
    default:
      return Error{exit_code_of_status(kFailedPrecondition),
                   name + " has not ended: it is " + state_name(job.state())};
  }
}

}  // namespace weft::client
