/* The chain of Fermi, Pasta and Ulam with alternating soft (quartic) and stiff (harmonic) springs
 * (Hairer, Lubich and Wanner 2006, sec. I.5.1), in the centres x0_i and the lengths x1_i of the
 * stiff springs.
 *
 *     slow  1/4 sum_{i=0}^{ell} d_i^4,  d_i = (x0_{i+1} - x1_{i+1}) - (x0_i + x1_i)
 *       with zeros beyond both ends,
 *     fast  omega^2/2 sum_i x1_i^2.
 *
 * q holds x0_1 .. x0_ell, x1_1 .. x1_ell. In a batch both halves are flat arrays in which the
 * neighbours of a number stand `count` places away, so that one loop over all sites and points
 * serves any ell and any count. */
#include <math.h>

#include "entry.h"

/* Largest number of springs whose stiff energies are watched. Their sum is always watched. */
#define WATCHED_MAX 8

struct chain;

typedef struct stiff_spring {
  const struct chain *chain;
  int i;
} stiff_spring;

typedef struct chain {
  int ell;
  double omega;
  int *slow_start, *slow_row, *fast_start, *fast_row;
  stiff_spring watched[WATCHED_MAX];
} chain;

static double fpu_cube(double x)
{
  return x * x * x;
}

/* Compute the potential of the soft spring between the right end `left` of one stiff spring and the
 * left end `right` of the next. */
static double fpu_quartic(double left, double right)
{
  const double d = right - left;
  return 0.25 * (d * d) * (d * d);
}

static int fpu_slow_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const int ell = ((const chain *)user)->ell;
  const double *restrict x0 = q, *restrict x1 = q + (size_t)ell * (size_t)count;
  (void)t;
  for (int k = 0; k < count; k++) V[k] = fpu_quartic(0.0, x0[k] - x1[k]);
  for (int i = 1; i < ell; i++)
    for (int k = 0, j = i * count; k < count; k++, j++)
      V[k] += fpu_quartic(x0[j - count] + x1[j - count], x0[j] - x1[j]);
  for (int k = 0, j = (ell - 1) * count; k < count; k++, j++)
    V[k] += fpu_quartic(x0[j] + x1[j], 0.0);
  return 0;
}

/* Compute the derivatives at one site between the neighbours' ends `left` and `right`. */
static void fpu_slow_forces(double left, double x0, double x1, double right, double *V_x0,
                            double *V_x1)
{
  const double before = fpu_cube((x0 - x1) - left), after = fpu_cube(right - (x0 + x1));
  *V_x0 = before - after;
  *V_x1 = -before - after;
}

PROBLEM_LANES static int fpu_slow_gradient(int count, const double *t, const double *q, double *V_q,
                                           void *user)
{
  const int ell = ((const chain *)user)->ell, last = (ell - 1) * count;
  const double *restrict x0 = q, *restrict x1 = q + last + count;
  double *restrict V_x0 = V_q, *restrict V_x1 = V_q + last + count;
  (void)t;
  for (int j = 0; j < count; j++)
    fpu_slow_forces(0.0, x0[j], x1[j], ell > 1 ? x0[j + count] - x1[j + count] : 0.0, &V_x0[j],
                    &V_x1[j]);
  for (int j = count; j < last; j++)
    fpu_slow_forces(x0[j - count] + x1[j - count], x0[j], x1[j], x0[j + count] - x1[j + count],
                    &V_x0[j], &V_x1[j]);
  for (int j = last; ell > 1 && j < last + count; j++)
    fpu_slow_forces(x0[j - count] + x1[j - count], x0[j], x1[j], 0.0, &V_x0[j], &V_x1[j]);
  return 0;
}

/* Evaluate the Hessian. Columns x0_i and x1_i hold the rows x0_{i-1}, x0_i, x0_{i+1}, x1_{i-1},
 * x1_i, x1_{i+1}, as far as they exist. */
static int fpu_slow_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const chain *own = user;
  const int ell = own->ell;
  const double *restrict x0 = q, *restrict x1 = q + (size_t)ell * (size_t)count;
  (void)t;
  for (int i = 0; i < ell; i++) {
    const int has_left = i > 0, has_right = i < ell - 1, to_x1 = (1 + has_left + has_right) * count,
              j = i * count;
    double *restrict x0_column = V_qq + (size_t)own->slow_start[i] * (size_t)count;
    double *restrict x1_column = V_qq + (size_t)own->slow_start[ell + i] * (size_t)count;
    for (int k = 0; k < count; k++) {
      const double left = has_left ? x0[j - count + k] + x1[j - count + k] : 0.0;
      const double right = has_right ? x0[j + count + k] - x1[j + count + k] : 0.0;
      const double d_before = x0[j + k] - x1[j + k] - left, d_after = right - x0[j + k] - x1[j + k];
      const double before = 3.0 * d_before * d_before, after = 3.0 * d_after * d_after;
      const int e = has_left * count + k;
      if (has_left) {
        x0_column[k] = x0_column[to_x1 + k] = -before;
        x1_column[k] = x1_column[to_x1 + k] = before;
      }
      x0_column[e] = x1_column[to_x1 + e] = before + after;
      x0_column[to_x1 + e] = x1_column[e] = after - before;
      if (has_right) {
        x0_column[e + count] = x1_column[e + count] = -after;
        x0_column[to_x1 + e + count] = x1_column[to_x1 + e + count] = after;
      }
    }
  }
  return 0;
}

static int fpu_fast_potential(int count, const double *t, const double *q, double *V, void *user)
{
  const chain *own = user;
  const double square = own->omega * own->omega;
  (void)t;
  for (int k = 0; k < count; k++) V[k] = 0.0;
  for (int i = own->ell; i < 2 * own->ell; i++)
    for (int k = 0; k < count; k++) V[k] += 0.5 * square * q[i * count + k] * q[i * count + k];
  return 0;
}

PROBLEM_LANES static int fpu_fast_gradient(int count, const double *t, const double *q, double *V_q,
                                           void *user)
{
  const chain *own = user;
  const int half = own->ell * count;
  const double square = own->omega * own->omega;
  const double *restrict x1 = q + half;
  double *restrict V_x0 = V_q, *restrict V_x1 = V_q + half;
  (void)t;
  for (int j = 0; j < half; j++) V_x0[j] = 0.0;
  for (int j = 0; j < half; j++) V_x1[j] = square * x1[j];
  return 0;
}

static int fpu_fast_hessian(int count, const double *t, const double *q, double *V_qq, void *user)
{
  const chain *own = user;
  const double square = own->omega * own->omega;
  (void)t, (void)q;
  for (int j = 0; j < own->ell * count; j++) V_qq[j] = square;
  return 0;
}

/* Compute I_i = (y1_i^2 + omega^2 x1_i^2)/2. The sum of all I_i is nearly conserved over times
 * exponentially long in omega. */
static int fpu_stiff_energy(double t, const double *q, const double *p, double *I, void *user)
{
  const stiff_spring *own = user;
  const double omega = own->chain->omega;
  const int j = own->chain->ell + own->i;
  (void)t;
  *I = 0.5 * (p[j] * p[j] + omega * omega * q[j] * q[j]);
  return 0;
}

/* Compute the sum of the I_i over all springs of the chain `user`. */
static int fpu_total_stiff_energy(double t, const double *q, const double *p, double *I, void *user)
{
  chain *own = user;
  double sum = 0.0;
  for (int i = 0; i < own->ell; i++) {
    stiff_spring spring = {.chain = own, .i = i};
    (void)fpu_stiff_energy(t, q, p, I, &spring);
    sum += *I;
  }
  *I = sum;
  return 0;
}

static dvi_status fpu_make_patterns(problem *made, chain *own)
{
  const int ell = own->ell, n = 2 * ell;
  int *numbers = problem_allocate(made, 13 * (size_t)ell + 2 * ((size_t)n + 1), sizeof(int));
  if (!numbers) return DVI_NO_MEMORY;
  own->slow_start = numbers;
  own->fast_start = own->slow_start + n + 1;
  own->fast_row = own->fast_start + n + 1;
  own->slow_row = own->fast_row + ell;
  int entries = 0;
  for (int column = 0; column < n; column++) {
    const int i = column % ell, first = i > 0 ? i - 1 : 0, last = i < ell - 1 ? i + 1 : i;
    own->slow_start[column] = entries;
    for (int row = first; row <= last; row++) own->slow_row[entries++] = row;
    for (int row = first; row <= last; row++) own->slow_row[entries++] = ell + row;
  }
  own->slow_start[n] = entries;
  for (int column = 0; column <= n; column++)
    own->fast_start[column] = column > ell ? column - ell : 0;
  for (int i = 0; i < ell; i++) own->fast_row[i] = ell + i;
  return DVI_OK;
}

static void fpu_make_start(problem *made, const chain *own)
{
  const int ell = own->ell;
  for (int i = 0; i < ell; i++) {
    problem_label(made, i, "x0_%d", i + 1);
    problem_label(made, ell + i, "x1_%d", i + 1);
  }
  made->q[0] = 1.0;
  made->v[0] = 1.0;
  made->q[ell] = 1.0 / own->omega;
  made->v[ell] = 1.0;
}

static dvi_status fpu_make_system(problem *made, chain *own)
{
  static const char *const energy_names[WATCHED_MAX] = {"I_1", "I_2", "I_3", "I_4",
                                                        "I_5", "I_6", "I_7", "I_8"};
  const dvi_potential springs[2] = {
      {.name = "slow",
       .value_batch = fpu_slow_potential,
       .gradient_batch = fpu_slow_gradient,
       .hessian_batch = fpu_slow_hessian,
       .qq = {own->slow_start, own->slow_row},
       .user = own},
      {.name = "fast",
       .value_batch = fpu_fast_potential,
       .gradient_batch = fpu_fast_gradient,
       .hessian_batch = fpu_fast_hessian,
       .qq = {own->fast_start, own->fast_row},
       .user = own,
       .fast = 1,
       .quadratic = 1},
  };
  dvi_invariant energies[WATCHED_MAX + 1];
  energies[0] = (dvi_invariant){.name = "I", .value = fpu_total_stiff_energy, .user = own};
  const int watched = own->ell <= WATCHED_MAX ? own->ell : 0;
  for (int i = 0; i < watched; i++) {
    own->watched[i] = (stiff_spring){.chain = own, .i = i};
    energies[i + 1] = (dvi_invariant){
        .name = energy_names[i], .value = fpu_stiff_energy, .user = &own->watched[i]};
  }
  const dvi_system_terms terms = {.dimension = 2 * own->ell,
                                  .mass = {.scalar = 1.0},
                                  .potentials = springs,
                                  .potential_count = 2,
                                  .invariants = energies,
                                  .invariant_count = watched + 1,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

static dvi_status fpu_make(const double *setting, problem *made)
{
  const int ell = (int)setting[0];
  dvi_status status = problem_room(made, 2 * ell, sizeof(chain));
  if (status != DVI_OK) return status;
  chain *own = made->parameters;
  own->ell = ell;
  own->omega = setting[1];
  status = fpu_make_patterns(made, own);
  if (status != DVI_OK) return status;
  fpu_make_start(made, own);
  return fpu_make_system(made, own);
}

static const problem_parameter parameters[] = {
    {.name = "ell",
     .value = 3.0,
     .least = 1.0,
     .most = 1e7,
     .whole = 1,
     .help = "the number of stiff springs, a whole number from 1 to 1e7"},
    {.name = "omega",
     .value = 50.0,
     .least = 1e-50,
     .most = 1e50,
     .help = "the stiff springs' frequency, positive"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.74775609914078874,  0.54961212455473042,    0.0039719108079603695,
    0.015648556344858702, 0.00091384409668280960, -0.000065269869521628596,
};
static const double digits_p[] = {
    -1.0767844027571126, 0.80068939878788474,   0.028229458269830615,
    1.1820645462316858,  -0.013043151661235064, -0.00037594526734922536,
};
static const double far_q[] = {
    0.056845823070123611,  0.79791318904286551,  0.22952640229139115,
    0.0025196393499629975, 0.011235420456945567, -0.0097345812522916437,
};

const problem_entry problem_entry_fpu = {
    .name = "fpu",
    .summary =
        "a chain of soft and stiff springs in turn, any length; slow exchange of stiff energies",
    .parameters = parameters,
    .make = fpu_make,
    .h = 0.005,
    .t_end = 50.0,
    .order_h = 0.005,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
    .far_t_end = 200.0,
    .far_q = far_q,
    .far_error = 5e-14,
};
