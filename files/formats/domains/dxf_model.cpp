// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf_model.h"

#include <algorithm>

#include "files/base/text.h"

namespace weft::files {
namespace {

constexpr int kMaxDepth = 64;                // of blocks in blocks
constexpr std::size_t kMaxPlaced = 5000000;  // groups and positions, by blocks
constexpr std::size_t kGroupsOfInsert = 8;   // as much work as a block that is empty

DxfPlacement shift(Point by) {
  return {.x0 = by.x, .y0 = by.y};
}

std::string subclasses_of(const DxfEntity& entity) {
  std::string all;
  for (const DxfGroup& group : entity.groups)
    if (group.code == 100) all += (all.empty() ? "" : ":") + harmless(group.value);
  return all;
}

class Collector {
 public:
  explicit Collector(const DxfDrawing& drawing) : drawing_(drawing) {}

  DxfModel collect() {
    look_through();
    drawing_.for_each(drawing_.entities(), [this](const DxfEntity& entity) {
      if (!is_drawn(entity.kind) || (model_.has_model && entity.is_on_paper())) return;
      Level level;
      level.feature = {.layer = "0",
                       .handle = entity.text(5),
                       .is_on_paper = entity.is_on_paper(),
                       .number = number_++};
      parts_ = 0;
      add(entity, level);
    });
    return std::move(model_);
  }

 private:
  // Where blocks have led.
  struct Level {
    DxfFeature feature;  // what is the same of all that is placed
    DxfPlacement placement;
    int depth = 0;
  };

  void look_through() {
    const auto note_unread = [this](const DxfEntity& entity) {
      if (!is_drawn(entity.kind) && !is_annotation(entity.kind))
        model_.notes.add(DxfNotes::Fate::kUnread, entity.kind, entity.line);
    };
    drawing_.for_each(drawing_.entities(), [&](const DxfEntity& entity) {
      if (!entity.is_on_paper()) {
        note_unread(entity);
        model_.has_model = model_.has_model || is_drawn(entity.kind);
      } else if (!is_annotation(entity.kind)) {
        model_.notes.add(DxfNotes::Fate::kOnPaper, entity.kind, entity.line);
      }
    });
    for (const auto& [name, block] : drawing_.blocks())
      drawing_.for_each(block.entities, note_unread);
  }

  void add(const DxfEntity& entity, const Level& level) {
    DxfFeature feature = level.feature;
    feature.kind = entity.kind;
    feature.line = entity.line;
    if (const auto layer = entity.text(8); !layer.empty() && layer != "0") feature.layer = layer;
    if (entity.kind == "INSERT") return insert(entity, level, feature);
    auto shape = shape_of(entity, level.placement);
    if (!shape) return model_.notes.add(DxfNotes::Fate::kNoCurve, entity.kind, entity.line);
    if (level.depth > 0) {
      for (const ArcChain& ring : shape->rings) count(ring.points.size(), entity);
      shape->has_computed_ends = true;
      feature.part = parts_++;
    }
    feature.linetype = entity.text(6);
    if (entity.kind == "HATCH") feature.pattern = entity.text(2);
    feature.subclasses = subclasses_of(entity);
    model_.features.push_back(std::move(feature));
    model_.shapes.push_back(std::move(*shape));
  }

  void insert(const DxfEntity& entity, const Level& level, const DxfFeature& feature) {
    if (level.depth == kMaxDepth) refuse(entity, "blocks that are nested at most 64 levels deep");
    const DxfDrawing::Block* const block = drawing_.block(entity.text(2));
    if (block == nullptr)
      return model_.notes.add(DxfNotes::Fate::kNoBlock, entity.kind, entity.line);
    const Point turn = direction(entity.real(50));
    const DxfPlacement rotation{turn.x, -turn.y, turn.y, turn.x, 0, 0};
    const DxfPlacement scale{.xx = entity.real(41, 1), .yy = entity.real(42, 1)};
    const DxfPlacement outer = level.placement.after(plane_of(entity.extrusion(), entity.real(30)))
                                   .after(shift(entity.point(10)))
                                   .after(rotation);
    const DxfPlacement inner = scale.after(shift({-block->base.x, -block->base.y}));
    Level below{feature, {}, level.depth + 1};
    const int columns = std::max(1, entity.integer(70, 1));
    const int rows = std::max(1, entity.integer(71, 1));
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const Point cell{column * entity.real(44), row * entity.real(45)};
        below.placement = outer.after(shift(cell)).after(inner);
        count(kGroupsOfInsert, entity);
        drawing_.for_each(block->entities, [&](const DxfEntity& part) {
          count(1 + part.groups.size() + 8 * part.vertices.size(), entity);
          if (is_drawn(part.kind)) add(part, below);
        });
      }
  }

  void count(std::size_t placed, const DxfEntity& entity) {
    placed_ += placed;
    if (placed_ > kMaxPlaced)
      refuse(entity,
             "blocks that place at most " + with_separators(kMaxPlaced) + " groups and positions");
  }
  [[noreturn]] void refuse(const DxfEntity& entity, const std::string& expected) const {
    throw DxfFault{fail(ExitCode::kUnreadableInput,
                        drawing_.file() + ":" + std::to_string(entity.line) + ": expected " +
                            expected + ", found more at this " + std::string(entity.kind))
                       .value()};
  }

  const DxfDrawing& drawing_;
  DxfModel model_;
  std::size_t number_ = 0;
  std::size_t parts_ = 0;  // of the entity so far
  std::size_t placed_ = 0;
};

std::string_view verdict_on(DxfNotes::Fate fate) {
  switch (fate) {
    case DxfNotes::Fate::kUnread:
      return "not read: it has no lines that weft knows";
    case DxfNotes::Fate::kOnPaper:
      return "left out: on paper, not in the model";
    case DxfNotes::Fate::kNoCurve:
      return "left out: a mesh of faces, or a spline whose numbers do not belong together";
    case DxfNotes::Fate::kNoBlock:
      return "left out: of a block that is not in the file";
    case DxfNotes::Fate::kStraightened:
      return "straight where a bulge is above 1e6, or between points that are hardly apart";
  }
  return "";
}

}  // namespace

void DxfNotes::add(Fate fate, std::string_view kind, std::uint64_t line) {
  Count& count = counts_[{fate, std::string(kind)}];
  if (count.number++ == 0 || line < count.line) count.line = line;
}

std::vector<Warning> DxfNotes::warnings(bool has_model) const {
  std::vector<Warning> all;
  for (const auto& [what, count] : counts_) {
    const auto& [fate, kind] = what;
    if (fate == Fate::kOnPaper && !has_model) continue;
    const bool one = count.number == 1;
    const std::string line = std::to_string(count.line);
    all.push_back({.kind = WarningKind::kLeftOut,
                   .place = "line " + line,
                   .count = count.number,
                   .text = with_separators(count.number) + (one ? " entity" : " entities") +
                           " of the kind " + in_quotes(kind) +
                           (one ? ", line " : ", the first in line ") + line +
                           (one ? ", is " : ", are ") + std::string(verdict_on(fate))});
  }
  return all;
}

DxfModel dxf_model(const DxfDrawing& drawing) {
  return Collector(drawing).collect();
}

}  // namespace weft::files
