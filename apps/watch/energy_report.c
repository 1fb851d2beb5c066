#include "watch/energy_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "load/density.h"

enum { ADVICE_SIZE = 128, GOOD_ORDER = 4 };

/* Fractions of the scale. Errors above bound_of_most are reported, and above bound_of_splitting for
 * methods whose steps exceed the periods of fast potentials on purpose and let their energy
 * oscillate. A better step aims at target. Errors above unresolved belong to steps that do not
 * resolve the motion at all. */
static const double bound_of_most = 0.01, bound_of_splitting = 0.1, target = 0.001,
                    unresolved = 0.3;

/* Round down to a number of two digits. */
static double round_down(double x)
{
  const double unit = pow(10.0, floor(log10(fabs(x))) - 1.0);
  return copysign(floor(fabs(x) / unit) * unit, x);
}

double energy_shorter_step(double h, int order, double part, double most)
{
  const double shorter = fabs(h) * pow(part, 1.0 / fmax(order, 1.0));
  return round_down(copysign(fmin(shorter, most), h));
}

const char *energy_better_method(const dvi_system_terms *terms)
{
  if (terms->hamiltonian != NULL)
    return terms->constraint != NULL ? "dg-phase:degree=4" : "hamiltonian:type=2,degree=4";
  if (terms->factors != NULL) return "lie-galerkin:degree=4";
  if (terms->nonholonomic_count > 0) return "composition:order=4";
  return terms->one_form != NULL ? "vprk:nodes=4" : "galerkin:degree=4";
}

/* Return the longest step to advise. The problem's own step is good for a first run, if it is one
 * in time. */
static double longest_step(const energy_watch *watch, const run_request *request)
{
  return dvi_integrator_monitor(watch->integrator) == NULL
             ? fmin(fabs(watch->scene->h), fabs(request->h))
             : fabs(request->h);
}

/* Choose a better step. A saturated error predicts no step, but the problem's own step suits an
 * order of 4. At an order of 2 a fifth of it has about the same error. */
static double better_step(const run_request *request, int order, double ratio, double most)
{
  const bool known = ratio < unresolved;
  return energy_shorter_step(request->h, order, target / fmin(ratio, 1.0),
                             known || order > 2 ? most : 0.2 * most);
}

/* Advise on better choices than a shorter step. Once the steps resolve the motion, a higher order
 * is better. Near collisions, steps that follow it are. */
static void energy_advise(const energy_watch *watch, const run_request *request, double ratio,
                          double most, char advice[ADVICE_SIZE])
{
  const problem *scene = watch->scene;
  const bool resolved = ratio < unresolved || most < fabs(request->h);
  const bool bodies = scene->bodies > 0 && scene->terms->factors == NULL &&
                      scene->terms->one_form == NULL;
  advice[0] = '\0';
  if (resolved && dvi_integrator_order(watch->integrator) <= GOOD_ORDER)
    (void)snprintf(advice, ADVICE_SIZE, ", or --method %s --h %g",
                   energy_better_method(scene->terms), copysign(most, request->h));
  else if (!resolved && bodies && dvi_integrator_monitor(watch->integrator) == NULL)
    (void)snprintf(advice, ADVICE_SIZE,
                   ", or --time-transform distance, whose steps follow close encounters");
}

/* Return whether the method separates the fast potentials of the system from the others. */
static bool steps_over_periods(const dvi_system_terms *terms, const char *method)
{
  static const char *const splitting[] = {"imex", "respa", "mollified", "trig", "multiscale"};
  bool fast = false, splits = false;
  for (int k = 0; k < terms->potential_count; k++) fast = fast || terms->potentials[k].fast;
  for (size_t k = 0; k < sizeof splitting / sizeof *splitting; k++)
    splits = splits || strncmp(method, splitting[k], strlen(splitting[k])) == 0;
  return fast && splits;
}

double energy_bound(const problem *scene, const char *method)
{
  return steps_over_periods(scene->terms, method) ? bound_of_splitting : bound_of_most;
}

void energy_tell(energy_watch *watch, const run_request *request)
{
  const energy_verdict verdict = energy_watch_end(watch);
  if (isnan(verdict.passed)) return;
  const double most = longest_step(watch, request);
  const int order = dvi_integrator_order(watch->integrator);
  char advice[ADVICE_SIZE];
  double least;
  energy_advise(watch, request, verdict.ratio, most, advice);
  complain("run: the energy error of %s with --h %g passed %g %% of the %s at t = %.6g, and was "
           "%.3g %% of it at t = %.6g",
           request->method, request->h, 100.0 * watch->bound, energy_scale_name(watch->scene),
           verdict.passed, 100.0 * verdict.ratio, verdict.t);
  if (density_grows(watch->scene, &least)) return; /* no step helps */
  complain("run: try --h %g%s; --verify tells how many digits are right",
           better_step(request, order, verdict.ratio, most), advice);
}
