// SPDX-License-Identifier: Apache-2.0
#include "server/http/mesh_warnings.h"

#include <fmt/format.h>

#include "files/base/text.h"

namespace weft::server {
namespace {

constexpr std::size_t kMaxWarnings = 16;

// A header's value: one line of ASCII.
std::string one_line(std::string text) {
  constexpr std::size_t kMax = 400;
  if (text.size() > kMax) text.resize(kMax);
  for (char& c : text)
    if (c < ' ' || c > '~') c = c == '\n' ? ' ' : '?';
  return text;
}

}  // namespace

void add_warnings(const v1::Summary& summary, const SentDomain& sent, std::uint64_t max_triangles,
                  std::vector<std::string>& warnings) {
  const auto place = [&sent](double x, double y) {
    files::Point at{x, y};
    if (sent.projection != nullptr && !sent.projection->to_metres())
      at = sent.projection->named_place(at);
    return files::coordinates(at.x, at.y);
  };
  if (summary.has_outside()) {
    const v1::OutsideSegments& outside = summary.outside();
    warnings.push_back(fmt::format("segments outside of what is meshed: {}, the first at {}",
                                   outside.segments(), place(outside.x(), outside.y())));
  }
  if (const v1::Merging& merging = summary.merging(); merging.vanished_faces() > 0)
    warnings.push_back(
        fmt::format("faces of the input that vanished, narrower than {:.3g}: {}, one at {}",
                    merging.tolerance(), merging.vanished_faces(),
                    place(merging.vanished_x(), merging.vanished_y())));
  const v1::Unrefined& unrefined = summary.unrefined();
  if (const std::uint64_t count = unrefined.precision() + unrefined.streaming(); count > 0)
    warnings.push_back(fmt::format("triangles that miss a bound without exemption: {}", count));
  if (max_triangles > 0 && summary.triangles() > max_triangles)
    warnings.push_back("the domain alone, without refinement, has more than max_triangles");
  if (summary.has_narrow()) {
    const v1::NarrowPlace& narrow = summary.narrow();
    warnings.push_back(
        fmt::format("triangles where segments are up to {:.3g} apart: at least {}, the most of "
                    "them at {}; if these should be one, snap={} merges them",
                    narrow.widest(), narrow.in_all(), place(narrow.x(), narrow.y()),
                    files::two_digits_above(narrow.widest())));
  }
  if (const v1::LayerSummary& layers = summary.layers(); layers.cut() > 0)
    warnings.push_back(
        fmt::format("layers thinner than asked for, for want of room, at {} corners, the least "
                    "{:.3g} thick at {}",
                    layers.cut(), layers.least_thickness(), place(layers.x(), layers.y())));
}

void warn(std::vector<std::string> warnings, boost::beast::http::fields& head) {
  if (warnings.size() > kMaxWarnings) {
    const std::size_t more = warnings.size() - (kMaxWarnings - 1);
    warnings.resize(kMaxWarnings - 1);
    warnings.push_back(fmt::format("{} more warnings", more));
  }
  for (const std::string& warning : warnings) head.insert("Weft-Warning", one_line(warning));
}

}  // namespace weft::server
