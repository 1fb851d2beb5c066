/* The integrals of a form over the cells, by Gauss's rule. The form's components at a point are
 * multiplied by the minors of the cell's edges, which are constant. */
#include <math.h>

#include "core/status.h"
#include "field/forms/component.h"
#include "field/forms/rule.h"
#include "field/mesh/volume.h"

typedef struct integral {
  const dvi_mesh *mesh;
  int k;
  dvi_form_function *function;
  void *user;
  dvi__rule rule;
} integral;

static dvi_status refuse_value(const integral *a, int64_t cell, int failed, double value)
{
  const dvi__cell_name name = dvi__name_cell(a->mesh, a->k, cell);
  if (failed != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "forms: the function of a %d-form returned %d in %s",
                     a->k, failed, name.text);
  return dvi__fail(DVI_NOT_FINITE, "forms: the function of a %d-form is %g in %s", a->k, value,
                   name.text);
}

/* Compute the components at one point, and add those that the cell sees. */
static dvi_status add_point(const integral *a, int64_t cell, const double *x,
                            const double *const *edge, double weight, double *sum)
{
  double value[DVI__COMPONENTS];
  int axis[DVI_MESH_DIMENSION_MAX], component = 0;
  const int failed = a->function(x, value, a->user);
  if (failed != 0) return refuse_value(a, cell, failed, 0);
  dvi__first_axes(a->k, axis);
  do {
    if (!isfinite(value[component])) return refuse_value(a, cell, 0, value[component]);
    *sum += weight * value[component++] * dvi__minor(a->k, edge, axis);
  } while (dvi__next_axes(a->mesh->space, a->k, axis));
  return DVI_OK;
}

static dvi_status integrate_cell(const integral *a, int64_t cell, double *sum)
{
  const int space = a->mesh->space, corners = dvi__corners(a->mesh->kind, a->k);
  const int64_t first = a->k > 0 ? a->mesh->corner[a->k][cell * corners] : cell;
  const double *origin = a->mesh->point + first * space;
  double room[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX], x[DVI_MESH_SPACE_MAX];
  const double *edge[DVI_MESH_DIMENSION_MAX];
  if (a->k > 0) dvi__cell_edges(a->mesh, a->k, cell, room);
  for (int i = 0; i < a->k; i++) edge[i] = room + i * space;
  *sum = 0;
  for (int point = 0; point < dvi__rule_count(a->k); point++) {
    double s[DVI_MESH_DIMENSION_MAX];
    const double weight = dvi__rule_point(&a->rule, a->mesh->kind, a->k, point, s);
    for (int l = 0; l < space; l++) {
      x[l] = origin[l];
      for (int i = 0; i < a->k; i++) x[l] += s[i] * edge[i][l];
    }
    DVI_TRY(add_point(a, cell, x, edge, weight, sum));
  }
  return DVI_OK;
}

dvi_status dvi_form_integrate(const dvi_mesh *mesh, int k, dvi_form_function *function, void *user,
                              double *form)
{
  if (mesh == NULL || function == NULL || form == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: a mesh, a function and an array are needed");
  if (k < 0 || k > mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "forms: the degree is %d, and must be 0 to %d", k, mesh->n);
  integral a = {.mesh = mesh, .k = k, .function = function, .user = user};
  DVI_TRY(dvi__rule_make(&a.rule));
  for (int64_t cell = 0; cell < mesh->count[k]; cell++)
    DVI_TRY(integrate_cell(&a, cell, form + cell));
  return DVI_OK;
}
