/* The updates of one row of boxes. Every value gets the same operations in the same order, however
 * rows are divided into tiles and threads. */
#include <string.h>

#include "field/yee/yee.h"

/* The differences of a row: p along the axis after the component's, q along the one after that. */
typedef struct differences {
  const double *p1, *p0, *q1, *q0;
} differences;

/* Give the address of a row that is that far from another one. The next rows of the sweep need E
 * of the next plane, and B of this one. Nothing is read there, so the end of the state does not
 * matter. */
static uintptr_t needed_soon(const double *row, ptrdiff_t away)
{
  return (uintptr_t)row + (uintptr_t)(away * (ptrdiff_t)sizeof *row);
}

/* ---- absorbing layers ---- */

/* Give the layers in which a box, or a node, of an axis is, or -1. */
static int layers_with(const dvi__yee_axis *a, int i)
{
  for (int e = 0; e < 2; e++)
    if (i >= a->layers[e].first && i < a->layers[e].first + a->layers[e].count) return e;
  return -1;
}

/* Change the difference along an axis by its layers, in a row across the axis. */
static void stretch_across(const dvi__yee_worker *w, int copy, int axis, int which, int j, int k,
                           dvi__yee_layers_row *row)
{
  const dvi__yee *y = w->yee;
  const dvi__yee_axis *a = &y->axis[axis];
  const int i = axis == 1 ? j : k, e = layers_with(a, i), form = which < 2;
  const dvi__yee_layers *l = &a->layers[e];
  const int layer = i - l->first, at = i - l->start;
  row->psi = l->psi + dvi__yee_psi_at(y, axis, e, copy, which, layer, j, k);
  row->soon = (uintptr_t)(4 * y->width * (size_t)(axis == 1 ? 1 : l->count) * sizeof(double));
  row->b = l->b[form][at];
  row->a = l->a[form][at];
  row->r = l->r[form][at];
  row->up = l->up[form][at];
  row->down = l->down[form][at];
  y->lanes->layers(row);
}

/* Change the differences of a component across rows, along y and z. */
static void stretch(const dvi__yee_worker *w, int copy, int component, int j, int k,
                    const differences *d, double *f, const double *ce)
{
  const int c = component % 3, is_face = component >= DVI__YEE_B;
  for (int side = 0; side < 2; side++) {
    const int axis = (c + 1 + side) % 3, which = (is_face ? 0 : 2) + (side == 0);
    if (axis == 0 || layers_with(&w->yee->axis[axis], axis == 1 ? j : k) < 0) continue;
    dvi__yee_layers_row row = {.count = w->yee->count,
                               .f = f,
                               .p1 = side == 0 ? d->p1 : d->q1,
                               .p0 = side == 0 ? d->p0 : d->q0,
                               .sign = (side == 0) == is_face ? -1 : 1,
                               .ce = ce};
    stretch_across(w, copy, axis, which, j, k, &row);
  }
}

/* Change the differences along x of the second and third component, at both ends of their rows. The
 * arguments begin at the places 0 of the rows. */
static void stretch_ends(const dvi__yee *y, int copy, int is_face, int j, int k,
                         const dvi__yee_layers_end *whole)
{
  const int form = is_face;
  for (int e = 0; e < 2; e++) {
    const dvi__yee_layers *l = &y->axis[0].layers[e];
    if (l->count == 0) continue;
    dvi__yee_layers_end end = *whole;
    end.count = (size_t)l->width;
    end.psi = l->psi + dvi__yee_psi_at(y, 0, e, copy, is_face ? 0 : 2, 0, j, k);
    end.b = l->b[form];
    end.a = l->a[form];
    end.r = l->r[form];
    end.up = l->up[form];
    end.down = l->down[form];
    for (int c = 0; c < 2; c++) {
      if (end.of[c].f == NULL) continue;
      end.of[c].f += l->start;
      end.of[c].p1 += l->start;
      end.of[c].p0 += l->start;
      if (end.of[c].ce != NULL) end.of[c].ce += l->start;
    }
    y->lanes->layers_end(&end);
  }
}

static int has_layers_along(const dvi__yee *y)
{
  return y->axis[0].layers[0].count + y->axis[0].layers[1].count > 0;
}

/* ---- acts, ends and copies ---- */

static void act(const dvi__yee_worker *w, const dvi__yee_acts *acts, int j, int k)
{
  if (acts->count == 0) return;
  const dvi__yee *y = w->yee;
  const size_t row = dvi__yee_row(y, j, k);
  double *f = y->state[0] + row * (size_t)y->components * y->width;
  for (int64_t n = acts->row[row]; n < acts->row[row + 1]; n++) {
    const dvi__yee_act *a = &acts->act[n];
    f[a->place] += a->w[0] * w->drive[a->from] + a->w[1] * w->drive[a->from + 1];
  }
}

/* Multiply `count` numbers at `from` by the phase, or with a negative sign by its inverse, to
 * `to`. */
static void copy_with_phase(const dvi__yee *y, const dvi__yee_axis *a, double sign, size_t from,
                            size_t to, size_t count)
{
  if (y->copies == 1) {
    memcpy(y->state[0] + to, y->state[0] + from, count * sizeof(double));
    return;
  }
  const double sine = sign * a->sine;
  for (size_t i = 0; i < count; i++) {
    const double re = y->state[0][from + i], im = y->state[1][from + i];
    y->state[0][to + i] = a->cosine * re - sine * im;
    y->state[1][to + i] = a->cosine * im + sine * re;
  }
}

/* Copy what the other end of x needs of a row: E at node 0, or B of the last box. */
static void copy_along(const dvi__yee *y, int component, int j, int k)
{
  const dvi__yee_axis *x = &y->axis[0];
  const size_t at = dvi__yee_at(y, component, j, k), n = (size_t)x->cells;
  if (!x->wraps || component % 3 == 0) return;
  if (component < DVI__YEE_B)
    copy_with_phase(y, x, 1, at, at + n, 1);
  else
    copy_with_phase(y, x, -1, at + n - 1, at - 1, 1);
}

/* Copy the rows of E or B at (j, k) to those at (to_j, to_k). */
static void copy_rows(const dvi__yee *y, int component, const dvi__yee_axis *a, int j, int k,
                      int to_j, int to_k)
{
  const int is_face = component >= DVI__YEE_B;
  const size_t skipped = is_face ? (size_t)y->edges_slots * y->width : 0,
               slots = (size_t)(is_face ? y->components - y->edges_slots : y->edges_slots),
               block = (size_t)y->components * y->width;
  copy_with_phase(y, a, is_face ? -1 : 1, dvi__yee_row(y, j, k) * block + skipped,
                  dvi__yee_row(y, to_j, to_k) * block + skipped, slots * y->width);
}

/* Copy what another end of an axis needs: E at node 0 to behind the last node, and B of the last
 * box to before the first one. Along a divided axis other processes have it. */
static void copy_around(const dvi__yee *y, int component, int j, int k)
{
  const dvi__yee_axis *across = &y->axis[1], *up = &y->axis[2];
  const int is_face = component >= DVI__YEE_B;
  const int from_j = is_face ? across->cells - 1 : 0, from_k = is_face ? up->cells - 1 : 0,
            to_j = is_face ? -1 : across->cells, to_k = is_face ? -1 : up->cells;
  if (across->wraps && !dvi__yee_is_divided(y, 1) && j == from_j)
    copy_rows(y, component, across, j, k, to_j, k);
  if (up->wraps && !dvi__yee_is_divided(y, 2) && k == from_k)
    copy_rows(y, component, up, j, k, j, to_k);
}

void dvi__yee_wrap_rows(const dvi__yee *y, int j, int k)
{
  for (int component = 0; component < 6; component++)
    if (y->slot[component] >= 0) copy_along(y, component, j, k);
  copy_around(y, DVI__YEE_E, j, k);
  copy_around(y, DVI__YEE_B, j, k);
}

/* ---- faces ---- */

static void update_face(const dvi__yee_worker *w, int copy, int c, int j, int k)
{
  const dvi__yee *y = w->yee;
  const int a = (c + 1) % 3, b = (c + 2) % 3;
  double *state = y->state[copy], *f = state + dvi__yee_at(y, DVI__YEE_B + c, j, k);
  const double *p = y->slot[b] >= 0 ? state + dvi__yee_at(y, b, j, k) : f,
               *q = y->slot[a] >= 0 ? state + dvi__yee_at(y, a, j, k) : f;
  const differences d = {y->slot[b] >= 0 ? p + y->next[a] : p, p,
                         y->slot[a] >= 0 ? q + y->next[b] : q, q};
  const dvi__yee_faces_row row = {
      y->count, f,
      d.p1,     d.p0,
      d.q1,     d.q0,
      y->dt,    needed_soon(f, y->next[1] + y->next[2] - y->edges_slots * (ptrdiff_t)y->width)};
  y->lanes->faces(&row);
  stretch(w, copy, DVI__YEE_B + c, j, k, &d, f, NULL);
}

/* The components that reach along x have no place at the last node. */
static void end_faces(const dvi__yee *y, int c, int j, int k)
{
  const size_t last = dvi__yee_at(y, DVI__YEE_B + c, j, k) + (size_t)y->axis[0].cells;
  for (int copy = 0; copy < y->copies && c != 0; copy++) y->state[copy][last] = 0;
  copy_along(y, DVI__YEE_B + c, j, k);
}

static int has_face(const dvi__yee *y, int c, int j, int k)
{
  const int component = DVI__YEE_B + c;
  return y->slot[component] >= 0 && j < dvi__yee_places(y, component, 1) &&
         k < dvi__yee_places(y, component, 2);
}

/* B_y has the difference of E_z along x, and B_z that of E_y. */
static void stretch_faces_along(const dvi__yee *y, int copy, int j, int k)
{
  dvi__yee_layers_end end = {.count = 0};
  for (int c = 1; c < 3; c++) {
    if (!has_face(y, c, j, k)) continue;
    end.of[c - 1].f = y->state[copy] + dvi__yee_at(y, DVI__YEE_B + c, j, k);
    end.of[c - 1].p0 = y->state[copy] + dvi__yee_at(y, 3 - c, j, k);
    end.of[c - 1].p1 = end.of[c - 1].p0 + 1;
    end.of[c - 1].sign = c == 1 ? 1 : -1;
  }
  stretch_ends(y, copy, 1, j, k, &end);
}

void dvi__yee_update_faces(const dvi__yee_worker *w, int j, int k)
{
  const dvi__yee *y = w->yee;
  for (int copy = 0; copy < y->copies; copy++) {
    for (int c = 0; c < 3; c++)
      if (has_face(y, c, j, k)) update_face(w, copy, c, j, k);
    if (has_layers_along(y)) stretch_faces_along(y, copy, j, k);
  }
  act(w, &y->on_faces, j, k);
  for (int c = 0; c < 3; c++)
    if (has_face(y, c, j, k)) end_faces(y, c, j, k);
  copy_around(y, DVI__YEE_B, j, k);
}

/* ---- edges ---- */

/* The rows of H that the edges at (j, k) need: H_b there, and one place before along an axis. */
typedef struct fields {
  const double *here[3], *before[3][3]; /* [b], [b][axis] */
} fields;

/* Give the row of H from that of B at `at` and of 1/mu at `beside`, in the scratch row *next if mu
 * is not 1. */
static const double *take_field(const dvi__yee_worker *w, int copy, size_t at, size_t beside,
                                double **next)
{
  const dvi__yee *y = w->yee;
  const double *B = y->state[copy] + at;
  double *H = *next;
  if (y->mi == NULL) return B;
  *next += y->width;
  y->lanes->product(y->width, y->mi + beside - DVI__YEE_LEFT, B - DVI__YEE_LEFT, H);
  return H + DVI__YEE_LEFT;
}

/* Each row is multiplied once, for all differences that have it. */
static void take_fields(const dvi__yee_worker *w, int copy, int j, int k, fields *f)
{
  const dvi__yee *y = w->yee;
  double *next = w->scratch;
  for (int b = 0; b < 3; b++) {
    if (y->slot[DVI__YEE_B + b] < 0) continue;
    const size_t at = dvi__yee_at(y, DVI__YEE_B + b, j, k), beside = dvi__yee_at_faces(y, b, j, k);
    f->here[b] = take_field(w, copy, at, beside, &next);
    f->before[b][0] = f->here[b] - 1;
    for (int axis = 1; axis < 3; axis++) {
      const size_t back = (size_t)y->next[axis], blocks = back / (size_t)y->components,
                   shrunk = blocks * (size_t)(y->components - y->edges_slots);
      f->before[b][axis] = axis == b || back == 0
                               ? f->here[b]
                               : take_field(w, copy, at - back, beside - shrunk, &next);
    }
  }
}

/* Give the differences of E_c, whose factors are 0 where there is no such H. */
static differences differences_of(const dvi__yee *y, int c, const fields *f, const double *none)
{
  const int a = (c + 1) % 3, b = (c + 2) % 3;
  differences d = {none, none, none, none};
  if (y->slot[DVI__YEE_B + b] >= 0) d.p1 = f->here[b], d.p0 = f->before[b][a];
  if (y->slot[DVI__YEE_B + a] >= 0) d.q1 = f->here[a], d.q0 = f->before[a][b];
  return d;
}

/* Set the factors of the differences of a row of E_c. */
static void set_metric(const dvi__yee *y, int c, int j, int k, dvi__yee_edges_row *row)
{
  const int at[3] = {y->axis[0].free[0], j, k}, a = (c + 1) % 3, b = (c + 2) % 3;
  const dvi__yee_axis *p = &y->axis[a], *q = &y->axis[b], *x = &y->axis[0];
  row->p_up = p->up[at[a]];
  row->p_down = p->down[at[a]];
  row->q_up = q->up[at[b]];
  row->q_down = q->down[at[b]];
  row->up = x->up;
  row->down = x->down;
  row->metric = row->p_up == row->p_down && row->q_up == row->q_down ? DVI__YEE_EQUAL
                                                                     : DVI__YEE_ACROSS;
  if (c != 0 && !x->is_uniform) row->metric = a == 0 ? DVI__YEE_P_ALONG : DVI__YEE_Q_ALONG;
}

/* Give the scratch row that keeps E_c of before the update, where it loses. */
static double *row_before(const dvi__yee_worker *w, int c)
{
  return w->scratch + (size_t)(DVI__YEE_SCRATCH - 3 + c) * w->yee->width;
}

/* Add s (E+ + E-) to what has been conducted. */
static void wear(const dvi__yee_worker *w, int c, int j, int k)
{
  const dvi__yee *y = w->yee;
  const size_t at = dvi__yee_at_edges(y, c, j, k);
  const double *s = y->loss + at, *before = row_before(w, c),
               *e = y->state[0] + dvi__yee_at(y, c, j, k);
  double *worn = y->worn + at;
  for (int i = 0; i <= y->axis[0].cells; i++) worn[i] += s[i] * (before[i] + e[i]);
}

static void update_edge(const dvi__yee_worker *w, int copy, int c, int j, int k, const fields *f)
{
  const dvi__yee *y = w->yee;
  const size_t beside = dvi__yee_at_edges(y, c, j, k);
  double *e = y->state[copy] + dvi__yee_at(y, c, j, k);
  const differences d = differences_of(y, c, f, e);
  dvi__yee_edges_row row = {
      .count = y->count,
      .e = e,
      .p1 = d.p1,
      .p0 = d.p0,
      .q1 = d.q1,
      .q0 = d.q0,
      .ce = y->ce != NULL ? y->ce + beside : NULL,
      .ca = dvi__yee_loses(y, c, j, k) ? y->ca + beside : NULL,
      .soon = needed_soon(e, y->next[1] + y->edges_slots * (ptrdiff_t)y->width)};
  set_metric(y, c, j, k, &row);
  y->lanes->edges(&row);
  stretch(w, copy, c, j, k, &d, e, row.ce);
}

/* Update the row of E_c, but keep what stands at ends of x without an unknown. */
static void update_edge_row(const dvi__yee_worker *w, int copy, int c, int j, int k,
                            const fields *f)
{
  const dvi__yee *y = w->yee;
  const dvi__yee_axis *x = &y->axis[0];
  const int n = x->cells, keeps_lower = c != 0 && x->free[0] > 0,
            keeps_upper = c != 0 && !x->wraps && x->free[1] <= n;
  double *e = y->state[copy] + dvi__yee_at(y, c, j, k);
  const double lower = e[0], upper = e[n];
  if (dvi__yee_loses(y, c, j, k))
    memcpy(row_before(w, c), e, y->count * sizeof *e);
  else if (y->wall != NULL)
    dvi__yee_keep_before(y, c, j, k, e, row_before(w, c));
  update_edge(w, copy, c, j, k, f);
  if (keeps_lower) e[0] = lower;
  if (keeps_upper) e[n] = upper;
}

static int has_edge(const dvi__yee *y, int c, int j, int k)
{
  return y->slot[c] >= 0 && dvi__yee_is_free(y, c, 1, j) && dvi__yee_is_free(y, c, 2, k);
}

/* E_y has the difference of H_z along x, and E_z that of H_y. */
static void stretch_edges_along(const dvi__yee *y, int copy, int j, int k, const fields *f)
{
  dvi__yee_layers_end end = {.count = 0};
  for (int c = 1; c < 3; c++) {
    if (!has_edge(y, c, j, k)) continue;
    const size_t beside = dvi__yee_at_edges(y, c, j, k);
    end.of[c - 1].f = y->state[copy] + dvi__yee_at(y, c, j, k);
    end.of[c - 1].p1 = f->here[3 - c];
    end.of[c - 1].p0 = f->before[3 - c][0];
    end.of[c - 1].ce = y->ce != NULL ? y->ce + beside : NULL;
    end.of[c - 1].sign = c == 1 ? -1 : 1;
  }
  stretch_ends(y, copy, 0, j, k, &end);
}

void dvi__yee_update_edges(const dvi__yee_worker *w, int j, int k)
{
  const dvi__yee *y = w->yee;
  for (int copy = y->copies - 1; copy >= 0; copy--) { /* the real one last, for its rows before */
    fields f = {.here = {NULL}};
    take_fields(w, copy, j, k, &f);
    for (int c = 0; c < 3; c++)
      if (has_edge(y, c, j, k)) update_edge_row(w, copy, c, j, k, &f);
    if (has_layers_along(y)) stretch_edges_along(y, copy, j, k, &f);
    for (int c = 0; c < 3 && y->wall != NULL; c++)
      if (has_edge(y, c, j, k))
        dvi__yee_absorb(y, c, j, k, row_before(w, c), y->state[copy] + dvi__yee_at(y, c, j, k));
  }
  act(w, &y->on_edges, j, k);
  for (int c = 0; c < 3; c++)
    if (has_edge(y, c, j, k) && dvi__yee_loses(y, c, j, k)) wear(w, c, j, k);
  for (int c = 1; c < 3; c++)
    if (has_edge(y, c, j, k)) copy_along(y, c, j, k);
  copy_around(y, DVI__YEE_E, j, k);
}
