/* The field around a hole: an annulus has one 1-form without sources and without curl that goes
 * around its hole. The program finds it, adds it up around the hole, and writes its vectors to
 * hole.vtu, which `dvi plot hole.vtu` draws. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Give the vectors in the middle of the triangles. */
static dvi_status interpolate(const dvi_mesh *mesh, const double *form, double *vector)
{
  const double middle[3] = {1 / 3.0, 1 / 3.0, 1 / 3.0};
  dvi_status status = DVI_OK;
  for (int64_t c = 0; c < dvi_mesh_count(mesh, 2) && !status; c++)
    status = dvi_form_evaluate(mesh, 1, form, c, middle, vector + 2 * c);
  return status;
}

/* Add up the form along the inner rim, in the direction of the angle. */
static double circulation(const dvi_mesh *mesh, const double *form)
{
  int64_t count;
  const int *edge = dvi_mesh_part_cells(mesh, "inner", 1, &count);
  const int *vertex = dvi_mesh_vertices(mesh, 1, NULL);
  const double *x = dvi_mesh_points(mesh);
  double sum = 0;
  for (int64_t i = 0; i < count; i++) {
    const double *a = x + 2 * vertex[2 * edge[i]], *b = x + 2 * vertex[2 * edge[i] + 1];
    sum += copysign(1, a[0] * b[1] - a[1] * b[0]) * form[edge[i]];
  }
  return sum;
}

int main(void)
{
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  int64_t holes = 0;
  double *form = NULL, *vector = NULL;
  dvi_status status = dvi_mesh_generate("annulus", NULL, &mesh);
  if (!status) status = dvi_star_create(mesh, NULL, &star);
  if (!status) status = dvi_form_harmonic(star, 1, NULL, &holes, NULL);
  form = (double *)calloc((size_t)(holes * dvi_mesh_count(mesh, 1)) + 1, sizeof *form);
  vector = (double *)calloc(2 * (size_t)dvi_mesh_count(mesh, 2) + 1, sizeof *vector);
  if (!status && (form == NULL || vector == NULL)) status = DVI_NO_MEMORY;
  if (!status) status = dvi_form_harmonic(star, 1, NULL, &holes, form);
  if (!status) status = interpolate(mesh, form, vector);
  const dvi_view view = {.name = "field", .values = vector, .components = 2, .degree = 2};
  if (!status) status = dvi_mesh_write(mesh, "hole.vtu", 1, &view);
  if (!status)
    printf("%d hole, circulation %.10f\n", (int)holes, fabs(circulation(mesh, form)));
  else
    fprintf(stderr, "%s\n", dvi_last_error());
  free(form);
  free(vector);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return status != 0;
}
