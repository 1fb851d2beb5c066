#include "solve/certify.h"

#include "core/status.h"
#include "solve/solver_struct.h"

/* ---- many solutions ---- */

int dvi__certify_is_prepared(const dvi__solver *s, int most)
{
  return s->keeps_point && (most <= 1 || s->many != NULL);
}

dvi_status dvi__certify_prepare(dvi__solver *s, int most)
{
  if (dvi__certify_is_prepared(s, most)) return DVI_OK;
  DVI_TRY(dvi__kinsol_prepare(s, 1, &s->tester));
  s->keeps_point = 1;
  return most > 1 ? dvi__kinsol_prepare(s, most, &s->many) : DVI_OK;
}

double *dvi__certify_point(dvi__solver *s, int i)
{
  return dvi__kinsol_point(s->many, i);
}

dvi_status dvi__certify_note(dvi__solver *s, int i, const double *next, double whole, double size)
{
  return dvi__kinsol_note(s->many, i, next, whole, size);
}

int dvi__certify_noted(dvi__solver *s, int count)
{
  if (!dvi__kinsol_certify_known(s->many, count)) return 0;
  s->counters->certified += count;
  return 1;
}

/* ---- one solution ---- */

/* Test the residual that the last iteration showed. */
static int certify_last(dvi__solver *s, double size)
{
  if (!s->has_point) return 0;
  s->has_point = 0; /* a test uses its place */
  return dvi__kinsol_note(s->tester, 0, s->equations.own_point(s->equations.of), s->whole, size) ==
             DVI_OK &&
         dvi__kinsol_certify_known(s->tester, 1);
}

/* Where that one is too large, which roundings may be, the next one decides. */
static dvi_status certify_own(dvi__solver *s, double size, int *certified,
                              dvi__solve_report *report)
{
  *certified = certify_last(s, size);
  if (*certified) return DVI_OK;
  DVI_TRY(dvi__kinsol_prepare(s, 1, &s->tester));
  return dvi__kinsol_certify(s->tester, size, s->equations.own_point(s->equations.of), certified,
                             report);
}

static dvi_status certify_rows(dvi__solver *s, double size, const double *x, int *certified,
                               dvi__solve_report *report)
{
  DVI_TRY(dvi__kinsol_prepare(s, 0, &s->kinsol));
  DVI_TRY(dvi__solver_prepare_chord(s, x));
  return dvi__kinsol_certify(s->kinsol, size, x, certified, report);
}

dvi_status dvi__certify(dvi__solver *solver, double size, const double *x,
                        dvi__solve_report *report)
{
  int certified = 0;
  DVI_TRY(x != NULL ? certify_rows(solver, size, x, &certified, report)
                    : certify_own(solver, size, &certified, report));
  if (!certified)
    return dvi__fail(DVI_NOT_CONVERGED,
                     "KINSOL does not certify the solution (scaled residual %.1e)",
                     report->residual);
  solver->counters->certified++;
  return DVI_OK;
}
