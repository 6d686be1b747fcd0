/* SPDX-License-Identifier: Apache-2.0 */
/* The C interface from C11: a mesh, an error, and a run that is cancelled. Prints what is wrong. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <weft/c.h>

static int faults = 0;
#define EXPECT(holds)                                         \
  do {                                                        \
    if (!(holds)) {                                           \
      fprintf(stderr, "line %d: not %s\n", __LINE__, #holds); \
      ++faults;                                               \
    }                                                         \
  } while (0)

static const double corners[] = {0, 0, 4, 0, 4, 4, 0, 4};
static const uint32_t sides[] = {0, 1, 1, 2, 2, 3, 3, 0};
static const int32_t markers[] = {1, 2, 3, 4};

static weft_request* square(const char* size) {
  weft_request* request = weft_request_new();
  weft_set_points(request, corners, 4);
  weft_set_segments(request, sides, markers, NULL, 4);
  weft_set(request, "size.expression", size);
  return request;
}

/* The mesh of the request, which it frees. */
static weft_mesh* make(weft_request* request, weft_error** error) {
  weft_mesh* mesh = weft_make(request, NULL, NULL, error);
  weft_request_free(request);
  return mesh;
}

static int cancel(const weft_progress* progress, void* calls) {
  EXPECT(progress->fraction >= 0 && progress->fraction <= 1);
  ++*(int*)calls;
  return 1;
}

static double figure(const weft_mesh* mesh, const char* path) {
  double value = NAN;
  EXPECT(weft_figure(mesh, path, &value));
  return value;
}

static void makes_a_mesh(void) {
  weft_error* error = NULL;
  weft_mesh* mesh = make(square("0.01"), &error);
  EXPECT(mesh != NULL && error == NULL);
  if (mesh == NULL) return;
  weft_arrays arrays = WEFT_ARRAYS;
  weft_mesh_arrays(mesh, &arrays);
  double area = 0;
  for (size_t i = 0; i < arrays.triangle_count; ++i) {
    const double* p[3];
    for (int k = 0; k < 3; ++k) {
      EXPECT(arrays.triangles[3 * i + k] < arrays.vertex_count);
      p[k] = arrays.vertices + 2 * arrays.triangles[3 * i + k];
    }
    const double doubled =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    EXPECT(doubled > 0 && doubled <= 0.02 * (1 + 1e-12));
    area += doubled / 2;
  }
  EXPECT(fabs(area - 16) < 1e-9 && fabs(figure(mesh, "area") - 16) < 1e-9);
  EXPECT(arrays.regions == NULL);
  EXPECT(arrays.edge_count > 4 && arrays.input_point_count == 4);
  for (size_t i = 0; i < arrays.edge_count; ++i)
    EXPECT(arrays.edges[4 * i + 3] == arrays.edges[4 * i + 2] + 1);
  EXPECT(figure(mesh, "min_angle_deg") >= 20 && figure(mesh, "threads") >= 1);
  EXPECT(figure(mesh, "unrefined.budget") == 0 && figure(mesh, "timings.engine_seconds") > 0);
  double value = 7;
  EXPECT(!weft_figure(mesh, "narrow.width", &value) && !weft_figure(mesh, "none", &value));
  EXPECT(value == 7);
  size_t size = 0;
  EXPECT(weft_mesh_summary(mesh, &size) != NULL && size > 100);
  weft_mesh_free(mesh);
}

static void says_what_is_wrong(void) {
  weft_error* error = NULL;
  EXPECT(make(square("x +"), &error) == NULL);
  EXPECT(strcmp(weft_error_reason(error), "EXPRESSION_SYNTAX") == 0);
  EXPECT(strcmp(weft_error_field(error), "size.expression") == 0);
  EXPECT(strstr(weft_error_message(error), "column") != NULL);
  double x, y;
  EXPECT(!weft_error_point(error, &x, &y));
  size_t size = 0;
  EXPECT(weft_error_status(error, &size) != NULL && size > 20);
  weft_error_free(error);

  weft_request* request = square("1");
  weft_set_points(request, NULL, 4);
  EXPECT(weft_make(request, NULL, NULL, NULL) == NULL);
  EXPECT(make(request, &error) == NULL);
  EXPECT(strcmp(weft_error_field(error), "domain.points") == 0);
  weft_error_free(error);

  EXPECT(make(square("(x-1)^2"), &error) == NULL);
  EXPECT(weft_error_point(error, &x, &y) && fabs(x - 1) < 1e-6);
  weft_error_free(error);
}

static void names_the_option_that_it_cannot_take(void) {
  static const char* const wrong[][2] = {{"quality.min_angle_deg", "much"},
                                         {"quality.optimise", "-1"},
                                         {"quality.placement", "Lattice"},
                                         {"allow_unrefined", "yes"},
                                         {"domain.points", "1"},
                                         {"nothing", "1"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    weft_request* request = square("1");
    weft_set(request, wrong[i][0], wrong[i][1]);
    weft_error* error = NULL;
    EXPECT(make(request, &error) == NULL);
    EXPECT(strcmp(weft_error_reason(error), "BAD_OPTION") == 0);
    EXPECT(strcmp(weft_error_field(error), wrong[i][0]) == 0);
    weft_error_free(error);
  }
}

static void reads_files(void) {
  weft_error* error = NULL;
  weft_file_options options = WEFT_FILE_OPTIONS;
  options.format = ".poly";
  EXPECT(weft_read_domain("/nowhere/no.txt", &options, &error) == NULL);
  EXPECT(strcmp(weft_error_field(error), "path") == 0);
  EXPECT(strstr(weft_error_message(error), "/nowhere/no.txt") != NULL);
  weft_error_free(error);
}

static void is_cancelled_by_its_caller(void) {
  weft_request* request = square("1e-7");
  int calls = 0;
  weft_error* error = NULL;
  EXPECT(weft_make(request, cancel, &calls, &error) == NULL);
  EXPECT(calls >= 1);
  EXPECT(error != NULL && strcmp(weft_error_reason(error), "CANCELLED") == 0);
  weft_error_free(error);
  weft_request_free(request);
}

static void says_how_edges_bend(void) {
  weft_request* request = square("1");
  const uint32_t side = 1;
  const double bulge = 0.4;
  weft_set_arcs(request, &side, &bulge, 1);
  weft_mesh* mesh = make(request, NULL);
  EXPECT(mesh != NULL);
  weft_arrays arrays = WEFT_ARRAYS;
  weft_mesh_arrays(mesh, &arrays);
  EXPECT(arrays.bulges != NULL);
  double turn = 0;
  for (size_t e = 0; e < arrays.edge_count; ++e) {
    const double of_edge = 4 * atan(arrays.bulges[e]);
    EXPECT((arrays.edges[4 * e + 2] == side) == (of_edge != 0));
    turn += of_edge;
  }
  EXPECT(fabs(turn - 4 * atan(bulge)) < 1e-12);
  weft_mesh_free(mesh);
  mesh = make(square("1"), NULL);
  weft_mesh_arrays(mesh, &arrays);
  EXPECT(arrays.bulges == NULL);
  weft_mesh_free(mesh);
}

static void fills_what_an_older_caller_does_not_know(void) {
  weft_mesh* mesh = make(square("0.01"), NULL);
  EXPECT(mesh != NULL);
  weft_arrays arrays = WEFT_ARRAYS;
  arrays.struct_size = offsetof(weft_arrays, leaves);
  const double mine = 1;
  arrays.leaves = &mine;
  weft_mesh_arrays(mesh, &arrays);
  EXPECT(arrays.leaves == &mine && arrays.input_points != NULL);
  weft_mesh_free(mesh);
}

int main(void) {
  makes_a_mesh();
  says_what_is_wrong();
  names_the_option_that_it_cannot_take();
  reads_files();
  is_cancelled_by_its_caller();
  says_how_edges_bend();
  fills_what_an_older_caller_does_not_know();
  EXPECT(strlen(weft_version()) > 0 && strlen(weft_engine_version()) > 0);
  return faults != 0;
}
