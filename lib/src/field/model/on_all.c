#include "field/model/on_all.h"

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* Give the diagonal of M and S with their factors, which K of gradients leaves alone. */
static double lower_part(const dvi__field_equations *e, int64_t i)
{
  const double mass = e->mass * e->field->mass.value[i];
  return e->loss != NULL ? mass + e->losses * e->loss[i] : mass;
}

/* Make the sum of M, S and K with their factors, and the diagonal of the first two, which are
 * diagonal on shares. */
static dvi_status make_matrix(const dvi__field_equations *e, dvi__csr *sum, double **lower)
{
  const dvi_matrix K = dvi__csr_view(&e->field->stiffness, 1);
  DVI_TRY(dvi__csr_copy(&K, sum));
  *lower = DVI_NEW(double, sum->rows);
  if (*lower == NULL) return dvi__fail(DVI_NO_MEMORY, "field: no memory for a matrix");
  if (e->mass == 0 && e->stiffness == 0) return DVI_OK;
  for (int64_t i = 0; i < sum->rows; i++) {
    const int64_t at = dvi__csr_find(sum, i, (int)i);
    for (int64_t k = sum->start[i]; k < sum->start[i + 1]; k++) sum->value[k] *= e->stiffness;
    (*lower)[i] = lower_part(e, i);
    sum->value[at] += (*lower)[i];
  }
  return DVI_OK;
}

dvi_status dvi__on_all_create(const dvi__field_equations *equations, dvi__on_all *made)
{
  const dvi_field *f = equations->field;
  const dvi_ranks *ranks = &f->mesh->share->ranks;
  dvi__csr A = {0};
  double *lower = NULL;
  *made = (dvi__on_all){.kind = ranks->solver};
  if (ranks->solver == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "field: equations on shares need a solver, which dvi_mesh_divide brings");
  dvi_status status = dvi__agree(f->mesh, make_matrix(equations, &A, &lower));
  if (status == DVI_OK) {
    const int is_definite = equations->mass != 0;
    const dvi__elliptic e = {.share = f->mesh,
                             .degree = f->degree,
                             .unknowns = f->unknowns,
                             .cell = f->unknown,
                             .A = dvi__csr_view(&A, 1),
                             .of_gradients = lower,
                             .components = is_definite || equations->diagonal ? 0 : f->components,
                             .component = f->component,
                             .mass = equations->sine != 0 ? f->mass.value : NULL,
                             .cosine = equations->cosine,
                             .sine = equations->sine,
                             .residual = equations->residual,
                             .diagonal = equations->diagonal,
                             .of = equations->of,
                             .rounding = equations->rounding};
    status = ranks->solver->create(&e, ranks->user, &made->solver);
  }
  dvi__csr_clear(&A);
  dvi__release(lower);
  return status;
}

void dvi__on_all_clear(dvi__on_all *made)
{
  if (made->solver != NULL) made->kind->destroy(made->solver);
  *made = (dvi__on_all){0};
}

/* Solve, and say why not. */
static dvi_status solve(const dvi__on_all *all, double *x, dvi__elliptic_report *report)
{
  const dvi_status status = all->kind->solve(all->solver, x, report);
  if (status != DVI_NOT_CONVERGED) return status;
  return dvi__fail(status,
                   "field: %s: Newton's method left a residual of %.2g after %d corrections and "
                   "%lld iterations: start from values nearer to a solution",
                   report->why, report->residual, report->corrections,
                   (long long)report->iterations);
}

dvi_status dvi__elliptic_solve_once(const dvi__elliptic *equations, double *x)
{
  const dvi_ranks *ranks = &equations->share->share->ranks;
  dvi__on_all all = {.kind = ranks->solver};
  dvi__elliptic_report report;
  dvi_status status = all.kind->create(equations, ranks->user, &all.solver);
  if (status == DVI_OK) status = solve(&all, x, &report);
  dvi__on_all_clear(&all);
  return status;
}

dvi_status dvi__field_solve_on_all(const dvi__field_equations *equations, double *x,
                                   dvi__elliptic_report *report)
{
  dvi__on_all all;
  dvi_status status = dvi__on_all_create(equations, &all);
  if (status == DVI_OK) status = solve(&all, x, report);
  dvi__on_all_clear(&all);
  return status;
}
