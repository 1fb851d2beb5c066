#include "support/field/electric.h"

#include <check.h>
#include <stdlib.h>

dvi_mesh *with_core(dvi_mesh *mesh, int (*is_inside)(const double *centre))
{
  const int n = dvi_mesh_dimension(mesh), space = dvi_mesh_space(mesh);
  const int64_t cells = dvi_mesh_count(mesh, n);
  double *centre = malloc((size_t)(cells * space) * sizeof *centre);
  int *inside = malloc((size_t)cells * sizeof *inside), width;
  ck_assert(dvi_mesh_centres(mesh, n, centre) == DVI_OK);
  dvi_mesh_part part = {.name = "core", .degree = n, .cell = inside};
  for (int64_t c = 0; c < cells; c++)
    if (is_inside(centre + c * space)) inside[part.count++] = (int)c;
  const int *vertex = dvi_mesh_vertices(mesh, n, &width);
  const dvi_mesh_terms terms = {.size = sizeof terms,
                                .kind = width == n + 1 && n > 1 ? DVI_SIMPLICES : DVI_BOXES,
                                .dimension = n,
                                .space = space,
                                .points = dvi_mesh_count(mesh, 0),
                                .point = dvi_mesh_points(mesh),
                                .cells = cells,
                                .vertex = vertex,
                                .part = &part,
                                .parts = 1};
  dvi_mesh *made = NULL;
  ck_assert_msg(dvi_mesh_create(&terms, &made) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  free(centre);
  free(inside);
  return made;
}

dvi_field *electric(dvi_mesh *mesh, dvi_star_kind kind, const double *eps, dvi_maxwell_terms terms)
{
  const int k = terms.scalar || dvi_mesh_dimension(mesh) == 1 ? 0 : 1;
  const double *factor[DVI_MESH_DIMENSION_MAX + 1] = {NULL};
  factor[k] = eps;
  const dvi_star_options options = {.size = sizeof options, .kind = kind, .factor = factor};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  ck_assert_msg(dvi_star_create(mesh, &options, &star) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  terms.size = sizeof terms;
  terms.star = star;
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  return field;
}

dvi_march *march_of(const dvi_field *field, dvi_march_options how, const double *E, const double *A)
{
  dvi_march *march = NULL;
  const dvi_march_state state = {.size = sizeof state, .E = E, .A = A};
  how.size = sizeof how;
  ck_assert_msg(dvi_march_create(field, &how, &march) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  return march;
}

double *form_of(const dvi_field *field, int k, dvi_form_function *function)
{
  const dvi_mesh *mesh = dvi_star_mesh(dvi_field_star(field));
  double *form = malloc((size_t)dvi_mesh_count(mesh, k) * sizeof *form);
  ck_assert_msg(dvi_form_integrate(mesh, k, function, NULL, form) == DVI_OK, "%s",
                dvi_last_error());
  return form;
}
