// SPDX-License-Identifier: Apache-2.0
#include "server/server_info.h"

#include <chrono>
#include <string>

#include "server/version.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

template <class Duration>
double to_seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

void add_limits(const ServerOptions& options, v1::ServerLimits& out) {
  const ServiceOptions& service = options.service;
  const Limits& limits = service.limits;
  for (const CountLimit& row : kCountLimits) {
    const auto* const field = out.GetDescriptor()->FindFieldByName(std::string(row.name));
    out.GetReflection()->SetUInt64(&out, field, limits.*row.limit);
  }
  out.set_max_expression_bytes(limits.max_expression_bytes);
  out.set_max_triangles(limits.max_triangles);
  out.set_max_bytes(limits.max_bytes);
  out.set_max_seconds(limits.max_seconds);
  out.set_max_request_bytes(limits.max_request_bytes);
  out.set_max_concurrent_jobs(service.jobs);
  out.set_max_min_angle_deg(kMaxMinAngleDeg);
  out.set_max_waiting_calls(service.queue);
  out.set_max_admitted_bytes(plan_memory(options).runs);
  out.set_stall_seconds(to_seconds(service.patience.stall_timeout));
}

void add_limits(const JobOptions& jobs, v1::JobLimits& out) {
  out.set_max_queued(jobs.service.max_queued);
  out.set_max_queued_per_client(jobs.service.max_open_of_client);
  out.set_max_attempts(jobs.retry.max_attempts);
  out.set_lease_seconds(to_seconds(jobs.runner.lease));
  out.set_keep_seconds(to_seconds(jobs.runner.keep.age));
  out.set_keep_bytes(jobs.runner.keep.bytes);
  out.set_keep_jobs_per_client(jobs.runner.keep.jobs_of_owner);
}

}  // namespace

v1::GetServerInfoResponse server_info(const ServerOptions& options, bool has_store) {
  v1::GetServerInfoResponse info;
  info.set_version(std::string(kVersion));
  info.set_engine_version(std::string(kEngineVersion));
  info.set_threads(options.service.threads);
  add_limits(options, *info.mutable_limits());
  if (has_store) add_limits(options.jobs, *info.mutable_jobs());
  return info;
}

}  // namespace weft::server
