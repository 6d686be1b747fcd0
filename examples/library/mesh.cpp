// SPDX-License-Identifier: Apache-2.0
// Meshes a square with a round hole, finer towards the hole, without a server.
#include <weft/weft.h>
#include <cmath>
#include <cstdio>

int main() {
  weft::MeshRequest request{.size = "0.001 + 0.05 * (hypot(x, y) - 0.5)", .min_angle_deg = 25};
  weft::Pslg& domain = request.pslg;
  const auto add_ring = [&](unsigned corners, double radius, double first_angle, int marker) {
    const auto first = static_cast<unsigned>(domain.points.size());
    for (unsigned i = 0; i < corners; ++i) {
      const double angle = first_angle + 2 * M_PI * i / corners;
      domain.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
      domain.segments.push_back({first + i, first + (i + 1) % corners, marker});
    }
  };
  add_ring(4, 2, M_PI / 4, 1);
  add_ring(64, 0.5, 0, 2);
  domain.holes.push_back({0, 0});

  const weft::Result<weft::Mesh> mesh = weft::mesh(request);
  if (!mesh) {
    std::fprintf(stderr, "%s\n", mesh.error().message.c_str());
    return 1;
  }
  std::printf("%zu vertices, %zu triangles, %zu edges on segments, smallest angle %.1f degrees\n",
              mesh->vertices.size(), mesh->triangles.size(), mesh->edges.size(),
              mesh->summary.min_angle_deg);
}
