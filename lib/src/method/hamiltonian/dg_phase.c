/* Discontinuous Galerkin variational integrators on the cotangent bundle, with constraints
 * phi(q,p) = 0 at the averages of a node's two sides.
 *
 *     S = sum over elements of h sum_i b_i (P_i.Q'_i/h - H(Q_i,P_i) - Lambda_i.phi(Q_i,P_i))
 *         + sum over nodes of [q].{p} - h lambda.phi({q},{p})
 *
 * The polynomials q and p have degree d, and Lambda has degree k-1. Let z = (q,p) and X_F = (F_p,
 * -F_q). Variation of the coefficients of z gives
 *     sum_i b_i phi_j (z' - h X_H - h X_phi Lambda)_i + phi_j(0) a + phi_j(1) a' = 0,
 *     a = ([z] - h X_phi lambda)/2.
 * The component along the Legendre polynomial of degree d vanishes at d Gauss points, so that
 * a' = (-1)^(d+1) a. At the start a is 0, and therefore everywhere. Hence [z] = h X_phi lambda, and
 * lambda alone is carried. The rest is collocation between two half kicks of the multiplier
 * (step/hamiltonian/phase_element.h). The order min(2d, 2k+2) is measured. The method is symmetric
 * and conserves dq dp + d[q] d[p]/4.
 *
 * For a one-form, phi = p - alpha(q) and H(q), the constraint has no moments inside the elements.
 * Then q is constant in the elements, because all motion of q comes from the multipliers. Every
 * degree and quadrature gives
 *     alpha({q'}) = alpha({q}) - h H_q({q} + [q]/2) + (Dalpha({q}))^T [q]/2
 *                   + (Dalpha({q'}))^T [q']/2,     {q'} = {q} + [q]/2 + [q']/2,
 * which is the element of degree 0 of step/degenerate/discontinuous.h. The order is 2, and the
 * method is symmetric. Source: Kraus, Yoshimura and Peng (talk), with the halves of the
 * multipliers; the moments are ours. */
#include "core/status.h"
#include "method/degenerate/dg_step.h"
#include "method/hamiltonian/phase_step.h"

enum { DEGREE, NODES, MOMENTS, ALARM };

static const dvi__key keys[] = {
    {"degree", NULL, 1, DVI__DG_POINTS_MOST, 1,
     "of the polynomials, 1 to 8; with a one-form all give the same steps; default: 1"},
    {"nodes", NULL, 1, DVI__DG_POINTS_MOST, DVI__LEFT_OUT,
     "Gauss points; with a one-form degree to 8, all give the same steps; with a Hamiltonian "
     "degree; default: degree"},
    {"moments", NULL, 0, DVI__DG_POINTS_MOST, DVI__LEFT_OUT,
     "of the constraint inside an element, even, 0 to degree; with a one-form 0; default: the "
     "most"},
    DVI__ALARM_KEY,
    {0},
};

static int has_form(const dvi__stepper *self)
{
  return (self->system->terms & DVI__ONE_FORM) != 0;
}

typedef struct dg_phase_options {
  int degree, nodes, moments, alarm;
} dg_phase_options;

/* Read the options. Numbers that are chosen here become part of the specification. */
static dg_phase_options dg_phase_read_options(dvi__stepper *self)
{
  int *value = self->settings.value;
  dg_phase_options o = {.degree = value[DEGREE],
                        .nodes = value[NODES],
                        .moments = value[MOMENTS],
                        .alarm = value[ALARM]};
  if (o.nodes == DVI__LEFT_OUT) o.nodes = value[NODES] = o.degree;
  if (o.moments == DVI__LEFT_OUT)
    o.moments = value[MOMENTS] = has_form(self) ? 0 : o.degree - o.degree % 2;
  return o;
}

static dvi_status create_for_form(dvi__stepper *self, const dg_phase_options *o)
{
  const dvi__dg_space space = {.degree = 0, .nodes = 1, .flux = DVI__AVERAGE_FLUX, .points = 1};
  if (o->moments != 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "dg-phase: moments=%d with a one-form; take 0, or vprk:projection=symplectic, "
                     "whose stages fulfil the constraint",
                     o->moments);
  self->order = 2;
  self->stable = 1; /* a linear alpha makes this the leapfrog, sin(theta) = h omega */
  return dvi__dg_create(self, &space, o->alarm,
                        "take another method, dg:degree=3,stiffness=c, from the start on");
}

/* This order was measured on circle-dirac and magnetic-pair
 * (tests/method/hamiltonian/test_dg_phase.c). */
static int dg_phase_order_of(int degree, int moments)
{
  return moments < degree - 1 ? 2 * moments + 2 : 2 * degree;
}

static dvi_status create_for_hamiltonian(dvi__stepper *self, const dg_phase_options *o)
{
  if (o->nodes != o->degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "dg-phase: nodes=%d for degree %d; with a Hamiltonian more nodes than degrees "
                     "leave jumps that no multiplier makes; take nodes=%d",
                     o->nodes, o->degree, o->degree);
  if (o->moments % 2 != 0 || o->moments > o->degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "dg-phase: moments=%d for degree %d; an even number up to the degree is "
                     "possible, for odd ones let the multiplier drift",
                     o->moments, o->degree);
  self->order = dg_phase_order_of(o->degree, o->moments);
  return dvi__phase_step_create(self, o->degree, o->moments, o->alarm);
}

static dvi_status dg_phase_create(dvi__stepper *self)
{
  const dg_phase_options o = dg_phase_read_options(self);
  if (o.nodes < o.degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "dg-phase: nodes=%d are too few for degree %d; take %d or more", o.nodes,
                     o.degree, o.degree);
  return has_form(self) ? create_for_form(self, &o) : create_for_hamiltonian(self, &o);
}

static dvi_status dg_phase_step(dvi__stepper *self, dvi__state *state, double h)
{
  return has_form(self) ? dvi__dg_step(self, state, h) : dvi__phase_step(self, state, h);
}

static const double *dg_phase_multiplier(const dvi__stepper *self)
{
  return has_form(self) ? NULL : dvi__phase_step_multiplier(self);
}

static const double *dg_phase_jump(const dvi__stepper *self)
{
  return has_form(self) ? dvi__dg_jump(self) : dvi__phase_step_jump(self);
}

const dvi__method dvi__dg_phase = {
    .name = "dg-phase",
    .summary = "discontinuous Galerkin with constraints phi(q,p) = 0 at the averages; order 2 "
               "degree; degenerate systems only",
    .cite = "KrausYoshimuraPeng",
    .keys = keys,
    .uses = DVI__ONE_FORM | DVI__POTENTIAL | DVI__CONSTRAINED_HAMILTONIAN,
    .create = dg_phase_create,
    .step = dg_phase_step,
    .multiplier = dg_phase_multiplier,
    .jump = dg_phase_jump,
    DVI__ONE_STEP_OPERATIONS,
};
