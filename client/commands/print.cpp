// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "client/commands/commands.h"

namespace weft::client {

Result<ExitCode> print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    return fail(ExitCode::kUnwritableOutput,
                std::string("standard output: ") + std::strerror(errno));
  return ExitCode::kOk;
}

}  // namespace weft::client
