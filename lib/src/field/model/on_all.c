#include "field/model/on_all.h"

#include "core/status.h"
#include "field/mesh/share.h"

/* Make the sum of M, S and K with their factors. M and S are diagonal on shares. */
static dvi_status make_matrix(const dvi__field_equations *e, dvi__csr *sum)
{
  const dvi__csr *M = &e->field->mass;
  const dvi_matrix K = dvi__csr_view(&e->field->stiffness, 1);
  DVI_TRY(dvi__csr_copy(&K, sum));
  if (e->mass == 0 && e->stiffness == 0) return DVI_OK;
  for (int64_t i = 0; i < sum->rows; i++) {
    const int64_t at = dvi__csr_find(sum, i, (int)i);
    for (int64_t k = sum->start[i]; k < sum->start[i + 1]; k++) sum->value[k] *= e->stiffness;
    sum->value[at] += e->mass * M->value[i];
    if (e->loss != NULL) sum->value[at] += e->losses * e->loss[i];
  }
  return DVI_OK;
}

dvi_status dvi__on_all_create(const dvi__field_equations *equations, dvi__on_all *made)
{
  const dvi_field *f = equations->field;
  const dvi_ranks *ranks = &f->mesh->share->ranks;
  dvi__csr A = {0};
  *made = (dvi__on_all){.kind = ranks->solver};
  if (ranks->solver == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "field: equations on shares need a solver, which dvi_mesh_divide brings");
  dvi_status status = dvi__agree(f->mesh, make_matrix(equations, &A));
  if (status == DVI_OK) {
    const int is_definite = equations->mass != 0;
    const dvi__elliptic e = {.share = f->mesh,
                             .degree = f->degree,
                             .unknowns = f->unknowns,
                             .cell = f->unknown,
                             .A = dvi__csr_view(&A, 1),
                             .components = is_definite || equations->diagonal ? 0 : f->components,
                             .component = f->component,
                             .mass = equations->sine != 0 ? f->mass.value : NULL,
                             .cosine = equations->cosine,
                             .sine = equations->sine,
                             .residual = equations->residual,
                             .diagonal = equations->diagonal,
                             .of = equations->of};
    status = ranks->solver->create(&e, ranks->user, &made->solver);
  }
  dvi__csr_clear(&A);
  return status;
}

void dvi__on_all_clear(dvi__on_all *made)
{
  if (made->solver != NULL) made->kind->destroy(made->solver);
  *made = (dvi__on_all){0};
}

dvi_status dvi__field_solve_on_all(const dvi__field_equations *equations, double *x,
                                   dvi__elliptic_report *report)
{
  dvi__on_all all;
  dvi_status status = dvi__on_all_create(equations, &all);
  if (status == DVI_OK) {
    status = all.kind->solve(all.solver, x, report);
    if (status == DVI_NOT_CONVERGED)
      status = dvi__fail(status,
                         "field: %s: Newton's method left a residual of %.2g after %d corrections "
                         "and %lld iterations: start from values nearer to a solution",
                         report->why, report->residual, report->corrections,
                         (long long)report->iterations);
  }
  dvi__on_all_clear(&all);
  return status;
}
