/* The components of the mesh in which no value of a field is fixed. Those of a share are those of
 * the whole mesh: sets of the share's vertices are joined through vertices that several processes
 * hold. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/connected.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

/* ---- a whole mesh ---- */

/* Number the sets that have no fixed vertex. `label` [vertices] is -2 for the others. */
static void number_components(dvi_field *field, const int *root, int *label)
{
  for (int64_t v = 0; v < field->cells; v++) label[v] = -1;
  for (int64_t v = 0; v < field->cells; v++)
    if (field->number[v] < 0) label[root[v]] = -2;
  for (int64_t i = 0; i < field->unknowns; i++) {
    int *number = label + root[field->unknown[i]];
    if (*number == -1) *number = (int)field->components++;
    field->component[i] = *number >= 0 ? *number : -1;
  }
}

/* ---- a share ---- */

/* Vertices of the share, with the least number in the whole mesh of each one's component. Numbers
 * are below 0 where a value is fixed, so that these components have -1. */
typedef struct labels {
  const dvi_field *field;
  const int *root; /* [vertices] of the sets of the share */
  double *label;   /* [vertices] */
} labels;

/* Give all vertices of a set the least label in it. Returns whether one changes. */
static int join_sets(const labels *l)
{
  const int64_t vertices = l->field->cells;
  int changes = 0;
  for (int64_t v = 0; v < vertices; v++)
    l->label[l->root[v]] = fmin(l->label[l->root[v]], l->label[v]);
  for (int64_t v = 0; v < vertices; v++) {
    changes = changes || l->label[v] != l->label[l->root[v]];
    l->label[v] = l->label[l->root[v]];
  }
  return changes;
}

/* Labels of vertices that others own may be less there, and those of own ones less here. Owners
 * find these by themselves: they have all neighbours of their vertices. */
static dvi_status join_shares(const labels *l)
{
  const dvi_mesh *mesh = l->field->mesh;
  double *before = DVI_NEW(double, l->field->cells), changes = 1;
  dvi_status status = dvi__agree(
      mesh, before != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "field: no memory for components"));
  while (changes > 0 && status == DVI_OK && before != NULL) {
    memcpy(before, l->label, (size_t)l->field->cells * sizeof *before);
    status = dvi__refresh(mesh, 0, l->label);
    for (int64_t v = 0; v < l->field->cells; v++) l->label[v] = fmin(l->label[v], before[v]);
    changes = join_sets(l);
    if (memcmp(before, l->label, (size_t)l->field->cells * sizeof *before) != 0) changes = 1;
    if (status == DVI_OK) status = dvi__largest_of_all(mesh, 1, &changes);
  }
  dvi__release(before);
  return status;
}

/* Find the least label above another one of all processes. INFINITY if there is none. */
static dvi_status find_next(const labels *l, double above, double *next)
{
  double least = -INFINITY; /* of the numbers' negatives the largest is asked for */
  for (int64_t v = 0; v < l->field->cells; v++)
    if (l->label[v] > above && -l->label[v] > least) least = -l->label[v];
  DVI_TRY(dvi__largest_of_all(l->field->mesh, 1, &least));
  *next = -least;
  return DVI_OK;
}

/* Components are numbered in the order of their first vertices in the whole mesh. */
static dvi_status number_shared(dvi_field *field, const labels *l)
{
  double next;
  for (int64_t i = 0; i < field->unknowns; i++) field->component[i] = -1;
  DVI_TRY(find_next(l, -1, &next));
  for (; isfinite(next); field->components++) {
    for (int64_t i = 0; i < field->unknowns; i++)
      if (l->label[field->unknown[i]] == next) field->component[i] = (int)field->components;
    DVI_TRY(find_next(l, next, &next));
  }
  return DVI_OK;
}

static dvi_status find_shared(dvi_field *field, const int *root)
{
  const labels l = {.field = field, .root = root, .label = DVI_NEW(double, field->cells)};
  dvi_status status = dvi__agree(
      field->mesh,
      l.label != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "field: no memory for components"));
  if (status == DVI_OK && l.label != NULL) {
    for (int64_t v = 0; v < field->cells; v++)
      l.label[v] = field->number[v] < 0 ? -1 : (double)dvi__whole_number(field->mesh, 0, v);
    (void)join_sets(&l);
    status = join_shares(&l);
  }
  if (status == DVI_OK && l.label != NULL) status = number_shared(field, &l);
  dvi__release(l.label);
  return status;
}

/* ---- both ---- */

dvi_status dvi__field_find_components(dvi_field *field)
{
  int *root = DVI_NEW(int, 2 * field->cells);
  field->component = DVI_NEW(int, field->unknowns);
  dvi_status status = root != NULL && field->component != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for components");
  status = dvi__agree(field->mesh, status);
  if (status == DVI_OK) dvi__find_components(field->mesh, root);
  if (status == DVI_OK && field->mesh->share == NULL)
    number_components(field, root, root + field->cells);
  else if (status == DVI_OK && root != NULL)
    status = find_shared(field, root);
  dvi__release(root);
  return status;
}
