/* The periodic Toda lattice, V = 0.64 sum_i exp(q_i - q_{i+1}), q_N = q_0, from a bump at rest. */
#include <dvi/taylor.h>
#include <math.h>

#include "entry.h"

static const double strength = 0.64;

/* The lattice. The Hessian holds, for the bond of i and i+1, the curvature c_i at (i,i) and
 * (i+1,i+1) and -c_i at (i,i+1) and (i+1,i). */
typedef struct lattice {
  int N;
  int *start, *row; /* pattern of the Hessian */
  int *own;         /* [N] index of entry (i,i) */
  int *above;       /* [N] index of entry (i,i+1) */
  int *below;       /* [N] index of entry (i+1,i) */
} lattice;

static int toda_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const lattice *own = user;
  (void)t;
  for (int k = 0; k < count; k++) V[k] = 0.0;
  for (int i = 0; i < own->N; i++) {
    const double *restrict left = q + i * count, *restrict right = q + (i + 1) % own->N * count;
    for (int k = 0; k < count; k++) V[k] += strength * exp(left[k] - right[k]);
  }
  return 0;
}

static int toda_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const lattice *own = user;
  (void)t;
  for (int j = 0; j < own->N * count; j++) V_q[j] = 0.0;
  for (int i = 0; i < own->N; i++) {
    const int a = i * count, b = (i + 1) % own->N * count;
    for (int k = 0; k < count; k++) {
      const double force = strength * exp(q[a + k] - q[b + k]);
      V_q[a + k] += force;
      V_q[b + k] -= force;
    }
  }
  return 0;
}

static int toda_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const lattice *own = user;
  (void)t;
  for (int j = 0; j < own->start[own->N] * count; j++) V_qq[j] = 0.0;
  for (int i = 0; i < own->N; i++) {
    const int next = (i + 1) % own->N;
    for (int k = 0; k < count; k++) {
      const double curvature = strength * exp(q[i * count + k] - q[next * count + k]);
      V_qq[own->own[i] * count + k] += curvature;
      V_qq[own->own[next] * count + k] += curvature;
      V_qq[own->above[i] * count + k] -= curvature;
      V_qq[own->below[i] * count + k] -= curvature;
    }
  }
  return 0;
}

/* Add one bond's curvature to the Hessian of one coefficient. */
static void toda_add_bond(const lattice *own, int i, double curvature, double *V_qq)
{
  V_qq[own->own[i]] += curvature;
  V_qq[own->own[(i + 1) % own->N]] += curvature;
  V_qq[own->above[i]] -= curvature;
  V_qq[own->below[i]] -= curvature;
}

/* Evaluate V and its derivatives along a curve, bond by bond. */
static int toda_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                       double *V_qq, void *user)
{
  const lattice *own = user;
  const int N = own->N, entries = own->start[N];
  double here[DVI_TAYLOR_MAX + 1], there[DVI_TAYLOR_MAX + 1], stretch[DVI_TAYLOR_MAX + 1],
      bond[DVI_TAYLOR_MAX + 1];
  (void)t;
  for (int k = 0; V && k <= degree; k++) V[k] = 0.0;
  for (int j = 0; V_q && j < (degree + 1) * N; j++) V_q[j] = 0.0;
  for (int j = 0; V_qq && j < (degree + 1) * entries; j++) V_qq[j] = 0.0;
  for (int i = 0; i < N; i++) {
    const int next = (i + 1) % N;
    dvi_taylor_get(degree, N, q, i, here);
    dvi_taylor_get(degree, N, q, next, there);
    dvi_taylor_combine(degree, 1.0, here, -1.0, there, stretch);
    dvi_taylor_exp(degree, stretch, bond);
    for (int k = 0; k <= degree; k++) {
      const double force = strength * bond[k];
      if (V) V[k] += force;
      if (V_q) V_q[k * N + i] += force;
      if (V_q) V_q[k * N + next] -= force;
      if (V_qq) toda_add_bond(own, i, force, V_qq + (ptrdiff_t)k * entries);
    }
  }
  return 0;
}

static int toda_translation(const double *q, double *xi, void *user)
{
  const lattice *own = user;
  (void)q;
  for (int i = 0; i < own->N; i++) xi[i] = 1.0;
  return 0;
}

/* Add `row` to the last column in order, if it is not there yet. */
static void toda_add_row(int first, int *entries, int *rows, int row)
{
  int e = *entries;
  while (e > first && rows[e - 1] > row) e--;
  if (e > first && rows[e - 1] == row) return;
  for (int j = *entries; j > e; j--) rows[j] = rows[j - 1];
  rows[e] = row;
  ++*entries;
}

static int toda_find_row(const lattice *own, int row, int column)
{
  int e = own->start[column];
  while (own->row[e] != row) e++;
  return e;
}

/* Make the pattern. A site meets itself and its two neighbours, which are the same site if N =
 * 2. */
static dvi_status toda_make_pattern(problem *made, lattice *own)
{
  const int N = own->N;
  int *numbers = problem_allocate(made, 7 * (size_t)N + 1, sizeof(int));
  if (!numbers) return DVI_NO_MEMORY;
  own->own = numbers;
  own->above = numbers + N;
  own->below = numbers + 2 * N;
  own->start = numbers + 3 * N;
  own->row = numbers + 4 * N + 1;
  for (int i = 0, entries = 0; i < N; i++) {
    own->start[i] = entries;
    toda_add_row(own->start[i], &entries, own->row, (i + N - 1) % N);
    toda_add_row(own->start[i], &entries, own->row, i);
    toda_add_row(own->start[i], &entries, own->row, (i + 1) % N);
    own->start[i + 1] = entries;
  }
  for (int i = 0; i < N; i++) {
    own->own[i] = toda_find_row(own, i, i);
    own->above[i] = toda_find_row(own, i, (i + 1) % N);
    own->below[i] = toda_find_row(own, (i + 1) % N, i);
  }
  return DVI_OK;
}

/* Compute the start by a cubic spline of half width 1/3 about -0.15, on sites spread evenly over
 * [-1/2, 1/2]. */
static double toda_bump(int i, int N)
{
  const double s = 6.0 * fabs(-0.5 + (double)i / (N - 1) + 0.15);
  if (s <= 1.0) return 1.0 - 1.5 * s * s + 0.75 * s * s * s;
  return s <= 2.0 ? 0.25 * (2.0 - s) * (2.0 - s) * (2.0 - s) : 0.0;
}

static dvi_status toda_make(const double *setting, problem *made)
{
  const int N = (int)setting[0];
  dvi_status status = problem_room(made, N, sizeof(lattice));
  if (status != DVI_OK) return status;
  lattice *own = made->parameters;
  own->N = N;
  status = toda_make_pattern(made, own);
  if (status != DVI_OK) return status;
  for (int i = 0; i < N; i++) {
    problem_label(made, i, "q_%d", i + 1);
    made->q[i] = toda_bump(i, N);
  }

  const dvi_potential bonds = {.name = "bonds",
                               .value_batch = toda_potential,
                               .gradient_batch = toda_gradient,
                               .hessian_batch = toda_hessian,
                               .qq = {own->start, own->row},
                               .user = own,
                               .taylor = toda_taylor};
  const dvi_symmetry symmetry = {.name = "momentum", .generator = toda_translation, .user = own};
  const dvi_system_terms terms = {.dimension = N,
                                  .mass = {.scalar = 1.0},
                                  .potentials = &bonds,
                                  .potential_count = 1,
                                  .symmetries = &symmetry,
                                  .symmetry_count = 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static const problem_parameter parameters[] = {
    {.name = "N",
     .value = 20.0,
     .least = 2.0,
     .most = 1e7,
     .whole = 1,
     .help = "the number of sites, a whole number from 2 to 1e7"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.41889702754726640,     0.22568671266096771,    0.080847079437953343,  0.018307753689089742,
    -0.0051375048501598452,  -0.0043134782832691139, 0.0011356736182353742, 0.00058132400159525924,
    -0.00089763940936775495, -0.011847865361160313,  0.013937501866215399,  0.10316017892688368,
    0.25195535414054813,     0.40009866426783464,    0.51197772320577327,   0.57186574662584127,
    0.57473530449107022,     0.54350968388302261,    0.53127852062331025,   0.52418579045647481,
};
static const double digits_p[] = {
    -0.11007535158887960,    -0.14577825984142129,    -0.080137746044188803,
    -0.031402133839598618,   -0.0073149959657370121,  0.0040358823997427299,
    0.00091990107662258293,  -0.00017120785092976442, 0.0057334236807233684,
    -0.00086525511005802001, -0.043096954099891211,   -0.095707789755792588,
    -0.11525285610483630,    -0.085314412505676815,   -0.018438043994271870,
    0.081864556152981128,    0.18680056421845269,     0.23236555138494464,
    0.17810612629856424,     0.043729001489250515,
};

const problem_entry problem_entry_toda = {
    .name = "toda",
    .summary = "a periodic lattice with exponential springs, started from a bump; integrable",
    .parameters = parameters,
    .make = toda_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.25,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
