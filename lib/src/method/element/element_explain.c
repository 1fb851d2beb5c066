/* Explanations of a step's solvers. Patterns are made and analysed for them, but nothing is
 * factored. */
#include "core/status.h"
#include "method/element/element_struct.h"
#include "step/element/fixed_point.h"

/* ---- for all methods with solve/nonlinear.h ---- */

void dvi__explain_entries(double unknowns, double entries, dvi__text *text)
{
  dvi__text_add(text, "Jacobian with %.0f entries (%.3g %% of a full one)\n", entries,
                100.0 * entries / unknowns / unknowns);
}

void dvi__explain_linear(dvi__solver *solver, dvi__text *text)
{
  if (dvi__solver_prepare(solver) != DVI_OK) {
    dvi__text_add(text, "linear solver: none: %s\n", dvi_last_error());
    return;
  }
  dvi__linear *linear = dvi__solver_linear(solver);
  const int is_sparse = dvi__linear_kind_of(linear) == DVI__LINEAR_SPARSE;
  dvi__text_add(text, "linear solver: %s", dvi__linear_name(linear));
  if (is_sparse && dvi__linear_analyse(linear) == DVI_OK)
    dvi__text_add(text, " in the order of AMD, %.3g numbers in L and U",
                  dvi__linear_cost_of(linear).entries);
  dvi__text_add(text, "; made when it is first needed\n");
}

/* ---- one element ---- */

static void explain_systems(dvi__decoupled *systems, dvi__text *text)
{
  dvi__linear_cost cost;
  dvi__text_add(text, "decoupled systems of n unknowns");
  if (dvi__decoupled_analyse(systems, &cost) == DVI_OK)
    dvi__text_add(text, ", %.3g numbers in their L and U", cost.entries);
}

static void explain_simplified(dvi__element *own, dvi__text *text)
{
  dvi__text_add(text, "simplified Newton's method (");
  if (own->blocks != NULL)
    dvi__text_add(text, "first by the blocks of what the mass couples, then by the whole Jacobian, "
                        "both kept over steps");
  else if (own->keeps_whole)
    dvi__text_add(text, "its Jacobian kept over steps");
  else if (own->decoupled == NULL)
    dvi__text_add(text, "not in this space");
  else if (dvi__element_weigh(own) == DVI_OK && own->is_dear)
    dvi__text_add(text, "not for systems of this size");
  else
    explain_systems(own->decoupled, text);
  dvi__text_add(text, "), ");
}

static int has_multipliers(const dvi__element *own)
{
  const dvi__action_space space = dvi__action_space_of(own->action);
  return dvi__action_unknowns(own->action) >
         space.degree * dvi__action_coupling(own->action)->columns;
}

static void explain_ladder(dvi__element *own, dvi__text *text)
{
  const char *name = dvi__solver_choice(own->choice), *last = "a path followed from shorter steps";
  if (own->without_hessian != NULL) {
    dvi__text_add(text,
                  "solver: %s: fixed point alone, for potential '%s' is declared without a "
                  "Hessian\n",
                  name, own->without_hessian);
    return;
  }
  if (!dvi__element_is_ladder(own)) {
    const char *why = has_multipliers(own) ? "for multipliers are unknowns" : "as asked";
    dvi__text_add(text, "solver: %s, %s; what it cannot solve goes on to %s\n", name, why, last);
    return;
  }
  dvi__text_add(text, "solver: %s: %s", name,
                own->keeps_whole ? "" : "fixed point while it contracts by 0.45 or better, else ");
  explain_simplified(own, text);
  dvi__text_add(text, "Newton's method, last %s%s\n", last,
                own->choice == DVI__SOLVER_CERTIFIED ? "; KINSOL certifies each solution" : "");
}

/* An operator has no name of its own, so the preconditioner is named. */
static void explain_newton(dvi__element *own, dvi__text *text)
{
  if (dvi__solver_prepare(own->solver) != DVI_OK || !own->newton.is_operator) {
    dvi__explain_linear(own->solver, text);
    return;
  }
  dvi__text_add(text, "linear solver: GMRES with products of the Jacobian, preconditioned by ");
  if (own->newton.systems != NULL)
    explain_systems(own->newton.systems, text);
  else
    dvi__text_add(text, "its kinetic part");
  dvi__text_add(text, "; made when it is first needed\n");
}

void dvi__element_explain(const dvi__stepper *self, dvi__text *text)
{
  dvi__element *own = self->own;
  const int general = (self->system->terms & DVI__LAGRANGIAN) != 0;
  const double s = dvi__action_space_of(own->action).degree;
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, ", dvi__action_unknowns(own->action));
  if (own->without_hessian != NULL)
    dvi__text_add(text, "no Jacobian\n");
  else if (dvi__action_prepare_hessians(own->action) == DVI_OK)
    dvi__explain_entries(dvi__action_unknowns(own->action),
                         s * s * dvi__pattern_entries(dvi__action_coupling(own->action)), text);
  else
    dvi__text_add(text, "no Jacobian: %s\n", dvi_last_error());
  dvi__text_add(
      text, "kinetic part: %s\n",
      general && dvi__action_has_fixed_point(own->action)
          ? "constant mass without coupling, divided by the monitor: fixed point iteration on the "
            "positions and momenta at the nodes"
      : general ? "general Lagrangian; its velocity Hessian is evaluated once a step"
      : dvi__action_has_preconditioner(own->action)
          ? "constant mass without coupling: fixed point iteration on the positions at the nodes, "
            "in which quadratic potentials with a diagonal Hessian are implicit"
      : dvi__action_lags(own->action)
          ? "constant mass without coupling: fixed point iteration on the positions at the nodes, "
            "in which slow potentials lag behind fast ones"
      : dvi__action_has_fixed_point(own->action)
          ? "constant mass without coupling: fixed point iteration on the positions at the nodes"
          : "constant mass");
  explain_ladder(own, text);
  if (own->without_hessian == NULL) explain_newton(own, text);
}
