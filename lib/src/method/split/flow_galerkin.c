/* Galerkin variational integrators along the flow of an integrable part, H = H0 + H1.
 *
 * Space: z(t0 + h/2 + tau) = phi_tau(w(tau)) in phase space, with the exact flow phi of H0 and
 * polynomials w of degree s. Quadrature: Gauss with s nodes. The flow takes p dq - H0 dt to
 * w_p dw_q and a total differential. What is left of the action is w_p.w_q' - K(tau,w),
 * K(tau,w) = H1(phi_tau(w)), with the discrete Hamiltonian of type II
 *
 *     Hd(q0,p1) = ext_{V,P} p1.Q(h) - h sum_i b_i (P_i.V_i - K(tau_i,Q_i,P_i)),
 *     Q_i = q0 + h sum_j a_ij V_j,      tau_i = h (c_i - 1/2),
 *
 * in the coordinates w. The equations are those of method/split/flow_stages.h between two halves of
 * the flow,
 *
 *     w0 = phi_{h/2}(z0),      w1 = w0 + sum_j G_j,      z1 = phi_{h/2}(w1).
 *
 * The order is 2 s, with a local error of the size of H1, and the step is exact without H1. The
 * method is symplectic and symmetric. Without fast potentials it is the Runge-Kutta-Nystroem method
 * a_ij (c_i - c_j) at Gauss's nodes. Source: Leok and Zhang 2011, sec. 2 (discrete Hamiltonians);
 * Lawson 1967; Wisdom and Holman 1991 (the flow). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/method.h"
#include "method/split/flow_stages.h"
#include "num/compensated.h"

enum { STAGES, STAGES_MOST = 20 };

static const dvi__key flow_keys[] = {
    {"stages", NULL, 1, STAGES_MOST, 4, "s, 1 to 20, for order 2 s; default: 4"},
    {0},
};

typedef struct flow_galerkin {
  dvi__flow_stages *stages;
  dvi__evaluator *masses;
  double *dq, *dp; /* [n] */
} flow_galerkin;

/* Take the flow's name, a key that the program's struct gives. A name in the specification must be
 * the same. */
static dvi_status take_flow_name(dvi__stepper *self)
{
  char **rest = &self->settings.rest;
  char *wanted = dvi__written("flow=%s", self->shapes->name);
  if (wanted == NULL)
    return dvi__fail(DVI_NO_MEMORY, "flow-galerkin: no memory for its specification");
  if (*rest != NULL && strcmp(*rest, wanted) != 0) {
    dvi__release(wanted);
    return dvi__fail(
        DVI_BAD_OPTION,
        "flow-galerkin: '%s' is not possible; it takes stages, and as flow the name of "
        "its shapes, %s",
        *rest, self->shapes->name);
  }
  dvi__release(*rest);
  *rest = wanted;
  return DVI_OK;
}

/* Check what the specification and the program say about the flow. */
static dvi_status settle_flow(dvi__stepper *self)
{
  if (self->shapes != NULL && self->shapes->flow == NULL)
    return dvi__fail(DVI_BAD_OPTION,
                     "flow-galerkin: the shapes %s have no flow; shaped-galerkin takes functions",
                     self->shapes->name);
  if (self->shapes != NULL) return take_flow_name(self);
  if (self->settings.rest == NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION,
                   "flow-galerkin: '%s' is not possible; it takes stages, and as flow the name of "
                   "the shapes that a program gives (dvi/shapes.h)",
                   self->settings.rest);
}

static dvi_status flow_galerkin_create(dvi__stepper *self)
{
  const int stages = self->settings.value[STAGES];
  DVI_TRY(settle_flow(self));
  flow_galerkin *own = self->own = DVI_NEW(flow_galerkin, 1);
  self->order = 2 * stages;
  self->symmetric = 1;
  self->bound = 1;
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "flow-galerkin: no memory");
  own->dq = DVI_NEW(double, self->system->n);
  own->dp = DVI_NEW(double, self->system->n);
  if (own->dq == NULL || own->dp == NULL)
    return dvi__fail(DVI_NO_MEMORY, "flow-galerkin: no memory");
  DVI_TRY(dvi__evaluator_create(self->system, 1, DVI__GRADIENTS, self->counters, &own->masses));
  const dvi_status status = dvi__flow_stages_create(
      self->system, self->shapes != NULL ? self->shapes->flow : NULL, stages, self->counters,
      &own->stages);
  if (status != DVI_OK) return dvi__fail_in(status, "flow-galerkin");
  self->memory_count = dvi__flow_stages_kept(own->stages);
  return DVI_OK;
}

static void flow_galerkin_destroy(dvi__stepper *self)
{
  flow_galerkin *own = self->own;
  if (own == NULL) return;
  dvi__flow_stages_destroy(&own->stages);
  dvi__evaluator_destroy(&own->masses);
  dvi__release(own->dq);
  dvi__release(own->dp);
  dvi__release(own);
}

static dvi_status flow_galerkin_step(dvi__stepper *self, dvi__state *state, double h)
{
  const flow_galerkin *own = self->own;
  const int n = self->system->n;
  dvi__integrable *flow = dvi__flow_stages_flow(own->stages);
  const dvi__phase phase = {.q = state->q,
                            .p = state->p,
                            .q_compensation = state->q_compensation,
                            .p_compensation = state->p_compensation};
  DVI_TRY(dvi__integrable_advance(flow, 0.5 * h, &phase));
  DVI_TRY(dvi__flow_stages_solve(own->stages, state->t, h, state->q, state->p, self->memory));
  dvi__flow_stages_keep(own->stages, self->memory);
  dvi__flow_stages_ends(own->stages, own->dq, own->dp);
  dvi__add_compensated_all(n, state->q, state->q_compensation, own->dq);
  dvi__add_compensated_all(n, state->p, state->p_compensation, own->dp);
  DVI_TRY(dvi__integrable_advance(flow, 0.5 * h, &phase));
  dvi__add_compensated(&state->t, &state->t_compensation, h);
  return DVI_OK;
}

/* Evaluate the path, or NaN where the flow fails, which the driver reports. */
static void flow_galerkin_path(const dvi__stepper *self, const double *q0, double h, double tau,
                               double *q, double *v)
{
  const flow_galerkin *own = self->own;
  const int n = self->system->n;
  (void)q0, (void)h;
  if (dvi__flow_stages_path(own->stages, self->memory, tau, own->dq, own->dp) != DVI_OK)
    for (int i = 0; i < n; i++) own->dq[i] = own->dp[i] = (double)NAN;
  if (q != NULL) memcpy(q, own->dq, (size_t)n * sizeof(double));
  if (v != NULL) dvi__mass_solve(own->masses, 1, own->dp, v);
}

static void flow_galerkin_explain(const dvi__stepper *self, dvi__text *text)
{
  const flow_galerkin *own = self->own;
  const int s = self->settings.value[STAGES];
  dvi__text_add(text, "flow: %s\n", dvi__integrable_words(dvi__flow_stages_flow(own->stages)));
  dvi__text_add(text, "space: the flow of polynomials of degree %d in phase space\n", s);
  dvi__text_add(text, "quadrature: gauss, %d nodes, of the rest beside the flow\n", s);
  dvi__text_add(text, "solver: fixed-point iteration on %d stages; no Hessian, no Jacobian\n", s);
}

const dvi__method dvi__flow_galerkin = {
    .name = "flow-galerkin",
    .summary = "paths along the exact flow of an integrable part: drift, rotation, Kepler or the "
               "program's own; order 2s; constant mass",
    .cite = "LeokZhang2011",
    .keys = flow_keys,
    .takes_rest = 1,
    .takes_shapes = 1,
    .needs = DVI__CONSTANT_MASS,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL,
    .create = flow_galerkin_create,
    .destroy = flow_galerkin_destroy,
    .step = flow_galerkin_step,
    .path = flow_galerkin_path,
    .explain = flow_galerkin_explain,
};
