/* A step by the stationarity of one element of the discrete action, which galerkin, midpoint and
 * trapezoidal share. */
#ifndef DVI_METHOD_ELEMENT_ELEMENT_STEP_H
#define DVI_METHOD_ELEMENT_ELEMENT_STEP_H
#include "step/element/action.h"
#include "method/method.h"
#include "solve/nonlinear.h"

/* The `solver` key of methods with such a step. Its index in the method's own table goes to
 * dvi__element_create. */
#define DVI__SOLVER_KEY                                                             \
  {                                                                                 \
    "solver", dvi__solver_choice, 0, 0, DVI__SOLVER_AUTO,                           \
        "auto, certified, fixed-point, simplified, newton or kinsol; default: auto" \
  }

enum {
  DVI__SOLVER_AUTO,
  DVI__SOLVER_CERTIFIED,
  DVI__SOLVER_FIXED_POINT,
  DVI__SOLVER_SIMPLIFIED,
  DVI__SOLVER_NEWTON,
  DVI__SOLVER_KINSOL
};
const char *dvi__solver_choice(int index);

/* Set a stepper's order, symmetric, memory and own for this space. `solver` is one of the numbers
 * above. */
dvi_status dvi__element_create(dvi__stepper *self, const dvi__action_space *space, int solver);

/* Let the paths be those of charts centred at their start, after create. Decoupling the Jacobian,
 * or replacing it by its kinetic part, costs as much accuracy there as the turn of a step. So the
 * ladder begins with the Jacobian's blocks of what the mass couples (blocks.h), and then with the
 * whole one, both kept over steps. */
dvi_status dvi__element_centre(dvi__stepper *self, const dvi__centring *centring);

/* Let the velocities fulfil the system's nonholonomic constraints, after create with degree 1. */
dvi_status dvi__element_constrain_velocities(dvi__stepper *self, dvi__velocity_rule rule);

/* Add a term to the rows (step/element/row_term.h), after create, before the driver reads the
 * memory's count. */
dvi_status dvi__element_add_term(dvi__stepper *self, const dvi__row_term *term);

/* Places of the memory.
 *
 *   DVI__LAST_H        length of the last step, 0 if there was none
 *   DVI__NEWTON_STEPS  number of steps that skip fixed point iteration, or that by blocks
 *   DVI__FULL_STEPS    number of steps that skip simplified Newton's method
 *   DVI__NEWTON_WAIT   number of steps skipped after the last failure of fixed point iteration,
 *                      0 since its last success
 *   DVI__FULL_WAIT     the same number for simplified Newton's method
 *   DVI__LATE          1 if momenta stand in the place of the unknowns
 *   DVI__LAST_Y        unknowns of the last step, or the start's velocity before the first step,
 *                      or the momenta at the start of the last step, with which its forces give
 *                      the unknowns (dvi__element_last_path)
 *
 * The forces of the last step and the frozen Jacobian of simplified Newton's method follow, then
 * its frozen blocks, and in charts what the last path had more than its predecessor continued. */
enum {
  DVI__LAST_H,
  DVI__NEWTON_STEPS,
  DVI__FULL_STEPS,
  DVI__NEWTON_WAIT,
  DVI__FULL_WAIT,
  DVI__LATE,
  DVI__LAST_Y
};

/* Give the place of the forces in the memory. */
size_t dvi__element_forces(const dvi__stepper *self);

/* Give the unknowns of the last step. Steps by fixed-point iteration do not need them, and leave
 * them to those who ask. They stay until the next step or path. */
const double *dvi__element_last_path(const dvi__stepper *self);

/* Give the space of a method that is one element of the action, by its specification, spelled out
 * into text. DVI_BAD_OPTION for other methods, and if the specification names a solver, which
 * `user` would ignore. */
dvi_status dvi__element_space(const dvi_system *system, const char *specification, const char *user,
                              dvi__action_space *space, dvi__text *spelled);

/* Give the method's order. With a quadrature of order u the relative error of the action is h^u
 * from the quadrature, and the square of the path's error. The path is stationary, and its velocity
 * has an error of h^s, or of h^(u-s+1) if the quadrature does not see all of it. */
int dvi__element_order(const dvi__action_space *space);

/* Give the fewest nodes of a rule whose order is 2 degree, or the most that it has. Tell whether
 * the rule is symmetric. */
int dvi__fewest_nodes(dvi_rule rule, int degree);
int dvi__symmetric_rule(dvi_rule rule);

/* Give the parts that the element was made of. */
dvi__action *dvi__element_action(const dvi__stepper *self);
int dvi__element_solver(const dvi__stepper *self);

/* Write lines of an explanation, on the entries of a Jacobian and on the linear solver. */
void dvi__explain_entries(double unknowns, double entries, dvi__text *text);
void dvi__explain_linear(dvi__solver *solver, dvi__text *text);

/* The other operations of dvi__method, and the initialiser for them. */
void dvi__element_destroy(dvi__stepper *self);
void dvi__element_start(dvi__stepper *self, const double *v);
dvi_status dvi__element_step(dvi__stepper *self, dvi__state *state, double h);
int dvi__element_march(dvi__stepper *self, dvi__state *state, dvi__state *last, double h,
                       int count);
void dvi__element_path(const dvi__stepper *self, const double *q0, double h, double tau, double *q,
                       double *v);
void dvi__element_explain(const dvi__stepper *self, dvi__text *text);

/* Keep what the iteration makes for each length, for methods that a composition may have as its
 * base. */
dvi_status dvi__element_keep_lengths(dvi__stepper *self, int count);

/* Step members side by side (element_lanes.c). */
dvi_status dvi__element_prepare_lanes(dvi__stepper *self, int capacity);
void dvi__element_clear_lanes(dvi__stepper *self);
void dvi__element_step_lanes(dvi__stepper *self, dvi__members *members, double h);

/* The terms that these methods can use. */
enum {
  DVI__ELEMENT_TERMS = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__FORCES |
                       DVI__VECTOR_POTENTIAL
};

#define DVI__ELEMENT_OPERATIONS                                                            \
  .destroy = dvi__element_destroy, .start = dvi__element_start, .step = dvi__element_step, \
  .march = dvi__element_march, .path = dvi__element_path, .explain = dvi__element_explain, \
  .prepare_lanes = dvi__element_prepare_lanes, .clear_lanes = dvi__element_clear_lanes,    \
  .step_lanes = dvi__element_step_lanes

#endif
