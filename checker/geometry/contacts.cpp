// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/contacts.h"

#include <algorithm>

#include "checker/geometry/box_tree.h"
#include "checker/geometry/predicates.h"

namespace weft::check {
namespace {

// Whether p, which lies on the line through a and b, lies strictly between them.
bool strictly_between(Vec2 p, Vec2 a, Vec2 b) {
  return lexicographically_less(a, b)
             ? lexicographically_less(a, p) && lexicographically_less(p, b)
             : lexicographically_less(b, p) && lexicographically_less(p, a);
}

class ContactFinder {
 public:
  ContactFinder(std::span<const Vec2> points, std::span<const SegmentEnds> segments)
      : points_(points), segments_(segments) {}

  void compare(std::uint32_t first, std::uint32_t second) {
    const auto [ia, ib] = segments_[first];
    const auto [ic, id] = segments_[second];
    const Vec2 a = points_[ia], b = points_[ib], c = points_[ic], d = points_[id];
    const int side_c = orientation(a, b, c);
    const int side_d = orientation(a, b, d);
    if (side_c * side_d > 0) return;
    const int side_a = orientation(c, d, a);
    const int side_b = orientation(c, d, b);
    if (side_c * side_d < 0 && side_a * side_b < 0) {
      found.crossings.push_back({first, second});
      return;
    }
    if (side_c == 0 && strictly_between(c, a, b)) found.touches.push_back({first, ic});
    if (side_d == 0 && strictly_between(d, a, b)) found.touches.push_back({first, id});
    if (side_a == 0 && strictly_between(a, c, d)) found.touches.push_back({second, ia});
    if (side_b == 0 && strictly_between(b, c, d)) found.touches.push_back({second, ib});
  }

  Contacts found;

 private:
  std::span<const Vec2> points_;
  std::span<const SegmentEnds> segments_;
};

}  // namespace

Contacts find_contacts(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
                       std::size_t limit) {
  std::vector<Box> boxes;
  boxes.reserve(segments.size());
  for (const auto [a, b] : segments) boxes.push_back(box_of(points[a], points[b]));
  const BoxTree tree(boxes);
  ContactFinder finder(points, segments);
  for (std::uint32_t s = 0; s < segments.size(); ++s) {
    tree.visit(boxes[s], [&](std::uint32_t t) {
      if (t > s) finder.compare(s, t);
    });
    if (finder.found.touches.size() + finder.found.crossings.size() > limit) {
      finder.found.complete = false;
      break;
    }
  }
  return std::move(finder.found);
}

}  // namespace weft::check
