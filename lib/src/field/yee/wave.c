/* Plane waves by total and scattered field (Taflove and Hagness 2005, sec. 5.6).
 *
 * Edges in the box and on its surface have the total field, all others the scattered one, and so
 * have the faces outside of it. A difference over the surface lacks the incident field, or has too
 * much of it, and an act mends it. The incident field moves on a line of nodes along its direction,
 *     H_q -= dt/h_q (E_{q+1} - E_q),   E_q -= dt/h*_q (H_q - H_{q-1}),
 * whose node 0 follows the signal and whose end absorbs. Along an axis its nodes are those of the
 * grid, so that both fields move alike. Otherwise it is interpolated. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/yee.h"

enum { BEFORE = 3, TAIL = 60 };

struct dvi__yee_beam {
  int lower[3], upper[3];          /* nodes of the box */
  double direction[3], E[3], H[3]; /* unit vectors */
  int axis;                        /* the wave's axis, or -1 */
  int first;                       /* the axis' node at the line's node 0 */
  double corner[3], h; /* where the line has its node BEFORE, and its step, without an axis */
  double delay;        /* from node 0 to where the wave enters */
  dvi_yee_signal *signal;
  void *user;
  double next;                         /* the signal of the next step */
  int count;                           /* boxes of the line */
  int from;                            /* first of its drives: E [count+1], then H [count] */
  double *up, *down, *loss_E, *loss_H; /* [count+1] dt/h*, dt/h, and s = sigma dt/2 at both */
  double *line;                        /* E [count+1], H [count], of the state */
};

/* ---- checks ---- */

static dvi_status refuse(int number, const char *why)
{
  return dvi__fail(DVI_BAD_ARGUMENT, "yee: wave %d %s", number, why);
}

static double norm_of(const double *x)
{
  return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

static dvi_status set_directions(const dvi__yee *y, const dvi_yee_wave *wave, int number,
                                 dvi__yee_beam *beam)
{
  double k[3] = {0}, p[3];
  for (int l = 0; l < 3; l++) {
    if (l < y->axes) k[l] = wave->direction[l];
    p[l] = wave->polarization[l];
  }
  const double long_k = norm_of(k), long_p = norm_of(p);
  if (!(long_k > 0 && long_p > 0 && isfinite(long_k) && isfinite(long_p)))
    return refuse(number, "needs a direction in the grid and a polarization");
  if (fabs(k[0] * p[0] + k[1] * p[1] + k[2] * p[2]) > 1e-9 * long_k * long_p)
    return refuse(number, "has E along its direction; make them orthogonal");
  beam->axis = -1;
  for (int l = 0; l < 3; l++) {
    beam->direction[l] = k[l] / long_k;
    beam->E[l] = p[l] / long_p;
    if (fabs(beam->direction[l]) == 1) beam->axis = l;
    if (p[l] != 0 && y->slot[l] < 0)
      return refuse(number, "is polarized along a component of E that the grid lacks");
  }
  for (int l = 0; l < 3; l++) {
    const int a = (l + 1) % 3, b = (l + 2) % 3;
    beam->H[l] = beam->direction[a] * beam->E[b] - beam->direction[b] * beam->E[a];
  }
  return DVI_OK;
}

/* Tell if the box has a face at an end of an axis. One on the grid's own end is left out. */
static int has_surface(const dvi__yee *y, const dvi__yee_beam *beam, int axis, int end)
{
  return axis < y->axes &&
         (end == 0 ? beam->lower[axis] > 0 : beam->upper[axis] < y->axis[axis].cells);
}

static dvi_status set_box(const dvi__yee *y, const dvi_yee_wave *wave, int number,
                          dvi__yee_beam *beam)
{
  DVI_TRY(dvi__yee_check_inside(y, wave->lower, "the box of wave", number));
  DVI_TRY(dvi__yee_check_inside(y, wave->upper, "the box of wave", number));
  for (int l = 0; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    const double k = beam->direction[l];
    beam->lower[l] = l < y->axes ? dvi__yee_nearest(a, wave->lower[l]) : 0;
    beam->upper[l] = l < y->axes ? dvi__yee_nearest(a, wave->upper[l]) : 1;
    if (beam->lower[l] >= beam->upper[l]) return refuse(number, "has an empty box");
    if (k != 0 && !has_surface(y, beam, l, k < 0))
      return refuse(number, "enters its box at the end of the grid; leave a box outside of it");
    if (k != 0 && a->wraps && !has_surface(y, beam, l, k > 0))
      return refuse(number, "leaves its box at the end of an axis that repeats itself");
    for (int e = 0; e < 2; e++) {
      const int inner = e == 0 ? a->layers[0].count : a->layers[1].first,
                node = e == 0 ? beam->lower[l] : beam->upper[l];
      if (a->layers[e].count > 0 && has_surface(y, beam, l, e) &&
          (e == 0 ? node <= inner : node >= inner))
        return refuse(number, "has its surface in absorbing layers; make its box smaller");
    }
  }
  return DVI_OK;
}

/* ---- the line ---- */

/* Give the length of the line's box q, and of the dual one around node q. */
static double length_of(const dvi__yee *y, const dvi__yee_beam *beam, int q)
{
  if (beam->axis < 0) return beam->h;
  const dvi__yee_axis *a = &y->axis[beam->axis];
  const int cell = beam->direction[beam->axis] > 0 ? beam->first + q : beam->first - 1 - q;
  return a->length[cell < 0 ? 0 : cell < a->cells ? cell : a->cells - 1];
}

static double shortest(const dvi__yee *y)
{
  double h = (double)INFINITY;
  for (int l = 0; l < y->axes; l++)
    for (int i = 0; i < y->axis[l].cells; i++) h = fmin(h, y->axis[l].length[i]);
  return h;
}

/* Place the line's node 0 before the box, and count its boxes. */
static void place_line(const dvi__yee *y, dvi__yee_beam *beam)
{
  double extent = 0;
  beam->h = shortest(y);
  for (int l = 0; l < y->axes; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    const int near = beam->direction[l] < 0 ? beam->upper[l] : beam->lower[l];
    beam->corner[l] = a->node[near];
    extent += fabs(beam->direction[l]) * (a->node[beam->upper[l]] - a->node[beam->lower[l]]);
    if (l != beam->axis) continue;
    beam->first = beam->direction[l] < 0 ? near + 1 : near - 1;
    beam->count = beam->upper[l] - beam->lower[l] + 3;
  }
  if (beam->axis < 0) beam->count = BEFORE + (int)ceil(extent / beam->h) + 3;
  beam->delay = beam->axis < 0 ? BEFORE * beam->h : length_of(y, beam, 0);
  beam->count += TAIL;
}

static void set_line(const dvi__yee *y, dvi__yee_beam *beam)
{
  const int n = beam->count;
  const double depth = TAIL * length_of(y, beam, n - 1), most = -2 * log(1e-14) / depth;
  for (int q = 0; q <= n; q++) {
    const double h = length_of(y, beam, q < n ? q : n - 1),
                 before = length_of(y, beam, q > 0 ? q - 1 : 0),
                 rho = fmax(0, (double)(q - (n - TAIL)) / TAIL),
                 middle = fmax(0, (q + 0.5 - (n - TAIL)) / TAIL);
    beam->up[q] = y->dt / (0.5 * (h + before));
    beam->down[q] = y->dt / h;
    beam->loss_E[q] = 0.5 * y->dt * most * rho * rho * rho;
    beam->loss_H[q] = 0.5 * y->dt * most * middle * middle * middle;
  }
}

/* Take a step of H from the line's E, and of E from its H. */
static double next_H(const dvi__yee_beam *beam, int q)
{
  const double *E = beam->line, H = beam->line[beam->count + 1 + q], s = beam->loss_H[q];
  return ((1 - s) * H - beam->down[q] * (E[q + 1] - E[q])) / (1 + s);
}

static double next_E(const dvi__yee_beam *beam, int q)
{
  const double *H = beam->line + beam->count + 1, s = beam->loss_E[q];
  return ((1 - s) * beam->line[q] - beam->up[q] * (H[q] - H[q - 1])) / (1 + s);
}

static dvi_status signal_at(const dvi__yee_beam *beam, double t, double *value)
{
  *value = 0;
  const int failed = beam->signal(t + beam->delay, value, beam->user);
  if (failed == 0 && isfinite(*value)) return DVI_OK;
  return dvi__fail(failed != 0 ? DVI_CALLBACK_FAILED : DVI_NOT_FINITE,
                   failed != 0 ? "yee: the signal of a wave returned %g at t = %.17g"
                               : "yee: the signal of a wave is %g at t = %.17g",
                   failed != 0 ? failed : *value, t + beam->delay);
}

dvi_status dvi__yee_ask_waves(dvi__yee *y, double t)
{
  for (int i = 0; i < y->beams; i++) DVI_TRY(signal_at(&y->beam[i], t, &y->beam[i].next));
  return DVI_OK;
}

void dvi__yee_start_waves(dvi__yee *y)
{
  for (int i = 0; i < y->beams; i++) {
    dvi__yee_beam *beam = &y->beam[i];
    for (int q = 0; q < 2 * beam->count + 1; q++) beam->line[q] = y->drive[beam->from + q] = 0;
    beam->line[0] = beam->next;
  }
}

void dvi__yee_move_waves(dvi__yee *y, double *drive)
{
  for (int i = 0; i < y->beams; i++) {
    dvi__yee_beam *beam = &y->beam[i];
    const int n = beam->count;
    double *E = beam->line, *H = beam->line + n + 1;
    for (int q = 0; q <= n; q++) drive[beam->from + q] = E[q];
    for (int q = 0; q < n; q++) H[q] = next_H(beam, q);
    for (int q = 0; q < n; q++) drive[beam->from + n + 1 + q] = H[q];
    for (int q = 1; q < n; q++) E[q] = next_E(beam, q);
    E[0] = beam->next;
  }
}

void dvi__yee_sample_waves(const dvi__yee_moment *m, double *on_faces, double *on_edges)
{
  for (int i = 0; i < m->yee->beams; i++) {
    const dvi__yee_beam *beam = &m->yee->beam[i];
    const int n = beam->count;
    for (int q = 0; q <= n; q++) on_faces[beam->from + q] = beam->line[q];
    for (int q = 0; q < n; q++) {
      const double H = beam->line[n + 1 + q];
      on_edges[beam->from + n + 1 + q] = (m->part - 0.5) * (H + m->part * (next_H(beam, q) - H));
    }
  }
}

/* ---- acts ---- */

/* Give where on the line a cell of a component is: its drive, and the weights of it and the next
 * one, for E at nodes or H at boxes. */
static int place_on_line(const dvi__yee *y, const dvi__yee_beam *beam, int component,
                         const int *place, double *w)
{
  const int is_H = component >= DVI__YEE_B, n = beam->count;
  if (beam->axis >= 0) {
    const int i = place[beam->axis];
    w[0] = 1, w[1] = 0;
    return beam->direction[beam->axis] > 0 ? i - beam->first : beam->first - i - is_H;
  }
  double s = BEFORE - 0.5 * is_H;
  for (int l = 0; l < y->axes; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    double x = a->node[place[l]];
    if (dvi__yee_reaches(component, l)) x += 0.5 * a->length[place[l]];
    s += beam->direction[l] * (x - beam->corner[l]) / beam->h;
  }
  const int q = (int)fmin(fmax(floor(s), 0), n - 2);
  w[1] = s - q;
  w[0] = 1 - w[1];
  return q;
}

/* Let the incident value of `incident` at `there` act on `component` at `place`. */
static dvi_status add_incident(dvi__yee *y, const dvi__yee_beam *beam, int component,
                               const int *place, int incident, const int *there, double factor)
{
  const int is_H = incident >= DVI__YEE_B, c = incident % 3;
  double size = is_H ? beam->H[c] : beam->E[c], w[2];
  for (int l = 0; l < 3; l++)
    if (dvi__yee_reaches(incident, l)) size *= y->axis[l].length[there[l]];
  if (!dvi__yee_updates(y, component, place)) return DVI_OK;
  if (size == 0 || place[0] >= dvi__yee_places(y, component, 0) ||
      place[1] >= dvi__yee_places(y, component, 1) || place[2] >= dvi__yee_places(y, component, 2))
    return DVI_OK;
  const int q = place_on_line(y, beam, incident, there, w),
            from = beam->from + (is_H ? beam->count + 1 : 0) + q;
  return dvi__yee_add_act(y, is_H ? &y->on_edges : &y->on_faces, component, place, from,
                          factor * size * w[0], factor * size * w[1]);
}

static dvi_status check_vacuum(const dvi__yee *y, int c, const int *edge, int b, const int *face)
{
  if (fabs(dvi__yee_over_eps(y, c, edge) - 1) < 1e-12 && dvi__yee_conduction(y, c, edge) < 1e-12 &&
      fabs(dvi__yee_over_mu(y, b, face) - 1) < 1e-12)
    return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "yee: a wave's box has a material at (%g, %g, %g) of its surface, which must be in "
      "vacuum",
      y->axis[0].node[edge[0]], y->axis[1].node[edge[1]], y->axis[2].node[edge[2]]);
}

/* Mend the differences between E_c on a face of the box, and B_b outside of it. */
static dvi_status add_pair(dvi__yee *y, const dvi__yee_beam *beam, int axis, int end, int c,
                           const int *edge)
{
  const int b = 3 - axis - c, is_next = b == (axis + 1) % 3;
  int face[3] = {edge[0], edge[1], edge[2]};
  if (end == 0) face[axis]--;
  if (y->slot[c] < 0 || y->slot[DVI__YEE_B + b] < 0) return DVI_OK;
  if (!dvi__yee_is_unknown(y, c, edge)) return DVI_OK;
  const int has_edge = dvi__yee_updates(y, c, edge);
  if (!has_edge && !dvi__yee_updates(y, DVI__YEE_B + b, face)) return DVI_OK;
  if (has_edge) DVI_TRY(check_vacuum(y, c, edge, b, face));
  const dvi__yee_axis *a = &y->axis[axis];
  const double sign = (end == 0) == is_next ? -1 : 1,
               change = end == 0 ? a->down[edge[axis]] : a->up[edge[axis]],
               factor = has_edge ? change / (1 + dvi__yee_loss(y, c, edge)) : 0;
  DVI_TRY(add_incident(y, beam, DVI__YEE_B + b, face, c, edge, sign * y->dt));
  return add_incident(y, beam, c, edge, DVI__YEE_B + b, face, sign * factor);
}

static dvi_status add_surface(dvi__yee *y, const dvi__yee_beam *beam, int axis, int end)
{
  for (int side = 1; side < 3; side++) {
    const int c = (axis + side) % 3, b = 3 - axis - c;
    int edge[3];
    edge[axis] = end == 0 ? beam->lower[axis] : beam->upper[axis];
    for (edge[c] = beam->lower[c]; edge[c] < beam->upper[c]; edge[c]++)
      for (edge[b] = beam->lower[b]; edge[b] <= beam->upper[b]; edge[b]++)
        if (edge[b] < y->axis[b].nodes) DVI_TRY(add_pair(y, beam, axis, end, c, edge));
  }
  return DVI_OK;
}

/* ---- waves ---- */

int dvi__yee_is_on_wave(const dvi__yee *y, const int *place, int is_box)
{
  for (int i = 0; i < y->beams; i++) {
    const dvi__yee_beam *beam = &y->beam[i];
    int is_within = 1, is_near = 0;
    for (int l = 0; l < y->axes; l++) {
      const int low = beam->lower[l] - is_box, high = beam->upper[l];
      is_within = is_within && place[l] >= low && place[l] <= high;
      is_near |= (place[l] == low && has_surface(y, beam, l, 0)) ||
                 (place[l] == high && has_surface(y, beam, l, 1));
    }
    if (is_within && is_near) return 1;
  }
  return 0;
}

static dvi_status make_wave(dvi__yee *y, const dvi_yee_wave *wave, int number, dvi__yee_beam *beam)
{
  *beam = (dvi__yee_beam){.signal = wave->signal, .user = wave->user};
  if (wave->signal == NULL) return refuse(number, "needs a signal");
  DVI_TRY(set_directions(y, wave, number, beam));
  DVI_TRY(set_box(y, wave, number, beam));
  place_line(y, beam);
  const size_t n = (size_t)beam->count + 1;
  beam->up = DVI_NEW(double, 6 * n);
  if (beam->up == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for a wave");
  beam->down = beam->up + n;
  beam->loss_E = beam->down + n;
  beam->loss_H = beam->loss_E + n;
  beam->line = beam->loss_H + n;
  beam->from = y->drives;
  y->drives += 2 * beam->count + 1;
  set_line(y, beam);
  for (int l = 0; l < y->axes; l++)
    for (int e = 0; e < 2; e++)
      if (has_surface(y, beam, l, e)) DVI_TRY(add_surface(y, beam, l, e));
  return DVI_OK;
}

dvi_status dvi__yee_make_waves(const dvi_yee_terms *terms, dvi__yee *y)
{
  if (terms->waves > 0 && y->copies > 1)
    return dvi__fail(DVI_UNSUPPORTED, "yee: a wave does not go with an axis that has a phase");
  y->beam = DVI_NEW(dvi__yee_beam, terms->waves);
  if (y->beam == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for waves");
  while (y->beams < terms->waves) {
    const int i = y->beams++;
    DVI_TRY(make_wave(y, &terms->wave[i], i, &y->beam[i]));
  }
  return DVI_OK;
}

void dvi__yee_clear_waves(dvi__yee *y)
{
  for (int i = 0; i < y->beams; i++) dvi__release(y->beam[i].up);
  dvi__release(y->beam);
}

double *dvi__yee_line_of(const dvi__yee *y, int wave, size_t *count)
{
  *count = 2 * (size_t)y->beam[wave].count + 1;
  return y->beam[wave].line;
}
