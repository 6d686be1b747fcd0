// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_mesh.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/text_writer.h"
#include "files/formats/domains/region_values.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/triangle/triangle_names.h"
#include "files/formats/triangle/triangle_points.h"
#include "files/formats/triangle/triangle_segments.h"

namespace weft::files {
namespace {

// The marker of the input point if it has one other than 0; else that of the first edge with one
// other than 0; else 1 if the vertex is on an edge.
ScratchArray<std::int32_t> vertex_markers(const MeshView& mesh) {
  ScratchArray<std::int32_t> markers(mesh.pages, mesh.vertex_count());
  if (!mesh.input_point_markers.empty())
    for (const std::size_t i : mesh.up_to(mesh.input_points.size() / 2))
      markers[mesh.input_points[2 * i]] = mesh.input_point_markers[mesh.input_points[2 * i + 1]];
  const auto mark_ends = [&](const auto& marker_of) {
    for (const std::size_t i : mesh.up_to(mesh.edges.size()))
      if (std::int32_t& marker = markers[mesh.edges[i]]; marker == 0) marker = marker_of(i);
  };
  mark_ends([&](std::size_t i) { return mesh.edge_markers[i / mesh.edge_nodes()]; });
  mark_ends([](std::size_t) { return 1; });
  return markers;
}

Result<void> read_triangles(const std::filesystem::path& path, const NodeNumbers& numbers,
                            Mesh& mesh, NameReader& names) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text());
  if (auto line = scanner.next_line("the triangle count"); !line) return line;
  const auto count = scanner.count("the triangle count");
  if (!count) return tl::unexpected(count.error());
  std::optional<std::int64_t> attributes;
  bool has_middles = false;
  if (!scanner.at_line_end()) {
    const auto corners = scanner.integer("the corners per triangle");
    if (!corners) return tl::unexpected(corners.error());
    if (*corners != 3 && *corners != 6)
      return scanner.error("the corners per triangle are " + std::to_string(*corners) +
                           ", only 3 and 6 are read");
    has_middles = *corners == 6;
    if (!scanner.at_line_end()) {
      const auto value = scanner.integer("the attribute count");
      if (!value) return tl::unexpected(value.error());
      attributes = *value;
    }
  }
  mesh.triangles.reserve(*count * 3);
  mesh.regions.reserve(*count);
  std::vector<double> regions;
  regions.reserve(*count);
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("a triangle"); !line) return line;
    if (auto number = scanner.integer("the triangle number"); !number)
      return tl::unexpected(number.error());
    for (int corner = 0; corner < 3; ++corner) {
      const auto v = numbers.read(scanner, "a corner");
      if (!v) return tl::unexpected(v.error());
      mesh.triangles.push_back(*v);
    }
    for (std::size_t k = 1; has_middles && k <= 3; ++k) {  // opposite corner 0, 1, 2
      const auto middle = numbers.read(scanner, "a node");
      if (!middle) return tl::unexpected(middle.error());
      const std::uint32_t* corner = &mesh.triangles[mesh.triangles.size() - 3];
      mesh.middles.push_back({corner[k % 3], corner[(k + 1) % 3], *middle});
    }
    double attribute = 0;
    if (attributes ? *attributes > 0 : !scanner.at_line_end()) {
      const auto value = scanner.real("the triangle's attribute");
      if (!value) return tl::unexpected(value.error());
      attribute = *value;
    }
    regions.push_back(attribute);
  }
  const RegionIds ids(regions);
  std::transform(regions.begin(), regions.end(), std::back_inserter(mesh.regions),
                 [&ids](double attribute) { return ids.of(attribute); });
  for (const auto& [id, value] : ids.assigned()) names.add(NameKind::kRegion, id, shortest(value));
  return {};
}

Result<void> read_edges(const std::filesystem::path& path, const NodeNumbers& numbers, Mesh& mesh,
                        NameReader& names) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text());
  if (auto points = read_triangle_points(scanner); !points) return tl::unexpected(points.error());
  const auto segments =
      read_triangle_segments(scanner, numbers, [&mesh](const TriangleSegment& segment) {
        mesh.edges.insert(mesh.edges.end(), {segment.a, segment.b});
        mesh.edge_markers.push_back(segment.marker);
      });
  if (!segments) return tl::unexpected(segments.error());
  if (*segments) mesh.warnings.push_back(**segments);
  read_names(contents->text(), names);
  return {};
}

}  // namespace

void write_triangle_mesh(const MeshView& mesh, OutputFile& node, OutputFile& ele,
                         OutputFile& poly) {
  const ScratchArray<std::int32_t> markers = vertex_markers(mesh);
  put_line(node, mesh.vertex_count(), 2, 0, 1);
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(node, v + 1, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], markers[v]);
  const std::size_t nodes = mesh.triangle_nodes();
  put_line(ele, mesh.triangle_count(), nodes, 1);
  constexpr std::size_t kOrder[] = {0, 1, 2, 4, 5, 3};  // node 4 is opposite corner 1
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    ele.number(static_cast<std::int64_t>(t + 1));
    ele.put(' ');
    for (std::size_t k = 0; k < nodes; ++k) {
      ele.number(mesh.triangles[nodes * t + kOrder[k]] + std::int64_t{1});
      ele.put(' ');
    }
    put_line(ele, mesh.regions[t]);
  }
  put_line(poly, 0, 2, 0, 1);
  put_line(poly, mesh.edge_count(), 1);
  for (const std::size_t e : mesh.up_to(mesh.edge_count())) {
    const std::uint32_t* ends = &mesh.edges[mesh.edge_nodes() * e];
    put_line(poly, e + 1, ends[0] + std::int64_t{1}, ends[1] + std::int64_t{1},
             mesh.edge_markers[e]);
  }
  put_line(poly, 0);
  put_names(*mesh.names, poly);
}

Result<Mesh> read_triangle_mesh(const std::filesystem::path& path) {
  std::filesystem::path base = path;
  auto points = read_node_file(base.replace_extension(".node"));
  if (!points) return tl::unexpected(points.error());
  Mesh mesh;
  mesh.coordinates.reserve(points->points.size() * 2);
  for (const Point& point : points->points) {
    mesh.coordinates.push_back(point.x);
    mesh.coordinates.push_back(point.y);
  }
  NameReader names(path.string());
  if (auto read = read_triangles(base.replace_extension(".ele"), points->numbers, mesh, names);
      !read)
    return tl::unexpected(read.error());
  std::error_code ignored;
  if (std::filesystem::exists(base.replace_extension(".poly"), ignored))
    if (auto read = read_edges(base, points->numbers, mesh, names); !read)
      return tl::unexpected(read.error());
  mesh.warnings = names.warnings();
  mesh.names = names.take();
  return validated(path, std::move(mesh));
}

}  // namespace weft::files
