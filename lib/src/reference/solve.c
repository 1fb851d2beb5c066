/* The common part of all codes: arguments, the consistent start, counters, failures. */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <dvi/reference.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "reference/run.h"
#include "system/evaluate/dynamics.h"
#include "system/term/term.h"

static const struct {
  const char *name;
  dvi_status (*integrate)(dvi__reference_run *run);
} codes[] = {
    [DVI_IDA] = {"ida", dvi__reference_ida},
    [DVI_CVODE_ADAMS] = {"cvode-adams", dvi__reference_cvode},
    [DVI_CVODE_BDF] = {"cvode-bdf", dvi__reference_cvode},
    [DVI_ARKODE] = {"arkode", dvi__reference_arkode},
    [DVI_IDA_INDEX_2] = {"ida-index-2", dvi__reference_ida},
};

enum { CODE_COUNT = sizeof codes / sizeof codes[0] };

/* Default tolerances. Without a gradient the momenta L_v are differenced values, whose noise stops
 * the codes below about 1e-11 (measured on IDA). */
static const double default_tolerance = 1e-12, default_without_gradient = 1e-9;
/* At index 2 the multiplier's noise, 1/h times that of q, enters the equations through L_q. */
static const double default_index_2 = 1e-9;
/* Multipliers of holonomic constraints are outside of the error test, but their noise stops IDA at
 * 1e-13 on Andrews' squeezer (measured). */
static const double default_holonomic = 1e-11;
static const long default_max_steps = 50000000;

const char *dvi_reference_name(dvi_reference_code code)
{
  return (unsigned)code < CODE_COUNT ? codes[code].name : NULL;
}

const char *dvi_reference_version(void)
{
  return SUNDIALS_VERSION;
}

static double cpu_time(void)
{
  struct timespec now;
  if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now) != 0) return (double)NAN;
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static dvi_status out_of_time(const dvi__reference_run *run)
{
  const double most = run->options.max_seconds;
  if (!(most > 0) || cpu_time() - run->began <= most) return DVI_OK;
  return dvi__fail(DVI_REFERENCE_FAILED,
                   "reference: it takes more than max_seconds, %g; allow more", most);
}

int dvi__reference_callback(dvi__reference_run *run, dvi_status status)
{
  run->callback = status == DVI_OK ? out_of_time(run) : status;
  return (run->callback > 0) - (run->callback < 0);
}

double dvi__reference_least_step(const dvi__reference_run *run)
{
  return 4 * DBL_EPSILON * fmax(fabs(run->t), fabs(run->t_end));
}

dvi_status dvi__reference_no_setup(const dvi__reference_run *run)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: could not be set up for %d coordinates",
                   codes[run->options.code].name, run->n);
}

/* IDA, CVODE and ARKODE number these flags alike. */
static const char *flag_remedy(int flag)
{
  switch (flag) {
  case -1: return "allow more steps";
  case -2: return "loosen the tolerances";
  case -3:
  case -4: return "loosen the tolerances, unless the solution is singular there";
  default: return "see the code's manual";
  }
}

dvi_status dvi__reference_stopped(const dvi__reference_run *run, int flag, char *flag_name)
{
  const char *code = codes[run->options.code].name,
             *reason = flag_name != NULL ? flag_name : "no memory";
  dvi_status status;
  if (run->callback != DVI_OK)
    status = dvi__fail_in(run->callback < 0 ? run->callback : DVI_REFERENCE_FAILED,
                          "%s: stopped at t = %.9g after %ld steps (%s)", code, run->reached,
                          run->steps, reason);
  else
    status = dvi__fail(DVI_REFERENCE_FAILED,
                       "%s: stopped at t = %.9g, before %.9g, after %ld steps (%s); %s", code,
                       run->reached, run->t_end, run->steps, reason, flag_remedy(flag));
  free(flag_name);
  return status;
}

static double default_of(const dvi_system *system, dvi_reference_code code)
{
  const int differenced = system->lagrangian != NULL &&
                          !dvi__general_has_gradient(system->lagrangian);
  if (code == DVI_IDA_INDEX_2) return default_index_2;
  if (code == DVI_IDA && (system->terms & DVI__HOLONOMIC) && !differenced) return default_holonomic;
  return differenced ? default_without_gradient : default_tolerance;
}

dvi_status dvi__reference_complete(const dvi_system *system, const dvi_reference_options *given,
                                   dvi_reference_options *options)
{
  *options = given != NULL ? *given : (dvi_reference_options){.code = DVI_IDA};
  if (dvi_reference_name(options->code) == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "reference: there is no code number %d", (int)options->code);
  if (system->contact_count > 0)
    return dvi__fail(DVI_UNSUPPORTED, "reference: the system declares contacts, and the codes "
                                      "integrate smooth motions alone");
  if (!(options->relative_tolerance >= 0) || !(options->relative_tolerance < 1))
    return dvi__fail(DVI_BAD_ARGUMENT, "reference: relative_tolerance is %g, must be in [0,1)",
                     options->relative_tolerance);
  if (!(options->absolute_tolerance >= 0) || isinf(options->absolute_tolerance))
    return dvi__fail(DVI_BAD_ARGUMENT, "reference: absolute_tolerance is %g, must not be negative",
                     options->absolute_tolerance);
  if (!(options->max_seconds >= 0))
    return dvi__fail(DVI_BAD_ARGUMENT, "reference: max_seconds is %g, must not be negative",
                     options->max_seconds);
  if (options->max_steps < 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "reference: max_steps is %ld, must not be negative",
                     options->max_steps);
  if (options->relative_tolerance == 0)
    options->relative_tolerance = default_of(system, options->code);
  if (options->absolute_tolerance == 0) options->absolute_tolerance = options->relative_tolerance;
  if (options->max_steps == 0) options->max_steps = default_max_steps;
  return DVI_OK;
}

static dvi_status reference_check_start(const dvi_system *system, double t, double t_end,
                                        const double *q, const double *p)
{
  if (system == NULL || q == NULL || p == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "reference: system, q and p are needed");
  if (!isfinite(t) || !isfinite(t_end))
    return dvi__fail(DVI_NOT_FINITE, "reference: the span from t = %g to %g is not finite", t,
                     t_end);
  const ptrdiff_t bad_q = dvi__first_not_finite((size_t)dvi_system_nq(system), q);
  if (bad_q >= 0) return dvi__fail(DVI_NOT_FINITE, "reference: q[%td] is %g", bad_q, q[bad_q]);
  const ptrdiff_t bad_p = dvi__first_not_finite((size_t)dvi_system_nv(system), p);
  if (bad_p >= 0) return dvi__fail(DVI_NOT_FINITE, "reference: p[%td] is %g", bad_p, p[bad_p]);
  return DVI_OK;
}

/* CVODE's Adams and ARKODE iterate without Jacobians, and take potentials without Hessians. */
static dvi__derivatives derivatives_of(const dvi__reference_run *run)
{
  const dvi_reference_code code = run->options.code;
  const int has_jacobians = code != DVI_CVODE_ADAMS && code != DVI_ARKODE;
  if (run->system->dynamics->equations == DVI__LIFTED) return DVI__STATES;
  return !has_jacobians && dvi__system_without_hessian(run->system) != NULL ? DVI__GRADIENTS
                                                                            : DVI__HESSIANS;
}

/* The patterns of second derivatives are complete only if these are evaluated. */
static size_t entries_of(const dvi__reference_run *run, const dvi__pattern *pattern)
{
  return derivatives_of(run) == DVI__GRADIENTS ? 0 : (size_t)dvi__pattern_entries(pattern);
}

static dvi_status reserve_forces(dvi__reference_run *run)
{
  if (run->system->force_count == 0) return DVI_OK;
  run->F_q = DVI_NEW(double, entries_of(run, &run->system->by_q));
  run->F_v = DVI_NEW(double, entries_of(run, &run->system->by_v));
  return run->F_q != NULL && run->F_v != NULL ? DVI_OK : dvi__reference_no_setup(run);
}

static dvi_status reference_reserve(dvi__reference_run *run, const double *q, const double *p)
{
  const size_t n = (size_t)run->n;
  run->q = dvi__duplicate(q, (size_t)run->system->n, sizeof *q);
  run->p = dvi__duplicate(p, n, sizeof *p);
  run->v = DVI_NEW(double, n);
  run->force = DVI_NEW(double, n);
  run->multiplier = DVI_NEW(double, dvi_system_constraint_count(run->system));
  run->L_qq = DVI_NEW(double, entries_of(run, &run->system->qq));
  run->L_qv = DVI_NEW(double, entries_of(run, &run->system->qv));
  run->L_vv = DVI_NEW(double, entries_of(run, &run->system->vv));
  if (run->q == NULL || run->p == NULL || run->v == NULL || run->force == NULL ||
      run->multiplier == NULL || run->L_qq == NULL || run->L_qv == NULL || run->L_vv == NULL ||
      dvi__sundials->new_context(&run->context) != 0)
    return dvi__reference_no_setup(run);
  return reserve_forces(run);
}

dvi_status dvi__reference_form_momentum(dvi__reference_run *run)
{
  return dvi__lagrangian_gradient(run->evaluator, 1, &run->t_end, run->q, run->v, NULL, run->p);
}

static dvi_status reference_prepare(dvi__reference_run *run, const double *q, const double *p)
{
  const dvi__dynamics *dynamics = run->system->dynamics;
  if (run->system->terms & DVI__NOISE)
    return dvi__fail(DVI_UNSUPPORTED,
                     "the system declares noise, and this code solves equations without");
  DVI_TRY(dvi__sundials_load());
  const int lifted = dynamics->equations == DVI__LIFTED;
  DVI_TRY(
      dvi__evaluator_create(run->system, 1, derivatives_of(run), &run->counters, &run->evaluator));
  DVI_TRY(reference_reserve(run, q, p));
  DVI_TRY(dvi__state_check(run->evaluator, run->q, run->p));
  if (dynamics->constraint != NULL)
    DVI_TRY(dynamics->constraint->check(run->evaluator, run->t, run->q, run->p));
  if (dynamics->constraint != NULL && dynamics->constraint->has_rank) {
    int side;
    DVI_TRY(dynamics->constraint->side(run->evaluator, run->t, run->q, run->p, 0, &side));
  }
  return lifted ? dynamics->velocity(run->evaluator, run->t, run->q, run->p, run->v)
                : dynamics->motion(run->evaluator, run->t, run->q, run->p, run->v, run->force,
                                   run->multiplier);
}

static void reference_clear(dvi__reference_run *run)
{
  dvi__evaluator_destroy(&run->evaluator);
  if (run->context != NULL) (void)SUNContext_Free(&run->context);
  dvi__release(run->F_q);
  dvi__release(run->F_v);
  dvi__release(run->L_vv);
  dvi__release(run->L_qv);
  dvi__release(run->L_qq);
  dvi__release(run->multiplier);
  dvi__release(run->force);
  dvi__release(run->v);
  dvi__release(run->p);
  dvi__release(run->q);
}

static dvi_status reference_integrate(dvi__reference_run *run, double *q, double *p)
{
  const char *code = codes[run->options.code].name;
  dvi_status status = reference_prepare(run, q, p);
  if (status != DVI_OK) (void)dvi__fail_in(status, "%s: no start at t = %.9g", code, run->t);
  if (status == DVI_OK) status = codes[run->options.code].integrate(run);
  if (status == DVI_OK) {
    memcpy(q, run->q, (size_t)run->system->n * sizeof *q);
    memcpy(p, run->p, (size_t)run->n * sizeof *p);
  }
  reference_clear(run);
  return status;
}

dvi_status dvi_reference_solve(const dvi_system *system, double t, double t_end, double *q,
                               double *p, const dvi_reference_options *options,
                               dvi_reference_report *report)
{
  dvi__reference_run run = {.system = system, .t = t, .t_end = t_end, .reached = t};
  DVI_TRY(reference_check_start(system, t, t_end, q, p));
  DVI_TRY(dvi__reference_complete(system, options, &run.options));
  run.n = dvi_system_nv(system);
  run.began = cpu_time();
  const dvi_status status = t == t_end ? DVI_OK : reference_integrate(&run, q, p);
  if (report != NULL)
    *report = (dvi_reference_report){.error = (double)NAN,
                                     .relative_tolerance = run.options.relative_tolerance,
                                     .steps = run.steps,
                                     .evaluations = run.counters.gradients,
                                     .cpu_seconds = cpu_time() - run.began};
  return status;
}
