// SPDX-License-Identifier: GPL-3.0-or-later
// Logs: key=value lines on stderr, one per job transition. Bodies are never logged.
#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>
#include <string_view>

namespace weft::server {

using Logger = std::shared_ptr<spdlog::logger>;

// REQUIRES: level is one of trace, debug, info, warning, error, critical, off. Thread-safe.
Logger make_logger(std::string_view level);

// The value as a line may carry it: quoted, with escapes, where it is empty or holds a space, a
// quote, an equals sign or a control character.
std::string log_value(std::string_view value);

// gRPC's own warnings and errors become lines of the same form. Process-wide; call once, early.
void adopt_grpc_logs();

}  // namespace weft::server
