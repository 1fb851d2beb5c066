/* Yee's grid as a march (dvi/march.h).
 *
 * L = E.M_1 E/2 - B.M_2 B/2 + J.A with E = -A' and B = d_1 A, discretised by differences of A:
 *     Ld = dt ( E^{n+1/2}.M_1 E^{n+1/2}/2 - B^n.M_2 B^n/2 + J^n.A^n ),
 *     E^{n+1/2} = (A^n - A^{n+1})/dt.
 * Its stationarity gives the step of dvi/yee.h. Source: Yee 1966; Stern 2009, secs. 3.2 and 3.3,
 * with a half step at the start. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

/* ---- creation ---- */

static void destroy(void *self)
{
  dvi__yee *y = self;
  double *const arrays[] = {y->state[0], y->state[1], y->ce,     y->ca,      y->loss,    y->worn,
                            y->mi,       y->drive,    y->charge, y->scratch, y->impulses};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  for (int l = 0; l < 3; l++) dvi__yee_clear_axis(&y->axis[l]);
  dvi__yee_clear_acts(&y->on_edges);
  dvi__yee_clear_acts(&y->on_faces);
  dvi__yee_clear_waves(y);
  dvi__yee_clear_planes(y);
  dvi__release(y->source);
  dvi__release(y->probe);
  dvi__release(y->flux);
  dvi__release(y->names);
  dvi__release(y->loses);
  dvi__release(y->wall_first);
  dvi__release(y->wall);
  dvi__release(y->moment);
  dvi__release(y->progress);
  dvi__team_destroy(&y->team);
  dvi__release(y);
}

static dvi_status refuse_step(const dvi__yee *y, double step)
{
  double x[3] = {0};
  dvi__yee_tightest(y, x);
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "yee: the step %.17g is not below the bound %.17g of stable ones, which boxes and "
      "materials at (%g, %g, %g) make the smallest; take a shorter step",
      step, y->bound, x[0], x[1], x[2]);
}

/* Choose the step. With a span, a whole number of steps makes it. */
static dvi_status choose_step(const dvi_yee_terms *terms, dvi__yee *y)
{
  const double fraction = terms->fraction != 0 ? terms->fraction : 0.9;
  DVI_TRY(dvi__yee_find_bound(y, &y->bound));
  if (!isfinite(terms->step) || terms->step < 0 || !(fraction > 0 && fraction < 1) ||
      !isfinite(terms->span) || terms->span < 0)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "yee: step = %g, fraction = %g, span = %g; steps and spans are positive, and a "
        "fraction is between 0 and 1",
        terms->step, fraction, terms->span);
  if (terms->step == 0 && !isfinite(y->bound))
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: nothing moves that bounds the step; set a step");
  y->dt = terms->step > 0 ? terms->step : fraction * y->bound;
  if (!(y->dt < y->bound)) return refuse_step(y, y->dt);
  if (terms->step == 0) y->dt = dvi__fit_step(y->dt, terms->span);
  for (int l = 0; l < 3; l++) dvi__yee_set_step(&y->axis[l], y->dt);
  return DVI_OK;
}

/* Make what the bound of the step needs. */
static dvi_status make_grid_and_media(const dvi_yee_terms *terms, dvi__yee *y)
{
  DVI_TRY(dvi__yee_make_grid(terms, y));
  DVI_TRY(dvi__yee_make_planes(terms, y));
  if (y->unknowns == 0)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "yee: no edge has an unknown, because conductors surround every box; take more "
        "boxes");
  return dvi__yee_make_media(terms, y);
}

static dvi_status make_march(const dvi_yee_terms *terms, dvi__yee *y)
{
  DVI_TRY(dvi__yee_make_losses(terms, y));
  DVI_TRY(dvi__yee_make_walls(terms, y));
  for (int copy = 0; copy < y->copies; copy++) {
    y->state[copy] = DVI_NEW(double, y->size + DVI__YEE_LEFT);
    if (y->state[copy] == NULL)
      return dvi__fail(DVI_NO_MEMORY, "yee: no memory for %zu field values", y->size);
  }
  DVI_TRY(dvi__yee_make_layers(y));
  DVI_TRY(dvi__yee_make_sweeps(y, terms));
  DVI_TRY(dvi__yee_make_sources(terms, y));
  return dvi__yee_make_observables(terms, y);
}

/* Processes have agreed on what the bound needs before they speak about it. */
static dvi_status make(const dvi_yee_terms *terms, dvi__yee *y)
{
  DVI_TRY(choose_step(terms, y));
  return dvi__yee_agree(y, make_march(terms, y));
}

/* ---- motion ---- */

/* Give the number of whole steps until t, with a few roundings of the times to spare. */
static int64_t steps_until(const dvi__yee *y, double t)
{
  return (int64_t)floor((t - y->t0) / y->dt + dvi__yee_spare(y, t));
}

static dvi_status advance(void *self, double t)
{
  dvi__yee *y = self;
  const double steps = (t - y->t0) / y->dt;
  DVI_TRY(dvi__yee_check_ranks(y));
  if (!(steps < 9e15))
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: %g steps until t = %g cannot be counted", steps, t);
  y->moment->is_now = 0;
  for (const int64_t last = steps_until(y, t); y->step < last;) {
    const int64_t left = last - y->step;
    int ready;
    const dvi_status status = dvi__yee_prepare(y, left < y->together ? (int)left : y->together,
                                               &ready);
    if (ready > 0) dvi__yee_sweep(y, ready);
    dvi__yee_take_impulses(y, ready);
    y->step += ready;
    if (status == DVI_OK && dvi__yee_check_ranks(y) == DVI_OK) continue;
    y->t = fmax(y->t, y->t0 + (double)y->step * y->dt);
    return status != DVI_OK ? status : dvi__yee_check_ranks(y);
  }
  y->t = t;
  return DVI_OK;
}

static double time_of(const void *self)
{
  const dvi__yee *y = self;
  return y->t;
}

static int64_t size_of(const void *self, dvi_march_form form)
{
  const dvi__yee *y = self;
  return y->copies * dvi__yee_form_size(y, form);
}

static void facts_of(const void *self, dvi_march_facts *facts)
{
  const dvi__yee *y = self;
  facts->step = facts->longest = y->dt;
  facts->bound = y->bound;
  facts->steps = y->step;
  facts->updates = y->step * y->faces;
}

static int writes(const void *self)
{
  const dvi__yee *y = self;
  return dvi__yee_rank(y) == 0;
}

static const dvi__march_kind yee_kind = {.name = "yee",
                                         .destroy = destroy,
                                         .start = dvi__yee_start,
                                         .advance = advance,
                                         .time = time_of,
                                         .size = size_of,
                                         .sample = dvi__yee_sample,
                                         .observables = dvi__yee_observables,
                                         .observable = dvi__yee_observable,
                                         .observe = dvi__yee_observe,
                                         .facts = facts_of,
                                         .save = dvi__yee_save,
                                         .load = dvi__yee_load,
                                         .agree = dvi__yee_agree_anew,
                                         .writes = writes};

dvi_status dvi_yee_create(const dvi_yee_terms *terms, dvi_march **march)
{
  if (march == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "yee: a place for the march is needed");
  *march = NULL;
  dvi__yee *y = DVI_NEW(dvi__yee, 1);
  dvi_status status = y != NULL ? make_grid_and_media(terms, y)
                                : dvi__fail(DVI_NO_MEMORY, "yee: no memory");
  status = dvi__yee_agree_of(terms, status);
  if (status == DVI_OK && y != NULL) status = make(terms, y);
  if (status != DVI_OK) {
    if (y != NULL) destroy(y);
    return status;
  }
  status = dvi__yee_agree_of(terms, dvi__march_wrap(&yee_kind, y, march));
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}
