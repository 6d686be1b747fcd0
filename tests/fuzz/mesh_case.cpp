// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mesh_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <variant>

namespace weft::fuzz {
namespace {

constexpr std::size_t kMaxPoints = 40;

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

// Takes a PSLG's choices from the bytes.
class PslgMaker {
 public:
  PslgMaker(ByteSource& bytes, Pslg& pslg) : bytes_(bytes), pslg_(pslg) {}

  // Returns whether nothing was rounded: whatever is near is so on the grid.
  bool make() {
    read_frame();
    const std::size_t fill = bytes_.below(4);
    has_arcs_ = fill == 3;
    pslg_.fill = fill == 1 ? Fill::kEvenOdd : fill == 2 ? Fill::kUnion : Fill::kSeeds;
    const std::size_t seeds = bytes_.byte();
    if (bytes_.below(4) != 3) add_box();
    while (bytes_.left() > 2 * seeds % 16 && points_.size() < kMaxPoints) add_point();
    for (std::size_t i = 0; fill == 2 && i < 1 + seeds / 16 % 4; ++i) add_area();
    for (std::size_t i = 0; i < seeds % 4; ++i) pslg_.holes.push_back(placed(seed()));
    for (std::size_t i = 0; i < seeds / 4 % 4; ++i) add_region();
    for (const Point p : points_) pslg_.points.push_back(placed(p));
    return jitter_ == 0 && sine_ == 0 && decimals_ < 0 && (scale_ == 1 || scale_ == 1e3) &&
           !skewed_ && !has_arcs_;
  }

  double extent() const { return scale_ * (grid_ + 1); }

 private:
  // How grid coordinates become those of the request.
  void read_frame() {
    grid_ = static_cast<double>(2 + bytes_.below(15));
    scale_ = bytes_.one_of<double>({1, 1, 1, 0.1, 1.0 / 3, 1e-3, 1e3, 17.7});
    jitter_ = bytes_.one_of<double>({0, 0, 0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8,
                                     1e-7, 1e-6, 1e-5, 1e-4, 1e-3});
    offset_ = bytes_.one_of<Point>(
        {{0, 0}, {0, 0}, {1, 1}, {1e3, 1e3}, {1e6, 1e6}, {5e5, 4.65e6}, {-1e3, 0}, {0, 1e6}});
    const std::array<double, 2> turn = bytes_.one_of<std::array<double, 2>>(
        {{1, 0}, {1, 0}, {0.8, 0.6}, {5.0 / 13, 12.0 / 13}, {15.0 / 17, 8.0 / 17}});
    cosine_ = turn[0];
    sine_ = turn[1];
    decimals_ = bytes_.one_of({-1, -1, -1, 2, 3, 4, 5, 6, 7, 8, 9});
  }

  Point placed(Point p) const {
    Point q{offset_.x + scale_ * (cosine_ * p.x - sine_ * p.y),
            offset_.y + scale_ * (sine_ * p.x + cosine_ * p.y)};
    if (decimals_ >= 0) {
      double power = 1;
      for (int i = 0; i < decimals_; ++i) power *= 10;
      q = {std::nearbyint(q.x * power) / power, std::nearbyint(q.y * power) / power};
    }
    return q;
  }

  Point on_grid() {
    const auto lines = static_cast<std::size_t>(grid_) + 1;
    const double x = static_cast<double>(bytes_.below(lines));
    return {x, static_cast<double>(bytes_.below(lines))};
  }
  Point earlier() { return points_.empty() ? on_grid() : points_[bytes_.below(points_.size())]; }
  // A few jitters either way.
  Point near(Point p) {
    const std::size_t steps = bytes_.byte();
    return {p.x + jitter_ * (static_cast<double>(steps % 16) - 7),
            p.y + jitter_ * (static_cast<double>(steps / 16) - 7)};
  }

  void link(std::size_t a, std::size_t b) {
    const auto marker = static_cast<std::int32_t>(pslg_.segments.size() % 5);
    pslg_.segments.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), marker});
    if (!has_arcs_) return;
    const double bulge = bytes_.one_of<double>(
        {0, 0, 0, 1, -1, 0.41421356237309503, -0.2, 0.05, 1e-3, -1e-6, 1e-9, -2.5, 20});
    if (bulge != 0)
      pslg_.arcs.push_back({static_cast<std::uint32_t>(pslg_.segments.size() - 1), bulge});
  }

  void add_box() {
    points_ = {{-1, -1}, {grid_ + 1, -1}, {grid_ + 1, grid_ + 1}, {-1, grid_ + 1}};
    for (std::size_t i = 0; i < 4; ++i) link(i, (i + 1) % 4);
  }

  // A triangle, often near others.
  void add_area() {
    const std::size_t first = points_.size();
    for (int corner = 0; corner < 3; ++corner)
      points_.push_back(bytes_.flag() ? on_grid() : near(earlier()));
    Area area{.priority = static_cast<std::int32_t>(bytes_.below(2)),
              .is_hole = bytes_.below(6) == 5};
    if (bytes_.flag()) area.region = static_cast<std::int32_t>(1 + bytes_.below(3));
    if (bytes_.flag())
      area.max_area = extent() * extent() / static_cast<double>(1 + bytes_.below(200));
    for (std::size_t i = 0; i < 3; ++i) {
      link(first + i, first + (i + 1) % 3);
      pslg_.segments.back().area = static_cast<std::uint32_t>(pslg_.areas.size());
    }
    pslg_.areas.push_back(area);
  }

  void add_point() {
    const std::size_t choice = bytes_.byte();
    points_.push_back(make_point(choice % 8));
    const std::size_t last = points_.size() - 1;
    switch (choice / 8 % 8) {
      case 0:
        return;
      case 1:
      case 2:
      case 3:
        if (last > 0) link(last - 1, last);
        return;
      case 4:
        if (last > 1) link(last - 2, last);
        if (last > 0) link(last - 1, last);
        return;
      default:
        if (const std::size_t other = bytes_.below(points_.size()); other != last)
          link(other, last);
    }
  }

  Point make_point(std::size_t kind) {
    switch (kind) {
      case 4:
        return near(earlier());
      case 5: {  // beside a segment, or on it
        const Point a = earlier();
        const Point b = earlier();
        const double t = static_cast<double>(bytes_.below(17)) / 16;
        return near({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
      }
      case 6: {  // on an arm of a star: the arms differ by little
        skewed_ = true;
        const Point apex = earlier();
        const std::size_t arm = bytes_.byte();
        const double length = static_cast<double>(1 + arm % 8);
        const double slope = bytes_.one_of({1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.05, 0.1, 0.3});
        const double rise = length * slope * static_cast<double>(arm / 8 % 8);
        return arm < 128 ? Point{apex.x + length, apex.y + rise}
                         : Point{apex.x - rise, apex.y + length};
      }
      case 7:
        return near(on_grid());
      default:
        return on_grid();
    }
  }

  Point seed() {
    const Point p = on_grid();
    return {p.x + 0.375, p.y + 0.4375};
  }

  void add_region() {
    RegionSeed region{.at = placed(seed()),
                      .id = static_cast<std::int32_t>(1 + bytes_.below(3)),
                      .max_area = std::nullopt};
    if (bytes_.flag())
      region.max_area = extent() * extent() / static_cast<double>(1 + bytes_.below(200));
    pslg_.regions.push_back(region);
  }

  ByteSource& bytes_;
  Pslg& pslg_;
  double grid_ = 2;
  double scale_ = 1;
  double jitter_ = 0;
  Point offset_;
  double cosine_ = 1;
  double sine_ = 0;
  int decimals_ = -1;
  bool skewed_ = false;
  bool has_arcs_ = false;
  std::vector<Point> points_;  // in grid coordinates
};

Point some_point(ByteSource& bytes, const Pslg& pslg) {
  return pslg.points.empty() ? Point{} : pslg.points[bytes.below(pslg.points.size())];
}

// A raster of lengths; some nodes may have no value.
FieldRaster read_field_raster(ByteSource& bytes, double extent, Point at) {
  FieldRaster raster{.origin = at,
                     .dx = extent / static_cast<double>(1 + bytes.below(8)),
                     .dy = extent / static_cast<double>(1 + bytes.below(8)),
                     .columns = static_cast<std::uint32_t>(1 + bytes.below(4)),
                     .rows = static_cast<std::uint32_t>(1 + bytes.below(4)),
                     .values = {}};
  for (std::size_t i = 0; i < std::size_t{raster.columns} * raster.rows; ++i) {
    const std::size_t step = bytes.byte();
    raster.values.push_back(step == 255 ? std::numeric_limits<float>::quiet_NaN()
                                        : static_cast<float>(extent * (1.0 + step) / 256));
  }
  return raster;
}

// Triangles between points of the domain, however they lie, flat ones among them.
FieldMesh read_field_mesh(ByteSource& bytes, double extent, const Pslg& pslg) {
  FieldMesh mesh;
  const std::size_t vertices = 3 + bytes.below(4);
  for (std::size_t i = 0; i < vertices; ++i) {
    mesh.vertices.push_back(some_point(bytes, pslg));
    const std::size_t step = bytes.byte();
    mesh.values.push_back(step == 255 ? std::numeric_limits<double>::quiet_NaN()
                                      : extent * static_cast<double>(1 + step) / 256);
  }
  for (std::size_t t = 0; t <= bytes.below(4); ++t) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::uint32_t& v : triangle) v = static_cast<std::uint32_t>(bytes.below(vertices));
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

DistanceSpec read_distance(ByteSource& bytes, const Pslg& pslg) {
  DistanceSpec distance;
  switch (bytes.below(4)) {
    case 1:
      distance.markers = {static_cast<std::int32_t>(bytes.below(5))};
      break;
    case 2:
    case 3:
      for (std::size_t i = 0; i <= bytes.below(6); ++i)
        distance.points.push_back(some_point(bytes, pslg));
      if (bytes.flag())
        for (std::uint32_t i = 0; i + 1 < distance.points.size(); i += 1 + bytes.below(2))
          distance.segments.push_back({i, i + 1});
      break;
    default:
      break;
  }
  return distance;
}

// An expression of the field f, and g if there is one.
std::string read_expression(ByteSource& bytes, double length, bool two) {
  const std::string g = two ? "g" : "f";
  switch (bytes.below(8)) {
    case 0:
      return "f";
    case 1:
      return print("coalesce(f, %.17g)", length);
    case 2:
      return print("defined(f) ? f + %.17g : %.17g", length, length / 2);
    case 3:
      return print("%.17g + %.17g*coalesce(slope(f), 1)", length, length);
    case 4:
      return print("coalesce(min(f, 2*%s), %.17g) + %.17g", g.c_str(), length, length / 4);
    case 5:
      return print("clamp(%.17g*coalesce(f, x), %.17g, %.17g)", 0.5, length / 3, 2 * length);
    case 6:
      return print("coalesce(f < %.17g ? %.17g : 2*%s, 1e30)", length, length / 2, g.c_str());
    default:
      return print("%.17g + 0.25*coalesce(f, 0)", length / 4);
  }
}

SizeSpec read_fields(ByteSource& bytes, double extent, const Pslg& pslg) {
  SizeSpec size;
  const std::size_t kinds = bytes.byte();
  const double length = extent / static_cast<double>(1 + bytes.below(32));
  if (kinds % 2 == 1) size.measure = Measure::kEdge;
  const std::size_t count = 1 + kinds / 2 % 2;
  for (std::size_t i = 0; i < count; ++i) {
    FieldSpec field{.name = i == 0 ? "f" : "g", .kind = {}};
    switch (bytes.below(4)) {
      case 0:
        field.kind = read_distance(bytes, pslg);
        break;
      case 1:
        field.kind = read_field_raster(bytes, extent, some_point(bytes, pslg));
        break;
      case 2:
        field.kind = read_field_mesh(bytes, extent, pslg);
        break;
      default:
        field.kind = WidthSpec{};
    }
    size.fields.push_back(std::move(field));
  }
  size.value = read_expression(bytes, length, count == 2);
  if (kinds / 4 % 8 == 0) size.cells_across = static_cast<double>(1 + kinds / 32);
  return size;
}

std::string to_text(const FieldSpec& field) {
  const auto points = [](const std::vector<Point>& all) {
    std::string text;
    for (const Point p : all) text += print(" (%.17g, %.17g)", p.x, p.y);
    return text;
  };
  std::string text = "# field " + field.name + ":";
  if (const auto* const distance = std::get_if<DistanceSpec>(&field.kind)) {
    text += " distance, markers";
    for (const std::int32_t marker : distance->markers) text += print(" %d", marker);
    text += ", points" + points(distance->points) + ", segments";
    for (const auto& [a, b] : distance->segments) text += print(" %u-%u", a, b);
  } else if (const auto* const raster = std::get_if<FieldRaster>(&field.kind)) {
    text += print(" raster: origin %.17g %.17g, step %.17g %.17g, %u x %u:", raster->origin.x,
                  raster->origin.y, raster->dx, raster->dy, raster->columns, raster->rows);
    for (const float value : raster->values) text += print(" %.9g", static_cast<double>(value));
  } else if (const auto* const mesh = std::get_if<FieldMesh>(&field.kind)) {
    text += " mesh:" + points(mesh->vertices) + ", triangles";
    for (const auto& [a, b, c] : mesh->triangles) text += print(" %u-%u-%u", a, b, c);
    text += ", values";
    for (const double value : mesh->values) text += print(" %.17g", value);
  } else {
    text += " width";
  }
  return text + "\n";
}

SizeSpec read_size(ByteSource& bytes, double extent, const Pslg& pslg) {
  SizeSpec size;
  const std::size_t kind = bytes.below(8);
  const double area = extent * extent / static_cast<double>(1 + bytes.byte());
  const Point at = some_point(bytes, pslg);
  switch (kind) {
    case 7:
      return read_fields(bytes, extent, pslg);
    case 4:
      size = area;
      break;
    case 5: {
      const double step = extent / 8;
      switch (bytes.below(6)) {
        case 0:
          size = print("%.17g + %.17g*hypot(x-%.17g, y-%.17g)", area / 4, step, at.x, at.y);
          break;
        case 1:
          size = print("x < %.17g ? %.17g : %.17g", at.x + step, area, area / 5);
          break;
        case 2:
          size = print("hypot(x-%.17g,y-%.17g) < %.17g ? %.17g : 1e30", at.x, at.y, step, area / 6);
          break;
        case 3:
          size = print("%.17g + abs(y-%.17g)*%.17g", area / 3, at.y, step);
          break;
        case 4:
          size = print("%.17g", area);
          break;
        default:
          size = print("max(%.17g, (x-%.17g)^2)", area / 4, at.x);
      }
      break;
    }
    case 6: {
      Raster raster{.origin = at,
                    .dx = extent / static_cast<double>(1 + bytes.below(8)),
                    .dy = extent / static_cast<double>(1 + bytes.below(8)),
                    .columns = static_cast<std::uint32_t>(1 + bytes.below(4)),
                    .rows = static_cast<std::uint32_t>(1 + bytes.below(4)),
                    .values = {}};
      for (std::size_t i = 0; i < std::size_t{raster.columns} * raster.rows; ++i)
        raster.values.push_back(extent * extent / static_cast<double>(1 + bytes.byte()));
      size = std::move(raster);
      break;
    }
    default:
      break;
  }
  return size;
}

// Puts the domain into a box whose sides repeat each other.
void add_periodic_box(MeshRequest& request) {
  Pslg& pslg = request.pslg;
  Box box;
  for (const Point p : pslg.points) box.add(p);
  if (!(box.min_x < box.max_x && box.min_y < box.max_y)) return;
  constexpr std::int32_t kBottom = 101;
  const auto first = static_cast<std::uint32_t>(pslg.points.size());
  pslg.points.insert(pslg.points.end(), {{box.min_x, box.min_y},
                                         {box.max_x, box.min_y},
                                         {box.max_x, box.max_y},
                                         {box.min_x, box.max_y}});
  for (std::uint32_t i = 0; i < 4; ++i)
    pslg.segments.push_back(
        {first + i, first + (i + 1) % 4, kBottom + static_cast<std::int32_t>(i)});
  request.periodic = {{kBottom, kBottom + 2}, {kBottom + 3, kBottom + 1}};
}

}  // namespace

MeshCase decode_mesh_case(ByteSource bytes) {
  MeshCase made;
  MeshRequest& request = made.request;
  // The bounds come first, so that what a mutation adds at the end is more of the domain.
  const std::size_t bounds = bytes.byte();
  ByteSource size_bytes = bytes;
  bytes.take(6);
  constexpr std::array<double, 9> kAngles{20, 20, 0, 25, 30, 33, 36, 12.5, 1};
  request.min_angle_deg = kAngles[bounds % kAngles.size()];
  request.leaf_triangles = bytes.one_of<double>({16'000, 50, 50, 100, 300});
  const std::size_t rarely = bytes.byte();
  PslgMaker maker(bytes, request.pslg);
  made.plain = maker.make();
  request.size = read_size(size_bytes, maker.extent(), request.pslg);
  if (rarely % 8 == 0 && rarely / 32 > 3) {  // not what the corpus held before it could be asked
    request.keep.emplace();
    const std::size_t which = rarely / 8 % 4;
    if (which > 0 && which <= request.pslg.segments.size())
      request.keep->push_back(request.pslg.segments[which - 1].marker);
  }
  if (rarely % 8 == 0 && rarely / 32 == 3) add_periodic_box(request);
  if (rarely % 8 == 4 && rarely / 64 == 3 && !request.pslg.segments.empty()) {
    const std::size_t which = rarely / 8 % request.pslg.segments.size();
    const double first = maker.extent() / static_cast<double>(8 + rarely % 64 * 16);
    request.layers = {{request.pslg.segments[which].marker, first, 1.3, 3, 99}};
  }
  if (rarely % 8 == 1) request.min_edge = maker.extent() / static_cast<double>(1 + rarely);
  if (rarely % 8 == 2) made.budget.max_triangles = rarely;
  if (rarely % 8 == 3) {
    constexpr std::array<double, 4> kSnaps{1e-9, 1e-6, 1e-4, 1e-3};
    request.pslg.snap = maker.extent() * kSnaps[rarely / 8 % kSnaps.size()];
  }
  if (rarely % 8 == 4) request.placement = Placement::kCircumcentre;
  if (rarely % 8 == 5) request.sweeps = rarely / 8 % 4;
  if (rarely % 8 == 5 && rarely / 32 == 7) request.size.points_per_circle = 36;
  if (rarely % 8 == 6) {
    constexpr std::array<double, 4> kGradations{0.15, 0.02, 0.5, 3};
    request.size.gradation = kGradations[rarely / 8 % kGradations.size()];
    // One in four, and not those that the corpus held before there was a choice.
    request.size.gradation_within = rarely / 32 % 4 == 1;
  }
  if (rarely % 8 == 7 && !request.pslg.segments.empty()) {
    const std::size_t which = rarely / 8 % request.pslg.segments.size();
    const double max_edge = maker.extent() / static_cast<double>(1 + rarely / 4);
    request.size.at.push_back({request.pslg.segments[which].marker, max_edge});
    if (rarely / 128 == 1) request.size.gradation = 0.25;
    request.size.gradation_within = rarely / 64 == 2;  // as above
  }
  made.plain = made.plain && request.pslg.snap == 0;
  const bool has_size =
      !std::holds_alternative<std::monostate>(request.size.value) || !request.size.at.empty();
  const bool is_small = has_size && bounds / kAngles.size() % 8 != 1;
  made.budget.triangle_limit = is_small ? kFewTriangles : kMaxTriangles;
  made.budget.max_bytes = is_small ? kFewBytes : kMaxBytes;
  return made;
}

std::string to_text(const MeshCase& mesh_case) {
  const MeshRequest& request = mesh_case.request;
  const Pslg& pslg = request.pslg;
  std::string text = print("# --min-angle %.17g", request.min_angle_deg);
  if (const auto* const constant = std::get_if<double>(&request.size.value))
    text += print(" --size %.17g", *constant);
  if (const auto* const expression = std::get_if<std::string>(&request.size.value))
    text +=
        (request.size.measure == Measure::kEdge ? " --edge '" : " --size '") + *expression + "'";
  if (request.size.points_per_circle > 0)
    text += print(" --points-per-circle %.17g", request.size.points_per_circle);
  if (request.size.cells_across > 0)
    text += print(" --cells-across %.17g", request.size.cells_across);
  for (const SizeAt& at : request.size.at)
    text += print(" --edge-at marker=%d:%.17g", at.marker, at.max_edge);
  if (request.size.gradation > 0) text += print(" --gradation %.17g", request.size.gradation);
  if (request.size.gradation_within) text += " --gradation-within";
  if (request.min_edge > 0) text += print(" --min-edge %.17g", request.min_edge);
  if (request.keep)
    text += " --keep " + (request.keep->empty() ? "all" : std::to_string(request.keep->front()));
  for (const PeriodicPair& pair : request.periodic)
    text += print(" --periodic %d:%d", pair.from, pair.to);
  for (const Layers& layers : request.layers)
    text += print(" --layers %d:first=%.17g,ratio=%.17g,rows=%u,region=%d", layers.marker,
                  layers.first, layers.ratio, layers.rows, layers.region.value_or(0));
  if (request.placement == Placement::kCircumcentre) text += " --placement circumcentre";
  if (request.sweeps) text += print(" --optimise %u", *request.sweeps);
  if (pslg.snap > 0) text += print(" --snap %.17g", pslg.snap);
  if (mesh_case.budget.max_triangles != Budget{}.max_triangles)
    text += print(" --max-triangles %llu",
                  static_cast<unsigned long long>(mesh_case.budget.max_triangles));
  text +=
      print("   (leaf_triangles %g, fill %s, triangle_limit %llu)\n",
            request.leaf_triangles.value_or(0), pslg.fill == Fill::kSeeds ? "seeds" : "even-odd",
            static_cast<unsigned long long>(mesh_case.budget.triangle_limit));
  if (const auto* const raster = std::get_if<Raster>(&request.size.value)) {
    text += print("# raster: origin %.17g %.17g, step %.17g %.17g, %u x %u:", raster->origin.x,
                  raster->origin.y, raster->dx, raster->dy, raster->columns, raster->rows);
    for (const double value : raster->values) text += print(" %.17g", value);
    text += "\n";
  }
  for (const FieldSpec& field : request.size.fields) text += to_text(field);
  text += print("%zu 2 0 0\n", pslg.points.size());
  for (std::size_t i = 0; i < pslg.points.size(); ++i)
    text += print("%zu %.17g %.17g\n", i, pslg.points[i].x, pslg.points[i].y);
  text += print("%zu 1\n", pslg.segments.size());
  for (std::size_t i = 0; i < pslg.segments.size(); ++i)
    text +=
        print("%zu %u %u %d\n", i, pslg.segments[i].a, pslg.segments[i].b, pslg.segments[i].marker);
  text += print("%zu\n", pslg.holes.size());
  for (std::size_t i = 0; i < pslg.holes.size(); ++i)
    text += print("%zu %.17g %.17g\n", i, pslg.holes[i].x, pslg.holes[i].y);
  for (const Arc& arc : pslg.arcs) text += print("# arc=%u:%.17g\n", arc.segment, arc.bulge);
  text += print("%zu\n", pslg.regions.size());
  for (std::size_t i = 0; i < pslg.regions.size(); ++i)
    text += print("%zu %.17g %.17g %d %.17g\n", i, pslg.regions[i].at.x, pslg.regions[i].at.y,
                  pslg.regions[i].id, pslg.regions[i].max_area.value_or(-1));
  return text;
}

}  // namespace weft::fuzz
