/* The report of the derivative check. */
#include <stdio.h>

#include "core/status.h"
#include "system/check/check_struct.h"

static void name_entry(const dvi__finding *f, const char *kinetic, size_t size, char *text)
{
  char place[32], owner[48];
  (void)snprintf(owner, sizeof owner, "%s", f->owner != NULL ? f->owner : kinetic);
  if (f->term != NULL) (void)snprintf(owner, sizeof owner, "%s '%.24s'", f->kind, f->term);
  if (f->constraint > 0) (void)snprintf(owner, sizeof owner, "constraint %d", f->constraint - 1);
  if (f->worst.column < 0)
    (void)snprintf(place, sizeof place, "(%d)", f->worst.row);
  else
    (void)snprintf(place, sizeof place, "(%d,%d)", f->worst.row, f->worst.column);
  (void)snprintf(text, size, "%s: %s %s", owner, f->block, place);
}

static dvi_status report_range(const dvi__broken_range *r, dvi_derivative_check *result)
{
  result->range_row = r->row;
  (void)snprintf(result->where, sizeof result->where,
                 "potential '%.24s': gradient_range (%d) is %s", r->term->name, r->row,
                 r->outside > 0   ? "written behind its range"
                 : r->outside < 0 ? "written before its range"
                                  : "not that of the whole");
  if (r->outside != 0)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "system check: potential '%.24s': gradient_range of coordinates %d to %d writes one %s",
        r->term->name, r->first, r->last - 1, r->outside > 0 ? "more" : "before them");
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: potential '%.24s': dV/dq (%d) is %.17g from gradient_range of "
                   "coordinates %d to %d, %.17g from the "
                   "whole gradient; is the reach %d too small?",
                   r->term->name, r->row, r->part, r->first, r->last - 1, r->whole,
                   r->term->callbacks.reach);
}

dvi_status dvi__check_report(const dvi__check *c, double tolerance, dvi_derivative_check *result)
{
  const dvi__finding *const hessian = c->of_pattern.worst.error > tolerance ? &c->of_pattern
                                                                            : &c->of_hessian;
  const dvi__finding *const worst = c->of_gradient.worst.error > tolerance ? &c->of_gradient
                                                                           : hessian;
  const int missing = worst == &c->of_pattern;
  char entry[128] = "";
  if (worst->block != NULL) name_entry(worst, c->kinetic, sizeof entry, entry);
  *result = (dvi_derivative_check){.gradient_error = c->of_gradient.worst.error,
                                   .hessian_error = c->of_hessian.worst.error,
                                   .outside = c->of_pattern.worst.error,
                                   .row = hessian->block != NULL ? hessian->worst.row : -1,
                                   .column = hessian->block != NULL ? hessian->worst.column : -1,
                                   .range_row = -1};
  if (c->range.row >= 0 && worst != &c->of_gradient) return report_range(&c->range, result);
  if (worst->worst.error <= tolerance) return DVI_OK;
  (void)snprintf(result->where, sizeof result->where, "%.70s %s", entry,
                 missing ? "is not in the pattern" : "is wrong");
  if (missing)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "system check: %s is not in the pattern, but differences give %.15g", entry,
                     worst->worst.differenced);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "system check: %s is %.15g from the callback, %.15g from differences", entry,
                   worst->worst.given, worst->worst.differenced);
}
