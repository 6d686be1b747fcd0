// SPDX-License-Identifier: Apache-2.0
// Logs: lines on stderr, one per step of a call or a job, as key=value or as JSON. Bodies are never
// logged.
//
// Code logs key=value, with strings by log_value. The JSON of a line has the same keys in the same
// order; a value that looks like a number is a JSON number:
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

// The value for a log line: quoted, with escapes, if it is empty, contains a space, a quote, an
// equals sign or a control character, or would be read as a number.
std::string log_value(std::string_view value);

// Turns gRPC's own warnings and errors into lines of the same form. Process-wide; call once, early.
void adopt_grpc_logs(LogFormat format = LogFormat::kText);

}  // namespace weft::server
