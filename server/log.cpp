// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <grpc/support/log.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace weft::server {
namespace {

void log_grpc(gpr_log_func_args* args) {
  if (args->severity == GPR_LOG_SEVERITY_DEBUG) return;
  const char* level = args->severity == GPR_LOG_SEVERITY_ERROR ? "error" : "info";
  const auto now =
      std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const std::string line =
      fmt::format("time={:%FT%T}.{:03}Z level={} event=grpc message={}\n",
                  std::chrono::time_point_cast<std::chrono::seconds>(now),
                  now.time_since_epoch().count() % 1000, level, log_value(args->message));
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

Logger make_logger(std::string_view level) {
  auto logger =
      std::make_shared<spdlog::logger>("weftd", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_formatter(std::make_unique<spdlog::pattern_formatter>(
      "time=%Y-%m-%dT%H:%M:%S.%eZ level=%l %v", spdlog::pattern_time_type::utc));
  logger->set_level(spdlog::level::from_str(std::string(level)));
  return logger;
}

std::string log_value(std::string_view value) {
  const auto special = [](char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == '"' || c == '=' || c == '\\' || c == 0x7f;
  };
  if (!value.empty() && std::none_of(value.begin(), value.end(), special))
    return std::string(value);
  std::string out;
  out += '"';
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  out += '"';
  return out;
}

void adopt_grpc_logs() {
  gpr_set_log_function(log_grpc);
}

}  // namespace weft::server
