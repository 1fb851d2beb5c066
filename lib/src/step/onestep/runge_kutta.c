/* The built-in tableaus. */
#include "step/onestep/runge_kutta.h"

#include <dvi/quadrature.h>
#include <math.h>
#include <string.h>

#include "step/onestep/collocation.h"
#include "core/hash.h"
#include "core/status.h"

#define ROOT_3 1.73205080756887729353
#define ROOT_21 4.58257569495584000659

enum { ROWS_MOST = 11 };

/* An explicit method has rows a_i of 1, 2, ... numbers for the stages behind the first. c is
 * computed. */
typedef struct rows {
  int stages, order;
  double a[ROWS_MOST - 1][ROWS_MOST - 1], b[ROWS_MOST];
} rows;

/* Euler 1768. */
static const rows euler = {
    .stages = 1,
    .order = 1,
    .b = {1},
};

/* Runge 1895. */
static const rows explicit_midpoint = {
    .stages = 2,
    .order = 2,
    .a = {{1.0 / 2}},
    .b = {0, 1},
};

/* Heun 1900. This is the explicit trapezoid of order 2, which is also called Heun's method. */
static const rows heun = {
    .stages = 2,
    .order = 2,
    .a = {{1}},
    .b = {1.0 / 2, 1.0 / 2},
};

/* Kutta 1901. */
static const rows kutta_3 = {
    .stages = 3,
    .order = 3,
    .a = {{1.0 / 2}, {-1, 2}},
    .b = {1.0 / 6, 2.0 / 3, 1.0 / 6},
};

static const rows rk_4 = {
    .stages = 4,
    .order = 4,
    .a = {{1.0 / 2}, {0, 1.0 / 2}, {0, 0, 1}},
    .b = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6},
};

static const rows three_eighths = {
    .stages = 4,
    .order = 4,
    .a = {{1.0 / 3}, {-1.0 / 3, 1}, {1, -1, 1}},
    .b = {1.0 / 8, 3.0 / 8, 3.0 / 8, 1.0 / 8},
};

/* Dormand and Prince 1980, table 2, without the stage of the error estimate. */
static const rows dormand_prince = {
    .stages = 6,
    .order = 5,
    .a = {{1.0 / 5},
          {3.0 / 40, 9.0 / 40},
          {44.0 / 45, -56.0 / 15, 32.0 / 9},
          {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
          {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}},
    .b = {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};

/* Butcher 1964. */
static const rows butcher_6 = {
    .stages = 7,
    .order = 6,
    .a = {{1.0 / 3},
          {0, 2.0 / 3},
          {1.0 / 12, 1.0 / 3, -1.0 / 12},
          {-1.0 / 16, 9.0 / 8, -3.0 / 16, -3.0 / 8},
          {0, 9.0 / 8, -3.0 / 8, -3.0 / 4, 1.0 / 2},
          {9.0 / 44, -9.0 / 11, 63.0 / 44, 18.0 / 11, 0, -16.0 / 11}},
    .b = {11.0 / 120, 0, 27.0 / 40, 27.0 / 40, -4.0 / 15, -4.0 / 15, 11.0 / 120},
};

/* Cooper and Verner 1972. */
static const rows cooper_verner = {
    .stages = 11,
    .order = 8,
    .a = {{1.0 / 2},
          {1.0 / 4, 1.0 / 4},
          {1.0 / 7, (-7 - 3 * ROOT_21) / 98, (21 + 5 * ROOT_21) / 49},
          {(11 + ROOT_21) / 84, 0, (18 + 4 * ROOT_21) / 63, (21 - ROOT_21) / 252},
          {(5 + ROOT_21) / 48, 0, (9 + ROOT_21) / 36, (-231 + 14 * ROOT_21) / 360,
           (63 - 7 * ROOT_21) / 80},
          {(10 - ROOT_21) / 42, 0, (-432 + 92 * ROOT_21) / 315, (633 - 145 * ROOT_21) / 90,
           (-504 + 115 * ROOT_21) / 70, (63 - 13 * ROOT_21) / 35},
          {1.0 / 14, 0, 0, 0, (14 - 3 * ROOT_21) / 126, (13 - 3 * ROOT_21) / 63, 1.0 / 9},
          {1.0 / 32, 0, 0, 0, (91 - 21 * ROOT_21) / 576, 11.0 / 72, (-385 - 75 * ROOT_21) / 1152,
           (63 + 13 * ROOT_21) / 128},
          {1.0 / 14, 0, 0, 0, 1.0 / 9, (-733 - 147 * ROOT_21) / 2205, (515 + 111 * ROOT_21) / 504,
           (-51 - 11 * ROOT_21) / 56, (132 + 28 * ROOT_21) / 245},
          {0, 0, 0, 0, (-42 + 7 * ROOT_21) / 18, (-18 + 28 * ROOT_21) / 45,
           (-273 - 53 * ROOT_21) / 72, (301 + 53 * ROOT_21) / 72, (28 - 28 * ROOT_21) / 45,
           (49 - 7 * ROOT_21) / 18}},
    .b = {1.0 / 20, 0, 0, 0, 0, 0, 0, 49.0 / 180, 16.0 / 45, 49.0 / 180, 1.0 / 20},
};

static void fill_explicit(const rows *of, dvi__runge_kutta *m)
{
  m->order = of->order;
  for (int i = 1; i < of->stages; i++)
    for (int j = 0; j < i; j++) m->c[i] += m->a[i][j] = of->a[i - 1][j];
  memcpy(m->b, of->b, (size_t)of->stages * sizeof *m->b);
}

/* Fill a tableau by collocation at the nodes of a rule. The rules are Gauss, Lobatto (IIIA) and
 * Radau with the right end (IIA). The order is that of the rule. Source: Hairer and Wanner 1996,
 * sec. IV.5. */
static dvi_status runge_kutta_fill_collocation(dvi_rule rule, dvi__runge_kutta *m)
{
  const int s = m->stages;
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST];
  DVI_TRY(dvi_quadrature(rule, s, m->c, m->b));
  DVI_TRY(dvi__collocate(s, m->c, a));
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) m->a[i][j] = a[i][j];
  m->order = dvi_quadrature_order(rule, s);
  return DVI_OK;
}

/* Fill a diagonally implicit tableau with one number g on the diagonal. The orders are 3 (Norsett
 * 1974) and 4 (Crouzeix 1975). Source: Hairer and Wanner 1996, tables IV.6.4, IV.6.5. */
static void fill_sdirk(dvi__runge_kutta *m)
{
  const double g = m->stages == 2 ? (3 + ROOT_3) / 6 : cos(acos(-1.0) / 18) / ROOT_3 + 0.5,
               d = 1 / (6 * (2 * g - 1) * (2 * g - 1));
  m->order = m->stages + 1;
  for (int i = 0; i < m->stages; i++) m->a[i][i] = g;
  m->c[0] = g;
  if (m->stages == 2) {
    m->a[1][0] = m->c[1] = 1 - 2 * g;
    m->c[1] += g;
    m->b[0] = m->b[1] = 0.5;
    return;
  }
  m->a[1][0] = 0.5 - g;
  m->a[2][0] = 2 * g;
  m->a[2][1] = 1 - 4 * g;
  m->c[1] = 0.5;
  m->c[2] = 1 - g;
  m->b[0] = m->b[2] = d;
  m->b[1] = 1 - 2 * d;
}

/* A built-in method is an explicit tableau, collocation by a rule, or SDIRK. */
static const struct entry {
  const char *name;
  const rows *rows;
  dvi_rule rule;
  int fewest, most;
} entries[DVI__RK_NAMED] = {
    {"euler", &euler, 0, 1, 1},
    {"explicit-midpoint", &explicit_midpoint, 0, 2, 2},
    {"heun", &heun, 0, 2, 2},
    {"kutta3", &kutta_3, 0, 3, 3},
    [DVI__RK_4] = {"rk4", &rk_4, 0, 4, 4},
    {"three-eighths", &three_eighths, 0, 4, 4},
    {"dormand-prince", &dormand_prince, 0, 6, 6},
    {"butcher6", &butcher_6, 0, 7, 7},
    {"cooper-verner", &cooper_verner, 0, 11, 11},
    {"backward-euler", NULL, DVI_RADAU_RIGHT, 1, 1},
    {"implicit-midpoint", NULL, DVI_GAUSS, 1, 1},
    {"gauss", NULL, DVI_GAUSS, 2, DVI__STAGES_MOST},
    {"radau-iia", NULL, DVI_RADAU_RIGHT, 2, DVI__STAGES_MOST},
    {"lobatto-iiia", NULL, DVI_LOBATTO, 2, DVI__STAGES_MOST},
    {"sdirk", NULL, DVI_MIDPOINT, 2, 3},
};

const char *dvi__runge_kutta_name(int i)
{
  return i >= 0 && i < DVI__RK_NAMED ? entries[i].name : NULL;
}

void dvi__runge_kutta_range(int i, int *fewest, int *most)
{
  *fewest = entries[i].fewest;
  *most = entries[i].most;
}

/* Compare the method with its adjoint, which has a*_ij = b_j - a_{s+1-i,s+1-j} and the same b,
 * backwards. */
void dvi__runge_kutta_classify(dvi__runge_kutta *m)
{
  const int s = m->stages;
  m->is_explicit = m->symmetric = 1;
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      m->is_explicit &= j < i || m->a[i][j] == 0;
      m->symmetric &= fabs(m->a[i][j] + m->a[s - 1 - i][s - 1 - j] - m->b[j]) <= 1e-14 &&
                      fabs(m->b[j] - m->b[s - 1 - j]) <= 1e-14;
    }
}

dvi_status dvi__runge_kutta_named(int i, int stages, dvi__runge_kutta *method)
{
  const struct entry *of = &entries[i];
  *method = (dvi__runge_kutta){.stages = stages};
  if (of->rows != NULL)
    fill_explicit(of->rows, method);
  else if (of->rule == DVI_MIDPOINT)
    fill_sdirk(method);
  else
    DVI_TRY(runge_kutta_fill_collocation(of->rule, method));
  dvi__runge_kutta_classify(method);
  return DVI_OK;
}

uint64_t dvi__runge_kutta_fingerprint(const dvi__runge_kutta *m)
{
  const size_t row = (size_t)m->stages * sizeof(double);
  uint64_t hash = dvi__hash(DVI__HASH_START, row, m->b);
  hash = dvi__hash(hash, row, m->c);
  for (int i = 0; i < m->stages; i++) hash = dvi__hash(hash, row, m->a[i]);
  return hash;
}
