/* The power through a surface, of facets of a mesh.
 *
 * Through a facet with the unit normal n it is the integral of E.(i_n H), which is that of
 * Poynting's vector, n.(E x H), in three dimensions, and -A' dA/dn of a 0-form. It is taken at the
 * facet's centre. E along the facet is the same in both of its cells, but B is known in their
 * middle, so that H is interpolated between the two. On an absorbing wall E and H are those of a
 * wave that leaves, and the power is sqrt(eps/mu) times the square of E along the facet. Through
 * other walls it vanishes. The error is of second order on boxes and on simplices that are alike,
 * and of first order where neighbours differ. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/component.h"
#include "field/forms/evaluate.h"
#include "field/forms/star.h"
#include "field/mesh/normal.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"
#include "field/model/field.h"

/* A facet, seen from the cell out of which the power flows. */
typedef struct facet {
  const dvi_field *field;
  int64_t number, cell;
  double area, normal[DVI_MESH_SPACE_MAX], place[DVI__CORNERS];
} facet;

static facet facet_of(const dvi_field *field, int64_t number, int64_t cell)
{
  const dvi_mesh *mesh = field->mesh;
  facet f = {.field = field, .number = number, .cell = cell, .area = 1};
  if (mesh->n > 1) f.area = dvi__cell_volume(mesh, mesh->n - 1, number);
  dvi__facet_normal(mesh, number, cell, f.normal);
  dvi__facet_place(mesh, number, cell, f.place);
  return f;
}

/* ---- products of E and H ---- */

/* Tell the number of a set of axes among the components of a form, and the sign by which the axis
 * `first` in front of the others is sorted in. */
static int component_with(int space, int k, int first, const int *axis, int *sign)
{
  int sorted[DVI_MESH_SPACE_MAX], other[DVI_MESH_SPACE_MAX], at = 0, number = 0;
  while (at < k && axis[at] < first) at++;
  for (int i = 0; i <= k; i++) sorted[i] = i < at ? axis[i] : i == at ? first : axis[i - 1];
  *sign = at % 2 == 0 ? 1 : -1;
  dvi__first_axes(k + 1, other);
  while (memcmp(sorted, other, (size_t)(k + 1) * sizeof *other) != 0) {
    number++;
    dvi__next_axes(space, k + 1, other);
  }
  return number;
}

/* Give the weights of the components of B in the component `axis` of i_n B. */
static void contract(int space, int k, const double *normal, const int *axis, double *along)
{
  memset(along, 0, DVI__COMPONENTS * sizeof *along);
  for (int l = 0; l < space; l++) {
    int sign, is_there = 0;
    for (int i = 0; i < k; i++) is_there = is_there || axis[i] == l;
    if (is_there) continue;
    const int component = component_with(space, k, l, axis, &sign);
    along[component] += sign * normal[l];
  }
}

/* Add the products of all components with the H of a cell beside the facet, which counts with a
 * weight. */
static dvi_status add_cell(const facet *f, int64_t cell, double weight, dvi__probe *probe)
{
  const dvi_mesh *mesh = f->field->mesh;
  const double *nu = f->field->star->factor[f->field->degree + 1];
  const int k = f->field->degree;
  double place[DVI__CORNERS], of_B[DVI__COMPONENTS];
  int axis[DVI_MESH_DIMENSION_MAX], component = 0;
  dvi__facet_place(mesh, f->number, cell, place);
  dvi__first_axes(k, axis);
  do {
    double of_E[DVI__COMPONENTS] = {0};
    of_E[component++] = weight * f->area * (nu != NULL ? nu[cell] : 1);
    contract(mesh->space, k, f->normal, axis, of_B);
    dvi__product *product = probe->product + probe->count++;
    DVI_TRY(dvi__functional_make(mesh, k, f->cell, f->place, of_E, product->factor));
    DVI_TRY(dvi__functional_make(mesh, k + 1, cell, place, of_B, product->factor + 1));
  } while (dvi__next_axes(mesh->space, k, axis));
  return DVI_OK;
}

/* Interpolate H between the middles of two cells, whose distances from the facet are as their
 * volumes. */
static dvi_status add_both_cells(const facet *f, int64_t beyond, dvi__probe *probe)
{
  const dvi_mesh *mesh = f->field->mesh;
  const double own = dvi__cell_volume(mesh, mesh->n, f->cell),
               other = dvi__cell_volume(mesh, mesh->n, beyond);
  DVI_TRY(add_cell(f, f->cell, other / (own + other), probe));
  return add_cell(f, beyond, own / (own + other), probe);
}

/* ---- squares of E ---- */

/* Add the square of E on an absorbing wall, of a 1-form that of E along the wall. */
static dvi_status add_wall(const facet *f, dvi__probe *probe)
{
  const dvi_mesh *mesh = f->field->mesh;
  const int k = f->field->degree, components = k == 0 ? 1 : mesh->space;
  for (int i = 0; i < components; i++) {
    double along[2][DVI__COMPONENTS] = {{0}};
    dvi__product *product = probe->product + probe->count++;
    product->is_square = 1;
    for (int l = 0; l < components; l++) {
      along[0][l] = (l == i) - (k == 0 ? 0 : f->normal[i] * f->normal[l]);
      along[1][l] = along[0][l] * f->area * dvi__admittance(f->field, f->cell);
    }
    for (int s = 0; s < 2; s++)
      DVI_TRY(dvi__functional_make(mesh, k, f->cell, f->place, along[s], product->factor + s));
  }
  return DVI_OK;
}

/* ---- surfaces ---- */

/* What is needed of a mesh's surface. */
typedef struct surface {
  const dvi_field *field;
  char *is_inside;    /* [n-cells] */
  char *is_absorbing; /* [facets] */
  int has_cells;
} surface;

static void clear(surface *s)
{
  dvi__release(s->is_inside);
  dvi__release(s->is_absorbing);
}

static dvi_status make_surface(const dvi_maxwell_terms *terms, const char *part, surface *s)
{
  const dvi_mesh *mesh = s->field->mesh;
  int64_t count;
  s->is_inside = dvi__mark_cells(mesh, part);
  s->is_absorbing = DVI_NEW(char, mesh->count[mesh->n - 1]);
  if (s->is_inside == NULL || s->is_absorbing == NULL)
    return dvi__fail(DVI_NO_MEMORY, "field: no memory for a probe");
  s->has_cells = dvi__part_total(mesh, part, mesh->n) > 0;
  for (int i = 0; i < terms->walls; i++) {
    if (terms->wall[i].kind != DVI_ABSORBING) continue;
    const int *number = dvi_mesh_part_cells(mesh, terms->wall[i].part, mesh->n - 1, &count);
    for (int64_t f = 0; f < count; f++) s->is_absorbing[number[f]] = 1;
  }
  return DVI_OK;
}

/* Give the cell out of which the power through a facet flows, or -1: the only one, or of two the
 * one in the part. */
static int64_t cell_behind(const surface *s, int64_t number)
{
  const int *coface = s->field->mesh->coface + 2 * number;
  if (coface[1] < 0) return s->has_cells && !s->is_inside[coface[0]] ? -1 : coface[0];
  if (s->is_inside[coface[0]] == s->is_inside[coface[1]]) return -1;
  return s->is_inside[coface[0]] ? coface[0] : coface[1];
}

static dvi_status add_facet(const surface *s, int64_t number, int64_t cell, dvi__probe *probe)
{
  const facet f = facet_of(s->field, number, cell);
  const int *coface = s->field->mesh->coface + 2 * number;
  if (coface[1] >= 0) return add_both_cells(&f, coface[0] == cell ? coface[1] : coface[0], probe);
  return s->is_absorbing[number] ? add_wall(&f, probe) : DVI_OK;
}

dvi_status dvi__probe_make_flux(const dvi_field *field, const dvi_maxwell_terms *terms,
                                const char *part, dvi__probe *probe)
{
  surface s = {.field = field};
  int64_t count, found = 0;
  const int components = dvi_form_components(field->mesh->space, field->degree);
  const int *number = dvi_mesh_part_cells(field->mesh, part, field->mesh->n - 1, &count);
  dvi_status status = make_surface(terms, part, &s);
  probe->product = DVI_NEW(dvi__product, 2 * count * components);
  if (status == DVI_OK && probe->product == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "field: no memory for a probe");
  for (int64_t i = 0; i < count && status == DVI_OK; i++) {
    const int64_t cell = cell_behind(&s, number[i]);
    if (cell < 0) continue;
    found += dvi__owns(field->mesh, field->mesh->n, cell);
    status = add_facet(&s, number[i], cell, probe);
  }
  clear(&s);
  DVI_TRY(dvi__agree(field->mesh, status));
  DVI_TRY(dvi__count_all(field->mesh, 1, &found));
  if (found > 0) return DVI_OK;
  return dvi__probe_refuse(probe->name, part,
                           "which has neither facets of the boundary nor cells with others around "
                           "them");
}
