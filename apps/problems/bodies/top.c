#include "bodies/top.h"

/* Row 3 of R in y = (R11, R12 .. R33). */
enum { UP = 6 };

static int top_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const double *w = ((const top *)user)->weight;
  const double *restrict up = q + (ptrdiff_t)UP * count;
  (void)t;
  for (int k = 0; k < count; k++)
    V[k] = w[0] * up[k] + w[1] * up[count + k] + w[2] * up[2 * count + k];
  return 0;
}

static int top_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const double *w = ((const top *)user)->weight;
  (void)t, (void)q;
  for (int i = 0; i < 9; i++)
    for (int k = 0; k < count; k++) V_q[i * count + k] = i < UP ? 0.0 : w[i - UP];
  return 0;
}

static int top_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  (void)count, (void)t, (void)q, (void)V_qq, (void)user; /* the pattern is empty */
  return 0;
}

static const int none_start[10], none_row[1];

/* The axes that the generators point to. */
static int axes[] = {0, 1, 2};

/* Turn in space about axis e. Omega = R^T e is that row of R. */
static int top_turn(const double *q, double *xi, void *user)
{
  const int e = *(const int *)user;
  for (int i = 0; i < 3; i++) xi[i] = q[3 * e + i];
  return 0;
}

/* The vertical symmetry, which a weight leaves, is the last one. */
static const dvi_symmetry symmetries[] = {
    {.name = "angular_momentum_x", .generator = top_turn, .user = &axes[0]},
    {.name = "angular_momentum_y", .generator = top_turn, .user = &axes[1]},
    {.name = "angular_momentum_z", .generator = top_turn, .user = &axes[2]}};

void top_inertia(top *body, const double *J)
{
  for (int i = 0; i < 3; i++) body->J[4 * i] = J[i];
}

dvi_status top_room(problem *made, const double *Omega)
{
  const dvi_factor factor = {.kind = DVI_SO3};
  const dvi_status status = problem_factors(made, 1, &factor, sizeof(top));
  for (int i = 0; i < 3 && status == DVI_OK; i++) made->v[i] = Omega[i];
  return status;
}

dvi_status top_system(problem *made, const dvi_invariant *invariant)
{
  top *own = made->parameters;
  const int heavy = own->weight[0] != 0.0 || own->weight[1] != 0.0 || own->weight[2] != 0.0;
  const dvi_factor factor = {.kind = DVI_SO3, .inertia = own->J};
  const dvi_potential potential = {.name = "weight",
                                   .value_batch = top_potential,
                                   .gradient_batch = top_gradient,
                                   .hessian_batch = top_hessian,
                                   .qq = {none_start, none_row},
                                   .user = own};
  const dvi_system_terms terms = {.factors = &factor,
                                  .factor_count = 1,
                                  .potentials = &potential,
                                  .potential_count = heavy,
                                  .symmetries = heavy ? symmetries + 2 : symmetries,
                                  .symmetry_count = heavy ? 1 : 3,
                                  .invariants = invariant,
                                  .invariant_count = invariant != NULL,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}
