// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_arcs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "files/base/text.h"
#include "files/bytes/number_text.h"

namespace weft::files {
namespace {

constexpr std::string_view kOpening = "# arc=";

struct NumberedArc {
  std::int64_t number = 0;  // of the segment
  double bulge = 0;
};

std::optional<NumberedArc> arc_of(std::string_view text) {
  NumberedArc arc;
  const char* const last = text.data() + text.size();
  const auto [end, problem] = std::from_chars(text.data(), last, arc.number);
  if (problem != std::errc() || end == last || *end != ':') return std::nullopt;
  const auto [after, fault] = std::from_chars(end + 1, last, arc.bulge);
  if (fault != std::errc() || after != last || !std::isfinite(arc.bulge)) return std::nullopt;
  return arc;
}

}  // namespace

void put_arcs(const std::vector<Domain::Arc>& arcs, OutputFile& file) {
  for (const Domain::Arc& arc : arcs)
    file.put(std::string(kOpening) + std::to_string(arc.segment + std::uint64_t{1}) + ":" +
             shortest(arc.bulge) + "\n");
}

Result<std::vector<Domain::Arc>> read_arcs(const std::string& name, std::string_view text,
                                           const std::vector<std::int64_t>& numbers) {
  std::vector<Domain::Arc> arcs;
  std::unordered_map<std::int64_t, std::uint32_t> index_of;
  for (std::size_t at = 0; (at = text.find(kOpening, at)) != std::string_view::npos;) {
    const bool opens_line = at == 0 || text[at - 1] == '\n';
    const std::string_view line = text.substr(at, text.find('\n', at) - at);
    at += line.size();
    if (!opens_line) continue;
    const auto refuse = [&](const std::string& why) {
      return fail(ExitCode::kUnreadableInput,
                  name + ": the comment \"" + std::string(trimmed(line)) + "\" " + why);
    };
    const auto arc = arc_of(trimmed(line.substr(kOpening.size())));
    if (!arc) return refuse("is not the number of a segment, a colon, and the bulge of its arc");
    if (index_of.empty())
      for (std::size_t i = 0; i < numbers.size(); ++i)
        index_of.emplace(numbers[i], static_cast<std::uint32_t>(i));
    const auto found = index_of.find(arc->number);
    if (found == index_of.end()) return refuse("names a segment that is not there");
    arcs.push_back({found->second, arc->bulge});
  }
  std::ranges::sort(arcs, {}, &Domain::Arc::segment);
  const auto twice = std::ranges::adjacent_find(arcs, {}, &Domain::Arc::segment);
  if (twice != arcs.end())
    return fail(ExitCode::kUnreadableInput, name + ": the segment " +
                                                std::to_string(numbers[twice->segment]) +
                                                " has two comments \"# arc=\"");
  return arcs;
}

}  // namespace weft::files
