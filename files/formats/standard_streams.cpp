// SPDX-License-Identifier: Apache-2.0
#include "files/formats/standard_streams.h"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "files/base/atomic_file.h"
#include "files/base/stream_copy.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::files {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 30;  // the largest limit of a reader

bool needs_name(const DataPath& file) {
  const DomainFormat* const domain = domain_format(file);
  const MeshFormat* const mesh = mesh_format(file);
  return domain != nullptr ? domain->needs_name : mesh != nullptr && mesh->needs_name;
}

tl::unexpected<Error> unreadable(int problem) {
  const std::string why = problem == ECANCELED ? "interrupted"
                          : problem == EFBIG
                              ? "has more than " + std::to_string(kMaxBytes) + " bytes"
                              : std::strerror(problem);
  return fail(ExitCode::kUnreadableInput, "standard input: " + why);
}

}  // namespace

Result<void> take_standard_input(const DataPath& file, const std::stop_token& stop) {
  if (file != kStandardInput) return {};
  if (file.format.empty())
    return fail(ExitCode::kUsage, "standard input needs a format: --from FORMAT, one of " +
                                      domain_extensions() + ", " + read_mesh_extensions());
  if (needs_name(file))
    return fail(ExitCode::kUsage,
                "standard input cannot be a " + file.format + ", which is read by its name");
  std::error_code ignored;
  const auto taken = open_unlinked(std::filesystem::temp_directory_path(ignored));
  if (!taken) return tl::unexpected(taken.error());
  if (const int problem = copy_stream(STDIN_FILENO, taken->get(), stop, kMaxBytes))
    return unreadable(problem);
  if (::dup2(taken->get(), STDIN_FILENO) < 0) return unreadable(errno);
  return {};
}

Result<void> check_has_format(const DataPath& file, const std::string& formats) {
  if (file != kStandardOutput || !file.format.empty()) return {};
  return fail(ExitCode::kUsage, "standard output needs a format: --to FORMAT, one of " + formats);
}

}  // namespace weft::files
