// SPDX-License-Identifier: Apache-2.0
// Shows on stderr how far a job is: a bar that redraws itself on a terminal, otherwise one plain
// line per stage and one every few seconds.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

enum class ProgressStyle { kNone, kLines, kBar };

// kBar if the stream is a terminal, kLines if it is not.
ProgressStyle progress_style_of(std::FILE* stream);

class ProgressBar {
 public:
  ProgressBar(std::FILE* stream, ProgressStyle style) : stream_(stream), style_(style) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(const v1::Progress& progress);
  // Shows work that is not a job of the server: "reading coast.poly".
  void say(const std::string& what);
  // Removes the bar from the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::FILE* stream_;
  ProgressStyle style_;
  v1::Stage stage_ = v1::STAGE_UNSPECIFIED;
  Clock::time_point last_line_ = Clock::now();
  bool shown_ = false;
};

// Progress.fraction, made valid: a number from 0 to 1.
double done_of(const v1::Progress& progress);

// "refining [#####.....] 720,000 triangles so far", or without a bar "refining, 50 % done, 720,000
// triangles so far". Bar and percentage show the work, a third of which follows when most triangles
// are made; so triangles are not shown as a share of the expected number.
std::string progress_text(const v1::Progress& progress, bool with_bar);

}  // namespace weft::client
