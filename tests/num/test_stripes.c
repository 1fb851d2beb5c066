/* labels: unit */
/* Chebyshev sums of sparse matrices, against the same recurrence with rows of a full matrix. */
#include "num/stripes.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "support/suite.h"

enum { MOST = 700, DEGREE = 40, OFFSETS = 4 };

/* Symmetric, with these diagonals, which may go around. */
static const int offset[OFFSETS] = {1, 2, 7, 300};

static int start[MOST + 1], row[MOST * (2 * OFFSETS + 1)];
static double values[MOST * (2 * OFFSETS + 1)], full[MOST][MOST];

static double entry(int i, int j)
{
  return 0.1 * sin(1.0 + i * j + i + j) + (i == j ? 1 : 0);
}

static dvi__pattern make(int n, int offsets, int ring)
{
  memset(full, 0, sizeof full);
  for (int i = 0; i < n; i++) {
    full[i][i] = entry(i, i);
    for (int k = 0; k < offsets; k++) {
      const int j = i + offset[k];
      if (j >= n && !ring) continue;
      full[i][j % n] = full[j % n][i] = entry(i, j % n);
    }
  }
  int at = 0;
  for (int i = 0; i < n; i++) {
    start[i] = at;
    for (int j = 0; j < n; j++)
      if (full[i][j] != 0) {
        row[at] = j;
        values[at++] = full[i][j];
      }
  }
  start[n] = at;
  return (dvi__pattern){.rows = n, .columns = n, .start = start, .row = row};
}

static double scale[MOST], room[8][MOST + 16], c[4 * (DEGREE + 1)];

/* Clenshaw's recurrence as it is, for T_k of G/2 - 1. */
static void reference(int n, int lanes, double shift, const double *const x[2], double y[2][MOST])
{
  static double one[2][MOST], two[2][MOST], product[2][MOST];
  memset(one, 0, sizeof one);
  memset(two, 0, sizeof two);
  for (int k = DEGREE; k >= 0; k--) {
    for (int l = 0; l < lanes; l++)
      for (int i = 0; i < n; i++) {
        product[l][i] = -(shift + 2) * one[l][i];
        for (int j = 0; j < n; j++) product[l][i] += scale[i] * full[i][j] * one[l][j];
      }
    for (int l = 0; l < lanes; l++)
      for (int i = 0; i < n; i++) {
        double sum = (k > 0 ? 1 : 0.5) * product[l][i] - two[l][i];
        for (int j = 0; j < lanes; j++) sum += c[(k * lanes + l) * lanes + j] * x[j][i];
        two[l][i] = one[l][i];
        one[l][i] = sum;
      }
  }
  memcpy(y, one, sizeof one);
}

static const struct {
  int n, offsets, ring;
} matrices[] = {{1, 0, 0},   {3, 1, 0},   {4, 1, 0},   {5, 1, 1},  {101, 2, 0},
                {603, 1, 0}, {603, 3, 1}, {700, 4, 0}, {602, 4, 1}};
enum { MATRICES = sizeof matrices / sizeof *matrices };

START_TEST(sums_are_those_of_the_full_matrix)
{
  const int n = matrices[_i / 2].n, lanes = 1 + _i % 2;
  const dvi__pattern pattern = make(n, matrices[_i / 2].offsets, matrices[_i / 2].ring);
  static double y[2][MOST];
  dvi__stripes G;
  for (int i = 0; i < n; i++) scale[i] = 1 + 0.2 * cos(i);
  for (int k = 0; k < 4 * (DEGREE + 1); k++) c[k] = cos(k) / (1 + 0.1 * k);
  ck_assert_int_eq(dvi__stripes_fill(&pattern, values, scale, 0.1, &G), DVI_OK);
  ck_assert_uint_le(2 * G.room, sizeof room[0] / sizeof(double) * 2);
  double *const x = room[0], *const d = room[2], *const b = room[4], *const other = room[6];
  memset(room, 0, sizeof room);
  const double *const lane[] = {x + DVI__STRIPES_MARGIN, x + G.room + DVI__STRIPES_MARGIN};
  for (int l = 0; l < lanes; l++)
    for (int i = 0; i < n; i++)
      x[(size_t)l * G.room + DVI__STRIPES_MARGIN + (size_t)i] = sin(3.0 * i + l);
  dvi__stripes_sum(&(dvi__clenshaw){
      .G = &G, .lanes = lanes, .degree = DEGREE, .c = c, .x = x, .d = d, .b = b, .other = other});
  reference(n, lanes, 0.1, lane, y);
  for (int l = 0; l < lanes; l++)
    for (int i = 0; i < n; i++) /* sums of size 10 to 100 */
      ck_assert_double_eq_tol(d[(size_t)l * G.room + DVI__STRIPES_MARGIN + (size_t)i], y[l][i],
                              1e-11);
  dvi__stripes_clear(&G);
}
END_TEST

/* G x = 0. Only C_k T_k(-1) are added, in each row alike, and the rows stay alike. */
START_TEST(where_the_matrix_vanishes_rows_stay_alike)
{
  static const double zeros[3] = {1, 2, 3}, even[3] = {1, 1, 1};
  static int three[] = {0, 1, 2, 3}, own[] = {0, 1, 2};
  const dvi__pattern pattern = {.rows = 3, .columns = 3, .start = three, .row = own};
  dvi__stripes G;
  for (int k = 0; k <= DEGREE; k++) c[k] = k % 2 == 0 ? 1 : 0.5;
  memset(room, 0, sizeof room);
  for (int i = 0; i < 3; i++) room[0][DVI__STRIPES_MARGIN + i] = zeros[i];
  ck_assert_int_eq(dvi__stripes_fill(&pattern, even, even, 1, &G), DVI_OK);
  dvi__stripes_sum(&(dvi__clenshaw){.G = &G,
                                    .lanes = 1,
                                    .degree = DEGREE,
                                    .c = c,
                                    .x = room[0],
                                    .d = room[2],
                                    .b = room[4],
                                    .other = room[6]});
  /* 21 - 20/2 */
  for (int i = 0; i < 3; i++) ck_assert_double_eq(room[2][DVI__STRIPES_MARGIN + i], 11 * zeros[i]);
  dvi__stripes_clear(&G);
}
END_TEST

SUITE(stripes)
{
  tcase_add_loop_test(tests, sums_are_those_of_the_full_matrix, 0, 2 * MATRICES);
  tcase_add_test(tests, where_the_matrix_vanishes_rows_stay_alike);
}
