// SPDX-License-Identifier: Apache-2.0
#include "server/observe/log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <grpc/support/log.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "server/observe/log_json.h"

namespace weft::server {
namespace {

std::string line_of(std::chrono::system_clock::time_point time, std::string_view level,
                    std::string_view fields) {
  const auto milliseconds = std::chrono::floor<std::chrono::milliseconds>(time);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(milliseconds);
  return fmt::format("time={:%FT%T}.{:03}Z level={} {}", seconds, (milliseconds - seconds).count(),
                     level, fields);
}

class Formatter final : public spdlog::formatter {
 public:
  explicit Formatter(LogFormat format) : format_(format) {}
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    const auto level = spdlog::level::to_string_view(message.level);
    std::string line = line_of(message.time, {level.data(), level.size()},
                               {message.payload.data(), message.payload.size()});
    if (format_ == LogFormat::kJson) line = json_of_fields(line);
    line += '\n';
    out.append(line.data(), line.data() + line.size());
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<Formatter>(format_);
  }

 private:
  const LogFormat format_;
};

// gRPC passes its messages to a function without a context, so the format is a template argument.
template <LogFormat kFormat>
void log_grpc(gpr_log_func_args* args) {
  if (args->severity == GPR_LOG_SEVERITY_DEBUG) return;
  std::string line = line_of(std::chrono::system_clock::now(),
                             args->severity == GPR_LOG_SEVERITY_ERROR ? "error" : "info",
                             "event=grpc message=" + log_value(args->message));
  if (kFormat == LogFormat::kJson) line = json_of_fields(line);
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

Logger make_logger(std::string_view level, LogFormat format) {
  auto logger =
      std::make_shared<spdlog::logger>("weftd", std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_formatter(std::make_unique<Formatter>(format));
  logger->set_level(spdlog::level::from_str(std::string(level)));
  return logger;
}

std::string log_value(std::string_view value) {
  const auto special = [](char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == '"' || c == '=' || c == '\\' || c == 0x7f;
  };
  if (!value.empty() && !is_number(value) && std::none_of(value.begin(), value.end(), special))
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

void adopt_grpc_logs(LogFormat format) {
  gpr_set_log_function(format == LogFormat::kJson ? log_grpc<LogFormat::kJson>
                                                  : log_grpc<LogFormat::kText>);
}

}  // namespace weft::server
