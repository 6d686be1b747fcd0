/* SPDX-License-Identifier: Apache-2.0 */
/* weft for C11, and for whatever else calls C: libweft.so. Arrays go in, arrays come out; options
 * and figures go by the names that the protocol (proto/weft/v1/mesh_service.proto) gives them,
 * whose comments say what they mean, their units, ranges and defaults.
 *
 *   weft_request *request = weft_request_new();
 *   weft_set_points(request, xy, 4);
 *   weft_set_segments(request, ends, NULL, NULL, 4);
 *   weft_set(request, "size.expression", "0.01 + x^2");
 *   weft_error *error = NULL;
 *   weft_mesh *mesh = weft_make(request, NULL, NULL, &error);
 *   weft_request_free(request);
 *
 * `weft_read_domain` and `weft_set_domain` take the points and segments from a file.
 *
 * Nothing that is given is kept. Thread-safe: any number of threads may call at the same time, for
 * requests of their own. A child process that fork makes may call, too, unless a call was at work
 * at that time. Functions that free take NULL. */
#ifndef WEFT_C_H
#define WEFT_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#define WEFT_API __attribute__((visibility("default")))

/* A request: a serialized weft.v1.GenerateMeshRequest. What cannot be taken, and memory that ran
 * out, is the error of weft_make. */
typedef struct weft_request weft_request;

WEFT_API weft_request* weft_request_new(void); /* NULL: memory ran out */
WEFT_API void weft_request_free(weft_request* request);

/* Sets an option from text: a number, "true" or "false", the name of an enumerator ("circumcentre"
 * of Placement). Its field is "domain.fill", "domain.snap", "size.constant", "size.expression",
 * "size.measure", "size.cells_across", "size.points_per_circle", "size.gradation",
 * "size.gradation_within", "quality.min_angle_deg", "quality.min_edge", "quality.placement",
 * "quality.optimise", "budget.max_triangles", "budget.max_bytes", "budget.max_seconds", "threads",
 * "want_quadtree", "allow_unrefined" or "simplify". */
WEFT_API void weft_set(weft_request* request, const char* field, const char* text);

#define WEFT_NONE UINT32_MAX /* an area that a segment is no border of */

/* x0, y0, x1, ... Call each of these three at most once. */
WEFT_API void weft_set_points(weft_request* request, const double* xy, size_t count);
WEFT_API void weft_set_holes(weft_request* request, const double* xy, size_t count);
/* Two points each; one marker and one area each, or NULL: all 0, all WEFT_NONE. */
WEFT_API void weft_set_segments(weft_request* request, const uint32_t* ends, const int32_t* markers,
                                const uint32_t* areas, size_t count);
/* Segments that are arcs of circles, and the bulge of each, at most once. */
WEFT_API void weft_set_arcs(weft_request* request, const uint32_t* segments, const double* bulges,
                            size_t count);

/* On triangles; 0: no bound. Of both the smaller one holds. */
typedef struct weft_bound {
  double max_area, max_edge;
} weft_bound;
/* The face around a point. */
WEFT_API void weft_add_region(weft_request* request, double x, double y, int32_t id,
                              weft_bound bound);
/* An area that segments name by its index, from 0. `region` may be NULL: none. */
WEFT_API void weft_add_area(weft_request* request, const int32_t* region, int32_t priority,
                            weft_bound bound, int is_hole);

typedef struct weft_grid {
  double x, y, dx, dy; /* of the first node, and between nodes */
  uint32_t columns, rows;
} weft_grid;
/* The size at the nodes, columns * rows values by rows from the lowest. */
WEFT_API void weft_set_size_raster(weft_request* request, const weft_grid* grid,
                                   const double* values);
/* The length of edges on segments with the marker. */
WEFT_API void weft_add_size_at(weft_request* request, int32_t marker, double max_edge);

/* Segments that stay as they are: those with one of the markers, all without. */
WEFT_API void weft_keep(weft_request* request, const int32_t* markers, size_t count);
/* Rows of thin triangles along the segments with the marker, 16 times at most. `region` may be
 * NULL. */
WEFT_API void weft_add_layers(weft_request* request, int32_t marker, double first, double ratio,
                              uint32_t rows, const int32_t* region);
/* Sides with these markers get the same vertices; 16 pairs at most. */
WEFT_API void weft_add_periodic(weft_request* request, int32_t from, int32_t to);

/* Fields that the expression may name. The distance to the domain's segments with one of the
 * markers, all without; or to points, or to the segments between them. */
WEFT_API void weft_add_distance(weft_request* request, const char* name, const int32_t* markers,
                                size_t count);
WEFT_API void weft_add_distance_to(weft_request* request, const char* name, const double* xy,
                                   size_t point_count, const uint32_t* ends, size_t segment_count);
WEFT_API void weft_add_raster(weft_request* request, const char* name, const weft_grid* grid,
                              const float* values);
/* Values at the vertices of triangles. */
WEFT_API void weft_add_mesh(weft_request* request, const char* name, const double* xy,
                            const double* values, size_t vertex_count, const uint32_t* triangles,
                            size_t triangle_count);
WEFT_API void weft_add_width(weft_request* request, const char* name);

typedef struct weft_error weft_error;

/* How a file is read; what is NULL has its default. Later versions add fields at the end alone:
 * `struct_size` is what the caller was compiled with. */
typedef struct weft_file_options {
  size_t struct_size;
  const char* format; /* an extension, ".geojson"; default: that of the path */
  const char* layer;  /* by its name; default: the only one that holds anything */
  const char* where;  /* which features, as an SQL expression of attributes; default: all */
} weft_file_options;
#define WEFT_FILE_OPTIONS \
  { .struct_size = sizeof(weft_file_options) }

/* A domain from a file of a format that docs/formats.md lists, or NULL and, unless `error` is NULL,
 * what is wrong, as `weft mesh` says it; the error's field is "path" or "options". `options` may be
 * NULL. Coordinates are those of the file. */
typedef struct weft_domain weft_domain;
WEFT_API weft_domain* weft_read_domain(const char* path, const weft_file_options* options,
                                       weft_error** error);
WEFT_API void weft_domain_free(weft_domain* domain);
/* Instead of points, segments, holes, arcs, regions and areas. Sets the fill, too. */
WEFT_API void weft_set_domain(weft_request* request, const weft_domain* domain);

/* What the functions below give lives as long as the domain. The bytes of a weft.v1.Domain. */
WEFT_API const void* weft_domain_message(const weft_domain* domain, size_t* size);
/* What is odd in the file: a sentence, and in `kind`, unless that is NULL, its kind, such as
 * "open-ring". NULL: there are no more than `index`. */
WEFT_API const char* weft_domain_warning(const weft_domain* domain, size_t index,
                                         const char** kind);
/* Whether the file says that its coordinates are longitudes and latitudes, or those of a plane.
 * Returns 0, and leaves the value alone, if it says neither. */
WEFT_API int weft_domain_is_geographic(const weft_domain* domain, int* is_geographic);
/* The ids of regions that stand for another number in the file, and that number; returns how many.
 */
WEFT_API size_t weft_domain_region_values(const weft_domain* domain, const int32_t** ids,
                                          const double** values);

typedef struct weft_progress {
  int32_t stage; /* 0 queued, 1 triangulate, 2 size, 3 refine, 4 done */
  uint64_t triangles, expected_triangles;
  double fraction;
} weft_progress;
/* Called on the thread that called weft_make, about ten times a second, for runs that are not
 * short; what is not 0 cancels. */
typedef int weft_on_progress(const weft_progress* progress, void* user);

typedef struct weft_mesh weft_mesh;

/* The mesh, or NULL and, unless `error` is NULL, what is wrong. `on_progress` may be NULL. A short
 * run computes on the calling thread, another on as many threads as there are processors, or as the
 * option "threads" says. */
WEFT_API weft_mesh* weft_make(const weft_request* request, weft_on_progress* on_progress,
                              void* user, weft_error** error);
/* The same of the bytes of a GenerateMeshRequest, whatever they are. */
WEFT_API weft_mesh* weft_make_message(const void* bytes, size_t size, weft_on_progress* on_progress,
                                      void* user, weft_error** error);
WEFT_API void weft_mesh_free(weft_mesh* mesh);

/* "BAD_OPTION" and so on; what is wrong in words; the path of the field at fault, "" if none is;
 * whether a point of the plane is meant, which is then in x and y; and the bytes of a
 * google.rpc.Status that has all of it. */
WEFT_API const char* weft_error_reason(const weft_error* error);
WEFT_API const char* weft_error_message(const weft_error* error);
WEFT_API const char* weft_error_field(const weft_error* error);
WEFT_API int weft_error_point(const weft_error* error, double* x, double* y);
WEFT_API const void* weft_error_status(const weft_error* error, size_t* size);
WEFT_API void weft_error_free(weft_error* error);

/* What a mesh is made of; the arrays live as long as the mesh. Later versions add fields at the end
 * alone: `struct_size` is what the caller was compiled with. */
typedef struct weft_arrays {
  size_t struct_size;
  size_t vertex_count, triangle_count, edge_count, input_point_count, leaf_count;
  const double* vertices;       /* x0, y0, x1, ... */
  const uint32_t* triangles;    /* three vertices each, counter-clockwise */
  const int32_t* regions;       /* one per triangle, or NULL: all 0 */
  const uint32_t* edges;        /* per edge on a segment: two vertices, the segment, its marker */
  const uint32_t* input_points; /* per input point that is a vertex: the vertex, the point */
  const double* leaves;         /* boxes of the quadtree: min x, min y, max x, max y */
  const double* bulges;         /* of each edge, as weft_set_arcs takes them, or NULL: all 0 */
} weft_arrays;
#define WEFT_ARRAYS \
  { .struct_size = sizeof(weft_arrays) }
WEFT_API void weft_mesh_arrays(const weft_mesh* mesh, weft_arrays* arrays);

/* The bytes of a weft.v1.Summary, which live as long as the mesh. */
WEFT_API const void* weft_mesh_summary(const weft_mesh* mesh, size_t* size);
/* A number of that message by its path, such as "min_angle_deg" or "unrefined.too_large". Returns
 * 0, and leaves the value alone, if the summary has no such number. */
WEFT_API int weft_figure(const weft_mesh* mesh, const char* path, double* value);

WEFT_API const char* weft_version(void);        /* of the library */
WEFT_API const char* weft_engine_version(void); /* a mesh depends on the request and this alone */

#ifdef __cplusplus
}
#endif
#endif
