// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arcs/flat_arcs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"

namespace weft {

namespace {

// As `bulges_of`, of a PSLG that `validate` may refuse: of what is no arc, 0.
std::vector<double> bulges_of_any(const Pslg& pslg) {
  std::vector<double> bulges(pslg.segments.size(), 0);
  for (const Arc& arc : pslg.arcs) {
    if (arc.segment >= bulges.size() || !(std::fabs(arc.bulge) <= kMaxBulge)) continue;
    const Segment& s = pslg.segments[arc.segment];
    if (std::max(s.a, s.b) < pslg.points.size() && pslg.points[s.a] != pslg.points[s.b])
      bulges[arc.segment] = arc.bulge;
  }
  return bulges;
}

double chords_of(double bulge, double turn) {
  return std::ceil(turn_of(std::fabs(bulge)) / turn * (1 - 1e-9));
}

// Of all arcs.
std::uint64_t count_chords(const std::vector<double>& bulges, double turn) {
  double chords = 0;
  for (const double bulge : bulges)
    if (bulge != 0) chords += chords_of(bulge, turn);
  return static_cast<std::uint64_t>(chords);
}

}  // namespace

std::vector<double> bulges_of(const Pslg& pslg) {
  std::vector<double> bulges(pslg.segments.size(), 0);
  for (const Arc& arc : pslg.arcs) bulges[arc.segment] = arc.bulge;
  return bulges;
}

std::uint64_t count_chords(const Pslg& pslg) {
  return count_chords(bulges_of_any(pslg), kFlatTurn);
}

Pslg flatten_arcs(const Pslg& pslg, double turn) {
  const std::vector<double> bulges = bulges_of_any(pslg);
  const std::uint64_t chords = count_chords(bulges, turn);
  Pslg flat = pslg;
  flat.arcs.clear();
  flat.segments.clear();
  flat.segments.reserve(pslg.segments.size() + chords);
  flat.points.reserve(pslg.points.size() + chords);
  for (std::size_t i = 0; i < pslg.segments.size(); ++i) {
    Segment s = pslg.segments[i];
    if (bulges[i] == 0) {
      flat.segments.push_back(s);
      continue;
    }
    const auto last = s.b;
    const Point a = pslg.points[s.a], b = pslg.points[s.b];
    const double count = chords_of(bulges[i], turn);
    const Point middle = middle_of_arc(a, b, bulges[i]);
    for (double k = 1; k < count; ++k) {
      const double fraction = k / count;
      const Point p = fraction == 0.5 ? middle
                      : fraction < 0.5
                          ? at_fraction(a, middle, half_bulge(bulges[i]), 2 * fraction)
                          : at_fraction(middle, b, half_bulge(bulges[i]), 2 * fraction - 1);
      flat.points.push_back(p);
      s.b = static_cast<std::uint32_t>(flat.points.size() - 1);
      flat.segments.push_back(s);
      s.a = s.b;
    }
    s.b = last;
    flat.segments.push_back(s);
  }
  return flat;
}

Box box_with_arcs(const Domain& domain, Box box) {
  for (std::size_t i = 0; i < domain.curvatures.size(); ++i) {
    const Point a = domain.vertices[domain.subsegments[i].a];
    const Point b = domain.vertices[domain.subsegments[i].b];
    box.add(control_point(a, b, bulge_of(domain.curvatures[i], length(b - a))));
  }
  return box;
}

}  // namespace weft
