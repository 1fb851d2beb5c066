/* Names of solvers, orders of spaces, and the space of a method for other uses of its discrete
 * action than step by step. */
#include "core/status.h"
#include "method/element/element_step.h"

const char *dvi__solver_choice(int index)
{
  static const char *const name[] = {"auto",       "certified", "fixed-point",
                                     "simplified", "newton",    "kinsol"};
  return index >= 0 && index < 6 ? name[index] : NULL;
}

static int smaller_order(int a, int b)
{
  return a < b ? a : b;
}

int dvi__element_order(const dvi__action_space *space)
{
  const int s = space->degree, u = dvi_quadrature_order(space->rule, space->nodes);
  return smaller_order(smaller_order(2 * s, u), 2 * (u - s + 1));
}

int dvi__fewest_nodes(dvi_rule rule, int degree)
{
  int best = 0;
  for (int nodes = 1; nodes <= DVI_QUADRATURE_MAX; nodes++) {
    const int order = dvi_quadrature_order(rule, nodes);
    if (order > 0) best = nodes;
    if (order >= 2 * degree && nodes >= degree) break;
  }
  return best;
}

int dvi__symmetric_rule(dvi_rule rule)
{
  return rule != DVI_RADAU_LEFT && rule != DVI_RADAU_RIGHT;
}

dvi_status dvi__element_space(const dvi_system *system, const char *specification, const char *user,
                              dvi__action_space *space, dvi__text *spelled)
{
  dvi_counters counters = {0};
  dvi__stepper stepper;
  dvi_status status = dvi__stepper_create(system, specification, NULL, &counters, &stepper);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", user);
  if (stepper.method->step != dvi__element_step)
    status = dvi__fail(DVI_BAD_OPTION,
                       "%s: %s is no discrete action with a polynomial path; galerkin, midpoint, "
                       "trapezoidal, and hp and hamiltonian of types 1 to 3 are",
                       user, stepper.method->name);
  else if (dvi__element_solver(&stepper) != DVI__SOLVER_AUTO)
    status = dvi__fail(DVI_BAD_OPTION,
                       "%s: solver=%s is for steps; a path is solved as a whole, leave it out",
                       user, dvi__solver_choice(dvi__element_solver(&stepper)));
  if (status == DVI_OK) {
    *space = dvi__action_space_of(dvi__element_action(&stepper));
    dvi__text_add(spelled, "%s", stepper.specification);
  }
  dvi__stepper_destroy(&stepper);
  return status;
}
