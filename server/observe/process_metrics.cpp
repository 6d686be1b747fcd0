// SPDX-License-Identifier: Apache-2.0
#include "server/observe/process_metrics.h"

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>

namespace weft::server {
namespace {

using prometheus::MetricType;

prometheus::MetricFamily family(const char* name, const char* help, MetricType type, double value) {
  prometheus::ClientMetric metric;
  if (type == MetricType::Counter) metric.counter.value = value;
  if (type == MetricType::Gauge) metric.gauge.value = value;
  return {name, help, type, {metric}};
}

// Fields of /proc/self/stat, by their numbers in proc(5).
class Stat {
 public:
  static std::optional<Stat> read() {
    std::ifstream in("/proc/self/stat");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    // The name of the program, in brackets, may hold anything.
    const std::size_t name_end = text.rfind(')');
    if (name_end == std::string::npos) return std::nullopt;
    std::istringstream rest(text.substr(name_end + 1));
    std::string state;
    rest >> state;
    Stat stat;
    for (std::size_t number = 4; number < stat.fields_.size(); ++number)
      if (!(rest >> stat.fields_[number])) return std::nullopt;
    return stat;
  }
  double field(std::size_t number) const { return fields_[number]; }

 private:
  std::array<double, 25> fields_{};
};

// Seconds since 1970 at which the machine was started.
std::optional<double> boot_time() {
  std::ifstream in("/proc/stat");
  std::string word;
  double seconds = 0;
  while (in >> word)
    if (word == "btime" && in >> seconds) return seconds;
  return std::nullopt;
}

std::optional<double> open_descriptors() {
  std::error_code error;
  std::filesystem::directory_iterator each("/proc/self/fd", error);
  if (error) return std::nullopt;
  double count = -1;  // the open folder itself is not counted
  for (const std::filesystem::directory_iterator end; each != end; each.increment(error)) ++count;
  return count;
}

}  // namespace

std::vector<prometheus::MetricFamily> process_metrics() {
  std::vector<prometheus::MetricFamily> families;
  const auto add = [&families](const char* name, const char* help, MetricType type, double value) {
    families.push_back(family(name, help, type, value));
  };
  if (const auto stat = Stat::read()) {
    const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
    add("process_cpu_seconds_total", "Processor time, of user and system", MetricType::Counter,
        (stat->field(14) + stat->field(15)) / ticks);
    add("process_threads", "Threads", MetricType::Gauge, stat->field(20));
    add("process_virtual_memory_bytes", "Size of the address space", MetricType::Gauge,
        stat->field(23));
    add("process_resident_memory_bytes", "Memory that is in use", MetricType::Gauge,
        stat->field(24) * static_cast<double>(::sysconf(_SC_PAGESIZE)));
    if (const auto boot = boot_time())
      add("process_start_time_seconds", "Time of the start, in seconds since 1970",
          MetricType::Gauge, *boot + stat->field(22) / ticks);
  }
  if (const auto count = open_descriptors())
    add("process_open_fds", "File descriptors that are open", MetricType::Gauge, *count);
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0)
    add("process_max_fds", "Maximum number of open file descriptors", MetricType::Gauge,
        static_cast<double>(limit.rlim_cur));
  return families;
}

}  // namespace weft::server
