/* A rigid satellite with a chain of n links in orbit, on SE(3) x (S^2)^n, coupled through the mass.
 *
 *     L = satellite + sum_k ( m |r_k'|^2/2 + m mu/|r_k| ) + M mu/|x|,
 *     r_k = x + R rho + l (q_1 + .. + q_k)
 *
 * There are point masses m at the links' ends. The chain is fixed to the satellite at rho. Newton's
 * field of strength mu has its centre at the origin. The start has a circular orbit's speed, and
 * turns with the orbit as if it were rigid, with the chain a little off the direction to the
 * centre. Source: Lee, Leok and McClamroch 2009, Int. J. Numer. Meth. Engng 79:1147 (chains of
 * directions). */
#include <math.h>

#include "bodies/pulls.h"

enum { BODY = 12, VELOCITIES = 6, LINKS_MAX = 40 };

typedef struct satellite {
  int links, nq;
  double l, inertia[9];
  pulls all;
  pull *pull;
  /* arms of r_k, which are x, rho's three columns of R, q_1 .. q_k. All pulls share the
   * beginning. */
  arm *arm;
  double *mass;
  int *start, *row;
} satellite;

static const double rho[3] = {-0.5, 0.0, 0.1};
static const double inertia[3] = {0.8, 1.2, 1.5}; /* inertia for M = 10 */

static void satellite_set_arms(satellite *own, double body_pull, double link_pull)
{
  own->arm[0] = (arm){.first = 9, .stride = 1, .factor = 1.0};
  for (int k = 0; k < 3; k++) own->arm[1 + k] = (arm){.first = k, .stride = 3, .factor = rho[k]};
  for (int j = 0; j < own->links; j++)
    own->arm[4 + j] = (arm){.first = BODY + 3 * j, .stride = 1, .factor = own->l};
  own->pull[0] = (pull){.strength = body_pull, .arms = 1, .arm = own->arm};
  for (int k = 1; k <= own->links; k++)
    own->pull[k] = (pull){.strength = link_pull, .arms = 4 + k, .arm = own->arm};
  own->all = (pulls){.nq = own->nq, .count = own->links + 1, .pull = own->pull};
}

/* Compute the coupling of the coordinates a and b through m |r_k'|^2/2 for every k that reaches
 * both. */
static double satellite_coupling(const satellite *own, double m, const arm *a, const arm *b)
{
  const ptrdiff_t later = a > b ? a - own->arm : b - own->arm;
  const int reached = later < 4 ? own->links : own->links - (int)(later - 4);
  return m * reached * a->factor * b->factor;
}

/* Return the arm of stored number s, which is its component *i. */
static const arm *satellite_arm(const satellite *own, int s, int *i)
{
  *i = s < 9 ? s / 3 : s % 3;
  return own->arm + (s < 9 ? 1 + s % 3 : s < BODY ? 0 : 4 + (s - BODY) / 3);
}

/* Fill the mass, column by column. Numbers of the same component are coupled. */
static void satellite_fill_mass(const satellite *own, double m)
{
  int e = 0;
  for (int column = 0; column < own->nq; column++) {
    int i, j;
    const arm *b = satellite_arm(own, column, &j);
    own->start[column] = e;
    for (int row = 0; row < own->nq; row++) {
      const arm *a = satellite_arm(own, row, &i);
      if (i != j) continue;
      own->row[e] = row;
      own->mass[e++] = satellite_coupling(own, m, a, b);
    }
  }
  own->start[own->nq] = e;
}

/* Turn in space about e, with Omega = R^t e, x' = e x x, q' = e x q. */
static int satellite_turn(const satellite *own, const double *q, double *xi, int e)
{
  const int i = (e + 1) % 3, j = (e + 2) % 3;
  for (int k = 0; k < 3; k++) xi[k] = q[3 * e + k];
  for (int s = 9, v = 3; s < own->nq; s += 3, v += 3) {
    xi[v + e] = 0.0;
    xi[v + i] = -q[s + j];
    xi[v + j] = q[s + i];
  }
  return 0;
}

static int satellite_turn_x(const double *q, double *xi, void *user)
{
  return satellite_turn(user, q, xi, 0);
}

static int satellite_turn_y(const double *q, double *xi, void *user)
{
  return satellite_turn(user, q, xi, 1);
}

static int satellite_turn_z(const double *q, double *xi, void *user)
{
  return satellite_turn(user, q, xi, 2);
}

static dvi_status satellite_allocate(problem *made, int n, dvi_factor *factors)
{
  factors[0] = (dvi_factor){.kind = DVI_SE3};
  for (int j = 1; j <= n; j++) factors[j] = (dvi_factor){.kind = DVI_S2};
  const dvi_status status = problem_factors(made, n + 1, factors, sizeof(satellite));
  if (status != DVI_OK) return status;
  const size_t nq = (size_t)made->nq;
  satellite *own = made->parameters;
  own->links = n;
  own->nq = made->nq;
  own->pull = problem_allocate(made, (size_t)n + 1, sizeof *own->pull);
  own->arm = problem_allocate(made, (size_t)n + 4, sizeof *own->arm);
  own->mass = problem_allocate(made, nq * nq / 3, sizeof *own->mass);
  own->row = problem_allocate(made, nq * nq / 3, sizeof *own->row);
  own->start = problem_allocate(made, nq + 1, sizeof *own->start);
  return own->pull && own->arm && own->mass && own->row && own->start ? DVI_OK : DVI_NO_MEMORY;
}

/* Place all at (r,0,0), turning about z with the orbit's rate. */
static void satellite_place(const problem *made, double r, double mu)
{
  const double rate = sqrt(mu / r) / r, length = sqrt(1.0 + 0.3 * 0.3 + 0.2 * 0.2);
  made->q[9] = r;
  for (int s = BODY; s < made->nq; s += 3) {
    made->q[s] = -1.0 / length;
    made->q[s + 1] = 0.3 / length;
    made->q[s + 2] = 0.2 / length;
  }
  made->v[2] = rate;
  for (int s = 9, v = 3; s < made->nq; s += 3, v += 3) {
    made->v[v] = -rate * made->q[s + 1];
    made->v[v + 1] = rate * made->q[s];
  }
}

static dvi_status satellite_make(const double *setting, problem *made)
{
  const int n = (int)setting[0];
  const double m = setting[1], M = setting[3], mu = setting[4];
  dvi_factor factors[LINKS_MAX + 1];
  const dvi_status status = satellite_allocate(made, n, factors);
  if (status != DVI_OK) return status;
  satellite *own = made->parameters;
  own->l = setting[2];
  for (int k = 0; k < 3; k++) own->inertia[4 * k] = inertia[k] * M / 10.0;
  satellite_set_arms(own, M * mu, m * mu);
  satellite_fill_mass(own, m);
  satellite_place(made, setting[5], mu);

  factors[0].mass = M;
  factors[0].inertia = own->inertia;
  const dvi_symmetry symmetries[] = {
      {.name = "angular_momentum_x", .generator = satellite_turn_x, .user = own},
      {.name = "angular_momentum_y", .generator = satellite_turn_y, .user = own},
      {.name = "angular_momentum_z", .generator = satellite_turn_z, .user = own}};
  const dvi_potential gravity = pulls_potential("gravity", &own->all);
  const dvi_system_terms terms = {.factors = factors,
                                  .factor_count = n + 1,
                                  .mass = {.values = own->mass, .pattern = {own->start, own->row}},
                                  .potentials = &gravity,
                                  .potential_count = 1,
                                  .symmetries = symmetries,
                                  .symmetry_count = 3,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "n",
     .value = 4.0,
     .least = 1.0,
     .most = LINKS_MAX,
     .whole = 1,
     .help = "how many links the chain has, a whole number from 1 to 40"},
    {.name = "m",
     .value = 0.5,
     .least = 1e-50,
     .most = 1e50,
     .help = "the mass at each link's end, positive"},
    {.name = "l",
     .value = 0.25,
     .least = 1e-50,
     .most = 1e50,
     .help = "the length of each link, positive"},
    {.name = "M",
     .value = 10.0,
     .least = 1e-50,
     .most = 1e50,
     .help = "the satellite's mass, positive; its inertia is M/10 diag(.8,1.2,1.5)"},
    {.name = "mu",
     .value = 10.0,
     .least = 0.0,
     .most = 1e50,
     .help = "the strength of the centre's field, from 0"},
    {.name = "r",
     .value = 5.0,
     .least = 1e-6,
     .most = 1e50,
     .start_only = 1,
     .help = "the distance from the centre at the start, positive"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.88124919583518624,   -0.47080097053433012,  -0.041788766238911798, 0.47160186812378802,
    0.88173814326020994,   0.011380891976941974,  0.031488614164342385,  -0.029737062127426328,
    0.99906164690375276,   4.0939191642543467,    2.6755706912179145,    0.015571633919547433,
    -0.82660476437944019,  -0.56154561397038705,  -0.037297277860872523, -0.81845276358708852,
    -0.5719523275618017,   -0.054823432702585419, -0.81538598424680775,  -0.57492331544101305,
    -0.067888718180401472, -0.83914356994147321,  -0.54158742826765449,  -0.050210821227183296};
static const double digits_p[] = {
    -0.21455993279368749,  -0.20157213237838903, -0.66153258685706795,  -10.313555289894445,
    13.218307020968069,    -0.12943815452343035, -0.28679939825809214,  0.42596860022477523,
    -0.057136880926848252, -0.20404771059088148, 0.29681978006716003,   -0.050404567952903441,
    -0.12558006403298999,  0.18277940379326094,  -0.039592980717266302, -0.053936935170994064,
    0.085699511381815224,  -0.022962094899135945};

const problem_entry problem_entry_satellite = {
    .name = "satellite",
    .summary = "a rigid satellite with a flexible chain in orbit; rigid motions and directions, "
               "coupled by their mass",
    .parameters = parameters,
    .make = satellite_make,
    .h = 0.05,
    .t_end = 100.0,
    .order_h = 0.05,
    .order_t_end = 2.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
