/* The numbers of a factor in dense panels, from the left to the right. Each panel is changed by the
 * panels before, one after the other, so that its sums have one order. */
#include "num/supernodal/supernodes.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/supernodal/layout.h"

/* Rows and columns of a product that stay in registers. */
enum { LANES = DVI__BEHIND / 2, ROWS = DVI__BEHIND, COLUMNS = 4 };

/* Columns that are eliminated one by one inside a panel. */
enum { STRIP = 8 };

typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

/* ---- create, destroy ---- */

void dvi__supernodes_destroy(dvi__supernodes **supernodes)
{
  dvi__supernodes *s = *supernodes;
  if (s == NULL) return;
  dvi__release(s->panel);
  dvi__release(s->panel_of);
  dvi__release(s->rows);
  dvi__release(s->numbers);
  dvi__release(s->place_of);
  dvi__release(s->first_of);
  dvi__release(s->scaled);
  dvi__release(s->product);
  dvi__release(s);
  *supernodes = NULL;
}

static dvi_status make_work(dvi__supernodes *s)
{
  const size_t panels = (size_t)s->panels;
  s->place_of = DVI_NEW(int, s->of.n);
  s->first_of = DVI_NEW(int, 3 * panels);
  s->scaled = DVI_NEW(double, DVI__PANEL_MOST *DVI__PANEL_MOST);
  s->product = DVI_NEW(double, ((size_t)s->tallest + ROWS) * DVI__PANEL_MOST);
  if (!s->place_of || !s->first_of || !s->scaled || !s->product)
    return dvi__fail(DVI_NO_MEMORY, "LDL: no memory for %d columns", s->of.n);
  s->next = s->first_of + panels;
  s->done = s->next + panels;
  return DVI_OK;
}

dvi_status dvi__supernodes_create(const dvi__elimination *elimination, dvi__supernodes **made)
{
  dvi__supernodes *s = *made = DVI_NEW(dvi__supernodes, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "LDL: no memory");
  s->of = *elimination;
  dvi_status status = dvi__supernodes_lay_out(s);
  if (status == DVI_OK) status = make_work(s);
  if (status != DVI_OK) dvi__supernodes_destroy(made);
  return status;
}

double dvi__supernodes_entries(const dvi__supernodes *supernodes)
{
  return (double)supernodes->count;
}

/* ---- products ---- */

/* C = B W with B [rows x terms], by columns of `stride` numbers, W [terms x columns], by rows, and
 * C [rows x columns], by columns of `tall` numbers, which have room for whole tiles. What is behind
 * the rows of B is read, and means nothing. */
typedef struct product {
  int rows, columns, terms;
  const double *B, *W;
  ptrdiff_t stride, tall;
  double *C;
} product;

/* Compute some rows and columns of C. All entries are sums in the order of the terms. */
static inline __attribute__((always_inline)) void multiply_tile(const product *p, int i, int j,
                                                                const int columns)
{
  lanes sum[COLUMNS][2] = {{{0}}};
  const double *b = p->B + i, *w = p->W + j;
  for (int k = 0; k < p->terms; k++, b += p->stride, w += p->columns) {
    lanes low, high;
    memcpy(&low, b, sizeof low);
    memcpy(&high, b + LANES, sizeof high);
    for (int c = 0; c < columns; c++) {
      sum[c][0] += w[c] * low;
      sum[c][1] += w[c] * high;
    }
  }
  for (int c = 0; c < columns; c++) memcpy(p->C + (j + c) * p->tall + i, sum[c], sizeof sum[c]);
}

/* Rows stay in the first cache for all columns. Entries above the diagonal of the first rows are
 * not needed, and some are not computed. */
WIDE static void multiply(const product *p)
{
  const int whole = p->columns / COLUMNS * COLUMNS, left = p->columns - whole;
  for (int i = 0; i < p->rows; i += ROWS) {
    for (int j = 0; j < whole && j < i + ROWS; j += COLUMNS) multiply_tile(p, i, j, COLUMNS);
    if (left == 3) multiply_tile(p, i, whole, 3);
    if (left == 2) multiply_tile(p, i, whole, 2);
    if (left == 1) multiply_tile(p, i, whole, 1);
  }
}

/* Multiply rows `from` on of a panel by D and by the transposed of the first `columns` of them,
 * over the first `terms` columns of the panel. */
static product multiply_panel(const dvi__supernodes *s, const dvi__panel *panel, const double *D,
                              int from, int columns, int terms)
{
  for (int k = 0; k < terms; k++)
    for (int c = 0; c < columns; c++)
      s->scaled[k * columns + c] = D[panel->first + k] *
                                   panel->L[(ptrdiff_t)k * panel->height + from + c];
  const product p = {.rows = panel->height - from,
                     .columns = columns,
                     .terms = terms,
                     .B = panel->L + from,
                     .W = s->scaled,
                     .stride = panel->height,
                     .tall = panel->height - from + ROWS,
                     .C = s->product};
  multiply(&p);
  return p;
}

/* ---- factor ---- */

static void enter_matrix(dvi__supernodes *s, const dvi__panel *p, const double *values)
{
  const dvi__elimination *e = &s->of;
  memset(p->L, 0, (size_t)p->width * (size_t)p->height * sizeof *p->L);
  for (int i = 0; i < p->height; i++) s->place_of[p->row[i]] = i;
  for (int j = 0; j < p->width; j++) {
    const int column = e->order[p->first + j];
    double *L = p->L + (ptrdiff_t)j * p->height;
    for (int at = e->start[column]; at < e->start[column + 1]; at++) {
      const int i = e->place[e->row[at]];
      if (i >= p->first + j) L[s->place_of[i]] = values[at];
    }
  }
}

/* Give a panel to the list of the panel that has its next row. */
static void pass_on(dvi__supernodes *s, int panel)
{
  const dvi__panel *p = s->panel + panel;
  if (s->done[panel] == p->height) return;
  const int to = s->panel_of[p->row[s->done[panel]]];
  s->next[panel] = s->first_of[to];
  s->first_of[to] = panel;
}

/* Take from a panel what an earlier one changes. */
static void subtract_other(dvi__supernodes *s, const dvi__panel *to, int other, const double *D)
{
  const dvi__panel *p = s->panel + other;
  const int from = s->done[other];
  int columns = 0;
  while (from + columns < p->height && p->row[from + columns] < to->first + to->width) columns++;
  const product change = multiply_panel(s, p, D, from, columns, p->width);
  for (int c = 0; c < columns; c++) {
    double *L = to->L + (ptrdiff_t)(p->row[from + c] - to->first) * to->height;
    const double *C = change.C + c * change.tall;
    for (int i = c; i < change.rows; i++) L[s->place_of[p->row[from + i]]] -= C[i];
  }
  s->done[other] = from + columns;
}

WIDE static void subtract(ptrdiff_t count, double factor, const double *restrict x,
                          double *restrict y)
{
  for (ptrdiff_t i = 0; i < count; i++) y[i] -= factor * x[i];
}

WIDE static void divide(ptrdiff_t count, double by, double *x)
{
  for (ptrdiff_t i = 0; i < count; i++) x[i] /= by;
}

/* Eliminate columns from `begin` to end-1, to which all columns before have been added. Returns the
 * first one whose pivot is not positive, or `end`. */
static int eliminate_strip(const dvi__panel *p, int begin, int end, double *D)
{
  for (int j = begin; j < end; j++) {
    double *L = p->L + (ptrdiff_t)j * p->height;
    const double pivot = D[p->first + j] = L[j];
    if (!(pivot > 0)) return j;
    divide(p->height - j - 1, pivot, L + j + 1);
    for (int k = j + 1; k < end; k++)
      subtract(p->height - k, pivot * L[k], L + k, p->L + (ptrdiff_t)k * p->height + k);
  }
  return end;
}

static int eliminate_panel(const dvi__supernodes *s, const dvi__panel *p, double *D)
{
  for (int begin = 0; begin < p->width; begin += STRIP) {
    const int end = begin + STRIP < p->width ? begin + STRIP : p->width;
    if (begin > 0) {
      const product change = multiply_panel(s, p, D, begin, end - begin, begin);
      for (int c = 0; c < change.columns; c++)
        subtract(change.rows - c, 1, change.C + c * change.tall + c,
                 p->L + (ptrdiff_t)(begin + c) * p->height + begin + c);
    }
    const int done = eliminate_strip(p, begin, end, D);
    if (done < end) return done;
  }
  return p->width;
}

int dvi__supernodes_factor(dvi__supernodes *s, const double *values, double *D)
{
  for (int i = 0; i < s->panels; i++) s->first_of[i] = -1;
  for (int i = 0; i < s->panels; i++) {
    const dvi__panel *p = s->panel + i;
    enter_matrix(s, p, values);
    for (int other = s->first_of[i], next; other >= 0; other = next) {
      next = s->next[other];
      subtract_other(s, p, other, D);
      pass_on(s, other);
    }
    const int done = eliminate_panel(s, p, D);
    if (done < p->width) return p->first + done;
    s->done[i] = p->width;
    pass_on(s, i);
  }
  return s->of.n;
}

/* ---- solve ---- */

/* Columns that a solution takes at a time, so that the vector beside them is read less often. */
enum { TOGETHER = 4 };

WIDE static void subtract_columns(ptrdiff_t count, ptrdiff_t stride, const double *restrict L,
                                  const double *restrict x, double *restrict y)
{
  for (ptrdiff_t i = 0; i < count; i++)
    y[i] = (((y[i] - L[i] * x[0]) - L[stride + i] * x[1]) - L[2 * stride + i] * x[2]) -
           L[3 * stride + i] * x[3];
}

/* Set sum [TOGETHER] to the products of columns with the vector, in the same lanes whatever the
 * processor has. */
WIDE static void dot_columns(ptrdiff_t count, ptrdiff_t stride, const double *restrict L,
                             const double *restrict y, double *restrict sum)
{
  lanes in_lanes[TOGETHER] = {{0}};
  ptrdiff_t i = 0;
  for (; i + LANES <= count; i += LANES) {
    lanes a, b;
    memcpy(&b, y + i, sizeof b);
    for (int c = 0; c < TOGETHER; c++) {
      memcpy(&a, L + c * stride + i, sizeof a);
      in_lanes[c] += a * b;
    }
  }
  for (int c = 0; c < TOGETHER; c++)
    sum[c] = (in_lanes[c][0] + in_lanes[c][1]) + (in_lanes[c][2] + in_lanes[c][3]);
  for (; i < count; i++)
    for (int c = 0; c < TOGETHER; c++) sum[c] += L[c * stride + i] * y[i];
}

static double dot(ptrdiff_t count, const double *restrict L, const double *restrict y)
{
  double sum = 0;
  for (ptrdiff_t i = 0; i < count; i++) sum += L[i] * y[i];
  return sum;
}

/* y <- L^-1 y by the columns of a panel. */
static void solve_forward(const dvi__panel *p, double *work, double *y)
{
  double *own = y + p->first;
  const ptrdiff_t width = p->width, height = p->height, below = height - width;
  for (ptrdiff_t i = 0; i < below; i++) work[i] = y[p->row[width + i]];
  for (ptrdiff_t j = 0; j < width; j++)
    for (ptrdiff_t i = j + 1; i < width; i++) own[i] -= p->L[j * height + i] * own[j];
  ptrdiff_t j = 0;
  for (; j + TOGETHER <= width; j += TOGETHER)
    subtract_columns(below, height, p->L + j * height + width, own + j, work);
  for (; j < width; j++) subtract(below, own[j], p->L + j * height + width, work);
  for (ptrdiff_t i = 0; i < below; i++) y[p->row[width + i]] = work[i];
}

/* y <- L^-T y by the columns of a panel. */
static void solve_backward(const dvi__panel *p, double *work, double *y)
{
  double *own = y + p->first;
  const ptrdiff_t width = p->width, height = p->height, below = height - width;
  for (ptrdiff_t i = 0; i < below; i++) work[i] = y[p->row[width + i]];
  double sum[DVI__PANEL_MOST];
  ptrdiff_t whole = 0;
  for (; whole + TOGETHER <= width; whole += TOGETHER)
    dot_columns(below, height, p->L + whole * height + width, work, sum + whole);
  for (; whole < width; whole++) sum[whole] = dot(below, p->L + whole * height + width, work);
  for (ptrdiff_t j = width - 1; j >= 0; j--)
    own[j] -= sum[j] + dot(width - j - 1, p->L + j * height + j + 1, own + j + 1);
}

void dvi__supernodes_solve(const dvi__supernodes *s, const double *D, double *y, double *work)
{
  for (int i = 0; i < s->panels; i++) solve_forward(s->panel + i, work, y);
  for (int k = 0; k < s->of.n; k++) y[k] /= D[k];
  for (int i = s->panels - 1; i >= 0; i--) solve_backward(s->panel + i, work, y);
}
