// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/formats/domains/attribute_condition.h"
#include "files/formats/domains/dxf_ends.h"
#include "files/formats/domains/dxf_model.h"
#include "files/formats/domains/feature_properties.h"
#include "files/formats/domains/geometry_builder.h"
#include "files/formats/domains/nested_outlines.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr std::string_view kLayer = "entities";
constexpr std::string_view kAttributes[] = {"Layer",    "PaperSpace",   "SubClasses",
                                            "Linetype", "EntityHandle", "Text"};

class Reader {
 public:
  Reader(const std::string& file, std::string_view text, const LayerOptions& options)
      : file_(file), drawing_(file, text), options_(options), builder_(file, options.lonlat) {}

  Result<Domain> read() {
    if (auto ok = check_options(); !ok) return tl::unexpected(ok.error());
    DxfModel model = dxf_model(drawing_);
    if (auto chosen = choose(model); !chosen) return tl::unexpected(chosen.error());
    join_ends(model.shapes);
    const std::vector<bool> straightened = straighten_degenerate(model.shapes);
    for (std::size_t i = 0; i < model.shapes.size(); ++i) {
      const DxfFeature& feature = model.features[i];
      if (straightened[i])
        model.notes.add(DxfNotes::Fate::kStraightened, feature.kind, feature.line);
      if (auto added = add(model.shapes[i], feature); !added) return tl::unexpected(added.error());
    }
    for (Warning& warning : model.notes.warnings(model.has_model))
      builder_.warn(std::move(warning));
    warn_of_filled_areas();
    auto domain = builder_.finish();
    if (domain && domain->areas.empty() && !options_.even_odd) warn_of_nested_outlines(*domain);
    return domain;
  }

 private:
  Result<void> check_options() const {
    for (const std::string& layer : options_.layers)
      if (layer != kLayer)
        return builder_.bad("", "has no layer " + in_quotes(layer) + "; there are " +
                                    in_quotes(kLayer) +
                                    ", whose attribute Layer says on which layer each is drawn");
    for (const auto& [property, attribute] : options_.attributes)
      if (!index_of(attribute))
        return builder_.bad("", "has no attribute " + in_quotes(attribute) + "; there are " +
                                    in_quotes(std::vector<std::string>(std::begin(kAttributes),
                                                                       std::end(kAttributes))));
    return {};
  }
  static std::optional<std::size_t> index_of(std::string_view attribute) {
    for (std::size_t i = 0; i < std::size(kAttributes); ++i)
      if (lower_case(kAttributes[i]) == lower_case(attribute)) return i;
    return std::nullopt;
  }

  AttributeValue value(const DxfFeature& feature, std::size_t attribute) const {
    const auto text = [this](std::string_view of_file) -> AttributeValue {
      if (of_file.empty()) return {};
      return drawing_.utf8(of_file);
    };
    switch (attribute) {
      case 0:
        return text(feature.layer);
      case 1:
        return feature.is_on_paper ? AttributeValue(1.0) : AttributeValue();
      case 2:
        return text(feature.subclasses);
      case 3:
        return text(feature.linetype);
      case 4:
        return text(feature.handle);
      default:
        return text(feature.pattern);
    }
  }

  // Keeps the features that meet the condition.
  Result<void> choose(DxfModel& model) {
    const auto condition = AttributeCondition::parse(options_.where, kAttributes);
    if (!condition)
      return builder_.bad("layer " + in_quotes(kLayer) + ", --where " + in_quotes(options_.where),
                          "cannot be read: " + condition.error().message);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < model.features.size(); ++i) {
      if (!condition->holds([&](std::size_t a) { return value(model.features[i], a); })) continue;
      has_lines_ = has_lines_ || model.shapes[i].kind == DxfShape::Kind::kLine;
      if (kept != i) {
        model.features[kept] = std::move(model.features[i]);
        model.shapes[kept] = std::move(model.shapes[i]);
      }
      ++kept;
    }
    model.features.resize(kept);
    model.shapes.resize(kept);
    return {};
  }

  std::string path_of(const DxfFeature& feature) const {
    return "layer " + in_quotes(kLayer) + ", feature " + std::to_string(feature.number) + " on " +
           in_quotes(drawing_.utf8(feature.layer)) +
           (feature.handle.empty() ? "" : ", handle " + harmless(feature.handle)) +
           (feature.part ? ", part " + std::to_string(*feature.part) : "");
  }

  Result<GeometryProperties> properties_of(const DxfFeature& feature, const std::string& path) {
    return feature_properties(
        builder_, path + ", field ", [&](const char* property) -> PropertyValue {
          const auto named = options_.attributes.find(property);
          if (named == options_.attributes.end()) return {};
          const AttributeValue found = value(feature, *index_of(named->second));
          if (const double* number = std::get_if<double>(&found))
            return number_of_table(property, *number);
          const std::string* const text = std::get_if<std::string>(&found);
          return {std::nullopt, text == nullptr ? "" : *text, ""};
        });
  }

  Result<void> add(const DxfShape& shape, const DxfFeature& feature) {
    const std::string path = path_of(feature);
    const auto properties = properties_of(feature, path);
    if (!properties) return tl::unexpected(properties.error());
    if (shape.kind == DxfShape::Kind::kPoint) return builder_.point(shape.rings[0].points[0], path);
    if (shape.kind == DxfShape::Kind::kLine)
      return builder_.line(shape.rings[0].points, path, *properties, {}, shape.rings[0].bulges);
    if (has_lines_) {
      if (filled_areas_++ == 0) first_filled_area_ = path;
      return {};
    }
    return add_area(shape, path, *properties);
  }

  Result<void> add_area(const DxfShape& area, const std::string& path,
                        const GeometryProperties& properties) {
    if (area.rings.empty()) builder_.leave_out(LeftOut::kGeometry, path);
    builder_.begin_polygon(RingRoles::kByPlace);
    for (std::size_t i = 0; i < area.rings.size(); ++i)
      if (auto added = builder_.ring(area.rings[i].points, path + ", ring " + std::to_string(i),
                                     properties, {}, area.rings[i].bulges);
          !added)
        return added;
    builder_.end_polygon(path, properties);
    return {};
  }

  // What lines bound is filled by areas for the eye.
  void warn_of_filled_areas() {
    if (filled_areas_ == 0) return;
    const bool one = filled_areas_ == 1;
    builder_.warn(
        {.kind = WarningKind::kLeftOut,
         .place = first_filled_area_,
         .count = filled_areas_,
         .text = with_separators(filled_areas_) +
                 (one ? " filled area (hatch, solid or face) is left out: "
                      : " filled areas (hatches, solids or faces) are left out, the first is ") +
                 first_filled_area_ +
                 "; lines bound what is meshed; without lines, as --where can choose, such areas "
                 "are"});
  }

  // Not of a drawing of so many arcs that their chords take gigabytes and minutes.
  void warn_of_nested_outlines(Domain& domain) const {
    constexpr std::size_t kMaxArcs = 5000;
    if (domain.arcs.size() > kMaxArcs) return;
    Domain flat = domain;
    if (!flatten_arcs(flat)) return;
    const std::vector<std::size_t> nested = nested_outlines(flat);
    if (nested.empty()) return;
    std::string first = flat.segment_places.locate(nested[0]);
    first.erase(std::min(first.rfind(", edge from"), first.size()));
    if (first.starts_with(file_ + ": ")) first.erase(0, file_.size() + 2);
    domain.warnings.push_back(
        {.kind = WarningKind::kNestedOutline,
         .file = file_,
         .place = first,
         .count = nested.size(),
         .text =
             with_separators(nested.size()) +
             (nested.size() == 1 ? " closed outline lies inside another one and is filled: "
                                 : " closed outlines lie inside others and are filled, the first "
                                   "is ") +
             first + "; --fill even-odd makes holes of them"});
  }

  const std::string file_;
  const DxfDrawing drawing_;
  const LayerOptions& options_;
  GeometryBuilder builder_;
  bool has_lines_ = false;
  std::size_t filled_areas_ = 0;  // of a drawing with lines
  std::string first_filled_area_{};
};

}  // namespace

Result<Domain> read_dxf_text(const std::string& file, std::string_view text,
                             const LayerOptions& options) {
  try {
    return Reader(file, text, options).read();
  } catch (const DxfFault& fault) {
    return tl::unexpected(fault.error);
  }
}

Result<Domain> read_dxf(const std::filesystem::path& path, const LayerOptions& options) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return read_dxf_text(path.string(), contents->text(), options);
}

}  // namespace weft::files
