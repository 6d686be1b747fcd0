// SPDX-License-Identifier: Apache-2.0
// The exit codes of `weft`. `weft --help` prints this table.
//
//   0        all went well
//   1        a fault of weft itself
//   2        the command line is wrong
//   3        `weft check` or `weft batch` ran, and a mesh fails; `weft lint` found faults
//   4        the input is missing, unreadable or malformed
//   5        the output cannot be written (nothing is left behind)
//   6        the private weftd could not be found or started
//   64 + n   the call to the server, or the job that was waited for, ended with gRPC status n: 65
//            the job was cancelled, 67 the request is wrong, 68 a deadline passed, 69 there is no
//            such job, 72 a limit or budget was exceeded, 73 the mesh misses its bounds, or the job
//            has not ended, 78 the server is absent or went away, 79 the stream was damaged, 80 the
//            token is missing or wrong
//   128 + n  stopped by signal n
#pragma once

namespace weft::files {

enum class ExitCode : int {
  kOk = 0,
  kInternal = 1,
  kUsage = 2,
  kCheckFailed = 3,
  kUnreadableInput = 4,
  kUnwritableOutput = 5,
  kServerNotStarted = 6,
  kFirstServerStatus = 64,
  kDataLoss = 64 + 15,
};

// REQUIRES: a gRPC status code, 1 to 16.
constexpr ExitCode exit_code_of_status(int grpc_code) {
  return static_cast<ExitCode>(static_cast<int>(ExitCode::kFirstServerStatus) + grpc_code);
}

}  // namespace weft::files
