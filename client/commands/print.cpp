// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "client/commands/commands.h"

namespace weft::client {

Result<ExitCode> print(const std::string& text, std::FILE* to) {
  if (std::fwrite(text.data(), 1, text.size(), to) != text.size() || std::fflush(to) != 0)
    return fail(ExitCode::kUnwritableOutput,
                std::string(to == stdout ? "standard output: " : "standard error: ") +
                    std::strerror(errno));
  return ExitCode::kOk;
}

}  // namespace weft::client
