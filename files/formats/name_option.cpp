// SPDX-License-Identifier: Apache-2.0
#include "files/formats/name_option.h"

#include <set>

#include "files/base/text.h"
#include "files/base/value_of.h"

namespace weft::files {

tl::expected<NameOption, std::string> NameOption::parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':');
  if (equals != std::string::npos && colon != std::string::npos && equals < colon) {
    const std::string kind = text.substr(0, equals);
    const auto id = value_of<std::int32_t>(text.substr(equals + 1, colon - equals - 1));
    const std::string name = text.substr(colon + 1);
    if (id && (kind == "marker" || kind == "region")) {
      if (const std::string fault = name_fault(name); !fault.empty())
        return tl::unexpected("the name in " + in_quotes(text) + " " + fault);
      return NameOption{kind == "marker" ? NameKind::kMarker : NameKind::kRegion, *id, name};
    }
  }
  return tl::unexpected(in_quotes(text) +
                        " is not a name of a marker or a region, such as marker=2:inlet");
}

Result<void> set_names(std::span<const NameOption> options, Names& names) {
  for (const NameOption& option : options) names.table(option.kind)[option.id] = option.name;
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion}) {
    std::set<std::string_view> used;
    for (const auto& [id, name] : names.table(kind))
      if (!used.insert(name).second)
        return fail(ExitCode::kUsage, std::string(word_of(kind)) + " " + std::to_string(id) +
                                          " is named " + in_quotes(name) + ", as " +
                                          std::to_string(*id_of(names.table(kind), name)) + " is");
  }
  return {};
}

}  // namespace weft::files
