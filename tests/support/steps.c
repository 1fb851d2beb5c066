#include "support/steps.h"

#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/suite.h"

stepped stepped_mesh(dvi_mesh *mesh, int k, int is_fixed)
{
  stepped s = {.mesh = mesh, .k = k};
  dvi_matrix d, below = {0}, M1, M2;
  int64_t count;
  ck_assert_msg(dvi_star_create(mesh, NULL, &s.star) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi_star_matrix(s.star, k, &M1), DVI_OK);
  ck_assert_int_eq(dvi_star_matrix(s.star, k + 1, &M2), DVI_OK);
  ck_assert_int_eq(dvi_mesh_incidence(mesh, k, &d), DVI_OK);
  if (k > 0) ck_assert_int_eq(dvi_mesh_incidence(mesh, k - 1, &below), DVI_OK);
  s.edges = d.columns;
  s.faces = d.rows;
  s.nodes = below.columns;
  s.is_fixed = calloc((size_t)s.edges, 1);
  const int *boundary = dvi_mesh_part_cells(mesh, "boundary", k, &count);
  for (int64_t i = 0; i < count && is_fixed; i++) s.is_fixed[boundary[i]] = 1;
  s.terms = (dvi__avi_terms){.edges = s.edges,
                             .faces = s.faces,
                             .width = d.width,
                             .facet = d.column,
                             .sign = d.sign,
                             .M1 = M1.value,
                             .M2 = M2.value,
                             .is_fixed = s.is_fixed,
                             .nodes = s.nodes,
                             .node_width = below.width,
                             .node = below.column,
                             .node_sign = below.sign};
  return s;
}

void end_stepped(stepped *s)
{
  free(s->is_fixed);
  dvi_star_destroy(&s->star);
  dvi_mesh_destroy(&s->mesh);
}

dvi_mesh *grid_mesh(const char *name, int dimension, int cells, double grading)
{
  dvi_mesh *mesh = NULL;
  dvi_generator_options options = {.size = sizeof options, .dimension = dimension};
  for (int i = 0; i < dimension; i++) options.cells[i] = cells;
  for (int i = 0; i < dimension; i++) options.grading[i] = grading;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

void step_of_boxes(const dvi_mesh *mesh, double fraction, int is_free, double *step)
{
  int width;
  const int *vertex = dvi_mesh_vertices(mesh, 2, &width);
  const double *point = dvi_mesh_points(mesh);
  const int64_t count = dvi_mesh_count(mesh, 2);
  double shortest = INFINITY;
  for (int64_t f = 0; f < count; f++) {
    const double *near = point + 2 * vertex[f * width], *far = point + 2 * vertex[f * width + 3];
    step[f] = fraction / hypot(1 / (far[0] - near[0]), 1 / (far[1] - near[1]));
    shortest = fmin(shortest, step[f]);
  }
  for (int64_t f = 0; f < count && !is_free; f++)
    step[f] = shortest * exp2(floor(log2(step[f] / shortest) + 1e-12));
}

void start_at_random(const stepped *s, dvi__avi *avi, unsigned long long seed)
{
  double *E = calloc((size_t)s->edges, sizeof *E);
  for (int64_t e = 0; e < s->edges; e++) E[e] = 2 * random_number(&seed) - 1;
  ck_assert_msg(dvi__avi_start(avi, 0, NULL, E, NULL) == DVI_OK, "%s", dvi_last_error());
  free(E);
}

dvi__avi *avi_of(const dvi__avi_terms *terms)
{
  dvi__avi *avi = NULL;
  ck_assert_msg(dvi__avi_create(terms, &avi) == DVI_OK, "%s", dvi_last_error());
  return avi;
}

double energy_of(const dvi__avi *avi)
{
  double energy;
  ck_assert_msg(dvi__avi_energy(avi, &energy, NULL) == DVI_OK, "%s", dvi_last_error());
  return energy;
}

void advance_to(dvi__avi *avi, double t)
{
  ck_assert_msg(dvi__avi_advance(avi, t) == DVI_OK, "%s", dvi_last_error());
}
