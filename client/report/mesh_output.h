// SPDX-License-Identifier: Apache-2.0
// Writes a mesh to files: meshes in their formats, and drawings. All of them appear complete, or
// none.
//
//   auto output = MeshOutput::open({.files = {"key.vtu"}}, "key.poly", stop);
//   auto spool = output->make_spool();
//   ... the mesh arrives in the spool ...
//   if (auto written = output->write(view, summary); !written) ...
//   print(output->text());
//
// Errors: kUsage if there is nothing to write, an extension is unknown, a name is given twice or
// is the input's; kUnwritableOutput if a file cannot be written. Not thread-safe.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "client/drawing/draw.h"
#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/derived/deep_boundary.h"
#include "files/formats/mesh.h"
#include "files/formats/mesh_formats.h"
#include "files/geo/domain_projection.h"
#include "files/message/mesh_spool.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

struct MeshOutputOptions {
  std::vector<DataPath> files{};
  MeshWriteOptions writing{};  // of the files
  std::vector<std::filesystem::path> drawings{};
  DrawOptions drawing{};           // of the drawings
  AreaBound area_bound{};          // that the drawings colour by
  bool draw_quadtree = false;      // over the drawings
  ProjectionOptions projection{};  // of the domain; the caller projects it
  bool make_folders = false;       // that are missing, once the mesh is complete
  bool has_values = false;         // whether the mesh may come with values at its vertices

  bool empty() const { return files.empty() && drawings.empty(); }
  // Where text on the files goes: standard output, unless one of the files does.
  std::FILE* text_stream() const;
};

class MeshOutput {
 public:
  // Checks that all files can be written, and writes nothing yet. `input`, if any, is not replaced.
  static Result<MeshOutput> open(const MeshOutputOptions& options,
                                 const std::optional<std::filesystem::path>& input,
                                 const std::stop_token& stop);

  // Makes a spool that holds the mesh while it arrives, beside the first file, and draws it; a mesh
  // that is only drawn is not held. This must outlive the spool.
  Result<std::unique_ptr<MeshSpool>> make_spool();
  const MeshOutputOptions& options() const { return options_; }
  // Null if nothing is drawn. It gets the mesh from the spool, or from whoever has no spool.
  Drawing* drawing() const { return drawing_.get(); }
  // The spool adds the mesh to this drawing, too, which must outlive it.
  void also_draw(Drawing& other) { other_drawing_ = &other; }
  // The mesh that arrives is that of `domain`, in metres of the projection, and is written in
  // longitude and latitude unless the projection says metres; drawings show the plane. Null: it is
  // written as it arrives. Errors: a source of values at the vertices has none there
  // (check_nodal_sources).
  Result<void> set_domain(const Domain& domain, std::shared_ptr<const DomainProjection> projection);
  // Decides which markers are open boundaries, as find_open_boundaries does.
  Result<void> find_markers(const NameTable& markers,
                            std::span<const std::int32_t> open_in_file = {});
  // The mesh has such sides.
  void set_periodic(const v1::Quality& quality);
  // REQUIRES: find_markers was called if the options give markers by name.
  // `mesh` is the spool's view; any view if nothing is drawn. Values at the vertices are sampled in
  // the plane in which it arrives, and written after those that it has, which REQUIRES other names
  // than theirs. Errors: those of sample_nodal, too; kUsage if boundaries are to be opened by depth
  // and there is none.
  Result<void> write(const MeshView& mesh, const v1::Summary& summary);
  // "wrote key.vtu, 1.2 MB\n" for each file, after lines on bandwidth and parts, on the quadtree if
  // it was drawn, and on each triangle that was marked as one of the worst. REQUIRES: written.
  std::string text(const v1::Summary& summary) const;
  // Sentences for the user, on values at the vertices and on what a file does not carry. REQUIRES:
  // written.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  MeshOutput(MeshOutputOptions options, std::vector<OutputFile> files, std::stop_token stop);

  // The mesh with its deep boundary opened, in `deep`, as the options want it.
  Result<MeshView> opened(const MeshView& mesh, std::optional<DeepBoundary>& deep);
  // All but the drawings, without moving them into place.
  Result<void> write_files(const MeshView& arrived);

  MeshOutputOptions options_;
  std::vector<OutputFile> files_;  // those of options_.files, then the drawings
  std::stop_token stop_;
  std::shared_ptr<const DomainProjection> projection_;
  NodalPlane plane_;  // of the mesh that arrives
  std::vector<std::string> warnings_;
  std::string text_;                  // lines on the order and the parts of what was written
  std::unique_ptr<Drawing> drawing_;  // source of all drawings; null if there are none
  Drawing* other_drawing_ = nullptr;
};

}  // namespace weft::client
