/* Constraints that make the arcs of all cells one length,
 *
 *     phi_a = l_{a+1} - l_a,     l = sqrt(h^2 + sigma^2 |Du|^2),
 *
 * which is the equidistribution of the monitor sqrt(1 + sigma^2 u_x^2), held at all times. A mesh
 * that is moved between steps by such a rule has no action, and this one does. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

/* The length of a cell, and its derivatives by the numbers of the right end. Those by the left end
 * are their negatives. */
typedef struct arc {
  double length, by[DVI__NODE_NUMBERS];
} arc;

static double scale(const dvi_moving *m, int number)
{
  return number == 0 ? 1 : m->stretch;
}

static int measure(const dvi_moving *m, const double *q, int cell, arc *l)
{
  double y[4 * DVI__NODE_NUMBERS], sum = 0;
  const int returned = dvi__moving_gather(m, &(dvi__moving_state){.q = q},
                                          m->cell.corner + 2 * cell, 2, y);
  if (returned != 0) return returned;
  for (int k = 0; k < m->numbers; k++) {
    l->by[k] = scale(m, k) * (y[m->numbers + k] - y[k]);
    sum += l->by[k] * l->by[k];
  }
  l->length = sqrt(sum);
  for (int k = 0; k < m->numbers; k++) l->by[k] *= scale(m, k) / l->length;
  return 0;
}

/* Give the coordinate of a number of a node, or -1. */
static int coordinate(const dvi_moving *m, int node, int number)
{
  return m->unknown[node % m->nodes * m->numbers + number];
}

/* Constraint a has the numbers of the nodes a to a + 2. Node `cells` of a ring is node 0. */
dvi_status dvi__moving_lay_out_arcs(dvi_moving *m)
{
  const int count = m->cells - 1;
  m->arcs = (dvi__pattern){m->unknowns, count, DVI_NEW(int, m->cells),
                           DVI_NEW(int, 3 * (size_t)count * (size_t)m->numbers)};
  if (m->arcs.start == NULL || m->arcs.row == NULL)
    return dvi__fail(DVI_NO_MEMORY, "moving: no memory for %d constraints", count);
  for (int a = 0, entries = 0; a < count; a++) {
    const int wraps = m->periodic && a + 2 == m->cells;
    for (int i = 0; i < 3 * m->numbers; i++) {
      const int at = i / m->numbers, node = wraps ? (a + (at + 2) % 3) % m->nodes : a + at;
      const int row = coordinate(m, node, i % m->numbers);
      if (row >= 0) m->arcs.row[entries++] = row;
    }
    m->arcs.start[a + 1] = entries;
  }
  return DVI_OK;
}

int dvi__moving_arc_value(double t, const double *q, double *phi, void *user)
{
  const dvi_moving *m = user;
  double last = 0;
  (void)t;
  for (int e = 0; e < m->cells; e++) {
    arc l = {0};
    const int returned = measure(m, q, e, &l);
    if (returned != 0) return returned;
    if (e > 0) phi[e - 1] = l.length - last;
    last = l.length;
  }
  return 0;
}

/* Add a derivative of the length of cell e to a column. */
static void add(const dvi_moving *m, int e, int column, double sign, const arc *l, double *phi_q)
{
  for (int i = 0; i < 2 * m->numbers && column >= 0 && column < m->cells - 1; i++) {
    const int right = i / m->numbers, row = coordinate(m, e + right, i % m->numbers);
    const double by = right ? l->by[i % m->numbers] : -l->by[i % m->numbers];
    if (row >= 0) phi_q[dvi__pattern_find(&m->arcs, row, column)] += sign * by;
  }
}

int dvi__moving_arc_gradient(double t, const double *q, double *phi_q, void *user)
{
  const dvi_moving *m = user;
  (void)t;
  memset(phi_q, 0, (size_t)dvi__pattern_entries(&m->arcs) * sizeof *phi_q);
  for (int e = 0; e < m->cells; e++) {
    arc l = {0};
    const int returned = measure(m, q, e, &l);
    if (returned != 0) return returned;
    add(m, e, e - 1, 1, &l, phi_q);
    add(m, e, e, -1, &l, phi_q);
  }
  return 0;
}

/* The second derivatives of a length are (s_k s_j delta_kj - l_k l_j)/l, with signs of the ends. */
int dvi__moving_arc_hessian(double t, const double *q, const double *w, double *phi_w_qq,
                            void *user)
{
  const dvi_moving *m = user;
  const int n = m->numbers;
  (void)t;
  memset(phi_w_qq, 0, (size_t)dvi__pattern_entries(&m->pattern) * sizeof *phi_w_qq);
  for (int e = 0; e < m->cells; e++) {
    arc l = {0};
    const int returned = measure(m, q, e, &l);
    if (returned != 0) return returned;
    const double weight = (e > 0 ? w[e - 1] : 0) - (e + 1 < m->cells ? w[e] : 0);
    const int *entry = m->cell.entry + (size_t)e * (size_t)(4 * n * n);
    for (int i = 0; i < 4 * n * n; i++) {
      const int k = i / (2 * n), j = i % (2 * n);
      const double square = k % n == j % n ? scale(m, k % n) * scale(m, k % n) : 0;
      const double by = weight * (square - l.by[k % n] * l.by[j % n]) / l.length;
      if (entry[i] >= 0) phi_w_qq[entry[i]] += k / n == j / n ? by : -by;
    }
  }
  return 0;
}
