/* The chain of Fermi, Pasta, Ulam and Tsingou with quartic springs between two walls. A site knows
 * its two neighbours, and gradients come by ranges.
 *
 *     V = sum_{i=1}^{n+1} d_i^2/2 + beta d_i^4/4,  d_i = q_i - q_{i-1},  q_0 = q_{n+1} = 0 */
#include <math.h>

#include "entry.h"

typedef struct springs {
  int n;
  double beta;
  int *start, *row; /* pattern of the Hessian, three diagonals */
} springs;

PROBLEM_INLINE double spring_tension(double beta, double d)
{
  return d * (1.0 + beta * (d * d));
}

/* Compute the pull on a site between its neighbours. All shapes of the gradient use this one
 * expression, so that they have the same bits. */
PROBLEM_INLINE double chain_pull(double beta, double left, double here, double right)
{
  return spring_tension(beta, here - left) - spring_tension(beta, right - here);
}

static int chain_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const springs *own = user;
  (void)t;
  for (int k = 0; k < count; k++) V[k] = 0.0;
  for (size_t i = 0, n = (size_t)own->n, points = (size_t)count; i <= n; i++)
    for (size_t k = 0; k < points; k++) {
      const double d = (i < n ? q[i * points + k] : 0.0) - (i > 0 ? q[(i - 1) * points + k] : 0.0),
                   d2 = d * d;
      V[k] += 0.5 * d2 + 0.25 * own->beta * (d2 * d2);
    }
  return 0;
}

PROBLEM_LANES static int chain_gradient_range(double t, const double *q, int first, int last,
                                              double *restrict V_q, void *user)
{
  const springs *own = user;
  const double beta = own->beta;
  /* both neighbours of these sites are sites */
  const int n = own->n, from = first > 0 ? first : 1, to = last < n ? last : n - 1;
  (void)t;
  if (n == 1) {
    V_q[0] = chain_pull(beta, 0.0, q[0], 0.0);
    return 0;
  }
  if (first == 0) V_q[0] = chain_pull(beta, 0.0, q[0], q[1]);
  for (int i = from; i < to; i++) V_q[i - first] = chain_pull(beta, q[i - 1], q[i], q[i + 1]);
  if (last == n) V_q[n - 1 - first] = chain_pull(beta, q[n - 2], q[n - 1], 0.0);
  return 0;
}

PROBLEM_LANES static void chain_gradient_row(int count, double beta, const double *left,
                                             const double *here, const double *right,
                                             double *restrict V_q)
{
  for (int k = 0; k < count; k++)
    V_q[k] = chain_pull(beta, left != NULL ? left[k] : 0.0, here[k],
                        right != NULL ? right[k] : 0.0);
}

static int chain_gradient(int count, const double *t, const double *q, double *V_q, void *user)
{
  const springs *own = user;
  if (count == 1) return chain_gradient_range(t[0], q, 0, own->n, V_q, user);
  for (size_t i = 0, n = (size_t)own->n, points = (size_t)count; i < n; i++)
    chain_gradient_row(count, own->beta, i > 0 ? q + (i - 1) * points : NULL, q + i * points,
                       i + 1 < n ? q + (i + 1) * points : NULL, V_q + i * points);
  return 0;
}

/* Compute the curvature of the spring before site i. */
static double spring_curvature(const springs *own, int count, int k, const double *q, int i)
{
  const size_t points = (size_t)count, at = (size_t)i * points + (size_t)k;
  const double d = (i < own->n ? q[at] : 0.0) - (i > 0 ? q[at - points] : 0.0);
  return 1.0 + 3.0 * own->beta * (d * d);
}

static int chain_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const springs *own = user;
  (void)t;
  for (int k = 0; k < count; k++) {
    double *entry = V_qq + k;
    for (int j = 0; j < own->n; j++) {
      const double before = spring_curvature(own, count, k, q, j),
                   after = spring_curvature(own, count, k, q, j + 1);
      if (j > 0) *entry = -before, entry += count;
      *entry = before + after, entry += count;
      if (j + 1 < own->n) *entry = -after, entry += count;
    }
  }
  return 0;
}

static dvi_status chain_make_pattern(problem *made, springs *own)
{
  const int n = own->n;
  int *numbers = problem_allocate(made, 4 * (size_t)n + 1, sizeof(int)), entries = 0;
  if (!numbers) return DVI_NO_MEMORY;
  own->start = numbers;
  own->row = numbers + n + 1;
  for (int j = 0; j < n; j++) {
    for (int i = j > 0 ? j - 1 : 0; i <= j + 1 && i < n; i++) own->row[entries++] = i;
    own->start[j + 1] = entries;
  }
  return DVI_OK;
}

/* Compute the normal mode of the harmonic chain whose waves are about 16 sites long. It is sin(pi k
 * i/(n+1)), with its argument reduced exactly. */
static double chain_mode(int i, int n)
{
  const int64_t k = (n + 7) / 8, walls = (int64_t)n + 1, half_turns = i * k % (2 * walls);
  return sin(3.14159265358979323846 * ((double)half_turns / (double)walls));
}

static dvi_status chain_make(const double *setting, problem *made)
{
  const int n = (int)setting[0];
  dvi_status status = problem_room(made, n, sizeof(springs));
  if (status != DVI_OK) return status;
  springs *own = made->parameters;
  own->n = n;
  own->beta = setting[1];
  status = chain_make_pattern(made, own);
  if (status != DVI_OK) return status;
  for (int i = 0; i < n; i++) {
    problem_label(made, i, "q_%d", i + 1);
    made->q[i] = chain_mode(i + 1, n);
  }

  const dvi_potential potential = {.name = "springs",
                                   .value_batch = chain_potential,
                                   .gradient_batch = chain_gradient,
                                   .hessian_batch = chain_hessian,
                                   .qq = {own->start, own->row},
                                   .user = own,
                                   .gradient_range = chain_gradient_range,
                                   .reach = 1};
  return problem_potential_system(made, 1, &potential);
}

static const problem_parameter parameters[] = {
    {.name = "n",
     .value = 32.0,
     .least = 1.0,
     .most = 1e8,
     .whole = 1,
     .help = "the number of sites, a whole number from 1 to 1e8"},
    {.name = "beta",
     .value = 1.0,
     .least = 0.0,
     .most = 1e3,
     .help = "the strength of the quartic springs, from 0 to 1e3"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    -0.24166567724306329, -0.4656772197090846,  -0.64092403619055005, -0.7199966565330248,
    -0.67161648022795883, -0.51572170232637438, -0.30021623529014446, -0.060999643000302486,
    0.18208262627781416,  0.41269419138623903,  0.60415002877501112,  0.71172643575467187,
    0.69543907806442318,  0.56213784773015163,  0.35737017460656917,  0.1217729588021593,
    -0.1217729588021593,  -0.35737017460656917, -0.56213784773015163, -0.69543907806442318,
    -0.71172643575467187, -0.60415002877501112, -0.41269419138623903, -0.18208262627781416,
    0.060999643000302486, 0.30021623529014446,  0.51572170232637438,  0.67161648022795883,
    0.7199966565330248,   0.64092403619055005,  0.4656772197090846,   0.24166567724306329,
};
static const double digits_p[] = {
    0.1022860176622927,    0.19356074728794831,  0.25659069666071765,  0.27987043922811933,
    0.26612325547338339,   0.21271322355513525,  0.12670951969471195,  0.025909466752578155,
    -0.077212244605028652, -0.17263042144220384, -0.24445248568558556, -0.27764051399582446,
    -0.2731004672410019,   -0.2297675585094083,  -0.15024665893649028, -0.051694968335699261,
    0.051694968335699261,  0.15024665893649028,  0.2297675585094083,   0.2731004672410019,
    0.27764051399582446,   0.24445248568558556,  0.17263042144220384,  0.077212244605028652,
    -0.025909466752578155, -0.12670951969471195, -0.21271322355513525, -0.26612325547338339,
    -0.27987043922811933,  -0.25659069666071765, -0.19356074728794831, -0.1022860176622927,
};

const problem_entry problem_entry_chain = {
    .name = "chain",
    .summary = "masses between two walls, joined by springs with a quartic part; for long chains",
    .parameters = parameters,
    .make = chain_make,
    .h = 0.1,
    .t_end = 100.0,
    .order_h = 0.25,
    .order_t_end = 10.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
