// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/wkt.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/malformed.h"
#include "files/bytes/number_text.h"
#include "files/formats/domains/geometry_builder.h"
#include "files/formats/domains/three_point_arcs.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr int kMaxDepth = 64;  // of collections in collections
constexpr std::string_view kBlanks = " \t\r\n\f\v";

class Reader {
 public:
  Reader(const std::string& name, std::string_view text, TextPlace place,
         const GeometryProperties& properties, GeometryBuilder& builder)
      : name_(name),
        whole_(text),
        rest_(text),
        place_(place),
        properties_(properties),
        builder_(builder) {}

  Result<void> read() {
    try {
      for (std::size_t i = 0; !at_end(); ++i) {
        geometry("geometry " + std::to_string(i), 0);
        while (take(';')) {
        }
      }
      return {};
    } catch (const Malformed& malformed) {
      return tl::unexpected(malformed.error);
    }
  }

 private:
  [[noreturn]] void fail_here(const std::string& what) const {
    const std::string_view before = whole_.substr(0, whole_.size() - rest_.size());
    const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    const std::size_t indent = line_start == 0 ? place_.column : 1;
    throw Malformed{{ExitCode::kUnreadableInput,
                     name_ + ":" + std::to_string(line()) + ":" +
                         std::to_string(before.size() - line_start + indent) + ": " + what}};
  }
  // The number of lines up to here; counts on from the place of the last call.
  std::uint64_t line() const {
    const std::size_t here = whole_.size() - rest_.size();
    lines_ += static_cast<std::size_t>(
        std::count(whole_.begin() + static_cast<std::ptrdiff_t>(counted_),
                   whole_.begin() + static_cast<std::ptrdiff_t>(here), '\n'));
    counted_ = here;
    return lines_ + place_.line;
  }

  void skip_blanks() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
  }
  bool at_end() {
    skip_blanks();
    return rest_.empty();
  }
  bool take(char c) {
    skip_blanks();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (take(c)) return;
    fail_here(std::string("expected '") + c + "', found " + found());
  }
  std::string found() const {
    return rest_.empty() ? "the end of the file"
                         : in_quotes(rest_.substr(0, rest_.find_first_of("(), \t\r\n", 1)));
  }
  // Reads letters, and returns them in upper case; reads nothing if there are none.
  std::string word() {
    skip_blanks();
    std::string out;
    while (!rest_.empty()) {
      const char c = static_cast<char>(rest_[0] & ~0x20);
      if (c < 'A' || c > 'Z') break;
      out += c;
      rest_.remove_prefix(1);
    }
    return out;
  }
  bool take_empty() {
    const std::string_view before = rest_;
    if (word() == "EMPTY") return true;
    rest_ = before;
    return false;
  }

  double number() {
    skip_blanks();
    const std::string_view word = rest_.substr(0, rest_.find_first_of("(),; \t\r\n\f\v"));
    const auto value = real_of(word);
    if (!value) fail_here("expected a finite number, found " + found());
    rest_.remove_prefix(word.size());
    return *value;
  }

  // NaN, as GEOS and GDAL write a height that is not there, in whatever way their C library does.
  bool take_nan() {
    skip_blanks();
    const std::string_view word = rest_.substr(0, rest_.find_first_of("(),; \t\r\n\f\v"));
    const std::string letters =
        lower_case(word.substr(std::min(word.find_first_not_of("+-1.#"), word.size())));
    if (!letters.starts_with("nan") && letters != "qnan" && letters != "ind") return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  // Reads two numbers, and up to two more that are dropped.
  Point position() {
    Point at;
    at.x = number();
    at.y = number();
    for (int more = 0; more < 2; ++more) {
      skip_blanks();
      if (rest_.empty() || rest_[0] == ',' || rest_[0] == ')') break;
      if (!take_nan()) number();
    }
    return at;
  }

  std::vector<Point> positions() {
    std::vector<Point> out;
    expect('(');
    do out.push_back(position());
    while (take(','));
    expect(')');
    return out;
  }

  std::string at_line(const std::string& path) const {
    return "line " + std::to_string(line()) + ", " + path;
  }

  void point(const std::string& path) {
    skip_blanks();
    const std::string place = at_line(path);
    const bool bare = !rest_.starts_with('(');  // MULTIPOINT(1 2, 3 4)
    if (!bare) expect('(');
    must(builder_.point(position(), place));
    if (!bare) expect(')');
  }

  void line_string(const std::string& path) {
    skip_blanks();
    const std::string place = at_line(path);
    must(builder_.line(positions(), place, properties_));
  }

  ArcChain straight() { return ArcChain(positions()); }
  ArcChain circular() {
    ArcChain chain;
    const std::string fault = add_three_point_arcs(positions(), chain);
    if (!fault.empty()) fail_here("this circular string " + fault);
    return chain;
  }
  ArcChain compound() {
    ArcChain chain;
    expect('(');
    do {
      const std::string fault = append(curve(), chain);
      if (!fault.empty()) fail_here("this compound curve " + fault);
    } while (take(','));
    expect(')');
    return chain;
  }
  // A curve that is part of something, whose name is left out if it is a line.
  ArcChain curve() {
    const std::string kind = take_kind();
    if (kind == "CIRCULARSTRING") return circular();
    if (kind == "COMPOUNDCURVE") return compound();
    if (!kind.empty() && kind != "LINESTRING")
      fail_here("expected a curve, found " + in_quotes(kind));
    return take_empty() ? ArcChain() : straight();
  }

  void add_line(const std::string& path, ArcChain (Reader::*read)()) {
    skip_blanks();
    const std::string place = at_line(path);
    const ArcChain chain = (this->*read)();
    must(builder_.line(chain.points, place, properties_, {}, chain.bulges));
  }
  void circular_string(const std::string& path) { add_line(path, &Reader::circular); }
  void compound_curve(const std::string& path) { add_line(path, &Reader::compound); }
  void curve_part(const std::string& path) { add_line(path, &Reader::curve); }

  void add_polygon(const std::string& path, ArcChain (Reader::*read)()) {
    skip_blanks();
    const std::string whole = at_line(path);
    builder_.begin_polygon();
    expect('(');
    std::size_t ring = 0;
    do {
      skip_blanks();
      const std::string place = at_line(path + ", ring " + std::to_string(ring++));
      const ArcChain chain = take_empty() ? ArcChain() : (this->*read)();
      must(builder_.ring(chain.points, place, properties_, {}, chain.bulges));
    } while (take(','));
    expect(')');
    builder_.end_polygon(whole, properties_);
  }
  void polygon(const std::string& path) { add_polygon(path, &Reader::straight); }
  void curve_polygon(const std::string& path) { add_polygon(path, &Reader::curve); }
  // Whose name is left out if it has no arcs.
  void surface_part(const std::string& path) {
    const std::string kind = take_kind();
    if (kind == "CURVEPOLYGON") return curve_polygon(path);
    if (!kind.empty() && kind != "POLYGON")
      fail_here("expected a polygon, found " + in_quotes(kind));
    polygon(path);
  }

  void leave_out(const std::string& path) { builder_.leave_out(LeftOut::kGeometry, at_line(path)); }

  // The name of a geometry without the tag of its dimensions: "POLYGON Z", "POLYGONZ".
  std::string take_kind() {
    std::string kind = word();
    for (const std::string_view tag : {"ZM", "Z", "M"})
      if (kind.ends_with(tag)) return kind.substr(0, kind.size() - tag.size());
    const std::string_view before = rest_;
    const std::string tag = word();
    if (tag != "Z" && tag != "M" && tag != "ZM") rest_ = before;
    return kind;
  }

  void geometry(const std::string& path, int depth) {
    std::string kind = take_kind();
    if (kind == "SRID") {
      expect('=');
      number();
      expect(';');
      kind = take_kind();
    }
    using Part = void (Reader::*)(const std::string&);
    struct Kind {
      std::string_view name;
      Part part;
      const char* parts;  // the parts of a collection, as errors call them
    };
    static constexpr Kind kKinds[] = {
        {"POINT", &Reader::point, nullptr},
        {"LINESTRING", &Reader::line_string, nullptr},
        {"LINEARRING", &Reader::line_string, nullptr},
        {"POLYGON", &Reader::polygon, nullptr},
        {"TRIANGLE", &Reader::polygon, nullptr},
        {"MULTIPOINT", &Reader::point, ", point "},
        {"MULTILINESTRING", &Reader::line_string, ", line "},
        {"MULTIPOLYGON", &Reader::polygon, ", polygon "},
        {"GEOMETRYCOLLECTION", nullptr, ", geometry "},
        {"CIRCULARSTRING", &Reader::circular_string, nullptr},
        {"COMPOUNDCURVE", &Reader::compound_curve, nullptr},
        {"CURVEPOLYGON", &Reader::curve_polygon, nullptr},
        {"MULTICURVE", &Reader::curve_part, ", line "},
        {"MULTISURFACE", &Reader::surface_part, ", polygon "},
    };
    const auto known = std::ranges::find(kKinds, kind, &Kind::name);
    if (known == std::end(kKinds))
      fail_here("expected a geometry of well-known text, found " +
                (kind.empty() ? found() : in_quotes(kind)));
    if (take_empty()) return leave_out(path);
    if (known->parts == nullptr) return (this->*known->part)(path);
    if (depth == kMaxDepth) fail_here("is nested deeper than 64 levels");
    expect('(');
    std::size_t i = 0;
    do {
      const std::string part = path + known->parts + std::to_string(i++);
      if (known->part == nullptr) {
        geometry(part, depth + 1);
      } else if (take_empty()) {
        leave_out(part);
      } else {
        (this->*known->part)(part);
      }
    } while (take(','));
    expect(')');
  }

  std::string name_;
  std::string_view whole_;
  std::string_view rest_;
  mutable std::size_t counted_ = 0;  // bytes whose lines are counted in lines_
  mutable std::size_t lines_ = 0;
  const TextPlace place_;
  const GeometryProperties& properties_;
  GeometryBuilder& builder_;
};

}  // namespace

Result<Domain> read_wkt(const std::filesystem::path& path, bool lonlat) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  GeometryBuilder builder(path.string(), lonlat);
  if (auto added = add_wkt(path.string(), contents->text(), {}, {}, builder); !added)
    return tl::unexpected(added.error());
  return builder.finish();
}

Result<void> add_wkt(const std::string& name, std::string_view text, TextPlace place,
                     const GeometryProperties& properties, GeometryBuilder& builder) {
  return Reader(name, text, place, properties, builder).read();
}

}  // namespace weft::files
