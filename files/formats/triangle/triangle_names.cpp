// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_names.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string>

namespace weft::files {
namespace {

// "# marker=".
std::string opening(NameKind kind) {
  return "# " + std::string(word_of(kind)) + "=";
}

void read_name(std::string_view line, NameReader& names) {
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion}) {
    const std::string start = opening(kind);
    if (!line.starts_with(start)) continue;
    const char* const last = line.data() + line.size();
    std::int32_t id = 0;
    const auto [end, problem] = std::from_chars(line.data() + start.size(), last, id);
    if (problem == std::errc() && end != last && *end == ':')
      names.add(kind, id, {end + 1, static_cast<std::size_t>(last - end - 1)});
  }
}

}  // namespace

void put_names(const Names& names, OutputFile& file) {
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion})
    for (const auto& [id, name] : names.table(kind))
      file.put(opening(kind) + std::to_string(id) + ":" + name + "\n");
}

void read_names(std::string_view text, NameReader& names) {
  for (std::size_t at = 0; (at = text.find('#', at)) != std::string_view::npos;) {
    const bool opens_line = at == 0 || text[at - 1] == '\n';
    std::string_view line = text.substr(at, text.find('\n', at) - at);
    at += line.size();
    // A name may end in blanks, not in control characters.
    while (line.ends_with('\r') || line.ends_with('\t')) line.remove_suffix(1);
    if (opens_line) read_name(line, names);
  }
}

}  // namespace weft::files
