/* Which values of a field are fixed. */
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

enum { PLACE_SIZE = 320 };

/* Name a cell, with the coordinates of a vertex. */
static void name_place(const dvi_field *field, int k, int64_t cell, char place[PLACE_SIZE])
{
  const dvi__cell_name name = dvi__name_cell(field->mesh, k, cell);
  const int space = field->mesh->space;
  const double *x = field->mesh->point + cell * space;
  size_t length = (size_t)snprintf(place, PLACE_SIZE, "%s", name.text);
  for (int l = 0; k == 0 && l < space && length < PLACE_SIZE; l++)
    length += (size_t)snprintf(place + length, PLACE_SIZE - length, "%s%.6g%s",
                               l == 0 ? ", (" : ", ", x[l], l + 1 == space ? ")" : "");
}

dvi_status dvi__field_check_datum(const dvi_field *field, const char *what, int failed,
                                  double value, int k, int64_t cell)
{
  char place[PLACE_SIZE];
  if (failed == 0 && isfinite(value)) return DVI_OK;
  name_place(field, k, cell, place);
  if (failed != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "field: the %s returned %d at %s", what, failed, place);
  return dvi__fail(DVI_NOT_FINITE, "field: the %s is %g at %s", what, value, place);
}

/* ---- values ---- */

/* Fix the vertices of a part. Those that are fixed already keep their values. */
static dvi_status fix_part(dvi_field *field, const dvi_condition *condition, double *value)
{
  int64_t count;
  char what[96];
  const int *vertex = dvi_mesh_part_cells(field->mesh, condition->part, 0, &count);
  (void)snprintf(what, sizeof what, "fixed value on part \"%.40s\"", condition->part);
  for (int64_t i = 0; i < count; i++) {
    const int v = vertex[i];
    double datum = 0;
    if (field->number[v] < 0) continue;
    const double *x = field->mesh->point + (int64_t)v * field->mesh->space;
    const int failed = condition->datum != NULL ? condition->datum(x, NULL, &datum, condition->user)
                                                : 0;
    DVI_TRY(dvi__field_check_datum(field, what, failed, datum, 0, v));
    value[v] = datum;
    field->number[v] = -1;
  }
  return DVI_OK;
}

static dvi_status check_condition(const dvi_field *field, const dvi_condition *condition)
{
  int64_t count;
  if (condition->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a condition has no part of the mesh");
  if (condition->kind != DVI_FREE && condition->kind != DVI_FIXED)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: the condition on part \"%s\" has no kind %d",
                     condition->part, (int)condition->kind);
  (void)dvi_mesh_part_cells(field->mesh, condition->part, 0, &count);
  if (count >= 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "field: a condition is set on part \"%s\", which the mesh has "
                   "not",
                   condition->part);
}

dvi_status dvi__field_number(dvi_field *field)
{
  int count = 0;
  for (int64_t v = 0; v < field->cells; v++)
    if (field->number[v] >= 0) field->unknown[count++] = (int)v;
  for (int i = 0; i < count; i++) field->number[field->unknown[i]] = i;
  field->unknowns = count;
  for (int i = 0; i < count; i++)
    field->whole_unknowns += dvi__owns(field->mesh, field->degree, field->unknown[i]);
  DVI_TRY(dvi__count_all(field->mesh, 1, &field->whole_unknowns));
  if (field->whole_unknowns > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "field: all %lld %s are fixed, and nothing is unknown",
                   (long long)dvi__whole_count(field->mesh, field->degree),
                   field->degree == 0 ? "vertices" : "edges");
}

static dvi_status fix(dvi_field *field, const dvi_wave_terms *terms)
{
  field->unknown = DVI_NEW(int, field->cells);
  field->number = DVI_NEW(int, field->cells);
  field->fixed = DVI_NEW(double, field->cells);
  if (field->unknown == NULL || field->number == NULL || field->fixed == NULL)
    return dvi__fail(DVI_NO_MEMORY, "field: no memory for %lld vertices", (long long)field->cells);
  for (int i = 0; i < terms->conditions; i++) {
    DVI_TRY(check_condition(field, terms->condition + i));
    if (terms->condition[i].kind == DVI_FIXED)
      DVI_TRY(fix_part(field, terms->condition + i, field->fixed));
  }
  return DVI_OK;
}

dvi_status dvi__field_fix(dvi_field *field, const dvi_wave_terms *terms)
{
  DVI_TRY(dvi__agree(field->mesh, fix(field, terms)));
  return dvi__field_number(field);
}
