// SPDX-License-Identifier: Apache-2.0
#include "client/jobs/top_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "client/jobs/job_text.h"
#include "client/progress_bar.h"
#include "client/server_error.h"
#include "client/text.h"

namespace weft::client {
namespace {

std::string rate_text(double per_second) {
  constexpr double kMost = 1e15;  // beyond it only what a server made up
  return with_separators(static_cast<std::uint64_t>(std::llround(std::min(per_second, kMost)))) +
         " triangles/s";
}

// How long the job was at work; empty where it never was.
std::string time_taken(const v1::Job& job) {
  if (!job.has_start_time() || !job.has_end_time()) return "";
  const auto seconds = [](const google::protobuf::Timestamp& time) {
    return static_cast<double>(time.seconds()) + time.nanos() / 1e9;
  };
  return seconds_text(seconds(job.end_time()) - seconds(job.start_time()));
}

std::string outcome_of(const v1::Job& job) {
  if (job.has_error()) return reason_of(job.error());
  return job.from_store() ? "from store" : time_taken(job);
}

// Older first.
bool ended_before(const v1::Job* a, const v1::Job* b) {
  return std::pair(a->end_time().seconds(), a->end_time().nanos()) <
         std::pair(b->end_time().seconds(), b->end_time().nanos());
}

void cut(std::string& line, std::size_t columns) {
  if (line.size() <= columns) return;
  std::size_t end = columns;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xc0) == 0x80) --end;
  line.resize(end);
}

}  // namespace

TopSample top_sample(double at_seconds, v1::GetServerInfoResponse info, std::vector<v1::Job> open,
                     std::vector<v1::Job> ended) {
  std::set<std::string> ids;
  for (const v1::Job& job : ended) ids.insert(job.id());
  // A job that ended between the two lists is in both.
  std::erase_if(open, [&ids](const v1::Job& job) { return ids.contains(job.id()); });
  std::ranges::move(ended, std::back_inserter(open));
  return {.at_seconds = at_seconds, .jobs = std::move(open), .info = std::move(info)};
}

void TopView::add(TopSample sample) {
  const double passed = sample.at_seconds - sample_.at_seconds;
  const bool comparable = !sample_.info.version().empty() && passed > 0;
  std::map<std::string, Growth> growth;
  for (const v1::Job& job : sample.jobs) {
    if (job.state() != v1::JOB_STATE_RUNNING) continue;
    Growth& now = growth[job.id()];
    now.triangles = job.progress().triangles();
    // A job that was not at work before began with none; an attempt that is begun anew, too.
    const auto before = growth_.find(job.id());
    const std::uint64_t had = before == growth_.end() ? 0 : before->second.triangles;
    if (comparable && now.triangles > had)
      now.per_second = static_cast<double>(now.triangles - had) / passed;
  }
  growth_ = std::move(growth);
  compared_ = comparable;
  sample_ = std::move(sample);
}

std::vector<std::string> TopView::head() const {
  const v1::GetServerInfoResponse& info = sample_.info;
  std::string counts;
  for (const v1::JobState state :
       {v1::JOB_STATE_QUEUED, v1::JOB_STATE_RUNNING, v1::JOB_STATE_SUCCEEDED, v1::JOB_STATE_FAILED,
        v1::JOB_STATE_CANCELLED}) {
    const auto count = std::ranges::count_if(
        sample_.jobs, [&](const v1::Job& job) { return job.state() == state; });
    counts += std::string(state_name(state)) + " " +
              with_separators(static_cast<std::uint64_t>(count)) +
              (sample_.ended_left_out && is_final(state) ? "+" : "") + "  ";
  }
  double rate = 0;
  for (const auto& [id, growth] : growth_) rate += growth.per_second;
  counts += compared_ ? rate_text(rate) : "";
  counts.erase(counts.find_last_not_of(' ') + 1);
  std::vector<std::string> lines = {"weftd " + harmless(info.version()) + " at " + address_ +
                                        ", engine " + harmless(info.engine_version()) + ", " +
                                        std::to_string(info.threads()) +
                                        (info.threads() == 1 ? " thread" : " threads"),
                                    counts};
  if (!problem_.empty()) lines.push_back(problem_);
  return lines;
}

std::vector<std::string> TopView::running() const {
  std::vector<std::string> lines;
  for (const v1::Job& job : sample_.jobs) {
    if (job.state() != v1::JOB_STATE_RUNNING) continue;
    std::string line = harmless(job.id()) + "  " + progress_text(job.progress(), true);
    if (const auto growth = growth_.find(job.id());
        growth != growth_.end() && growth->second.per_second > 0)
      line += ", " + rate_text(growth->second.per_second);
    lines.push_back(std::move(line));
  }
  // The list has the youngest first; who was first at work is first here.
  std::ranges::reverse(lines);
  return lines;
}

std::vector<std::string> TopView::ended(std::size_t most) const {
  std::vector<const v1::Job*> jobs;
  for (const v1::Job& job : sample_.jobs)
    if (is_final(job.state())) jobs.push_back(&job);
  std::ranges::sort(jobs, [](const v1::Job* a, const v1::Job* b) { return ended_before(b, a); });
  if (jobs.size() > most) jobs.resize(most);
  std::vector<std::string> lines;
  for (const v1::Job* job : jobs) {
    std::string state = state_name(job->state());
    state.resize(std::string_view("succeeded").size(), ' ');
    std::string line = harmless(job->id()) + "  " + state + "  " + time_text(job->end_time()) +
                       "  " + outcome_of(*job);
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string TopView::text(const std::optional<ScreenSize>& size) const {
  constexpr std::size_t kMostEnded = 10;
  std::vector<std::string> lines = head();
  const auto append = [&lines](const char* heading, std::vector<std::string> table) {
    if (table.empty()) return;
    lines.insert(lines.end(), {"", heading});
    lines.insert(lines.end(), table.begin(), table.end());
  };
  append("AT WORK", running());
  append("ENDED", ended(kMostEnded));
  if (size && lines.size() > size->lines) lines.resize(size->lines);
  std::string text;
  for (std::string& line : lines) {
    std::ranges::replace(line, '\n', ' ');
    if (size) cut(line, size->columns);
    text.append(line).append("\n");
  }
  return text;
}

}  // namespace weft::client
