// SPDX-License-Identifier: Apache-2.0
// The commands of `weft` on jobs that a server keeps. They follow the rules of commands.h; all of
// them need a named server.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "client/call/job_server.h"
#include "client/call/mesh_request.h"
#include "client/report/mesh_output.h"
#include "files/base/data_path.h"
#include "files/base/error.h"
#include "files/formats/layer_options.h"

namespace weft::client {

struct SubmitOptions {
  DataPath input;
  LayerOptions layers;
  RequestOptions request_options;
  MeshOutputOptions output;  // needs `wait`
  std::string request_id;    // empty: a random one
  std::string notify;        // empty: what the server has for the client
  bool wait = false;
  CallOptions calls;
  bool json = false;
  bool quiet = false;
};
Result<ExitCode> run_submit(const SubmitOptions& options, std::stop_token stop);

struct FetchOptions {
  std::string id;
  MeshOutputOptions output;
  std::optional<std::filesystem::path> domain;  // that was submitted
  LayerOptions layers;                          // of the domain
  bool wait = false;
  CallOptions calls;
  bool json = false;
  bool quiet = false;
};
Result<ExitCode> run_fetch(const FetchOptions& options, std::stop_token stop);

struct JobOptions {
  std::string id;
  CallOptions calls;
  bool json = false;
};
Result<ExitCode> run_get(const JobOptions& options, std::stop_token stop);
Result<ExitCode> run_watch(const JobOptions& options, std::stop_token stop);

struct JobsOptions {
  std::vector<std::string> ids;
  CallOptions calls;
  bool json = false;
};
// Tries all; the exit code is that of the first failure.
Result<ExitCode> run_cancel(const JobsOptions& options, std::stop_token stop);
Result<ExitCode> run_delete(const JobsOptions& options, std::stop_token stop);

struct ListOptions {
  std::vector<v1::JobState> states;    // empty: all
  std::optional<std::uint64_t> limit;  // DEFAULT: all
  CallOptions calls;
  bool json = false;
};
Result<ExitCode> run_list(const ListOptions& options, std::stop_token stop);

struct TopOptions {
  double interval_seconds = 1;
  bool once = false;
  CallOptions calls;  // the time-out is that of each poll of the server
};
Result<ExitCode> run_top(const TopOptions& options, std::stop_token stop);

}  // namespace weft::client
