// SPDX-License-Identifier: Apache-2.0
// All shapes of a drawing, with those of the blocks that it places, and what it has beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/formats/domains/dxf_entities.h"
#include "files/formats/domains/dxf_shapes.h"
#include "files/formats/warning.h"

namespace weft::files {

// What of a drawing is not in its domain as it is drawn, by the kind of entity.
class DxfNotes {
 public:
  enum class Fate { kUnread, kOnPaper, kNoCurve, kNoBlock, kStraightened };

  void add(Fate fate, std::string_view kind, std::uint64_t line);
  // Those on paper count if there is a model.
  std::vector<Warning> warnings(bool has_model) const;

 private:
  struct Count {
    std::size_t number = 0;
    std::uint64_t line = 0;  // of the first
  };
  std::map<std::pair<Fate, std::string>, Count> counts_;
};

// The entity that a shape is of. Texts are those of the file.
struct DxfFeature {
  std::string_view kind;
  std::string_view layer;  // in a block, 0 is the layer that the block is placed on
  std::string_view linetype;
  std::string_view handle;  // of the INSERT for what is in a block
  std::string_view pattern;
  std::string subclasses;  // "AcDbEntity:AcDbLine"
  bool is_on_paper = false;
  std::size_t number = 0;           // among the entities that are drawn
  std::optional<std::size_t> part;  // of what an INSERT places
  std::uint64_t line = 0;           // of the entity's kind
};

struct DxfModel {
  std::vector<DxfFeature> features;
  std::vector<DxfShape> shapes;  // one for each feature
  DxfNotes notes;
  bool has_model = false;  // or all is on paper
};

// The entities of the model, in their order; of a drawing that is on paper alone, those. Texts,
// dimensions and other annotations are not read. Throws DxfFault; blocks that are placed in blocks
// go 64 levels deep, and all blocks place at most 5 million groups of entities and positions.
DxfModel dxf_model(const DxfDrawing& drawing);

}  // namespace weft::files
