// SPDX-License-Identifier: Apache-2.0
// Logs: lines on stderr, one per step of a call or a job, as key=value or as JSON. Bodies are never logged.
//
// Whoever logs writes key=value, strings by log_value; the JSON of a line has the same keys in the
// same order, with values that are written as numbers as numbers:
//   time=2026-01-02T03:04:05.678Z level=info event=call_ended call=1f-7 status=OK seconds=0.012
//   {"time":"2026-01-02T03:04:05.678Z","level":"info","event":"call_ended","call":"1f-7", ...}
#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>
#include <string_view>

namespace weft::server {

using Logger = std::shared_ptr<spdlog::logger>;

enum class LogFormat { kText, kJson };

// REQUIRES: level is one of trace, debug, info, warning, error, critical, off. Thread-safe.
Logger make_logger(std::string_view level, LogFormat format = LogFormat::kText);

// The value as a line may carry it: quoted, with escapes, where it is empty or holds a space, a
// quote, an equals sign or a control character, or would be read as a number.
std::string log_value(std::string_view value);

// gRPC's own warnings and errors become lines of the same form. Process-wide; call once, early.
void adopt_grpc_logs(LogFormat format = LogFormat::kText);

}  // namespace weft::server
