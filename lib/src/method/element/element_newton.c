/* The Jacobian of an element for Newton's method, as a matrix or as an operator, and its frozen
 * part.
 *
 * The Jacobian of s n unknowns is a matrix if its factorisation takes at most MOST_WHOLE
 * operations, which are s^3 times those of one n x n system with the Hessians' pattern, whose graph
 * it has with blocks of s x s. Beyond that GMRES solves by its products (step/element/action.h),
 * preconditioned by the decoupled systems of n unknowns, frozen in the middle of the path, as long
 * as their factors pay. Beyond that the kinetic part, M/h, preconditions. Then nothing is factored,
 * and the ladder leaves out simplified Newton's method, which needs those factors.
 *
 * A factor pays if it takes no more operations than OPERATIONS_PAID for each number that a product
 * of the Jacobian reads, and no more than MOST_NUMBERS. This was measured on nets of springs with h
 * omega = 14, at KLU's rate of 2 to 3e9 operations a second. Preconditioned by M/h a step takes 150
 * to 250 products at 6 operations for each number. A factor that is back after 20 such steps may
 * take 30 000. (docs/performance.md, "Large sparse systems".) */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_struct.h"

#define MOST_WHOLE 2e8
#define OPERATIONS_PAID 3e4
#define MOST_NUMBERS 2e8

/* Full matrices of fewer unknowns are faster than products and sparse decoupled systems. */
enum { LEAST_ROWS = 200 };

/* ---- choice ---- */

static dvi__decoupled *newton_systems(const dvi__element *own)
{
  return own->decoupled != NULL ? own->decoupled : own->newton.owned;
}

/* Estimate the cost of one real n x n system. A bound serves if it is `enough` operations at most,
 * or if there are no decoupled systems. Else their analysis tells the cost. */
static dvi_status newton_estimate_cost(const dvi__element *own, double enough,
                                       dvi__linear_cost *cost)
{
  dvi__decoupled *systems = newton_systems(own);
  dvi__linear_cost all;
  DVI_TRY(dvi__action_prepare_hessians(own->action));
  *cost = (dvi__linear_cost){0, dvi__pattern_operations(dvi__action_coupling(own->action))};
  if (cost->operations <= enough || systems == NULL) return DVI_OK;
  DVI_TRY(dvi__decoupled_analyse(systems, &all));
  const double weight = dvi__decoupled_weight(systems);
  *cost = (dvi__linear_cost){all.entries / weight, all.operations / weight};
  return DVI_OK;
}

/* Give the largest number of operations for the factors of all decoupled systems. */
static double newton_most_operations(const dvi__element *own)
{
  const double numbers = (double)dvi__pattern_entries(dvi__action_coupling(own->action)) *
                         dvi__action_nodes(own->action);
  return OPERATIONS_PAID * numbers;
}

static int newton_factors_pay(const dvi__element *own, const dvi__linear_cost *one)
{
  const double weight = dvi__decoupled_weight(newton_systems(own));
  return weight * one->operations <= newton_most_operations(own) &&
         weight * one->entries <= MOST_NUMBERS;
}

dvi_status dvi__element_weigh(dvi__element *own)
{
  dvi__linear_cost one;
  if (own->is_weighed || own->decoupled == NULL) return DVI_OK;
  DVI_TRY(dvi__action_prepare_hessians(own->action));
  const double enough = newton_most_operations(own) / dvi__decoupled_weight(own->decoupled);
  DVI_TRY(newton_estimate_cost(own, enough, &one));
  own->is_dear = !newton_factors_pay(own, &one);
  own->is_weighed = 1;
  return DVI_OK;
}

/* Create systems for a preconditioner, where simplified Newton's method has none. */
static dvi_status newton_create_systems(dvi__element *own)
{
  if (newton_systems(own) != NULL) return DVI_OK;
  const dvi_status status = dvi__decoupled_create(own->action, own->counters, &own->newton.owned);
  return status == DVI_SINGULAR ? DVI_OK : status; /* none in this space */
}

/* Let a time-transformed system, whose Hessian is full and whose decoupled systems are sparse all
 * the same, have the operator. */
static dvi_status newton_choose_rank_two(dvi__element *own)
{
  const dvi__pattern *coupling = dvi__action_coupling(own->action);
  const double n = coupling->columns;
  if (dvi__action_unknowns(own->action) < LEAST_ROWS || dvi__pattern_entries(coupling) < n * n)
    return DVI_OK;
  DVI_TRY(newton_create_systems(own));
  dvi__decoupled *systems = newton_systems(own);
  if (systems == NULL || !dvi__decoupled_has_rank_two(systems)) return DVI_OK;
  own->newton.is_operator = 1;
  own->newton.systems = systems;
  return DVI_OK;
}

/* Choose the form. The parts of row terms in the Jacobian have no products, and it stays a
 * matrix. */
static dvi_status newton_choose_form(dvi__element *own)
{
  const double s = dvi__action_space_of(own->action).degree;
  dvi__linear_cost one;
  own->newton.is_operator = 0;
  if (dvi__action_has_terms(own->action)) return DVI_OK;
  DVI_TRY(newton_estimate_cost(own, HUGE_VAL, &one));
  DVI_TRY(newton_choose_rank_two(own));
  if (own->newton.is_operator || s * s * s * one.operations <= MOST_WHOLE) return DVI_OK;
  DVI_TRY(newton_create_systems(own));
  DVI_TRY(newton_estimate_cost(own, 0, &one));
  if (s * s * s * one.operations <= MOST_WHOLE) return DVI_OK;
  own->newton.is_operator = 1;
  own->newton.systems = newton_systems(own) != NULL && newton_factors_pay(own, &one)
                            ? newton_systems(own)
                            : NULL;
  return DVI_OK;
}

/* ---- operator ---- */

static void newton_times(void *of, const double *x, double *y)
{
  const dvi__element *own = of;
  own->counters->products++;
  dvi__action_times_jacobian(own->action, x, y);
}

static void newton_precondition(void *of, double *R)
{
  const dvi__element *own = of;
  if (own->newton.systems != NULL)
    dvi__decoupled_solve(own->newton.systems, R);
  else
    dvi__action_chord(own->action, R);
}

/* The kinetic part of a positive mass is definite, and its sign is that of h. */
static int newton_sign(void *of)
{
  const dvi__decoupled *systems = ((const dvi__element *)of)->newton.systems;
  return systems != NULL ? dvi__decoupled_sign(systems) : 1;
}

static int newton_is_definite(void *of, int sign)
{
  const dvi__decoupled *systems = ((const dvi__element *)of)->newton.systems;
  return systems == NULL || dvi__decoupled_is_definite(systems, sign);
}

static dvi_status newton_prepare_operator(dvi__element *own)
{
  dvi__newton_form *newton = &own->newton;
  const int has_systems = newton->systems != NULL,
            is_known = own->definite || (has_systems && !own->has_forces);
  DVI_TRY(dvi__action_prepare_product(own->action));
  newton->A = (dvi__operator){.size = dvi__action_unknowns(own->action),
                              .of = own,
                              .times = newton_times,
                              .precondition = newton_precondition,
                              .sign = is_known ? newton_sign : NULL,
                              .is_definite = is_known ? newton_is_definite : NULL};
  if (!has_systems || newton->point != NULL) return DVI_OK;
  newton->point = DVI_NEW(double, dvi__decoupled_point_size(newton->systems));
  return newton->point != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "action: no memory for a point");
}

/* Freeze the preconditioner at Y. One serves all Jacobians of an iteration. */
static dvi_status newton_freeze_preconditioner(dvi__element *own, const double *Y)
{
  dvi__decoupled *systems = own->newton.systems;
  if (own->newton.is_frozen) return DVI_OK;
  if (systems != NULL) dvi__decoupled_point(systems, Y, own->newton.point);
  const dvi_status status = systems != NULL ? dvi__decoupled_freeze(systems, own->newton.point)
                                            : dvi__action_prepare_chord(own->action, Y);
  if (status == DVI_SINGULAR)
    return dvi__fail_in(DVI_NOT_CONVERGED, "the preconditioner of the Jacobian cannot be factored");
  own->newton.is_frozen = status == DVI_OK;
  return status;
}

/* Freeze the preconditioner, and evaluate the Hessians for products. */
static dvi_status newton_linearise(dvi__element *own, const double *Y)
{
  DVI_TRY(newton_freeze_preconditioner(own, Y));
  return dvi__action_hessians(own->action, Y);
}

/* ---- callbacks of the solver ---- */

static dvi_status newton_prepare(void *of, dvi__equations *equations)
{
  dvi__element *own = of;
  DVI_TRY(newton_choose_form(own));
  if (!own->newton.is_operator) return dvi__action_prepare_jacobian(own->action);
  DVI_TRY(newton_prepare_operator(own));
  equations->whole = &own->newton.A;
  return DVI_OK;
}

static dvi_status newton_jacobian(void *of, const double *Y, double *values)
{
  dvi__element *own = of;
  return own->newton.is_operator ? newton_linearise(own, Y)
                                 : dvi__action_jacobian(own->action, Y, values);
}

dvi_status dvi__element_invert_blocks(const dvi__element *own, const double *Y, double *inverse)
{
  own->counters->jacobians++;
  DVI_TRY(dvi__action_jacobian(own->action, Y, dvi__blocks_jacobian(own->blocks)));
  return dvi__blocks_invert(own->blocks, inverse);
}

static dvi_status newton_freeze(void *of, const double *Y)
{
  const dvi__element *own = of;
  double *point = own->frozen + DVI__FROZEN_POINT;
  if (own->by_blocks) return own->keeps ? DVI_OK : dvi__element_invert_blocks(own, Y, point);
  if (own->keeps_whole) {
    if (!own->keeps) DVI_TRY(dvi__solver_jacobian(own->solver, Y, point));
    return dvi__solver_take_jacobian(own->solver, point);
  }
  if (!own->keeps) dvi__decoupled_point(own->decoupled, Y, point);
  return dvi__decoupled_freeze(own->decoupled, point);
}

static void newton_solve_frozen(void *of, double *R)
{
  const dvi__element *own = of;
  if (own->by_blocks)
    dvi__blocks_solve(own->blocks, own->frozen + DVI__FROZEN_POINT, R);
  else if (own->keeps_whole)
    dvi__solver_apply_factor(own->solver, R);
  else
    dvi__decoupled_solve(own->decoupled, R);
}

void dvi__element_set_newton(dvi__equations *equations)
{
  equations->prepare = newton_prepare;
  equations->jacobian = newton_jacobian;
  equations->freeze = newton_freeze;
  equations->frozen = newton_solve_frozen;
}

void dvi__element_clear_newton(dvi__element *own)
{
  dvi__decoupled_destroy(&own->newton.owned);
  dvi__release(own->newton.point);
  own->newton = (dvi__newton_form){0};
}

const dvi__decoupled *dvi__element_frozen(const dvi__element *own)
{
  return own->rung == DVI__SIMPLIFIED ? own->decoupled : own->newton.systems;
}
