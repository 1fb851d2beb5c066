/* One tent.
 *
 * The discrete action of a k-form A on a mesh of spacetime with the metric (+,..,+,-) is
 *
 *     S = -1/2 (dA).M_{k+1} (dA),   stationary: the row of d^T M_{k+1} d A of each k-cell is 0,
 *
 * with the circumcentric star and its signs, the sum of what the (n+1)-simplices contribute. The
 * state is a front over the mesh of space. A tent raises its vertex v to v', with one new simplex
 * for each n-cell around v. It completes the rows of the k-cells s at v. Each of them has one
 * unknown, A on the raised cell s', by way of the only new (k+1)-cell at s, which has v and v':
 *
 *     row of s from below + row of s from the other cells of the tent = M (A(s') - A(s)).
 *
 * k-cells with both v and v' have A = 0, a gauge. Their rows say that the charge at v is conserved,
 * and hold by themselves. What the tent adds to the rows of the s', and of cells on its rim, is all
 * that the front needs to know of the past.
 *
 * Where light has the speed c = (eps mu)^(-1/2) in a cell, the metric of its simplices has c t in
 * place of t, and their part of the action the weight (eps/mu)^(1/2).
 *
 * Sources: Stern 2009, sec. 3.4.4; Erickson, Guoy, Sullivan and Ungor 2005 for tents. */
#include <math.h>

#include "core/status.h"
#include "field/tents/front.h"

/* The sum of pieces of a dual cell is zero if it is below this part of them. */
static const double cancelled = 1e-10;

typedef struct tent {
  const dvi__tents *of;
  dvi__front *front;
  int vertex;
  double top; /* the time of v' */
} tent;

/* A simplex of the tent. In the ascending order of its corners, v' follows v, which is corner
 * number `at`. */
typedef struct simplex {
  int64_t cell; /* of space */
  int at;
  double *weight; /* of M_{k+1}, by the set of corners */
} simplex;

/* ---- sets of corners ---- */

static int lower(const simplex *s)
{
  return 1 << s->at;
}

static int upper(const simplex *s)
{
  return 2 << s->at;
}

static int has_both(const simplex *s, int set)
{
  const int pole = lower(s) | upper(s);
  return (set & pole) == pole;
}

/* Return the cell of space under a face. */
static int64_t under(const tent *t, const simplex *s, int set)
{
  const int before = set & (lower(s) - 1), after = (set & ~(2 * upper(s) - 1)) >> 1,
            at_pole = (set & (lower(s) | upper(s))) != 0 ? lower(s) : 0;
  return dvi__face_of(t->of, s->cell, before | at_pole | after);
}

/* Return the sign with which a face without one of its corners belongs to its boundary. */
static int sign_without(int set, int corner)
{
  return __builtin_popcount((unsigned)(set & (corner - 1))) % 2 == 0 ? 1 : -1;
}

/* ---- the star ---- */

/* Times are taken from that of v, so that no digit is lost. */
static void place(const tent *t, const simplex *s, dvi__placed *placed)
{
  dvi__placed cell;
  const dvi_mesh *mesh = t->of->mesh;
  const int n = mesh->n, space = mesh->space, *corner = mesh->corner[n] + s->cell * (n + 1);
  dvi__place_cell(mesh, n, s->cell, &cell);
  placed->corners = n + 2;
  placed->space = space + 1;
  placed->metric = t->of->metric;
  for (int c = 0; c < n + 2; c++) {
    const int from = c <= s->at ? c : c - 1;
    const double time = c == s->at + 1 ? t->top : t->front->time[corner[from]];
    const dvi__twofold later = dvi__exact_sum(time, -t->front->time[t->vertex]),
                       light = dvi__twofold_times(later, (dvi__twofold){t->of->speed[s->cell], 0});
    for (int l = 0; l < space; l++) {
      placed->x[c][l] = cell.x[from][l];
      placed->tail[c][l] = cell.tail[from][l];
    }
    placed->x[c][space] = light.head;
    placed->tail[c][space] = light.tail;
  }
}

static dvi_status weigh(const tent *t, const simplex *s)
{
  dvi__placed placed;
  dvi__duals duals;
  const dvi__sets *raised = &t->of->raised;
  const int n = t->of->mesh->n;
  place(t, s, &placed);
  if (dvi__duals_of(&placed, n + 1, t->of->k + 1, &duals) != 0) {
    const dvi__cell_name name = dvi__name_cell(t->of->mesh, n, s->cell);
    return dvi__fail(DVI_SINGULAR,
                     "tents: over %s, between t = %.6g and %.6g, a face of spacetime has no "
                     "volume: take a smaller fraction",
                     name.text, t->front->time[t->vertex], t->top);
  }
  for (int i = 0; i < raised->count; i++) {
    const int set = raised->set[i];
    s->weight[set] = t->of->weight[s->cell] * duals.piece[set] / duals.volume[set];
  }
  return DVI_OK;
}

/* ---- rows ---- */

/* Give dA on a (k+1)-face. */
static double flux(const tent *t, const simplex *s, int set)
{
  const dvi__tents *w = t->of;
  if (has_both(s, set)) {
    const int risen = set & ~lower(s);
    return sign_without(set, lower(s)) * w->rise[under(t, s, risen)];
  }
  double sum = w->base[under(t, s, set)];
  for (int corner = 1; corner <= set; corner *= 2) {
    if (!(set & corner)) continue;
    const int64_t cell = under(t, s, set & ~corner);
    const double risen = (set & ~corner & upper(s)) != 0 ? w->rise[cell] : 0;
    sum += sign_without(set, corner) * (t->front->A[cell] + risen);
  }
  return sum;
}

/* Add M dA of a (k+1)-face to the rows of its k-faces, but not to those of k-faces in `closed`, and
 * not to those of the gauge. */
static void add_to_rows(const tent *t, const simplex *s, int set, int closed)
{
  const double H = s->weight[set] * flux(t, s, set);
  for (int corner = 1; corner <= set; corner *= 2) {
    const int facet = set & ~corner;
    if (set & corner && !(facet & closed))
      t->of->row[under(t, s, facet)] += sign_without(set, corner) * H;
  }
}

static void add_old_face(const tent *t, const simplex *s, int set)
{
  add_to_rows(t, s, set, 0);
}

static void add_new_face(const tent *t, const simplex *s, int set)
{
  add_to_rows(t, s, set, lower(s));
}

static void add_dual(const tent *t, const simplex *s, int set)
{
  const int64_t cell = under(t, s, set & ~upper(s));
  t->of->dual[cell] += s->weight[set];
  t->of->size[cell] += fabs(s->weight[set]);
}

/* ---- the tent ---- */

static simplex simplex_of(const tent *t, int i)
{
  const dvi_mesh *mesh = t->of->mesh;
  const int64_t cell = t->of->cells.cell[t->of->cells.start[t->vertex] + i];
  const int *corner = mesh->corner[mesh->n] + cell * (mesh->n + 1);
  simplex s = {.cell = cell, .weight = t->of->star_of + (ptrdiff_t)i * DVI__CORNER_SETS};
  while (corner[s.at] != t->vertex) s.at++;
  return s;
}

static int count_simplices(const tent *t)
{
  return (int)(t->of->cells.start[t->vertex + 1] - t->of->cells.start[t->vertex]);
}

static void begin_rows(const tent *t)
{
  const dvi__tents *w = t->of;
  for (int i = 0; i < count_simplices(t); i++) {
    const simplex s = simplex_of(t, i);
    for (int f = 0; f < w->faces.count; f++) {
      const int64_t cell = dvi__face_of(w, s.cell, w->faces.set[f]);
      w->row[cell] = t->front->row[cell];
      w->rise[cell] = w->dual[cell] = w->size[cell] = 0;
    }
  }
}

/* Complete the rows from below, and sum up the dual cells of the new ones. */
static dvi_status add_below(const tent *t)
{
  const dvi__sets *raised = &t->of->raised;
  for (int i = 0; i < count_simplices(t); i++) {
    const simplex s = simplex_of(t, i);
    DVI_TRY(weigh(t, &s));
    for (int f = 0; f < raised->count; f++)
      if (has_both(&s, raised->set[f]))
        add_dual(t, &s, raised->set[f]);
      else if (!(raised->set[f] & upper(&s)))
        add_old_face(t, &s, raised->set[f]);
  }
  return DVI_OK;
}

static dvi_status refuse_dual(const tent *t, int64_t cell)
{
  const dvi__cell_name name = dvi__name_cell(t->of->mesh, t->of->k, cell);
  return dvi__fail(DVI_SINGULAR,
                   "tents: over %s, between t = %.6g and %.6g, the dual cell has the weight %.3g, "
                   "which should be below 0: take a mesh with acute angles, or a smaller fraction",
                   name.text, t->front->time[t->vertex], t->top, t->of->dual[cell]);
}

/* A force pushes in equal parts at the ends of its pole. A row grows against it, as M_k E does. */
static double half_impulse(const tent *t, int cell)
{
  const double *force = t->of->force;
  return force != NULL ? -0.5 * force[cell] * (t->top - t->front->time[t->vertex]) : 0;
}

static dvi_status solve_rows(const tent *t)
{
  const dvi__tents *w = t->of;
  for (int64_t i = w->values.start[t->vertex]; i < w->values.start[t->vertex + 1]; i++) {
    const int cell = w->values.cell[i];
    if (!w->held[cell]) {
      if (!(w->dual[cell] < -cancelled * w->size[cell])) return refuse_dual(t, cell);
      w->rise[cell] = (w->row[cell] + half_impulse(t, cell)) / w->dual[cell];
    }
    w->row[cell] = half_impulse(t, cell);
  }
  return DVI_OK;
}

static void add_above(const tent *t)
{
  const dvi__sets *raised = &t->of->raised;
  for (int i = 0; i < count_simplices(t); i++) {
    const simplex s = simplex_of(t, i);
    for (int f = 0; f < raised->count; f++)
      if (raised->set[f] & upper(&s)) add_new_face(t, &s, raised->set[f]);
  }
}

static dvi_status check_finite(const tent *t)
{
  const dvi__tents *w = t->of;
  for (int i = 0; i < count_simplices(t); i++) {
    const simplex s = simplex_of(t, i);
    for (int f = 0; f < w->faces.count; f++) {
      const int64_t cell = dvi__face_of(w, s.cell, w->faces.set[f]);
      if (isfinite(w->row[cell]) && isfinite(t->front->A[cell] + w->rise[cell])) continue;
      const dvi__cell_name name = dvi__name_cell(w->mesh, w->k, cell);
      return dvi__fail(DVI_NOT_FINITE,
                       "tents: the value of %s is not finite at t = %.6g: the fraction %.3g may be "
                       "too large",
                       name.text, t->top, w->fraction);
    }
  }
  return DVI_OK;
}

static void commit(const tent *t)
{
  const dvi__tents *w = t->of;
  for (int i = 0; i < count_simplices(t); i++) {
    const simplex s = simplex_of(t, i);
    for (int f = 0; f < w->faces.count; f++) {
      const int64_t cell = dvi__face_of(w, s.cell, w->faces.set[f]);
      t->front->row[cell] = w->row[cell];
    }
  }
  for (int64_t i = w->values.start[t->vertex]; i < w->values.start[t->vertex + 1]; i++)
    t->front->A[w->values.cell[i]] += w->rise[w->values.cell[i]];
  t->front->time[t->vertex] = t->top;
  t->front->rises[t->vertex]++;
  t->front->tents++;
}

dvi_status dvi__tent_pitch(const dvi__tents *tents, dvi__front *front, int vertex, double top)
{
  const tent t = {.of = tents, .front = front, .vertex = vertex, .top = top};
  begin_rows(&t);
  DVI_TRY(add_below(&t));
  DVI_TRY(solve_rows(&t));
  add_above(&t);
  DVI_TRY(check_finite(&t));
  commit(&t);
  return DVI_OK;
}
