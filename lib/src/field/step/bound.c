#include "field/step/bound.h"

#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* What the eigenvalues of (k+1)-cells alone consist of. */
typedef struct local_terms {
  const dvi_field *field;
  dvi_matrix d, M2;
  int *sharing; /* [k-cells] n_e, the (k+1)-cells around each of them */
} local_terms;

/* The eigenvalue of a (k+1)-cell alone, whose k-cells belong in equal parts to all (k+1)-cells
 * around them: M_2 sum_e n_e / M_1(e). */
static double local_square(const local_terms *terms, int64_t f)
{
  const dvi__csr *M1 = &terms->field->mass;
  const dvi_matrix *d = &terms->d, *M2 = &terms->M2;
  double sum = 0, stiffness = 0;
  for (int64_t i = f * d->width; i < (f + 1) * d->width; i++) {
    const int unknown = terms->field->number[d->column[i]];
    if (unknown >= 0)
      sum += terms->sharing[d->column[i]] / M1->value[dvi__csr_find(M1, unknown, unknown)];
  }
  for (int64_t e = dvi__first_entry(M2, f); e < dvi__first_entry(M2, f + 1); e++)
    if (dvi__entry_column(M2, f, e) == f) stiffness = dvi__entry_value(M2, e);
  return stiffness * sum;
}

/* Find the own cell with the largest eigenvalue by itself. */
static dvi_status find_stiffest(const dvi_field *field, int64_t *stiffest, double *most)
{
  local_terms terms = {.field = field};
  *stiffest = 0;
  DVI_TRY(dvi_mesh_incidence(field->mesh, field->degree, &terms.d));
  DVI_TRY(dvi_star_matrix(field->star, field->degree + 1, &terms.M2));
  terms.sharing = DVI_NEW(int, terms.d.columns);
  if (terms.sharing == NULL) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a sentence");
  for (int64_t i = 0; i < terms.d.rows * terms.d.width; i++) terms.sharing[terms.d.column[i]]++;
  for (int64_t f = 0; f < terms.d.rows; f++) {
    const double square = dvi__owns(field->mesh, field->degree + 1, f) ? local_square(&terms, f)
                                                                       : -1;
    if (!(square > *most)) continue;
    *most = square;
    *stiffest = f;
  }
  dvi__release(terms.sharing);
  return DVI_OK;
}

static dvi_status name_stiffest(const dvi_field *field, int64_t cell, double step, double bound)
{
  const int degree = field->degree + 1;
  const dvi__cell_name name = dvi__name_cell(field->mesh, degree, cell);
  const int vertex = field->mesh->corner[degree][cell * dvi__corners(field->mesh->kind, degree)];
  const double *x = field->mesh->point + (int64_t)vertex * field->mesh->space;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "march: the step %g is not below the bound %.9g, which comes from %s near (%g, "
                   "%g, %g): take a shorter step, avi, or a mesh without such cells",
                   step, bound, name.text, x[0], field->mesh->space > 1 ? x[1] : 0.0,
                   field->mesh->space > 2 ? x[2] : 0.0);
}

/* The process that owns the first of the stiffest cells of the whole mesh names it. */
static dvi_status refuse_step(const dvi_field *field, double step, double bound)
{
  const dvi_mesh *mesh = field->mesh;
  int64_t cell;
  double most = -1, of_all, first;
  DVI_TRY(dvi__agree(mesh, find_stiffest(field, &cell, &most)));
  of_all = most;
  DVI_TRY(dvi__largest_of_all(mesh, 1, &of_all));
  const double number = most == of_all ? -(double)dvi__whole_number(mesh, field->degree + 1, cell)
                                       : -(double)INFINITY;
  first = number;
  DVI_TRY(dvi__largest_of_all(mesh, 1, &first));
  return dvi__agree(mesh, number == first ? name_stiffest(field, cell, step, bound) : DVI_OK);
}

dvi_status dvi__choose_step(const dvi_field *field, const dvi__march_plan *plan, double *step,
                            double *bound)
{
  double omega;
  DVI_TRY(dvi_field_fastest(field, &omega));
  *bound = omega > 0 ? 2 / omega : (double)INFINITY;
  *step = plan->step;
  if (plan->step == 0 && !(omega > 0))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "march: nothing oscillates, so that no step is a part of the largest stable "
                     "one: give a step");
  if (plan->step == 0) *step = dvi__fit_step(plan->fraction * *bound, plan->span);
  return *step < *bound ? DVI_OK : refuse_step(field, *step, *bound);
}

dvi_status dvi__refuse_options(const char *name, const dvi__march_plan *plan)
{
  if (*plan->options == '\0') return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "march: %s has no options, and \"%s\" is one", name,
                   plan->options);
}

dvi_status dvi__plan_march(const dvi_march_options *options, dvi__march_plan *plan)
{
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: set options.size to sizeof(dvi_march_options)");
  if (!isfinite(options->step) || options->step < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: the step is %g; a finite one above 0 is needed",
                     options->step);
  if (!(options->fraction >= 0 && options->fraction < 1))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "march: the fraction of the largest stable step is %g; above 0 and below 1 "
                     "are possible",
                     options->fraction);
  if (!isfinite(options->span) || options->span < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: the span is %g; 0 or more are possible",
                     options->span);
  if (options->threads < 0 || options->threads > DVI__MARCH_THREADS)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: %d threads; 1 to %d are possible", options->threads,
                     DVI__MARCH_THREADS);
  *plan = (dvi__march_plan){.step = options->step,
                            .fraction = options->fraction > 0 ? options->fraction : 0.5,
                            .span = options->span,
                            .threads = options->threads > 0 ? options->threads : 1,
                            .potential = options->potential};
  return DVI_OK;
}
