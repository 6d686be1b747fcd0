// SPDX-License-Identifier: Apache-2.0
#include "client/report/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "client/base/files.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

const char* stage_name(v1::Stage stage) {
  switch (stage) {
    case v1::STAGE_QUEUED:
      return "waiting";
    case v1::STAGE_TRIANGULATE:
      return "triangulating";
    case v1::STAGE_SIZE:
      return "sizing";
    case v1::STAGE_REFINE:
      return "refining";
    case v1::STAGE_EMIT:
      return "receiving";
    default:
      return "working";
  }
}

}  // namespace

ProgressStyle progress_style_of(std::FILE* stream) {
  return ::isatty(::fileno(stream)) ? ProgressStyle::kBar : ProgressStyle::kLines;
}

double done_of(const v1::Progress& progress) {
  return progress.fraction() > 0 ? std::min(progress.fraction(), 1.0) : 0;
}

std::string progress_text(const v1::Progress& progress, bool with_bar) {
  std::string text = stage_name(progress.stage());
  const bool estimated = progress.expected_triangles() > 0;
  const double done = done_of(progress);
  if (with_bar && estimated) {
    constexpr std::size_t kWidth = 30;
    const auto filled = static_cast<std::size_t>(done * kWidth);
    text.append(" [").append(filled, '#').append(kWidth - filled, '.').append("]");
  }
  if (!with_bar && done > 0) text += ", " + std::to_string(std::lround(100 * done)) + " % done";
  if (progress.triangles() > 0) {
    text += (with_bar ? " " : ", ") + with_separators(progress.triangles()) +
            (progress.triangles() == 1 ? " triangle so far" : " triangles so far");
  } else if (estimated) {
    text += (with_bar ? " about " : ", about ") + with_separators(progress.expected_triangles()) +
            " triangles expected";
  }
  return text;
}

void ProgressBar::update(const v1::Progress& progress) {
  constexpr auto kBetweenLines = std::chrono::seconds(5);
  const bool new_stage = progress.stage() != stage_;
  stage_ = progress.stage();
  if (style_ == ProgressStyle::kBar) {
    std::fprintf(stream_, "\r\033[K%s", progress_text(progress, true).c_str());
    std::fflush(stream_);
    shown_ = true;
  } else if (style_ == ProgressStyle::kLines &&
             (new_stage || Clock::now() - last_line_ >= kBetweenLines)) {
    last_line_ = Clock::now();
    std::fprintf(stream_, "weft: %s\n", progress_text(progress, false).c_str());
  }
}

void ProgressBar::say(const std::string& what) {
  if (style_ == ProgressStyle::kBar) {
    std::fprintf(stream_, "\r\033[K%s", what.c_str());
    std::fflush(stream_);
    shown_ = true;
  } else if (style_ == ProgressStyle::kLines) {
    std::fprintf(stream_, "weft: %s\n", what.c_str());
  }
}

void ProgressBar::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stream_);
  std::fflush(stream_);
  shown_ = false;
}

}  // namespace weft::client
