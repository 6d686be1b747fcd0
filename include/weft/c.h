/* SPDX-License-Identifier: Apache-2.0 */
/* weft for C11, and for whatever else calls C: libweft.so. What the fields mean is in weft/pslg.h,
 * weft/size.h, weft/weft.h and weft/mesh.h.
 *
 *   weft_request request = WEFT_REQUEST;
 *   request.points = xy, request.point_count = 4;
 *   request.segments = ends, request.segment_count = 4;
 *   request.size_kind = WEFT_SIZE_EXPRESSION, request.size_expression = "0.01 + x^2";
 *   weft_error *error = NULL;
 *   weft_mesh *mesh = weft_make(&request, NULL, &error);
 *
 * Structures that begin with `struct_size` may grow at their end: their initializers set it to what
 * the caller was compiled with, and what he does not know has its default. Nothing that a request
 * points to is kept. Thread-safe: any number of threads may call at the same time. A process that
 * fork makes may call, too, unless a call was at work at that time. */
#ifndef WEFT_C_H
#define WEFT_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#define WEFT_API __attribute__((visibility("default")))

#define WEFT_NONE UINT32_MAX /* an area that a segment is no border of */

enum { WEFT_FILL_SEEDS, WEFT_FILL_EVEN_ODD, WEFT_FILL_UNION };
enum { WEFT_SIZE_NONE, WEFT_SIZE_CONSTANT, WEFT_SIZE_EXPRESSION, WEFT_SIZE_RASTER };
enum { WEFT_MEASURE_AREA, WEFT_MEASURE_EDGE };
enum { WEFT_FIELD_DISTANCE, WEFT_FIELD_RASTER, WEFT_FIELD_MESH, WEFT_FIELD_WIDTH };
enum { WEFT_PLACEMENT_LATTICE, WEFT_PLACEMENT_CIRCUMCENTRE };

/* On the area of triangles; of both bounds the smaller one holds. */
typedef struct weft_bound {
  int32_t has_max_area, has_max_edge;
  double max_area, max_edge;
} weft_bound;

typedef struct weft_region {
  double x, y;
  int32_t id;
  weft_bound bound;
} weft_region;

typedef struct weft_area {
  int32_t has_region, region, priority, is_hole;
  weft_bound bound;
} weft_area;

typedef struct weft_size_at {
  int32_t marker;
  double max_edge;
} weft_size_at;

typedef struct weft_grid {
  double x, y, dx, dy; /* of the first node, and between nodes */
  uint32_t columns, rows;
} weft_grid;

/* A field that an expression may name. Of the arrays, those of its kind count. */
typedef struct weft_field {
  const char* name;
  int32_t kind;
  const int32_t* markers; /* distance */
  size_t marker_count;
  const double* points; /* distance, mesh: x0, y0, x1, ... */
  size_t point_count;
  const uint32_t* segments; /* distance: two points each */
  size_t segment_count;
  const uint32_t* triangles; /* mesh: three points each */
  size_t triangle_count;
  const double* point_values; /* mesh */
  weft_grid grid;             /* raster */
  const float* grid_values;   /* raster: columns * rows, by rows from the lowest */
} weft_field;

typedef struct weft_request {
  size_t struct_size;
  const double* points; /* x0, y0, x1, ... */
  size_t point_count;
  const uint32_t* segments; /* two points each */
  size_t segment_count;
  const int32_t* segment_markers; /* one per segment, or NULL: all 0 */
  const uint32_t* segment_areas;  /* one per segment, or NULL: all WEFT_NONE */
  const double* holes;            /* x0, y0, x1, ... */
  size_t hole_count;
  const weft_region* regions;
  size_t region_count;
  const weft_area* areas;
  size_t area_count;
  int32_t fill;
  double snap;

  int32_t size_kind, size_measure;
  double size_constant;
  const char* size_expression;
  weft_grid size_grid;
  const double* size_values; /* columns * rows, by rows from the lowest */
  const weft_field* fields;
  size_t field_count;
  double gradation;
  int32_t gradation_within;
  double cells_across;
  const weft_size_at* sizes_at;
  size_t size_at_count;

  double min_angle_deg, min_edge;
  int32_t placement;
  int32_t sweeps; /* -1: as many as pay */
  int32_t allow_unrefined;
  double simplify; /* share of the size */
} weft_request;
#define WEFT_REQUEST \
  { .struct_size = sizeof(weft_request), .min_angle_deg = 20, .sweeps = -1 }

typedef struct weft_progress {
  int32_t stage; /* 0 queued, 1 triangulate, 2 size, 3 refine, 4 done */
  uint64_t triangles, expected_triangles;
  double fraction;
} weft_progress;

/* How a mesh is made. None of it changes the mesh but max_triangles. */
typedef struct weft_control {
  size_t struct_size;
  uint32_t threads;       /* 0: one for each processor; small meshes take one */
  uint64_t max_triangles; /* 0: any number */
  uint64_t max_bytes;     /* 0: any number */
  double max_seconds;     /* 0: any number */
  /* Called on the thread that called weft_make, some times a second; what is not 0 cancels. A mesh
   * of some milliseconds is made without. */
  int (*on_progress)(const weft_progress* progress, void* user);
  void* user;
} weft_control;
#define WEFT_CONTROL \
  { .struct_size = sizeof(weft_control) }

typedef struct weft_error weft_error;
typedef struct weft_mesh weft_mesh;

/* The mesh, or NULL and, unless `error` is NULL, what is wrong. `control` may be NULL. */
WEFT_API weft_mesh* weft_make(const weft_request* request, const weft_control* control,
                              weft_error** error);
WEFT_API void weft_mesh_free(weft_mesh* mesh);

/* "BAD_OPTION" and so on; what is wrong in words; the path of the field at fault, "" if none is;
 * and whether a point of the plane is meant, which is then in x and y. */
WEFT_API const char* weft_error_reason(const weft_error* error);
WEFT_API const char* weft_error_message(const weft_error* error);
WEFT_API const char* weft_error_field(const weft_error* error);
WEFT_API int weft_error_point(const weft_error* error, double* x, double* y);
WEFT_API void weft_error_free(weft_error* error);

/* What a mesh is made of; the arrays live as long as the mesh. */
typedef struct weft_arrays {
  size_t struct_size;
  size_t vertex_count, triangle_count, edge_count, input_point_count, leaf_count;
  const double* vertices;       /* x0, y0, x1, ... */
  const uint32_t* triangles;    /* three vertices each, counter-clockwise */
  const int32_t* regions;       /* one per triangle, or NULL: all 0 */
  const uint32_t* edges;        /* per edge on a segment: two vertices, the segment, its marker */
  const uint32_t* input_points; /* per input point that is a vertex: the vertex, the point */
  const double* leaves;         /* boxes of the quadtree: min x, min y, max x, max y */
} weft_arrays;
#define WEFT_ARRAYS \
  { .struct_size = sizeof(weft_arrays) }
WEFT_API void weft_mesh_arrays(const weft_mesh* mesh, weft_arrays* arrays);

typedef struct weft_summary {
  size_t struct_size;
  uint8_t digest[32];
  uint32_t chunks, rounds, threads;
  int32_t streamed, has_narrow, overlap_united;
  double area, min_angle_deg, max_angle_deg, min_angle_p1_deg, mean_quality, ideal_ratio;
  double lattice_share;
  uint64_t angle_histogram[18], aspect_histogram[9], size_histogram[10];
  uint64_t small_input_angle, edge_floor, budget, precision, streaming, too_large;
  double unrefined_x, unrefined_y;
  double merge_tolerance, farthest, farthest_x, farthest_y, vanished_x, vanished_y;
  uint64_t merged_points, merged_segments, vanished_faces;
  uint64_t overlap_areas;
  double overlap_area;
  uint32_t narrow_segment, narrow_other;
  double narrow_x, narrow_y, narrow_width, narrow_triangles;
  double triangulate_seconds, size_seconds, coarse_seconds, refine_seconds, emit_seconds;
  double engine_seconds;
  uint64_t peak_bytes, insertions, deferred, exact_predicates;
  size_t warning_count;
  /* what simplify did: 0 without */
  int32_t has_simplification;
  uint64_t simplified_points, dropped_islands, dropped_waters, cut_channels;
  double simplified_area, simplified_farthest;
  uint64_t cut_off_waters, straits;
  /* segments that border no area and of which no part bounds the mesh or lies in it, and the first
   */
  uint64_t outside_segments;
  double outside_x, outside_y;
  uint32_t outside_first;
  /* of all narrow places, see weft/mesh.h: 0 without */
  double narrow_in_all, narrow_widest;
} weft_summary;
#define WEFT_SUMMARY \
  { .struct_size = sizeof(weft_summary) }
WEFT_API void weft_mesh_summary(const weft_mesh* mesh, weft_summary* summary);

/* About the size, for index < warning_count: "bounds_nothing", "coarse_raster", "field_not_named"
 * or "gradation_within_alone"; the name of the field that is meant, or ""; and a sentence. */
WEFT_API const char* weft_warning_kind(const weft_mesh* mesh, size_t index);
WEFT_API const char* weft_warning_field(const weft_mesh* mesh, size_t index);
WEFT_API const char* weft_warning_message(const weft_mesh* mesh, size_t index);

WEFT_API const char* weft_version(void);        /* of the library */
WEFT_API const char* weft_engine_version(void); /* a mesh depends on the request and this alone */

#ifdef __cplusplus
}
#endif
#endif
