// SPDX-License-Identifier: Apache-2.0
// The metrics that every process exports to Prometheus, under the usual names:
// process_cpu_seconds_total, process_resident_memory_bytes, process_open_fds and so on. Values that
// /proc does not have are left out.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

namespace weft::server {

std::vector<prometheus::MetricFamily> process_metrics();

}  // namespace weft::server
