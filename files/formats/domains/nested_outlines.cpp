// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/nested_outlines.h"

#include <limits>

#include "checker/geometry/box_tree.h"
#include "files/formats/derived/orientation.h"

namespace weft::files {
namespace {

check::Vec2 vec(Point p) {
  return {p.x, p.y};
}

class Outlines {
 public:
  explicit Outlines(const Domain& domain) : domain_(domain), tree_(boxes(domain)) {}

  // Whether the chain of segments from `first` to before `end` is inside others: an odd number of
  // these are to its left, and an odd number to its right.
  bool is_nested(std::size_t first, std::size_t end) const {
    const Point at = domain_.points[domain_.segments[first].a];
    constexpr double kFar = std::numeric_limits<double>::max();
    bool left = false;
    bool right = false;
    tree_.visit({-kFar, at.y, kFar, at.y}, [&](std::uint32_t i) {
      if (i >= first && i < end) return;
      Point low = domain_.points[domain_.segments[i].a];
      Point high = domain_.points[domain_.segments[i].b];
      if (low.y > high.y) std::swap(low, high);
      if (low.y <= at.y && at.y < high.y) {
        bool& side = orientation(low, high, at) > 0 ? right : left;
        side = !side;
      }
    });
    return left && right;
  }

 private:
  static std::vector<check::Box> boxes(const Domain& domain) {
    std::vector<check::Box> all;
    for (const Domain::Segment& segment : domain.segments)
      all.push_back(check::box_of(vec(domain.points[segment.a]), vec(domain.points[segment.b])));
    return all;
  }

  const Domain& domain_;
  check::BoxTree tree_;
};

}  // namespace

std::vector<std::size_t> nested_outlines(const Domain& domain) {
  const Outlines outlines(domain);
  const auto& segments = domain.segments;
  std::vector<std::size_t> nested;
  for (std::size_t first = 0; first < segments.size();) {
    std::size_t end = first + 1;
    while (end < segments.size() && segments[end].a == segments[end - 1].b) ++end;
    const bool is_closed =
        end - first > 2 && domain.points[segments[first].a] == domain.points[segments[end - 1].b];
    if (is_closed && outlines.is_nested(first, end)) nested.push_back(first);
    first = end;
  }
  return nested;
}

}  // namespace weft::files
