/* labels: unit */
/* The sums of a time-transformed step have, at every instruction set, the bits of plain loops. */
#include <math.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/rescaled.h"
#include "support/suite.h"

enum { N = 3, STAGES_MOST = 17, LANES_MOST = 24, SWEEPS = 2 };

static void best_again(void)
{
  dvi__lanes_choose(-1);
}

static void fill(int count, double *x, int seed)
{
  for (int i = 0; i < count; i++) x[i] = sin(1.0 + seed + 3 * i) * ldexp(1.0, (seed + i) % 7 - 3);
}

/* All arrays of one iteration. */
typedef struct numbers {
  double place[STAGES_MOST * LANES_MOST], momentum[STAGES_MOST * LANES_MOST], weight[LANES_MOST];
  double inverse_mass[N], p0[N], origin[N], g[LANES_MOST], V[LANES_MOST];
  double g_q[N * STAGES_MOST + LANES_MOST], V_q[N * STAGES_MOST + LANES_MOST];
  double P[N * LANES_MOST], Z[N * LANES_MOST], next[N * LANES_MOST], rate[LANES_MOST];
  double u[N * STAGES_MOST], f[N * STAGES_MOST], Q[N * STAGES_MOST];
} numbers;

/* Matrices are padded with zeros, and so small that a few iterations stay finite. */
static void fill_numbers(int stages, int lanes, numbers *x)
{
  memset(x, 0, sizeof *x);
  fill(stages * lanes, x->place, 1), fill(stages * lanes, x->momentum, 2);
  for (int k = 0; k < stages * lanes; k++) {
    const double scale = k % lanes < stages ? 0x1p-8 : 0;
    x->place[k] *= scale;
    x->momentum[k] *= scale;
  }
  fill(stages, x->weight, 3), fill(N, x->inverse_mass, 4), fill(N, x->p0, 5);
  fill(N, x->origin, 6), fill(stages, x->g, 7), fill(stages, x->V, 8);
  fill(N * stages, x->g_q, 9), fill(N * stages, x->V_q, 10), fill(N * stages, x->u, 11);
  fill(N * stages, x->f, 12);
  for (int i = 0; i < N; i++) {
    fill(stages, x->P + i * lanes, 13 + i);
    fill(stages, x->Z + i * lanes, 16 + i);
  }
}

static dvi__rescaled_sums sums_of(int stages, int lanes, numbers *x)
{
  return (dvi__rescaled_sums){.n = N,
                              .stages = stages,
                              .lanes = lanes,
                              .sweeps = SWEEPS,
                              .place = x->place,
                              .momentum = x->momentum,
                              .weight = x->weight,
                              .inverse_mass = x->inverse_mass,
                              .p0 = x->p0,
                              .origin = x->origin,
                              .g = x->g,
                              .V = x->V,
                              .g_q = x->g_q,
                              .V_q = x->V_q,
                              .P = x->P,
                              .Z = x->Z,
                              .next = x->next,
                              .u = x->u,
                              .f = x->f,
                              .Q = x->Q,
                              .rate = x->rate};
}

/* ---- plain loops ---- */

static double row_sum(int stages, int lanes, const double *matrix, int j, const double *x)
{
  double sum[2] = {0, 0};
  for (int l = 0; l < stages; l++) sum[l % 2] += matrix[l * lanes + j] * x[l];
  return sum[0] + sum[1];
}

static void plain_momenta(const dvi__rescaled_sums *s)
{
  for (int i = 0; i < N; i++)
    for (int j = 0; j < s->stages; j++)
      s->P[i * s->lanes + j] = s->p0[i] +
                               row_sum(s->stages, s->lanes, s->momentum, j, s->f + i * s->stages);
}

static void plain_forces(const dvi__rescaled_sums *s)
{
  for (int j = 0; j < s->stages; j++) {
    double energy = 0;
    for (int i = 0; i < N; i++) {
      const double P = s->P[i * s->lanes + j];
      energy += s->inverse_mass[i] * (P * P);
    }
    energy = 0.5 * energy + s->V[j];
    for (int i = 0, at = j; i < N; i++, at += s->stages)
      s->f[at] = -s->weight[j] * (s->g[j] * s->V_q[at] + energy * s->g_q[at]);
  }
}

static void plain_rates(const dvi__rescaled_sums *s)
{
  for (int j = 0; j < s->stages; j++) {
    s->rate[j] = s->g[j];
    for (int i = 0; i < N; i++)
      s->rate[j] += s->g_q[i * s->stages + j] *
                    (s->next[i * s->lanes + j] - s->Z[i * s->lanes + j]);
    s->rate[j] *= s->weight[j];
    for (int i = 0; i < N; i++)
      s->u[i * s->stages + j] = s->rate[j] * (s->inverse_mass[i] * s->P[i * s->lanes + j]);
  }
}

static void plain_places(const dvi__rescaled_sums *s)
{
  for (int i = 0; i < N; i++)
    for (int j = 0; j < s->stages; j++)
      s->next[i * s->lanes + j] = row_sum(s->stages, s->lanes, s->place, j, s->u + i * s->stages);
}

static void plain_move(dvi__rescaled_sums *s)
{
  s->change = s->largest = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < s->stages; j++) {
      const int at = i * s->lanes + j;
      s->change = fmax(s->change, fabs(s->next[at] - s->Z[at]));
      s->largest = fmax(s->largest, fabs(s->next[at]));
      s->Z[at] = s->next[at];
      s->Q[i * s->stages + j] = s->origin[i] + s->Z[at];
    }
}

static void plain_iterate(dvi__rescaled_sums *s)
{
  for (int k = 0; k < N * s->lanes; k++) s->next[k] = s->Z[k];
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    plain_forces(s);
    plain_momenta(s);
    plain_rates(s);
    plain_places(s);
  }
  plain_move(s);
}

/* ---- tests ---- */

static void check_rows(int stages, const double *one, const double *other)
{
  ck_assert_mem_eq(one, other, (size_t)(N * stages) * sizeof(double));
}

static void check_padded(int stages, int lanes, const double *one, const double *other)
{
  for (int i = 0; i < N; i++)
    ck_assert_mem_eq(one + i * lanes, other + i * lanes, (size_t)stages * sizeof(double));
}

START_TEST(an_iteration_has_the_bits_of_plain_loops)
{
  const int level = _i / STAGES_MOST, stages = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  numbers own, plain;
  fill_numbers(stages, lanes, &own);
  fill_numbers(stages, lanes, &plain);
  dvi__rescaled_sums s = sums_of(stages, lanes, &own), reference = sums_of(stages, lanes, &plain);
  dvi__lanes_choose(level);
  dvi__rescaled_begin(&s);
  plain_momenta(&reference);
  plain_places(&reference);
  plain_move(&reference);
  check_padded(stages, lanes, own.P, plain.P);
  check_rows(stages, own.Q, plain.Q);
  for (int k = 0; k < 3; k++) {
    dvi__rescaled_iterate(&s);
    plain_iterate(&reference);
    ck_assert_double_eq(s.change, reference.change);
    ck_assert_double_eq(s.largest, reference.largest);
  }
  check_padded(stages, lanes, own.P, plain.P);
  check_padded(stages, lanes, own.Z, plain.Z);
  check_rows(stages, own.u, plain.u);
  check_rows(stages, own.f, plain.f);
  check_rows(stages, own.Q, plain.Q);
  ck_assert_mem_eq(own.rate, plain.rate, (size_t)stages * sizeof(double));
}
END_TEST

/* A change that is NaN must not look like a small one. */
START_TEST(one_number_that_is_not_a_number_is_seen_anywhere)
{
  const int level = _i / STAGES_MOST, stages = 1 + _i % STAGES_MOST, lanes = dvi__lanes_for(stages);
  for (int k = 0; k < N * stages; k++) {
    numbers own;
    fill_numbers(stages, lanes, &own);
    dvi__rescaled_sums s = sums_of(stages, lanes, &own);
    dvi__lanes_choose(level);
    own.V_q[k] = (double)NAN;
    dvi__rescaled_iterate(&s);
    ck_assert_double_nan(s.change);
    ck_assert_double_nan(s.largest);
  }
}
END_TEST

START_TEST(powers_of_distances_have_the_bits_of_plain_loops)
{
  enum { COUNT = 31 };
  double x[COUNT], power[COUNT];
  dvi__lanes_choose(_i);
  for (int count = 0; count <= COUNT; count++) {
    for (int k = 0; k < count; k++) x[k] = exp(sin(1.0 + k + count) * 20);
    dvi__rescaled_distances((size_t)count, x, power);
    for (int k = 0; k < count; k++) ck_assert_double_eq(power[k], 1 / sqrt(x[k] * sqrt(x[k])));
  }
}
END_TEST

SUITE(rescaled)
{
  tcase_add_checked_fixture(tests, NULL, best_again);
  tcase_add_loop_test(tests, an_iteration_has_the_bits_of_plain_loops, 0,
                      dvi__lanes_levels() * STAGES_MOST);
  tcase_add_loop_test(tests, powers_of_distances_have_the_bits_of_plain_loops, 0,
                      dvi__lanes_levels());
  tcase_add_loop_test(tests, one_number_that_is_not_a_number_is_seen_anywhere, 0,
                      dvi__lanes_levels() * STAGES_MOST);
}
