// SPDX-License-Identifier: Apache-2.0
// `weft info`: what a mesh or a domain holds.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <span>
#include <vector>

#include "client/commands/area_bound.h"
#include "client/commands/commands.h"
#include "client/report/mesh_angles.h"
#include "client/report/mesh_quality.h"
#include "client/report/mesh_text.h"
#include "client/report/quality_report.h"
#include "files/base/text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

std::string row(const char* name, const std::string& value) {
  char label[32];
  std::snprintf(label, sizeof label, "%-10s ", name);
  return label + value + "\n";
}

std::string warnings(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += "WARNING: " + sentence + "\n";
  return text;
}

// "0 (1,200), 3 'inlet' (17)": each value, its name and how often it occurs; then the names of
// values that do not occur.
std::string tally(std::map<std::int32_t, std::uint64_t> counts, const NameTable& names) {
  for (const auto& [id, name] : names) counts.try_emplace(id, 0);
  constexpr std::size_t kMaxListed = 20;
  std::string text;
  std::size_t listed = 0;
  for (const auto& [value, count] : counts) {
    if (listed++ == kMaxListed)
      return text + " and " + std::to_string(counts.size() - kMaxListed) + " more";
    if (!text.empty()) text += ", ";
    const std::string* const name = name_of(names, value);
    text += std::to_string(value) + (name ? " '" + *name + "'" : "") + " (" +
            with_separators(count) + ")";
  }
  return text.empty() ? "none" : text;
}

std::map<std::int32_t, std::uint64_t> count_values(std::span<const std::int32_t> values) {
  std::map<std::int32_t, std::uint64_t> counts;
  auto last = counts.end();
  for (const std::int32_t value : values) {  // runs are long
    if (last == counts.end() || last->first != value) last = counts.try_emplace(value, 0).first;
    ++last->second;
  }
  return counts;
}

class BoundingBox {
 public:
  void add(double x, double y) {
    low_ = empty_ ? Point{x, y} : Point{std::min(low_.x, x), std::min(low_.y, y)};
    high_ = empty_ ? Point{x, y} : Point{std::max(high_.x, x), std::max(high_.y, y)};
    empty_ = false;
  }
  std::string text() const {
    return empty_ ? "empty" : coordinates(low_.x, low_.y) + " to " + coordinates(high_.x, high_.y);
  }

 private:
  Point low_;
  Point high_;
  bool empty_ = true;
};

// "region 1 = 0.35, region 2 = 0.7": attributes of a .poly file that are no ids.
std::string list(std::span<const RegionValue> values) {
  std::string text = region_values_text(values);
  text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;)
    text.replace(at, 1, ", ");
  return text;
}

std::string describe(const Domain& domain) {
  BoundingBox box;
  for (const Point& point : domain.points) box.add(point.x, point.y);
  std::vector<std::int32_t> markers;
  for (const auto& segment : domain.segments) markers.push_back(segment.marker);
  std::vector<std::int32_t> regions;
  for (const auto& region : domain.regions) regions.push_back(region.id);
  for (const auto& area : domain.areas)
    if (area.region) regions.push_back(*area.region);
  return row("points", with_separators(domain.points.size())) +
         row("segments", with_separators(domain.segments.size())) +
         (domain.areas.empty() ? row("holes", with_separators(domain.holes.size()))
                               : row("polygons", with_separators(domain.areas.size()))) +
         row("regions", tally(count_values(regions), domain.names.regions)) +
         (domain.region_values.empty() ? "" : row("attributes", list(domain.region_values))) +
         row("markers", tally(count_values(markers), domain.names.markers)) +
         row("filling", domain.fill == Domain::Fill::kSeeds     ? "seeds"
                        : domain.fill == Domain::Fill::kEvenOdd ? "even-odd"
                                                                : "union") +
         (domain.system ? row("system", domain.system->name) : "") + row("box", box.text());
}

std::string describe(const Mesh& mesh) {
  const MeshView view = mesh.view();
  BoundingBox box;
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    box.add(mesh.coordinates[i], mesh.coordinates[i + 1]);
  double area = 0;
  for (std::size_t t = 0; t < view.triangle_count(); ++t) {
    const double* a = &mesh.coordinates[2 * std::size_t{mesh.triangles[3 * t]}];
    const double* b = &mesh.coordinates[2 * std::size_t{mesh.triangles[3 * t + 1]}];
    const double* c = &mesh.coordinates[2 * std::size_t{mesh.triangles[3 * t + 2]}];
    area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  const AngleRange angles = mesh_angles(view);
  char range[64];
  std::snprintf(range, sizeof range, "%.4f to %.4f degrees", angles.min_deg, angles.max_deg);
  return row("vertices", with_separators(view.vertex_count())) +
         row("triangles", with_separators(view.triangle_count())) +
         row("edges", with_separators(view.edge_count()) + " on input segments") +
         row("angles", view.triangle_count() > 0 ? range : "none") + row("area", shortest(area)) +
         row("regions", tally(count_values(view.regions), mesh.names.regions)) +
         row("markers", tally(count_values(view.edge_markers), mesh.names.markers)) +
         row("box", box.text());
}

}  // namespace

Result<ExitCode> run_info(const InfoOptions& options) {
  const DataPath& file = options.file;
  if (is_plain_domain_path(file)) {
    if (options.quality)
      return fail(ExitCode::kUsage, file.string() + ": is a domain; --quality is for meshes");
    const auto domain = read_domain(file, options.layers);
    if (!domain) return tl::unexpected(domain.error());
    return print(row("domain", file.string()) + describe(*domain) +
                 warnings(sentences(domain->warnings)));
  }
  if (!is_domain_path(file)) return unknown_domain_format(file);
  if (options.layers.wanted())
    return fail(ExitCode::kUsage, "--layer, --where and --attribute are for domains, " +
                                      file.string() + " is a mesh");
  const auto mesh = read_mesh(file);
  if (!mesh) return tl::unexpected(mesh.error());
  const std::string about =
      row("mesh", file.string()) + describe(*mesh) + warnings(sentences(mesh->warnings));
  if (!options.quality) return print(about);
  const auto bound = area_bound(options.size, file.string(), *mesh);
  if (!bound) return tl::unexpected(bound.error());
  const MeshQuality quality = measure_quality(mesh->view(), *bound);
  return print(options.json ? json_line(quality_json(quality))
                            : about + quality_text(quality, locale_is_utf8()));
}

}  // namespace weft::client
