/* SPDX-License-Identifier: Apache-2.0 */
/* The C interface from C11: a mesh, an error, and a run that is cancelled. Prints what is wrong. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <weft/c.h>

static int faults = 0;
#define EXPECT(holds)                                             \
  do {                                                            \
    if (!(holds)) {                                               \
      fprintf(stderr, "line %d: not %s\n", __LINE__, #holds);     \
      ++faults;                                                   \
    }                                                             \
  } while (0)

static const double corners[] = {0, 0, 4, 0, 4, 4, 0, 4};
static const uint32_t sides[] = {0, 1, 1, 2, 2, 3, 3, 0};
static const int32_t markers[] = {1, 2, 3, 4};

static weft_request square(const char *size) {
  weft_request request = WEFT_REQUEST;
  request.points = corners;
  request.point_count = 4;
  request.segments = sides;
  request.segment_count = 4;
  request.segment_markers = markers;
  request.size_kind = WEFT_SIZE_EXPRESSION;
  request.size_expression = size;
  return request;
}

static int cancel(const weft_progress *progress, void *calls) {
  EXPECT(progress->fraction >= 0 && progress->fraction <= 1);
  ++*(int *)calls;
  return 1;
}

static void makes_a_mesh(void) {
  const weft_request request = square("0.01");
  weft_error *error = NULL;
  weft_mesh *mesh = weft_make(&request, NULL, &error);
  EXPECT(mesh != NULL && error == NULL);
  if (mesh == NULL) return;
  weft_arrays arrays = WEFT_ARRAYS;
  weft_mesh_arrays(mesh, &arrays);
  weft_summary summary = WEFT_SUMMARY;
  weft_mesh_summary(mesh, &summary);
  double area = 0;
  for (size_t i = 0; i < arrays.triangle_count; ++i) {
    const double *p[3];
    for (int k = 0; k < 3; ++k) {
      EXPECT(arrays.triangles[3 * i + k] < arrays.vertex_count);
      p[k] = arrays.vertices + 2 * arrays.triangles[3 * i + k];
    }
    const double doubled = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                           (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    EXPECT(doubled > 0 && doubled <= 0.02 * (1 + 1e-12));
    area += doubled / 2;
  }
  EXPECT(fabs(area - 16) < 1e-9 && fabs(summary.area - 16) < 1e-9);
  EXPECT(arrays.regions == NULL);
  EXPECT(arrays.edge_count > 4 && arrays.input_point_count == 4);
  for (size_t i = 0; i < arrays.edge_count; ++i)
    EXPECT(arrays.edges[4 * i + 3] == arrays.edges[4 * i + 2] + 1);
  EXPECT(summary.min_angle_deg >= 20 && summary.threads == 1 && summary.warning_count == 0);
  weft_mesh_free(mesh);
}

static void says_what_is_wrong(void) {
  weft_request request = square("x +");
  weft_error *error = NULL;
  EXPECT(weft_make(&request, NULL, &error) == NULL);
  EXPECT(strcmp(weft_error_reason(error), "EXPRESSION_SYNTAX") == 0);
  EXPECT(strcmp(weft_error_field(error), "size.expression") == 0);
  EXPECT(strstr(weft_error_message(error), "column") != NULL);
  double x, y;
  EXPECT(!weft_error_point(error, &x, &y));
  weft_error_free(error);

  request = square("1");
  request.points = NULL;
  EXPECT(weft_make(&request, NULL, NULL) == NULL);
  EXPECT(weft_make(&request, NULL, &error) == NULL);
  EXPECT(strcmp(weft_error_field(error), "domain.points") == 0);
  weft_error_free(error);

  request = square("(x-1)^2");
  EXPECT(weft_make(&request, NULL, &error) == NULL);
  EXPECT(weft_error_point(error, &x, &y) && fabs(x - 1) < 1e-6);
  weft_error_free(error);
}

static void is_cancelled_by_its_caller(void) {
  const weft_request request = square("1e-7");
  int calls = 0;
  weft_control control = WEFT_CONTROL;
  control.on_progress = cancel;
  control.user = &calls;
  weft_error *error = NULL;
  EXPECT(weft_make(&request, &control, &error) == NULL);
  EXPECT(calls >= 1);
  EXPECT(error != NULL && strcmp(weft_error_reason(error), "CANCELLED") == 0);
  weft_error_free(error);
}

static void fills_what_an_older_caller_does_not_know(void) {
  weft_request request = square("0.01");
  request.struct_size = offsetof(weft_request, min_angle_deg);
  request.min_angle_deg = 99; /* beyond what the caller was compiled with */
  weft_mesh *mesh = weft_make(&request, NULL, NULL);
  EXPECT(mesh != NULL);
  weft_summary summary = WEFT_SUMMARY;
  summary.struct_size = offsetof(weft_summary, chunks);
  summary.chunks = 77;
  weft_mesh_summary(mesh, &summary);
  EXPECT(summary.chunks == 77 && summary.digest[0] + summary.digest[1] + summary.digest[2] > 0);
  weft_mesh_free(mesh);
}

int main(void) {
  makes_a_mesh();
  says_what_is_wrong();
  is_cancelled_by_its_caller();
  fills_what_an_older_caller_does_not_know();
  EXPECT(strlen(weft_version()) > 0 && strlen(weft_engine_version()) > 0);
  return faults != 0;
}
