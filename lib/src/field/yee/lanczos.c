/* The largest eigenvalue of M_1^-1 d_1^T M_2 d_1 by Lanczos' method (field/algebra/ritz.h) in the
 * scalar product of M_1. The rows of the march itself apply the operator. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/ritz.h"
#include "field/yee/ranks.h"
#include "num/philox.h"

enum { VECTORS = 3 };

/* The iteration: vectors w, v, and the one before it, as states, and the matrix T. */
typedef struct lanczos {
  dvi__yee grid; /* a march without losses, layers and sources, with a step of 1 */
  double *vector[VECTORS][2];
  dvi__ritz T;
} lanczos;

/* ---- vectors ---- */

typedef void row_work(const lanczos *l, int c, const int *first, double *x, const double *z,
                      void *numbers);

/* Work on all rows of E of x and z, from their places `first` on. */
static void for_rows_of(const lanczos *l, double **x, double **z, row_work *work, void *numbers)
{
  const dvi__yee *y = &l->grid;
  int first[3] = {0, 0, 0};
  for (int copy = 0; copy < y->copies; copy++)
    for (int c = 0; c < 3; c++) {
      if (y->slot[c] < 0) continue;
      for (first[2] = dvi__yee_begin(y, 2); first[2] < dvi__yee_end(y, c, 2); first[2]++)
        for (first[1] = dvi__yee_begin(y, 1); first[1] < dvi__yee_end(y, c, 1); first[1]++) {
          const size_t at = dvi__yee_at(y, c, first[1], first[2]);
          work(l, c, first, x[copy] + at, z[copy] + at, numbers);
        }
    }
}

static void add_product(const lanczos *l, int c, const int *first, double *x, const double *z,
                        void *sum)
{
  const int places = dvi__yee_places(&l->grid, c, 0);
  double *star = l->grid.scratch;
  dvi__yee_stars(&l->grid, c, first, places, star);
  for (int i = 0; i < places; i++) dvi__block_sum_add(sum, star[i] * x[i] * z[i]);
}

static double product(const lanczos *l, double **x, double **z)
{
  dvi__block_sum sum = {.count = 0};
  for_rows_of(l, x, z, add_product, &sum);
  return dvi__yee_sum_of_all(&l->grid, dvi__block_sum_end(&sum));
}

static void combine_row(const lanczos *l, int c, const int *first, double *x, const double *z,
                        void *numbers)
{
  const int places = dvi__yee_places(&l->grid, c, 0);
  const double *factors = numbers, a = factors[0], b = factors[1];
  (void)first;
  for (int i = 0; i < places; i++) x[i] = a * x[i] + b * z[i];
}

/* x <- a x + b z */
static void combine(const lanczos *l, double a, double **x, double b, double **z)
{
  double factors[2] = {a, b};
  for_rows_of(l, x, z, combine_row, factors);
}

static void for_all_rows(const dvi__yee *y, const dvi__yee_worker *worker,
                         void (*update)(const dvi__yee_worker *worker, int j, int k))
{
  for (int k = y->own[2][0]; k < y->own[2][1]; k++)
    for (int j = y->own[1][0]; j < y->own[1][1]; j++) update(worker, j, k);
}

/* Replace w by A v. Rows need E behind the last node, where v has copies, too. */
static void apply(lanczos *l, double **v, double **w)
{
  dvi__yee *y = &l->grid;
  const dvi__yee_worker worker = {y, y->scratch, NULL};
  for (int copy = 0; copy < y->copies; copy++) {
    memset(w[copy], 0, y->size * sizeof(double));
    y->state[copy] = w[copy];
  }
  combine(l, 0, w, 1, v);
  dvi__yee_wrap_values(y);
  for_all_rows(y, &worker, dvi__yee_update_faces);
  dvi__yee_pass_faces(y);
  combine(l, 0, y->state, 0, y->state);
  for_all_rows(y, &worker, dvi__yee_update_edges);
  combine(l, -1, y->state, 0, y->state);
}

/* Parts in all eigenvectors, which are orthonormal in M_1, are alike at random. */
static void start_vector(lanczos *l, double **v)
{
  const dvi__yee *y = &l->grid;
  const int64_t size = dvi__yee_form_size(y, DVI_FORM_E);
  for (int64_t i = 0; i < size; i++) {
    int c, place[3];
    dvi__yee_place_of(y, DVI_FORM_E, i, &c, place);
    const int64_t number = dvi__yee_whole_number(y, c, place);
    uint32_t bits[4] = {(uint32_t)number, (uint32_t)(number >> 32), 0, 0};
    const int is_unknown = dvi__yee_is_unknown(y, c, place);
    dvi__philox(bits, 1);
    const size_t at = dvi__yee_at(y, c, place[1], place[2]) + (size_t)place[0];
    for (int copy = 0; copy < y->copies && is_unknown; copy++)
      v[copy][at] = (bits[copy] / 4294967296.0 - 0.5) / sqrt(dvi__yee_star(y, c, place));
  }
  const double norm = sqrt(product(l, v, v));
  combine(l, norm > 0 ? 1 / norm : 0, v, 0, v);
}

/* ---- iteration ---- */

static double iterate(lanczos *l, double other)
{
  const int64_t unknowns = l->grid.copies * dvi__yee_whole_size(&l->grid, DVI_FORM_E);
  double **before = l->vector[0], **v = l->vector[1], **w = l->vector[2], bound = 0;
  start_vector(l, v);
  while (!dvi__ritz_suffices(&l->T, unknowns, other, &bound)) {
    const int j = l->T.steps++;
    if (j > 0) {
      double **free_one = before;
      before = v, v = w, w = free_one;
      combine(l, 1 / l->T.beta[j], v, 0, v);
    }
    apply(l, v, w);
    l->T.alpha[j] = product(l, w, v);
    combine(l, 1, w, -l->T.alpha[j], v);
    if (j > 0) combine(l, 1, w, -l->T.beta[j], before);
    l->T.beta[j + 1] = sqrt(product(l, w, w));
  }
  return bound;
}

dvi_status dvi__yee_lanczos(const dvi__yee *y, double other, double *bound)
{
  dvi_status status = DVI_OK;
  lanczos *l = DVI_NEW(lanczos, 1);
  double *scratch = DVI_NEW(double, DVI__YEE_SCRATCH * y->width);
  if (l == NULL || scratch == NULL) status = DVI_NO_MEMORY;
  for (int i = 0; i < VECTORS && l != NULL; i++)
    for (int copy = 0; copy < y->copies; copy++) {
      l->vector[i][copy] = DVI_NEW(double, y->size + DVI__YEE_LEFT);
      if (l->vector[i][copy] == NULL) status = DVI_NO_MEMORY;
    }
  if (status != DVI_OK) status = dvi__fail(status, "yee: no memory for Lanczos's vectors");
  status = dvi__yee_agree(y, status);
  if (status == DVI_OK) {
    l->grid = *y;
    l->grid.scratch = scratch;
    l->grid.dt = 1;
    l->grid.lanes = dvi__yee_lanes_in_use();
    for (int axis = 0; axis < 3; axis++)
      for (int e = 0; e < 2; e++) l->grid.axis[axis].layers[e].count = 0;
    *bound = iterate(l, other);
    status = dvi__yee_check_ranks(y);
  }
  for (int i = 0; i < VECTORS && l != NULL; i++)
    for (int copy = 0; copy < 2; copy++) dvi__release(l->vector[i][copy]);
  dvi__release(l);
  dvi__release(scratch);
  return status;
}
