// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/domain.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <utility>

#include "engine/domain/arrangement.h"
#include "engine/domain/carve.h"
#include "engine/domain/hilbert.h"
#include "engine/domain/pacer.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

// The triangles that stay, along a Hilbert curve through their centroids.
std::vector<std::uint32_t> kept_triangles(const Arrangement& a, const Carving& carving,
                                          Pacer& pacer) {
  std::vector<std::uint32_t> kept;
  std::vector<Point> centroids;
  const auto count = static_cast<std::size_t>(
      a.triangles.size() -
      static_cast<std::size_t>(std::count(carving.region.begin(), carving.region.end(), kNone)));
  kept.reserve(count);
  centroids.reserve(count);
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t) {
    pacer.step();
    if (carving.region[t] == kNone) continue;
    const auto& v = a.triangles[t].vertex;
    const Point p = a.vertices[v[0]], q = a.vertices[v[1]], r = a.vertices[v[2]];
    kept.push_back(t);
    centroids.push_back({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
  }
  std::vector<std::uint32_t> order = hilbert_order(centroids, pacer);
  for (std::uint32_t& i : order) i = kept[i];
  return order;
}

// Keeps what the carving keeps, numbered without gaps.
Domain extract(const Arrangement& a, Carving&& carving, Pacer& pacer) {
  const std::vector<std::uint32_t> kept = kept_triangles(a, carving, pacer);
  std::vector<std::uint32_t> triangle_number(a.triangles.size(), kNone);
  std::vector<std::uint32_t> vertex_number(a.vertices.size(), kNone);
  for (std::uint32_t i = 0; i < kept.size(); ++i) {
    pacer.step();
    triangle_number[kept[i]] = i;
    for (const std::uint32_t v : a.triangles[kept[i]].vertex) vertex_number[v] = 0;
  }

  Domain domain;
  domain.vertices.reserve(a.vertices.size());
  domain.input_point.reserve(a.vertices.size());
  domain.subsegments.reserve(a.constraints.size());
  for (std::uint32_t v = 0; v < a.vertices.size(); ++v) {
    pacer.step();
    if (vertex_number[v] == kNone) continue;
    vertex_number[v] = static_cast<std::uint32_t>(domain.vertices.size());
    domain.vertices.push_back(a.vertices[v]);
    domain.input_point.push_back(a.input_point[v]);
  }

  std::vector<std::uint32_t> subsegment_number(a.constraints.size(), kNone);
  domain.triangles.resize(kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    pacer.step();
    const Arrangement::Triangle& from = a.triangles[kept[k]];
    Domain::Triangle& to = domain.triangles[k];
    for (int i = 0; i < 3; ++i) to.vertex[i] = vertex_number[from.vertex[i]];
    for (int i = 0; i < 3; ++i) {
      to.neighbor[i] = from.neighbor[i] == kNone ? kNone : triangle_number[from.neighbor[i]];
      to.subsegment[i] = kNone;
      if (from.constraint[i] == kNone) continue;
      std::uint32_t& number = subsegment_number[from.constraint[i]];
      if (number == kNone) {
        number = static_cast<std::uint32_t>(domain.subsegments.size());
        const Arrangement::Constraint& c = a.constraints[from.constraint[i]];
        domain.subsegments.push_back(
            {to.vertex[(i + 1) % 3], to.vertex[(i + 2) % 3], c.segment, c.marker});
      }
      to.subsegment[i] = number;
    }
    to.region = carving.region[kept[k]];
  }
  domain.regions = std::move(carving.regions);
  domain.merging = a.merging;
  return domain;
}

Result<Domain> run(const Pslg& pslg, Pacer& pacer) {
  pacer.poll();
  if (auto error = validate(pslg, pacer)) return tl::unexpected(*std::move(error));
  const Arrangement arrangement = arrange(pslg, pacer);
  Result<Carving> carving = carve(arrangement, pslg, pacer);
  if (!carving) return tl::unexpected(std::move(carving).error());
  return extract(arrangement, *std::move(carving), pacer);
}

}  // namespace

Result<Domain> triangulate(const Pslg& pslg, const ExecutionContext& context) {
  try {
    Pacer pacer(context);
    return run(pslg, pacer);
  } catch (Stopped& stopped) {
    return tl::unexpected(std::move(stopped.error));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, "",
                "the machine has no memory left to triangulate the domain");
  } catch (const std::exception& e) {
    return fail(ErrorCode::kInternal, "", std::string("triangulating the domain: ") + e.what());
  }
}

}  // namespace weft
