// SPDX-License-Identifier: Apache-2.0
// Domains of the C interface (weft/c.h), by the readers of files/.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/c/c_error.h"
#include "files/formats/domain_formats.h"
#include "files/message/domain_message.h"
#include "weft/c.h"

struct weft_domain {
  struct Warning {
    std::string kind;
    std::string sentence;
  };

  std::string message;  // a weft.v1.Domain
  std::vector<Warning> warnings;
  std::optional<bool> is_geographic;
  // The ids of regions that stand for another number in the file, and these.
  std::vector<std::int32_t> ids;
  std::vector<double> values;
};

namespace weft {
namespace {

std::string text(const char* text) {
  return text == nullptr ? "" : text;
}

// The path is at fault, or what is asked of it.
Error error_of_file(const files::Error& error) {
  switch (error.exit) {
    case files::ExitCode::kUnreadableInput:
      return {ErrorCode::kBadOption, "path", error.message};
    case files::ExitCode::kUsage:
      return {ErrorCode::kBadOption, "options", error.message};
    default:
      return {ErrorCode::kInternal, "", error.message};
  }
}

Result<weft_domain*> read(const char* path, const weft_file_options& options) {
  files::DataPath file(text(path));
  file.format = text(options.format);
  files::LayerOptions layers{.where = text(options.where)};
  if (options.layer != nullptr) layers.layers = {options.layer};
  const auto domain = files::read_domain(file, layers);
  if (!domain) return tl::unexpected(error_of_file(domain.error()));
  auto read = std::make_unique<weft_domain>();
  read->message = files::domain_message(*domain);
  for (const files::Warning& warning : domain->warnings)
    read->warnings.push_back({std::string(files::warning_name(warning.kind)), warning.sentence()});
  if (domain->system) read->is_geographic = domain->system->geographic;
  for (const files::RegionValue& region : domain->region_values) {
    read->ids.push_back(region.id);
    read->values.push_back(region.value);
  }
  return read.release();
}

}  // namespace
}  // namespace weft

extern "C" {

weft_domain* weft_read_domain(const char* path, const weft_file_options* options,
                              weft_error** error) {
  weft_file_options known{};
  if (options != nullptr)
    std::memcpy(&known, options, std::min(options->struct_size, sizeof known));
  return weft::made_by<weft_domain>([&] { return weft::read(path, known); }, error);
}

void weft_domain_free(weft_domain* domain) {
  delete domain;
}

const void* weft_domain_message(const weft_domain* domain, size_t* size) {
  *size = domain->message.size();
  return domain->message.data();
}

const char* weft_domain_warning(const weft_domain* domain, size_t index, const char** kind) {
  if (index >= domain->warnings.size()) return nullptr;
  if (kind != nullptr) *kind = domain->warnings[index].kind.c_str();
  return domain->warnings[index].sentence.c_str();
}

int weft_domain_is_geographic(const weft_domain* domain, int* is_geographic) {
  if (domain->is_geographic) *is_geographic = *domain->is_geographic;
  return domain->is_geographic.has_value();
}

size_t weft_domain_region_values(const weft_domain* domain, const int32_t** ids,
                                 const double** values) {
  *ids = domain->ids.data();
  *values = domain->values.data();
  return domain->ids.size();
}

}  // extern "C"
