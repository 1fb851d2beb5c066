/* The matrix pencil.
 *
 * A Hankel matrix H_p(i, j) = y_p(i+j) of sums of exponentials has the rows of
 *
 *     V = span { (1, z_k, z_k^2 ..) },
 *
 * for each probe. The right singular vectors of all H_p, one above the other, whose singular values
 * are no noise, are a basis of V. Without its last row it is V_0, without the first one V_1, and
 *
 *     V_0 Phi = V_1   has   eig Phi = { z_k }.
 *
 * Source: Hua and Sarkar 1990, sec. III; for several series at once Sarkar and Pereira 1995. */
#include "field/spectra/pencil.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/spectra/complex_matrix.h"

enum { BLOCK = 64, COLUMNS = 512 };

static int64_t smaller(int64_t a, int64_t b)
{
  return a < b ? a : b;
}

/* Columns are one more than poles. All Hankel matrices together are about square, as long as the
 * columns are not too many. */
int dvi__poles_most(int length, int probes)
{
  const int64_t square = (int64_t)length * probes / (probes + 1), half = length / 2,
                limit = half > COLUMNS ? half : COLUMNS;
  return (int)smaller(square, smaller(limit, 3 * (int64_t)length / 4));
}

double dvi__hankel_size(int length, int probes)
{
  const int most = dvi__poles_most(length, probes), columns = most + 1, rows = length - most;
  return sqrt((double)rows * columns * probes);
}

/* The arrays of the pencil, for C columns and R rows of a Hankel matrix. */
typedef struct pencil {
  int rows, columns;
  double complex *stack;  /* [(C + R) * C] the triangle so far, and the next Hankel matrix */
  double complex *square; /* [C * C] */
  double complex *right;  /* [C * C] rows of conjugated right vectors */
  double complex *factor; /* [C] */
  double complex *work;   /* [BLOCK * C] */
  double *singular;       /* [C] */
} pencil;

static dvi_status pencil_create(int length, int probes, pencil *p)
{
  const size_t columns = (size_t)dvi__poles_most(length, probes) + 1,
               rows = (size_t)length - columns + 1;
  *p = (pencil){.rows = (int)rows, .columns = (int)columns};
  p->stack = DVI_NEW(double complex, (columns + rows) * columns);
  p->square = DVI_NEW(double complex, columns *columns);
  p->right = DVI_NEW(double complex, columns *columns);
  p->factor = DVI_NEW(double complex, columns);
  p->work = DVI_NEW(double complex, BLOCK *columns);
  p->singular = DVI_NEW(double, columns);
  if (p->stack && p->square && p->right && p->factor && p->work && p->singular) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "spectrum: no memory for a Hankel matrix of %zu columns",
                   columns);
}

static void pencil_clear(pencil *p)
{
  dvi__release(p->stack);
  dvi__release(p->square);
  dvi__release(p->right);
  dvi__release(p->factor);
  dvi__release(p->work);
  dvi__release(p->singular);
}

/* Keep the upper triangle of the stack alone, and put the Hankel matrix of y below it. */
static void put_hankel(pencil *p, const double complex *y)
{
  const int64_t C = p->columns, lead = C + p->rows;
  for (int64_t j = 0; j < C; j++) {
    double complex *column = p->stack + j * lead;
    for (int64_t i = j + 1; i < C; i++) column[i] = 0;
    for (int64_t i = 0; i < p->rows; i++) column[C + i] = y[i + j];
  }
}

/* Set `square` to the triangle R of the Hankel matrices of all probes, whose right vectors are
 * theirs. */
static void triangulate(pencil *p, const dvi__exponentials *series)
{
  const int C = p->columns, lead = C + p->rows;
  for (int64_t k = 0; k < series->probes; k++) {
    put_hankel(p, series->y + k * series->length);
    dvi__complex_qr(lead, C, p->stack, p->factor, p->work);
  }
  for (int64_t j = 0; j < C; j++)
    memcpy(p->square + j * C, p->stack + j * lead, (size_t)(j + 1) * sizeof *p->square);
}

/* Solve V_0 Phi = V_1 for Phi [count*count] in the sense of least squares, in the stack. */
static int shift_matrix(pencil *p, int count, double complex *Phi)
{
  const int C = p->columns, rows = C - 1;
  double complex *V0 = p->stack, *V1 = p->square;
  for (int64_t k = 0; k < count; k++)
    for (int64_t i = 0; i < rows; i++) {
      V0[k * rows + i] = p->right[i * C + k];
      V1[k * rows + i] = p->right[(i + 1) * C + k];
    }
  dvi__complex_qr(rows, count, V0, p->factor, p->work);
  dvi__complex_reflect(rows, count, V0, p->factor, count, V1, p->work);
  if (!dvi__complex_back(rows, count, V0, rows, count, V1)) return 0;
  for (int64_t k = 0; k < count; k++)
    memcpy(Phi + k * count, V1 + k * rows, (size_t)count * sizeof *Phi);
  return 1;
}

/* Drop poles that decay, or grow, by more than roundoff from one sample to the next. */
static int drop_instants(int count, double complex *z)
{
  int kept = 0;
  for (int k = 0; k < count; k++)
    if (cabs(z[k]) > DBL_EPSILON && cabs(z[k]) < 1 / DBL_EPSILON) z[kept++] = z[k];
  return kept;
}

/* Estimate the largest singular value of noise from the smallest ones, of which a fifth at least
 * are noise. Those of a R x C matrix of independent numbers lie between sqrt(R) -+ sqrt(C)
 * (Marchenko and Pastur 1967), and a fifth of them below sqrt(R) - 0.685 sqrt(C). Hankel matrices
 * of noise, whose entries repeat, have some that are larger. */
static double largest_of_noise(const pencil *p, int probes)
{
  const double hankel = 1.6, ratio = sqrt((double)p->rows * probes / p->columns);
  const int most = p->columns - 1, fifth = most - 1 - most / 5;
  return hankel * (ratio + 1) / (ratio - 0.685) * p->singular[fifth];
}

static int rank_above(const pencil *p, double floor)
{
  int rank = 0;
  while (rank < p->columns - 1 && p->singular[rank] > floor) rank++;
  return rank;
}

static dvi_status solve_pencil(pencil *p, int probes, double floor, int *count, double complex *z)
{
  DVI_TRY(dvi__complex_svd(p->columns, p->square, p->singular, p->right));
  *count = rank_above(p, fmax(floor, largest_of_noise(p, probes)));
  if (*count == 0) return DVI_OK;
  double complex *Phi = p->right;
  if (!shift_matrix(p, *count, Phi)) {
    *count = 0; /* an impulse at the last sample grows from nothing */
    return DVI_OK;
  }
  DVI_TRY(dvi__complex_eigenvalues(*count, Phi, z));
  *count = drop_instants(*count, z);
  return DVI_OK;
}

dvi_status dvi__find_poles(const dvi__exponentials *series, double floor, int *count,
                           double complex *z)
{
  pencil p;
  dvi_status status = pencil_create(series->length, series->probes, &p);
  if (status == DVI_OK) {
    triangulate(&p, series);
    status = solve_pencil(&p, series->probes, floor, count, z);
  }
  pencil_clear(&p);
  return status;
}
