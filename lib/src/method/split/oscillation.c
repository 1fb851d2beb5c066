#include "method/split/oscillation.h"

#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "system/part.h"

/* ---- the step ---- */

/* The fast gradient at the state stands in the memory behind the numbers of the impulse method. The
 * filter and the next move use it. */
static double *kept_gradient(const dvi__stepper *self)
{
  return self->memory + self->system->n + 1;
}

static dvi_status oscillation_move(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__oscillation *own = self->own;
  const double middle = state->t + 0.5 * h, *V_q = own->keeps ? kept_gradient(self) : own->V_q;
  const dvi__phase phase = dvi__impulse_phase(state);
  if (!own->keeps)
    DVI_TRY(dvi__potentials_gradient(own->fast_forces, 1, &middle, state->q, own->V_q));
  if (own->polynomials != NULL) return dvi__polynomials_move(own->polynomials, h, V_q, &phase);
  dvi__modes_move(own->modes, h, V_q, &phase);
  return DVI_OK;
}

/* ---- filters ---- */

/* Slots of the polynomials. */
enum { SHIFT, PSI };

static int is_one(const dvi__growth *growth)
{
  return growth->type == 0 && growth->poles == 0 && growth->mass == 1;
}

static dvi_status list_filters(dvi__oscillation *own, int n, double h)
{
  const double *square = dvi__modes_squares(own->modes);
  for (int k = 0; k < n; k++)
    if (!own->filters->at(own->filters->number, h * h * square[k], &own->filter[k]))
      return dvi__fail(DVI_NOT_CONVERGED,
                       "h omega = %.6g of a fast mode, where this filter does not exist: it "
                       "divides by sinc(h omega), or by its root",
                       fabs(h) * sqrt(fabs(square[k])));
  return DVI_OK;
}

static double shift_at(const void *user, double s)
{
  const dvi__filters *filters = user;
  dvi__filter at = {0, 0, 0};
  (void)filters->at(filters->number, s, &at);
  return at.shift;
}

static double psi_at(const void *user, double s)
{
  const dvi__filters *filters = user;
  dvi__filter at = {0, 0, 0};
  (void)filters->at(filters->number, s, &at);
  return at.psi;
}

static dvi_status expand_filters(dvi__oscillation *own, double h)
{
  const dvi__filters *filters = own->filters;
  if (!is_one(&filters->phi))
    DVI_TRY(
        dvi__polynomials_expand(own->polynomials, SHIFT, h, &filters->phi, 1, shift_at, filters));
  if (is_one(&filters->psi)) return DVI_OK;
  return dvi__polynomials_expand(own->polynomials, PSI, h, &filters->psi, 0, psi_at, filters);
}

static dvi_status oscillation_prepare(dvi__oscillation *own, int n, double h)
{
  if (own->h == h) return DVI_OK;
  own->h = 0;
  DVI_TRY(own->modes != NULL ? list_filters(own, n, h) : expand_filters(own, h));
  own->h = h;
  return DVI_OK;
}

/* Set nearby = A(q), from the fast gradient at q. */
static void oscillation_filter_place(dvi__oscillation *own, int n, double h, const double *q,
                                     const double *fast)
{
  if (own->modes != NULL) {
    dvi__modes_of_forces(own->modes, fast, own->y);
    for (int k = 0; k < n; k++) own->y[k] *= -h * h * own->filter[k].shift;
    dvi__modes_to_coordinates(own->modes, own->y, own->nearby);
  } else {
    dvi__polynomials_to_coordinates(own->polynomials, SHIFT, fast, own->nearby);
    for (int i = 0; i < n; i++) own->nearby[i] *= -h * h;
  }
  for (int i = 0; i < n; i++) own->nearby[i] += q[i];
}

static void oscillation_filter_force(dvi__oscillation *own, int n, const double *slow,
                                     double *softened)
{
  if (own->modes != NULL) {
    dvi__modes_of_forces(own->modes, slow, own->y);
    for (int k = 0; k < n; k++) own->y[k] *= own->filter[k].psi;
    dvi__modes_to_forces(own->modes, own->y, softened);
  } else {
    dvi__polynomials_to_forces(own->polynomials, PSI, slow, softened);
  }
}

static dvi_status filtered_gradient(dvi__stepper *self, const dvi__state *state, double h,
                                    double *V_q)
{
  dvi__oscillation *own = self->own;
  const int n = self->system->n, here = is_one(&own->filters->phi),
            hard = is_one(&own->filters->psi);
  double *fast = own->keeps ? kept_gradient(self) : own->V_q, *slow = hard ? V_q : own->V_q;
  DVI_TRY(oscillation_prepare(own, n, h));
  if (!here) {
    DVI_TRY(dvi__potentials_gradient(own->fast_forces, 1, &state->t, state->q, fast));
    oscillation_filter_place(own, n, h, state->q, fast);
  }
  DVI_TRY(dvi__potentials_gradient(own->impulse.forces, 1, &state->t, here ? state->q : own->nearby,
                                   slow));
  if (!hard) oscillation_filter_force(own, n, slow, V_q);
  return DVI_OK;
}

/* ---- create, destroy ---- */

/* Polynomials take larger blocks where possible, because products with so many modes take
 * longer. */
enum { MODES_BLOCK_QUICK = 64 };

static int has_polynomials(const dvi__filters *filters)
{
  return filters == NULL || (filters->phi.mass > 0 && filters->psi.mass > 0);
}

static dvi_status make_polynomials(dvi__oscillation *own, dvi_counters *counters)
{
  if (has_polynomials(own->filters))
    return dvi__polynomials_create(own->impulse.fast, counters, &own->polynomials);
  return dvi__fail(DVI_UNSUPPORTED,
                   "polynomials: the filter jumps, they cannot follow it; take another one");
}

/* Choose modes for small blocks, else polynomials. Filters with poles need modes, because modes may
 * lie between the poles, as long as there can be some. */
static dvi_status oscillation_choose(dvi__oscillation *own, dvi_counters *counters)
{
  const dvi__filters *filters = own->filters;
  const int poles = filters != NULL && (filters->phi.poles > 0 || filters->psi.poles > 0);
  const int most = poles || !has_polynomials(filters) ? DVI__MODES_BLOCK_MOST : MODES_BLOCK_QUICK;
  dvi_status status = dvi__modes_create(own->impulse.fast, most, counters, &own->modes);
  if (status != DVI_BAD_SIZE) return status;
  status = make_polynomials(own, counters);
  if (status != DVI_UNSUPPORTED) return status;
  char because[256];
  (void)snprintf(because, sizeof because, "%s", dvi_last_error());
  status = dvi__modes_create(own->impulse.fast, DVI__MODES_BLOCK_MOST, counters, &own->modes);
  return status == DVI_BAD_SIZE ? dvi__fail_in(status, "%s", because) : status;
}

static dvi_status oscillation_initialise(dvi__stepper *self, dvi__oscillation *own,
                                         dvi__motion motion)
{
  const size_t n = (size_t)self->system->n;
  DVI_TRY(motion == DVI__MOTION_MODES ? dvi__modes_create(own->impulse.fast, DVI__MODES_BLOCK_MOST,
                                                          self->counters, &own->modes)
          : motion == DVI__MOTION_POLYNOMIALS ? make_polynomials(own, self->counters)
                                              : oscillation_choose(own, self->counters));
  own->filter = DVI_NEW(dvi__filter, n);
  own->V_q = DVI_NEW(double, n);
  own->y = DVI_NEW(double, n);
  own->nearby = DVI_NEW(double, n);
  if (!own->filter || !own->V_q || !own->y || !own->nearby)
    return dvi__fail(DVI_NO_MEMORY, "no memory");
  return dvi__evaluator_create(own->impulse.fast, 1, DVI__GRADIENTS, self->counters,
                               &own->fast_forces);
}

dvi_status dvi__oscillation_create(dvi__stepper *self, const dvi__filters *filters,
                                   dvi__motion motion, const char *remedy)
{
  if (!dvi__system_fast_is_quadratic(self->system))
    return dvi__fail(
        DVI_UNSUPPORTED,
        "%s: a fast potential is not declared `quadratic`, and only such ones have modes; %s (it "
        "is '%s'; those of scenes are declared if their second derivatives are constant)",
        self->method->name, remedy, dvi__system_fast_not_quadratic(self->system));
  DVI_TRY(dvi__impulse_create(self, sizeof(dvi__oscillation), 0));
  dvi__oscillation *own = self->own;
  own->filters = filters;
  own->impulse.move = oscillation_move;
  own->impulse.gradient = filters != NULL ? filtered_gradient : NULL;
  own->keeps = filters != NULL && !is_one(&filters->phi) && self->system->autonomous;
  if (own->keeps) self->memory_count += (size_t)self->system->n;
  const dvi_status status = oscillation_initialise(self, own, motion);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "%s", self->method->name);
}

void dvi__oscillation_destroy(dvi__stepper *self)
{
  dvi__oscillation *own = self->own;
  if (own == NULL) return;
  dvi__modes_destroy(&own->modes);
  dvi__polynomials_destroy(&own->polynomials);
  dvi__evaluator_destroy(&own->fast_forces);
  dvi__release(own->filter);
  dvi__release(own->V_q);
  dvi__release(own->y);
  dvi__release(own->nearby);
  dvi__impulse_destroy(self);
}

/* ---- explain ---- */

static void explain_steps(const dvi__polynomials *polynomials, int count, const double *h,
                          dvi__text *text)
{
  double bound[3];
  dvi__text_add(text, " for steps with h omega =");
  for (int k = 0; k < count; k++) dvi__text_add(text, "%s %g", k > 0 ? "," : "", pow(10, k));
  dvi__text_add(text, " of degree");
  for (int k = 0; k < count; k++)
    dvi__text_add(text, "%s %d", k > 0 ? "," : "",
                  dvi__polynomials_degree(polynomials, h[k], &bound[k]));
  dvi__text_add(text, ", which leave out at most");
  for (int k = 0; k < count; k++) dvi__text_add(text, "%s %.2g", k > 0 ? "," : "", bound[k]);
  dvi__text_add(text, " of the motion");
}

static void explain_polynomials(const dvi__polynomials *polynomials, dvi__text *text)
{
  const double longest = dvi__polynomials_longest(polynomials);
  double low, high, h[3];
  int count = 0;
  dvi__polynomials_interval(polynomials, &low, &high);
  for (; count < 3; count++) {
    h[count] = pow(10, count) / sqrt(high);
    if (h[count] > longest) break;
  }
  dvi__text_add(
      text,
      "solver: none; Chebyshev polynomials of M^-1 K, whose omega^2 lie between %.6g and %.6g:",
      low, high);
  if (count > 0) explain_steps(polynomials, count, h, text);
  if (count < 3)
    dvi__text_add(text, "%s steps are at most %.3g long, for modes may grow", count > 0 ? ";" : "",
                  longest);
  dvi__text_add(text, "\n");
}

void dvi__oscillation_explain(const dvi__stepper *self, dvi__text *text)
{
  const dvi__oscillation *own = self->own;
  dvi__text_add(text,
                "kernel: kicks by the slow potentials, one gradient of them a step; the fast ones "
                "move exactly, by %s\n",
                own->modes != NULL ? "their normal modes" : "polynomials");
  if (own->modes != NULL)
    dvi__text_add(
        text, "solver: none; modes of %d blocks of coordinates, the largest of %d, found once\n",
        dvi__modes_block_count(own->modes), dvi__modes_largest_block(own->modes));
  else
    explain_polynomials(own->polynomials, text);
}
