// SPDX-License-Identifier: Apache-2.0
// The view of `weft top`: counts by state, running jobs, throughput, and the jobs that ended last.
// It uses no terminal and no clock: it turns samples into lines.
//
// Throughput is the growth of the triangles of jobs from one sample to the next: of running jobs,
// and of those that ended in between. Jobs that share their work count once each.
//
//   TopView view;
//   view.add({.at_seconds = 0, .jobs = ..., .info = ...});
//   view.add({.at_seconds = 1, .jobs = ..., .info = ...});
//   print(view.text({.columns = 80, .lines = 24}));
//
// Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/report/screen_size.h"
#include "weft/v1/job_service.pb.h"

namespace weft::client {

struct TopSample {
  double at_seconds = 0;        // of a clock that never goes back
  std::vector<v1::Job> jobs{};  // those that have not ended, and the youngest that have
  v1::GetServerInfoResponse info{};
  std::set<v1::JobState> left_out{};  // final states that have older jobs, too
};

// Makes a sample of the lists `open` and `ended`, which were requested one after the other.
TopSample top_sample(double at_seconds, v1::GetServerInfoResponse info, std::vector<v1::Job> open,
                     std::vector<v1::Job> ended);

class TopView {
 public:
  explicit TopView(std::string address) : address_(std::move(address)) {}

  void add(TopSample sample);
  // Sets the problem of the last poll of the server; empty: none.
  void set_problem(std::string problem) { problem_ = std::move(problem); }

  // Lines that end in line feeds, cut between two fields to fit the size; without a size, all
  // lines, uncut.
  std::string text(const std::optional<ScreenSize>& size) const;

 private:
  struct Growth {
    std::uint64_t triangles = 0;
    double per_second = 0;
  };

  std::vector<std::string> head() const;
  std::vector<std::string> running() const;
  std::vector<std::string> ended(std::size_t most) const;

  // Triangles made since the last sample by jobs that ended since then.
  std::uint64_t ended_growth(const TopSample& sample) const;

  std::string address_;
  std::string problem_;
  TopSample sample_;
  double ended_per_second_ = 0;
  bool compared_ = false;                 // whether there are two samples
  std::map<std::string, Growth> growth_;  // of running jobs, by id
};

}  // namespace weft::client
