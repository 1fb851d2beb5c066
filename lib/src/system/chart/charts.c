/* Rotations, rigid motions and directions with a constant mass have L = y'.My'/2 - V(t,y) on the
 * stored coordinates y. Velocities and momenta are those of the tangent spaces. At a state they are
 * found in the charts centred there, where the mass is constant, p = L_vv v. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "system/chart/charted.h"
#include "system/evaluate/dynamics.h"
#include "system/dynamics/holonomic.h"
#include "system/dynamics/holonomic_rows.h"
#include "system/evaluate/evaluator_struct.h"
#include "system/factor.h"
#include "system/mass.h"

typedef struct chart_memory {
  dvi__charted *charted;
  double *mass;         /* L_vv at the centre, in the order of the charts' vv */
  double *rate, *local; /* work [n] */
  /* evaluates states of the charted system, if there are constraints */
  dvi__evaluator *inner;
  double *xi; /* [n] a place in the charts */
} chart_memory;

static int factors_are_declared(const dvi_system_terms *terms)
{
  return terms->factors != NULL && terms->holonomic_count == 0;
}

static int constrained_factors_are_declared(const dvi_system_terms *terms)
{
  return terms->factors != NULL && terms->holonomic_count > 0;
}

static dvi_status prepare_charts(dvi__evaluator *e, dvi__derivatives most)
{
  const size_t n = (size_t)e->system->n;
  if (most != DVI__STATES) return DVI_OK;
  chart_memory *own = e->own = DVI_NEW(chart_memory, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory");
  DVI_TRY(dvi__charted_create(e->system, 0, e->counters, &own->charted));
  const dvi__pattern *vv = &dvi__charted_system(own->charted)->vv;
  own->rate = DVI_NEW(double, n);
  own->local = DVI_NEW(double, n);
  own->mass = DVI_NEW(double, dvi__pattern_entries(vv));
  own->xi = DVI_NEW(double, n);
  if (!own->rate || !own->local || !own->mass || !own->xi)
    return dvi__fail(DVI_NO_MEMORY, "evaluator: no memory");
  return dvi__linear_create(vv, DVI__LINEAR_AUTO, e->counters, &e->velocity);
}

static dvi_status prepare_constrained_charts(dvi__evaluator *e, dvi__derivatives most)
{
  if (most != DVI__STATES) return DVI_OK;
  DVI_TRY(prepare_charts(e, most));
  DVI_TRY(dvi__rows_prepare(e));
  chart_memory *own = e->own;
  return dvi__evaluator_create(dvi__charted_system(own->charted), 1, DVI__STATES, e->counters,
                               &own->inner);
}

static void release_charts(dvi__evaluator *e)
{
  chart_memory *own = e->own;
  dvi__rows_release(e);
  if (own == NULL) return;
  dvi__evaluator_destroy(&own->inner);
  dvi__charted_destroy(&own->charted);
  dvi__release(own->xi);
  dvi__release(own->rate);
  dvi__release(own->local);
  dvi__release(own->mass);
  dvi__release(own);
}

/* Compute the rate of the stored coordinates. */
static const double *rate_of_point(dvi__evaluator *e, const double *q, const double *v)
{
  const chart_memory *own = e->own;
  dvi__factors_rate(e->system, q, v, own->rate);
  return own->rate;
}

static dvi_status value_on_manifold(dvi__evaluator *e, double t, const double *q, const double *v,
                                    double *L)
{
  return dvi__lagrangian_value(e, 1, &t, q, rate_of_point(e, q, v), L);
}

static dvi_status forces_on_manifold(dvi__evaluator *e, double t, const double *q, const double *v,
                                     double *L_q)
{
  return dvi__lagrangian_gradient(e, 1, &t, q, rate_of_point(e, q, v), L_q, NULL);
}

static dvi_status momentum_on_manifold(dvi__evaluator *e, double t, const double *q,
                                       const double *v, double *p)
{
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, rate_of_point(e, q, v), NULL, e->point[0]));
  dvi__factors_momentum(e->system, q, e->point[0], p);
  return DVI_OK;
}

static dvi_status factor_chart_mass(dvi__evaluator *e, double t, const double *q, const double *v)
{
  const chart_memory *own = e->own;
  (void)v;
  dvi__charted_centre(own->charted, q);
  dvi__charted_mass(own->charted, own->mass);
  const dvi_status status = dvi__linear_factor(e->velocity, own->mass);
  return status == DVI_SINGULAR ? dvi__lagrangian_is_degenerate(t) : status;
}

static dvi_status velocity_in_charts(dvi__evaluator *e, double t, const double *q, const double *p,
                                     double *v)
{
  const chart_memory *own = e->own;
  DVI_TRY(factor_chart_mass(e, t, q, NULL));
  dvi__charted_enter(own->charted, p, own->local);
  dvi__linear_solve(e->velocity, own->local);
  if (dvi__first_not_finite((size_t)e->system->nx, own->local) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "the velocity M^-1 p at t = %.6g is not finite", t);
  dvi__charted_store(own->charted, own->local, v);
  return DVI_OK;
}

/* ---- constraints ---- */

/* Move q, and then the momentum, in the charts at q. The numbers of the momentum stay while q
 * moves, as in R^n. */
static dvi_status project_in_charts(dvi__evaluator *e, double t, double *q, double *p)
{
  const chart_memory *own = e->own;
  for (int part = 0; part < 2; part++) {
    memset(own->xi, 0, (size_t)e->system->nx * sizeof(double));
    dvi__charted_centre(own->charted, q);
    dvi__charted_enter(own->charted, p, own->local);
    DVI_TRY(
        dvi__charted_explain(own->charted, dvi__rows_approach(own->inner, t, own->xi, own->local)));
    dvi__charted_point(own->charted, own->xi, NULL, q, NULL);
  }
  dvi__charted_store(own->charted, own->local, p);
  return dvi__rows_found(e, t, q);
}

static dvi_status reactions_in_charts(dvi__evaluator *e, double t, const double *q, const double *v,
                                      double *lambda)
{
  const chart_memory *own = e->own;
  memset(own->xi, 0, (size_t)e->system->nx * sizeof(double));
  dvi__charted_centre(own->charted, q);
  dvi__charted_enter(own->charted, v, own->local);
  return dvi__charted_explain(
      own->charted, dvi__rows_acceleration(own->inner, t, own->xi, own->local, NULL, lambda));
}

dvi_status dvi__charts_factor_rows(dvi__evaluator *e, double t, const double *q)
{
  const chart_memory *own = e->own;
  const size_t size = (size_t)e->system->nx * sizeof(double);
  memset(own->xi, 0, size);
  memset(own->local, 0, size);
  dvi__charted_centre(own->charted, q);
  return dvi__charted_explain(own->charted, dvi__rows_factor(own->inner, t, own->xi, own->local));
}

dvi_status dvi__charts_solve_rows(const dvi__evaluator *e, double t, double *lambda, double *moved)
{
  const chart_memory *own = e->own;
  const dvi__rows_memory *r = dvi__rows_memory_of(own->inner);
  const int nx = e->system->nx, rows = e->system->row_count;
  memset(r->x, 0, (size_t)nx * sizeof(double));
  memcpy(r->x + nx, lambda, (size_t)rows * sizeof(double));
  DVI_TRY(dvi__rows_solve(r, nx + rows, t));
  for (int a = 0; a < rows; a++) lambda[a] = -r->x[nx + a];
  *moved = dvi__largest((size_t)nx, r->x);
  return DVI_OK;
}

/* The matrix is that of the charted system. What is known of its rows is noted here, too. */
static dvi_status side_in_charts(dvi__evaluator *e, double t, const double *q, const double *p,
                                 int before, int *side)
{
  const chart_memory *own = e->own;
  dvi__rows_memory *rows = dvi__rows_memory_of(e);
  const dvi__rows_memory *inner = dvi__rows_memory_of(own->inner);
  memset(own->xi, 0, (size_t)e->system->nx * sizeof(double));
  dvi__charted_centre(own->charted, q);
  dvi__charted_enter(own->charted, p, own->local);
  DVI_TRY(dvi__charted_explain(own->charted,
                               dvi__rows_side(own->inner, t, own->xi, own->local, before, side)));
  rows->dependent_count = inner->dependent_count;
  memcpy(rows->dependent, inner->dependent, (size_t)e->system->row_count);
  return DVI_OK;
}

static const dvi__state_constraint on_rows_in_charts = {
    .matrix = "matrix of the constraints",
    .check = dvi__rows_check,
    .project = project_in_charts,
    .distance = dvi__rows_distance,
    .size = dvi__rows_size,
    .has_rank = 1,
    .side = side_in_charts,
};

const dvi__dynamics dvi__dynamics_constrained_charts = {
    .name = "constant mass on a manifold with holonomic constraints",
    .function = "Lagrangian",
    .equations = DVI__LIFTED,
    .has_kinetic_energy = 1,
    .on_manifold = 1,
    .is_declared = constrained_factors_are_declared,
    .declare = dvi__mass_copy,
    .prepare = prepare_constrained_charts,
    .release = release_charts,
    .velocity = velocity_in_charts,
    .regular = factor_chart_mass,
    .energy = dvi__energy_of_lagrangian,
    .value = value_on_manifold,
    .forces = forces_on_manifold,
    .momentum = momentum_on_manifold,
    .constraint = &on_rows_in_charts,
    .reactions = reactions_in_charts,
};

const dvi__dynamics dvi__dynamics_charts = {
    .name = "constant mass on a manifold",
    .function = "Lagrangian",
    .equations = DVI__LIFTED,
    .has_kinetic_energy = 1,
    .on_manifold = 1,
    .is_declared = factors_are_declared,
    .declare = dvi__mass_copy,
    .prepare = prepare_charts,
    .release = release_charts,
    .velocity = velocity_in_charts,
    .regular = factor_chart_mass,
    .energy = dvi__energy_of_lagrangian,
    .value = value_on_manifold,
    .forces = forces_on_manifold,
    .momentum = momentum_on_manifold,
};
