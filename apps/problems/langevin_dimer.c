/* Two particles in the plane whose bond has two lengths, in a heat bath:
 *
 *     V(r) = b (1 - s^2)^2,   s = (r - 3/2)/w,   r = |x2 - x1|,
 *
 * with minima at r = 3/2 - w and 3/2 + w, and the barrier b between them (Straub, Borkovec and
 * Berne 1988). In equilibrium r has the density r exp(-V/kT). Without friction there is no bath. */
#include <math.h>

#include "entry.h"

static const double middle = 1.5;

typedef struct bond {
  double b, w;
} bond;

/* A bond of a length r, with the unit vector along it. */
typedef struct stretch {
  double r, x, y, s;
} stretch;

PROBLEM_INLINE stretch stretch_of(const bond *own, double x, double y)
{
  const double r = sqrt(x * x + y * y);
  return (stretch){r, x / r, y / r, (r - middle) / own->w};
}

PROBLEM_LANES
static int bond_potential(int count, const double *t, const double *q, double *V, void *user)
{
  (void)t;
  for (int k = 0; k < count; k++) {
    const stretch now = stretch_of(user, q[2 * count + k] - q[k], q[3 * count + k] - q[count + k]);
    const double rest = 1.0 - now.s * now.s;
    V[k] = ((const bond *)user)->b * (rest * rest);
  }
  return 0;
}

PROBLEM_LANES
static int bond_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const bond *own = user;
  (void)t;
  for (int k = 0; k < count; k++) {
    const stretch now = stretch_of(own, q[2 * count + k] - q[k], q[3 * count + k] - q[count + k]);
    const double slope = -4.0 * own->b * now.s * (1.0 - now.s * now.s) / own->w;
    V_q[2 * count + k] = slope * now.x;
    V_q[3 * count + k] = slope * now.y;
    V_q[k] = -V_q[2 * count + k];
    V_q[count + k] = -V_q[3 * count + k];
  }
  return 0;
}

static int bond_hessian(double t, const double *q, double *V_qq, void *user)
{
  const bond *own = user;
  const stretch now = stretch_of(own, q[2] - q[0], q[3] - q[1]);
  const double across = -4.0 * own->b * now.s * (1.0 - now.s * now.s) / own->w / now.r,
               along = -4.0 * own->b * (1.0 - 3.0 * now.s * now.s) / (own->w * own->w) - across,
               H[] = {across + along * now.x * now.x, along * now.x * now.y,
                      across + along * now.y * now.y};
  (void)t;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      V_qq[4 * i + j] = (i < 2) == (j < 2) ? H[i % 2 + j % 2] : -H[i % 2 + j % 2];
  return 0;
}

static dvi_status langevin_dimer_make(const double *setting, problem *made)
{
  static const char *const names[] = {"x1", "y1", "x2", "y2"};
  static const double q[] = {-0.6, 0.1, 0.5, 0.0}, v[] = {0.1, 0.3, -0.2, -0.4};
  const dvi_status status = problem_room(made, 4, sizeof(bond));
  if (status != DVI_OK) return status;
  bond *own = made->parameters;
  *own = (bond){.b = setting[0], .w = setting[1]};
  for (int i = 0; i < 4; i++) {
    problem_label(made, i, "%s", names[i]);
    made->q[i] = q[i];
    made->v[i] = v[i];
  }
  const dvi_potential spring = {.name = "bond",
                                .value_batch = bond_potential,
                                .gradient_batch = bond_gradient,
                                .hessian = bond_hessian,
                                .user = own};
  const dvi_noise bath = {
      .temperature = setting[2], .friction = setting[3], .seed = (unsigned long long)setting[4]};
  const dvi_system_terms terms = {.dimension = 4,
                                  .mass = {.scalar = 1.0},
                                  .autonomous = 1,
                                  .potentials = &spring,
                                  .potential_count = 1,
                                  .noise = bath.friction > 0.0 ? &bath : NULL};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "b",
     .value = 1.0,
     .least = 0.0,
     .most = 1e10,
     .help = "the barrier between the two lengths of the bond, 0 or more"},
    {.name = "w",
     .value = 0.5,
     .least = 0.01,
     .most = 1.4,
     .help = "half the distance of the two lengths, 0.01 to 1.4"},
    {.name = "kT",
     .value = 0.5,
     .least = 0.0,
     .most = 1e10,
     .help = "the temperature of the bath, an energy, 0 or more"},
    {.name = "gamma",
     .value = 1.0,
     .least = 0.0,
     .most = 1e10,
     .help = "the friction of the bath; 0 leaves it out"},
    {.name = "seed",
     .value = 7.0,
     .least = 0.0,
     .most = 9007199254740992.0,
     .whole = 1,
     .help = "the seed of the noise, a whole number from 0 on"},
    {.name = NULL},
};

/* Quadruple-precision results without friction, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {0.07080640942246723, -0.5879375525101143, -0.6708064094224673,
                                  0.1879375525101142};
static const double digits_p[] = {-0.5054345802569339, -0.11288948360675484, 0.4054345802569339,
                                  0.012889483606754843};

const problem_entry problem_entry_langevin_dimer = {
    .name = "langevin-dimer",
    .summary = "two particles whose bond has two lengths, in a heat bath",
    .parameters = parameters,
    .make = langevin_dimer_make,
    .h = 0.02,
    .t_end = 100.0,
    .order_h = 0.02,
    .order_t_end = 5.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
