// SPDX-License-Identifier: Apache-2.0
// The limit to the growth of a size within the domain, on a mesh of it. With distances d along the
// shortest paths that stay in the domain, the exact limit of the length of edges h is
//   h_G(p) = min over q in the domain of h(q) + G d(p, q),
// the largest function below h that grows by at most G along any path. So each function of that
// kind is nowhere above it, and one that is linear in the triangles of a mesh is of that kind if
// its slope is at most G in each: triangles know what is land, however thin.
//
//   lower_to_size(size, 0.15, mesh, context);   // values at the vertices: at most h
//   limit_slopes(0.15, mesh, context);          // at most h_G
//
// With edges of about kResolution times value / G, the result is 3 to 5 % below the exact limit;
// more where edges are much longer than that, or triangles are flat, because of the domain.
#pragma once

#include <optional>

#include "engine/base/context.h"
#include "engine/size/fields/mesh_field.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

inline constexpr double kResolution = 0.08;

// Lowers the values of the mesh, lengths of edges, until the function that is linear in its
// triangles is nowhere above h where h grows by more than `gradation`. Elsewhere it need not be: a
// path out of there meets nothing above what h grows to. Where the bounds of h cannot tell it from
// 0, only a sample counts. Same values on any number of threads. Errors: those of the context.
std::optional<Error> lower_to_size(const SizeFunction& size, double gradation, FieldMesh& mesh,
                                   const ExecutionContext& context);

// Lowers the values until no triangle has a slope above `gradation`. Values of parts of the mesh
// that have only infinite ones stay so. REQUIRES: the triangles are counter-clockwise and
// conforming; values are positive. Errors: those of the context.
std::optional<Error> limit_slopes(double gradation, FieldMesh& mesh,
                                  const ExecutionContext& context);

}  // namespace weft
