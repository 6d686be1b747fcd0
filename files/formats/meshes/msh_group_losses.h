// SPDX-License-Identifier: Apache-2.0
// Gmsh's elements may be in several physical groups; here an element has one region or marker: that
// of the first of its groups in the file. MSH 4.1 lists the groups of an entity; MSH 2.2 has the
// element once for each. What is lost by that becomes warnings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/formats/mesh.h"

namespace weft::files {

// The numbers of the groups of the mesh's elements.
struct MshGroups {
  std::vector<std::int32_t> of_edges;
  std::vector<std::int32_t> of_triangles;
  std::vector<std::int32_t> of_faces;  // of four corners
};

class MshGroupLosses {
 public:
  using Group = std::pair<std::int32_t, std::int32_t>;  // dimension, number

  void name(Group group, std::string_view name) { names_.emplace(group, name); }
  // Groups that elements carry.
  void keep(const MshGroups& groups);
  // So many elements of the group `lost` carry `kept` instead.
  void lose(Group lost, Group kept, std::size_t elements);

  // Removes elements that repeat an earlier one of another group.
  void remove_repeated(Mesh& mesh, MshGroups& groups);

  // Sentences that follow the name of the file.
  std::vector<std::string> sentences() const;

 private:
  std::string called(Group group) const;

  struct Loss {
    std::size_t elements = 0;
    Group kept;  // of the first of them
  };
  std::map<Group, std::string> names_;
  std::set<Group> kept_;
  std::map<Group, Loss> lost_;
};

}  // namespace weft::files
