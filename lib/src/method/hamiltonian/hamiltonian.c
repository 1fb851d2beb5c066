/* Discrete Hamiltonians of types 1, 2 and 3 are generating functions of (q0,q1), (q0,p1) and
 * (p0,q1).
 *
 *     type 2, right:  H+(q0,p1) = ext { p1.q1 - S },     q1 = D2 H+,   p0 = D1 H+
 *     type 3, left:   H-(p0,q1) = ext { -p0.q0 - S },    q0 = -D1 H-,  p1 = -D2 H-
 *     type 1:         Ld(q0,q1) = ext S,                 p0 = -D1 Ld,  p1 = D2 Ld
 *     S = h sum_j b_j [ P_j.q'(c_j) - H(t0 + c_j h, q(c_j), P_j) ]
 *
 * The paths q have degree s, and the momenta P_j stand at the r >= s points of a quadrature. The
 * types prescribe different ends, and where all of them exist they are the same map
 * (step/hamiltonian/canonical.h). A quadrature of order u gives the order min(2s, u, 2(u-s+1)),
 * which is 2s for Gauss with r = s.
 *
 * H may be degenerate, that is linear in momenta or independent of them. Then r = s points are as
 * many velocities as a path has, q1 is not a free end, and Ld does not exist, so that only types 2
 * and 3 are possible. For a Lagrangian the P_j of its Legendre transform are L_v(q(c_j), q'(c_j)).
 * What remains is an element of the action (step/element/action.h), and all types are the step of
 * galerkin with the same degree and points. Source: Leok and Zhang 2011; Lall and West 2006 (the
 * types); Marsden and West 2001, sec. 1.5. */
#include <math.h>

#include "step/hamiltonian/canonical.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_step.h"
#include "method/one_step.h"
#include "num/compensated.h"
#include "num/finite.h"
#include "num/linear.h"

enum { TYPE, DEGREE, QUADRATURE, NODES };

static const char *hamiltonian_rule_name(int index)
{
  return dvi_rule_name((dvi_rule)index);
}

static const dvi__key keys[] = {
    {"type", NULL, 1, 3, 2,
     "of generating functions: 1 (q0,q1), 2 (q0,p1) or 3 (p0,q1); default: 2"},
    {"degree", NULL, 1, DVI__CANONICAL_DEGREE, 2, "degree of the path, 1 to 8; default: 2"},
    {"quadrature", hamiltonian_rule_name, 0, 0, DVI_GAUSS, "one of galerkin's; default: gauss"},
    {"nodes", NULL, 1, DVI__CANONICAL_POINTS, DVI__LEFT_OUT,
     "quadrature points, at least the degree, at most 9; default: the fewest of order 2 degree, "
     "Gauss's and Radau's rules the degree"},
    {0},
};

typedef struct hamiltonian_options {
  int type, degree, nodes;
  dvi_rule rule;
} hamiltonian_options;

static hamiltonian_options hamiltonian_options_of(const dvi__stepper *self)
{
  const int *value = self->settings.value;
  return (hamiltonian_options){.type = value[TYPE],
                               .degree = value[DEGREE],
                               .nodes = value[NODES],
                               .rule = (dvi_rule)value[QUADRATURE]};
}

/* ---- Hamiltonians ---- */

/* The memory holds the largest |q_i| so far, or the motion of the first step, and the largest |p_i|
 * for each i, or what the forces of the first step could add to it. */
enum { LARGEST_Q = DVI__CARRIED, LARGEST_P };

typedef struct canonical {
  dvi__one_step one;
  double *unit;        /* [n] units of the increments of p */
  dvi__linear *second; /* factors of H_pp where it must be regular, else NULL */
} canonical;

static void hamiltonian_explain(const dvi__stepper *self, dvi__text *text)
{
  static const char *const ends[] = {"Ld(q0,q1)", "H+(q0,p1)", "H-(p0,q1)"};
  const canonical *own = self->own;
  const int type = hamiltonian_options_of(self).type;
  dvi__text_add(text, "discrete Hamiltonian: type %d, %s%s\n", type, ends[type - 1],
                own->second != NULL ? "; H_pp must be regular, which each step checks"
                                    : "; H may be degenerate");
}

static dvi_status hamiltonian_place(dvi__stepper *self, const dvi__state *state, double h,
                                    double part)
{
  const canonical *own = self->own;
  (void)part;
  dvi__canonical_place(own->one.of, state->t, h, state->q, state->p, own->unit);
  return DVI_OK;
}

DVI__STEP_ITERATION(canonical)

DVI__STEP_KIND(canonical, hamiltonian_place, hamiltonian_explain, DVI__STEP_ITERATES);

static dvi_status hamiltonian_refuse(const dvi__stepper *self, dvi_status status)
{
  const hamiltonian_options o = hamiltonian_options_of(self);
  if (o.type == 1)
    return dvi__fail(
        status,
        "the Hamiltonian is degenerate, d2H/dp2 is singular: not every q1 can be reached from a "
        "q0, and there is no discrete Lagrangian Ld(q0,q1), which type=1 is; type=2 and 3 can");
  return dvi__fail(status,
                   "the Hamiltonian is degenerate, d2H/dp2 is singular: %d points want more "
                   "velocities than a path of degree %d has; take nodes=%d",
                   o.nodes, o.degree, o.degree);
}

/* Check that H_pp is regular at the start of the step. */
static dvi_status hamiltonian_check_regular(dvi__stepper *self, const dvi__state *state)
{
  const canonical *own = self->own;
  const double *H_pp;
  if (own->second == NULL) return DVI_OK;
  DVI_TRY(dvi__canonical_curvature(own->one.of, state->t, state->q, state->p, &H_pp));
  const dvi_status status = dvi__linear_factor(own->second, H_pp);
  return status == DVI_SINGULAR ? hamiltonian_refuse(self, DVI_SINGULAR) : status;
}

/* Count what the forces of the first step would add to the momenta at the size of the coordinates.
 * A small momentum beside stiff forces is lost in the roundings of these, and in its own unit they
 * would be large (central differences of a third derivative at 40 points or more). */
static dvi_status hamiltonian_count_forces(const dvi__stepper *self, const dvi__state *state,
                                           double h, double of_q)
{
  const canonical *own = self->own;
  double *of_p = self->memory + LARGEST_P, *rows = own->unit;
  DVI_TRY(dvi__canonical_stiffness(own->one.of, state->t, state->q, state->p, rows));
  for (int i = 0; i < self->system->n; i++) of_p[i] = fmax(of_p[i], fabs(h) * rows[i] * of_q);
  return DVI_OK;
}

/* Choose units for the increments of p as for those of q, so that the units and masses of
 * coordinates do not matter. A momentum that holds only the rounding errors of others gives no
 * unit. */
static dvi_status hamiltonian_choose_units(const dvi__stepper *self, const dvi__state *state,
                                           double h)
{
  const canonical *own = self->own;
  const size_t n = (size_t)self->system->n;
  double *of_q = self->memory + LARGEST_Q, *of_p = self->memory + LARGEST_P;
  *of_q = fmax(*of_q, dvi__largest(n, state->q));
  if (self->memory[DVI__LENGTH] == 0)
    *of_q = fmax(*of_q, fabs(h) * dvi__largest(n, self->memory + own->one.last));
  if (self->memory[DVI__LENGTH] == 0) DVI_TRY(hamiltonian_count_forces(self, state, h, *of_q));
  for (size_t i = 0; i < n; i++) of_p[i] = fmax(of_p[i], fabs(state->p[i]));
  const double least = 0x1p-40 * dvi__largest(n, of_p);
  for (size_t i = 0; i < n; i++) {
    const double unit = fmax(of_p[i], least) / *of_q;
    own->unit[i] = isnormal(unit) && isnormal(1 / unit) ? unit : 1;
  }
  return DVI_OK;
}

static dvi_status hamiltonian_step(dvi__stepper *self, dvi__state *state, double h)
{
  const canonical *own = self->own;
  const dvi__one_step *one = &own->one;
  DVI_TRY(hamiltonian_check_regular(self, state));
  DVI_TRY(hamiltonian_choose_units(self, state, h));
  DVI_TRY(dvi__one_step_solve(self, state, h));
  if (!dvi__one_step_is_iterated(self))
    DVI_TRY(dvi__canonical_residual(one->of, one->x, one->work));
  dvi__canonical_ends(one->of, one->x, one->dq, one->dp);
  dvi__canonical_keep(one->of, one->x, one->work);
  DVI_TRY(dvi__one_step_move(self, state, h, one->work));
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  return DVI_OK;
}

static void hamiltonian_path(const dvi__stepper *self, const double *q0, double h, double tau,
                             double *q, double *v)
{
  const dvi__one_step *one = self->own;
  dvi__canonical_path(one->of, self->memory + one->last, q0, h, tau, q, v);
}

static void hamiltonian_destroy(dvi__stepper *self)
{
  canonical *own = self->own;
  if (own == NULL) return;
  dvi__linear_destroy(&own->second);
  dvi__release(own->unit);
  dvi__one_step_destroy(self);
}

/* ---- create ---- */

static const dvi__method on_phase_space = {
    .name = "hamiltonian",
    .keys = keys,
    .uses = DVI__HAMILTONIAN,
    .destroy = hamiltonian_destroy,
    .start = dvi__one_step_start,
    .step = hamiltonian_step,
    .path = hamiltonian_path,
    .explain = dvi__one_step_explain,
};

/* Watch for a degenerate H. A momentum without a declared second derivative is degenerate whatever
 * the numbers are. */
static dvi_status watch_regular(dvi__stepper *self, const dvi__action_space *space)
{
  canonical *own = self->own;
  const dvi__pattern *pp = &self->system->vv;
  if (hamiltonian_options_of(self).type != 1 && space->nodes == space->degree) return DVI_OK;
  for (int j = 0; j < pp->columns; j++)
    if (pp->start[j] == pp->start[j + 1])
      return dvi__fail_in(hamiltonian_refuse(self, DVI_UNSUPPORTED), "hamiltonian");
  const dvi_status status = dvi__linear_create(pp, dvi__linear_for_exchanges(pp->columns),
                                               self->counters, &own->second);
  return status == DVI_SINGULAR
             ? dvi__fail_in(hamiltonian_refuse(self, DVI_UNSUPPORTED), "hamiltonian")
             : status;
}

static dvi_status create_on_phase_space(dvi__stepper *self, const dvi__action_space *space)
{
  dvi__canonical *step_of;
  self->method = &on_phase_space;
  self->order = dvi__element_order(space);
  self->symmetric = dvi__symmetric_rule(space->rule);
  DVI_TRY(dvi__canonical_create(self->system, space, self->counters, &step_of));
  DVI_TRY(
      dvi__one_step_create(self, sizeof(canonical), &kind, step_of, 1 + (size_t)self->system->n));
  canonical *own = self->own;
  own->unit = DVI_NEW(double, self->system->n);
  return own->unit != NULL ? watch_regular(self, space)
                           : dvi__fail(DVI_NO_MEMORY, "hamiltonian: no memory");
}

static dvi_status hamiltonian_create(dvi__stepper *self)
{
  const hamiltonian_options o = hamiltonian_options_of(self);
  const dvi_rule rule = o.rule;
  const int degree = o.degree, radau = !dvi__symmetric_rule(rule),
            nodes = o.nodes != DVI__LEFT_OUT ? o.nodes
                    : radau                  ? degree
                                             : dvi__fewest_nodes(rule, degree);
  self->settings.value[NODES] = nodes; /* part of the specification, chosen or not */
  if (dvi_quadrature_order(rule, nodes) == 0 || nodes > DVI__CANONICAL_POINTS)
    return dvi__fail(
        DVI_BAD_OPTION,
        "hamiltonian: quadrature %s has no rule with %d point%s here; at most %d are possible",
        dvi_rule_name(rule), nodes, nodes == 1 ? "" : "s", DVI__CANONICAL_POINTS);
  if (nodes < degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "hamiltonian: %d quadrature points see at most %d of the %d velocity modes of "
                     "degree %d; nodes must be at least degree",
                     nodes, nodes, degree, degree);
  const dvi__action_space space = {
      .basis = DVI_LAGRANGE_LOBATTO, .degree = degree, .rule = rule, .nodes = nodes};
  return self->system->terms & DVI__HAMILTONIAN
             ? create_on_phase_space(self, &space)
             : dvi__element_create(self, &space, DVI__SOLVER_AUTO);
}

const dvi__method dvi__hamiltonian = {
    .name = "hamiltonian",
    .summary = "discrete Hamiltonians of type 1, 2 and 3, Galerkin; order 2 degree; Hamiltonians "
               "without a Lagrangian, too",
    .cite = "LeokZhang2011",
    .keys = keys,
    .uses = DVI__ELEMENT_TERMS | DVI__HAMILTONIAN,
    .create = hamiltonian_create,
    DVI__ELEMENT_OPERATIONS,
};
