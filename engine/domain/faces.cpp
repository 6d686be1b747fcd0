// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/faces.h"

#include <algorithm>

namespace weft {
namespace {

// Floods from `start` across edges without a constraint. Whether a neighbour is new is hard to
// predict, so each is stored without a branch (the compiler would turn a choice of what to store
// into one). The queue is first in, first out, so that a triangle is known long before its turn.
// `queue` has room for all triangles and three more.
void flood(const Arrangement& a, std::uint32_t start, std::uint32_t face, Faces& faces,
           std::vector<std::uint32_t>& queue, StopPoller& poller) {
  std::uint32_t* const of = faces.of_triangle.data();
  const auto beyond = static_cast<std::uint32_t>(a.triangles.size());
  of[start] = face;
  std::uint32_t* first = queue.data();
  std::uint32_t* last = first;
  *last++ = start;
  while (first != last) {
    poller.step();
    const Arrangement::Triangle& t = a.triangles[*first++];
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t n = std::min(t.neighbor[i], beyond);
      const std::uint32_t known = of[n];
      const std::uint32_t is_new = (t.constraint[i] & known) == kNone;
      *last = n;
      last += is_new;
      of[n] = known ^ ((known ^ face) & (0 - is_new));
    }
  }
}

}  // namespace

Faces find_faces(const Arrangement& a, StopPoller& poller) {
  Faces faces;
  faces.of_triangle.assign(a.triangles.size() + 1, kNone);
  faces.of_triangle.back() = Faces::kUnbounded;
  std::vector<std::uint32_t> queue(a.triangles.size() + 3);
  const auto open_to_the_outside = [](const Arrangement::Triangle& t) {
    for (int i = 0; i < 3; ++i)
      if (t.neighbor[i] == kNone && t.constraint[i] == kNone) return true;
    return false;
  };
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t)
    if (faces.of_triangle[t] == kNone && open_to_the_outside(a.triangles[t]))
      flood(a, t, Faces::kUnbounded, faces, queue, poller);
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t)
    if (faces.of_triangle[t] == kNone) flood(a, t, faces.count++, faces, queue, poller);
  return faces;
}

FaceGraph::FaceGraph(const Arrangement& a, const Faces& faces, StopPoller& poller)
    : first_(faces.count + 1, 0) {
  const auto for_each_step = [&](auto&& visit) {
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
      poller.step();
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t c = a.triangles[t].constraint[i];
        if (c == kNone) continue;
        const std::uint32_t n = a.triangles[t].neighbor[i];
        const std::uint32_t from = faces.of_triangle[t];
        const std::uint32_t to = n == kNone ? Faces::kUnbounded : faces.of_triangle[n];
        if (from == to) continue;
        visit(Step{from, to, c});
        // The unbounded face has no triangle behind the hull to visit this edge from.
        if (n == kNone) visit(Step{to, from, c});
      }
    }
  };
  for_each_step([&](const Step& s) { ++first_[s.from + 1]; });
  for (std::size_t f = 0; f < faces.count; ++f) first_[f + 1] += first_[f];
  steps_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each_step([&](const Step& s) { steps_[next[s.from]++] = s; });
}

}  // namespace weft
