#include "support/systems/hamiltonians.h"

#include <math.h>
#include <string.h>

#include "support/suite.h"

/* ---- logistic growth and its adjoint: p q (1-q) is kept ---- */

static int adjoint_value(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = p[0] * q[0] * (1 - q[0]);
  return 0;
}

static int adjoint_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                            void *user)
{
  (void)t, (void)user;
  H_q[0] = p[0] * (1 - 2 * q[0]);
  H_p[0] = q[0] * (1 - q[0]);
  return 0;
}

static int adjoint_hessian(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                           double *H_pp, void *user)
{
  (void)t, (void)H_pp, (void)user;
  H_qq[0] = -2 * p[0];
  H_qp[0] = 1 - 2 * q[0];
  return 0;
}

static const int one_start[] = {0, 1}, none_start[] = {0, 0}, first_row[] = {0};

static void adjoint_exact(double t, double *q, double *p)
{
  const double q0 = 0.2, p0 = 1.5, grown = q0 * exp(t);
  q[0] = grown / (1 - q0 + grown);
  p[0] = p0 * q0 * (1 - q0) / (q[0] * (1 - q[0]));
}

/* ---- an oscillator whose stiffness is a coordinate: p_k' = -q^2/2 ---- */

enum { Q, K };

static int stiffness_value(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = (p[Q] * p[Q] + q[K] * q[Q] * q[Q]) / 2;
  return 0;
}

static int stiffness_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                              void *user)
{
  (void)t, (void)user;
  H_q[Q] = q[K] * q[Q];
  H_q[K] = q[Q] * q[Q] / 2;
  H_p[Q] = p[Q];
  H_p[K] = 0;
  return 0;
}

static int stiffness_hessian(double t, const double *q, const double *p, double *H_qq, double *H_qp,
                             double *H_pp, void *user)
{
  (void)t, (void)p, (void)H_qp, (void)user;
  H_qq[0] = q[K];
  H_qq[1] = H_qq[2] = q[Q];
  H_pp[0] = 1;
  return 0;
}

static const int full_start[] = {0, 2, 3}, full_row[] = {Q, K, Q}, empty_start[] = {0, 0, 0},
                 q_start[] = {0, 1, 1};

/* From q = 1 at rest with k = 4 the solution is q = cos 2t, p_k = -(t/4 + sin(4t)/16). */
static void stiffness_exact(double t, double *q, double *p)
{
  q[Q] = cos(2 * t);
  q[K] = 4;
  p[Q] = -2 * sin(2 * t);
  p[K] = -(t / 4 + sin(4 * t) / 16);
}

/* ---- regular ones ---- */

static int driven_value(double t, const double *q, const double *p, double *H, void *user)
{
  (void)user;
  *H = (p[0] * p[0] + q[0] * q[0]) / 2 - q[0] * cos(2 * t);
  return 0;
}

static int driven_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                           void *user)
{
  (void)user;
  H_q[0] = q[0] - cos(2 * t);
  H_p[0] = p[0];
  return 0;
}

/* q'' = -q + cos 2t from (1, 0.5). */
static void driven_exact(double t, double *q, double *p)
{
  q[0] = 4 * cos(t) / 3 + 0.5 * sin(t) - cos(2 * t) / 3;
  p[0] = -4 * sin(t) / 3 + 0.5 * cos(t) + 2 * sin(2 * t) / 3;
}

static int curved_value(double t, const double *q, const double *p, double *H, void *user)
{
  (void)t, (void)user;
  *H = (1 + q[0] * q[0]) * p[0] * p[0] / 2;
  return 0;
}

static int curved_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                           void *user)
{
  (void)t, (void)user;
  H_q[0] = q[0] * p[0] * p[0];
  H_p[0] = (1 + q[0] * q[0]) * p[0];
  return 0;
}

static void curved_exact(double t, double *q, double *p)
{
  q[0] = sinh(t);
  p[0] = 1 / cosh(t);
}

const hamiltonian_problem hamiltonian_problems[] = {
    {"adjoint",
     1,
     1,
     {.value = adjoint_value,
      .gradient = adjoint_gradient,
      .hessian = adjoint_hessian,
      .pp = {none_start, NULL},
      .qp = {one_start, first_row}},
     {0.2},
     {1.5},
     0.5,
     adjoint_exact},
    {"stiffness",
     2,
     1,
     {.value = stiffness_value,
      .gradient = stiffness_gradient,
      .hessian = stiffness_hessian,
      .qq = {full_start, full_row},
      .qp = {empty_start, NULL},
      .pp = {q_start, first_row}},
     {1, 4},
     {0, 0},
     1,
     stiffness_exact},
    {"driven",
     1,
     0,
     {.value = driven_value, .gradient = driven_gradient},
     {1},
     {0.5},
     1,
     driven_exact},
    {"curved",
     1,
     0,
     {.value = curved_value, .gradient = curved_gradient},
     {0},
     {1},
     1,
     curved_exact},
    {.name = NULL},
};

const hamiltonian_problem *find_hamiltonian_problem(const char *name)
{
  for (const hamiltonian_problem *model = hamiltonian_problems; model->name != NULL; model++)
    if (strcmp(model->name, name) == 0) return model;
  ck_abort_msg("no Hamiltonian %s", name);
  return NULL;
}

dvi_system *create_hamiltonian_system(const hamiltonian_problem *model)
{
  const dvi_system_terms terms = {.dimension = model->n, .hamiltonian = &model->hamiltonian};
  dvi_system *system;
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

dvi_integrator *start_hamiltonian_integrator(const dvi_system *system,
                                             const hamiltonian_problem *model, const char *method)
{
  dvi_integrator *made = create_integrator(system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

/* ---- Legendre transforms ---- */

enum { TRANSFORMED_MOST = 24, INVARIANTS_MOST = 16 };

static int transform_value(double t, const double *q, const double *p, double *H, void *user)
{
  const problem *model = user;
  double values[INVARIANTS_MOST];
  ck_assert_int_le(dvi_system_invariant_count(model->system), INVARIANTS_MOST);
  if (dvi_system_invariants(model->system, t, q, p, values) != DVI_OK) return 1;
  *H = values[0];
  return 0;
}

/* Gives H_q = -L_q and H_p = v. With a constant mass H_q is the potentials' gradient. */
static int transform_gradient(double t, const double *q, const double *p, double *H_q, double *H_p,
                              void *user)
{
  const problem *model = user;
  const dvi_lagrangian *L = model->terms->lagrangian;
  double forces[TRANSFORMED_MOST];
  int returned = 0;
  memset(H_p, 0, (size_t)model->nq * sizeof *H_p);
  memset(H_q, 0, (size_t)model->nq * sizeof *H_q);
  if (dvi_system_velocity(model->system, t, q, p, H_p) != DVI_OK) return 1;
  if (L != NULL) {
    double momenta[TRANSFORMED_MOST];
    returned = L->gradient != NULL ? L->gradient(t, q, H_p, forces, momenta, L->user)
                                   : L->gradient_batch(1, &t, q, H_p, forces, momenta, L->user);
    for (int i = 0; i < model->nq; i++) H_q[i] -= forces[i];
  }
  for (int k = 0; k < model->terms->potential_count && returned == 0; k++) {
    const dvi_potential *V = &model->terms->potentials[k];
    returned = V->gradient != NULL ? V->gradient(t, q, forces, V->user)
                                   : V->gradient_batch(1, &t, q, forces, V->user);
    for (int i = 0; i < model->nq; i++) H_q[i] += forces[i];
  }
  return returned;
}

dvi_system *create_legendre_transform(problem *model)
{
  const dvi_hamiltonian H = {
      .value = transform_value, .gradient = transform_gradient, .user = model};
  const dvi_system_terms terms = {
      .dimension = model->nq, .hamiltonian = &H, .autonomous = model->terms->autonomous};
  dvi_system *system;
  ck_assert_int_le(model->nq, TRANSFORMED_MOST);
  ck_assert_msg(dvi_system_create(&terms, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}
