// SPDX-License-Identifier: Apache-2.0
#include "client/report/top_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "client/call/server_error.h"
#include "client/report/job_text.h"
#include "client/report/progress_bar.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

std::string rate_text(double per_second) {
  constexpr double kMax = 1e15;  // more than this only a faulty server reports
  return with_separators(static_cast<std::uint64_t>(std::llround(std::min(per_second, kMax)))) +
         " triangles/s";
}

// How long the job was at work; empty if it never was.
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

std::pair<std::int64_t, std::int32_t> when(const google::protobuf::Timestamp& time) {
  return {time.seconds(), time.nanos()};
}

// Whether it is older.
bool ended_before(const v1::Job* a, const v1::Job* b) {
  return when(a->end_time()) < when(b->end_time());
}

// Half a number, or a number without its unit, misleads. So the line is cut at the last comma or
// gap if that keeps half of it, otherwise at the last space.
void cut(std::string& line, std::size_t columns) {
  if (line.size() <= columns) return;
  std::size_t end = columns;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xc0) == 0x80) --end;
  const auto last = [&](const char* separator) {
    const std::size_t found = line.rfind(separator, end);
    return found == std::string::npos ? 0 : found;
  };
  const std::size_t field = std::max(last(", "), last("  "));
  const std::size_t word = last(" ");
  if (2 * field >= columns) {
    end = field;
  } else if (word > 0) {
    end = word;
  }
  line.resize(end);
  line.erase(line.find_last_not_of(" ,") + 1);
}

}  // namespace

TopSample top_sample(double at_seconds, v1::GetServerInfoResponse info, std::vector<v1::Job> open,
                     std::vector<v1::Job> ended) {
  std::set<std::string> ids;
  for (const v1::Job& job : ended) ids.insert(job.id());
  // A job that ended between the two lists is in both of them.
  std::erase_if(open, [&ids](const v1::Job& job) { return ids.contains(job.id()); });
  std::ranges::move(ended, std::back_inserter(open));
  return {.at_seconds = at_seconds, .jobs = std::move(open), .info = std::move(info)};
}

std::uint64_t TopView::ended_growth(const TopSample& sample) const {
  std::set<std::string> ended_before_it;
  std::pair<std::int64_t, std::int32_t> youngest{};
  for (const v1::Job& job : sample_.jobs) {
    youngest = std::max(youngest, when(job.create_time()));
    if (is_final(job.state())) ended_before_it.insert(job.id());
  }
  std::uint64_t triangles = 0;
  for (const v1::Job& job : sample.jobs) {
    if (job.state() != v1::JOB_STATE_SUCCEEDED || job.from_store()) continue;
    const auto known = growth_.find(job.id());
    // A job that was not at work is new, or was waiting. Older ones that enter the list because
    // others were deleted are neither.
    const bool waited = std::ranges::any_of(sample_.jobs, [&](const v1::Job& before) {
      return before.id() == job.id() && !is_final(before.state());
    });
    const bool is_new = when(job.create_time()) > youngest;
    if (ended_before_it.contains(job.id()) || !(waited || is_new)) continue;
    const std::uint64_t had = known == growth_.end() ? 0 : known->second.triangles;
    triangles += job.summary().triangles() - std::min(had, job.summary().triangles());
  }
  return triangles;
}

void TopView::add(TopSample sample) {
  const double passed = sample.at_seconds - sample_.at_seconds;
  const bool comparable = !sample_.info.version().empty() && passed > 0;
  std::map<std::string, Growth> growth;
  for (const v1::Job& job : sample.jobs) {
    if (job.state() != v1::JOB_STATE_RUNNING) continue;
    Growth& now = growth[job.id()];
    now.triangles = job.progress().triangles();
    // A job that was not at work before counts from zero; so does a new attempt.
    const auto before = growth_.find(job.id());
    const std::uint64_t had = before == growth_.end() ? 0 : before->second.triangles;
    if (comparable && now.triangles > had)
      now.per_second = static_cast<double>(now.triangles - had) / passed;
  }
  ended_per_second_ = comparable ? static_cast<double>(ended_growth(sample)) / passed : 0;
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
              (sample_.left_out.contains(state) ? "+" : "") + "  ";
  }
  double rate = ended_per_second_;
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
  // The list begins with the youngest; here the one that has been at work for longest comes first.
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
  constexpr std::size_t kMaxEnded = 10;
  std::vector<std::string> lines = head();
  const auto append = [&lines](const char* heading, std::vector<std::string> table) {
    if (table.empty()) return;
    lines.insert(lines.end(), {"", heading});
    lines.insert(lines.end(), table.begin(), table.end());
  };
  append("AT WORK", running());
  append("ENDED", ended(kMaxEnded));
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
