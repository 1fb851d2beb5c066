/* Currents and dipoles.
 *
 * The term J.A of the Lagrangian pairs a current with A on the edges. A dipole p at x has
 * J_e = p'.w_e(x) with Whitney's form w_e, and a current with a density the integral of the density
 * over the edge's dual face. A step takes the impulse dt J(t), of a moment its difference over the
 * step. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"
#include "num/compensated.h"

/* ---- signals ---- */

static dvi_status signal_at(const dvi__yee_source *source, double t, double *value)
{
  *value = 0;
  const int failed = source->signal(t, value, source->user);
  if (failed == 0 && isfinite(*value)) return DVI_OK;
  return dvi__fail(failed != 0 ? DVI_CALLBACK_FAILED : DVI_NOT_FINITE,
                   failed != 0 ? "yee: a signal returned %g at t = %.17g"
                               : "yee: a signal is %g at t = %.17g",
                   failed != 0 ? failed : *value, t);
}

/* Give the impulse from t - before to t + after, with a current taken at t. */
static dvi_status impulse_of(const dvi__yee_source *source, double t, double before, double after,
                             double *impulse)
{
  double first = 0, last;
  if (source->is_moment) {
    DVI_TRY(signal_at(source, t - before, &first));
    DVI_TRY(signal_at(source, t + after, &last));
    *impulse = last - first;
    return DVI_OK;
  }
  DVI_TRY(signal_at(source, t, &last));
  *impulse = (before + after) * last;
  return DVI_OK;
}

dvi_status dvi__yee_start_sources(dvi__yee *y, double t0)
{
  for (int i = 0; i < y->sources; i++)
    DVI_TRY(impulse_of(&y->source[i], t0, 0, 0.5 * y->dt, &y->drive[i]));
  return DVI_OK;
}

void dvi__yee_restart_impulses(dvi__yee *y)
{
  for (int i = 0; i < y->sources; i++) {
    y->source[i].impulse = y->drive[i];
    y->source[i].compensation = 0;
  }
}

/* Without signals there is nothing that can fail on some processes only. */
static dvi_status agree_on_signals(const dvi__yee *y, dvi_status status)
{
  return y->sources + y->beams > 0 ? dvi__yee_agree(y, status) : status;
}

/* Ask for all signals of a step. */
static dvi_status ask(dvi__yee *y, int64_t step, double *drive)
{
  const double t = y->t0 + (double)step * y->dt, half = 0.5 * y->dt;
  for (int i = 0; i < y->sources; i++) DVI_TRY(impulse_of(&y->source[i], t, half, half, &drive[i]));
  return dvi__yee_ask_waves(y, y->t0 + ((double)step + 0.5) * y->dt);
}

dvi_status dvi__yee_prepare(dvi__yee *y, int steps, int *ready)
{
  for (*ready = 0; *ready < steps; (*ready)++) {
    double *drive = y->drive + (size_t)*ready * (size_t)y->drives;
    DVI_TRY(agree_on_signals(y, ask(y, y->step + *ready + 1, drive)));
    dvi__yee_move_waves(y, drive);
  }
  return DVI_OK;
}

void dvi__yee_take_impulses(dvi__yee *y, int steps)
{
  for (int step = 0; step < steps; step++)
    for (int i = 0; i < y->sources; i++)
      dvi__add_compensated(&y->source[i].impulse, &y->source[i].compensation,
                           y->drive[(size_t)step * (size_t)y->drives + (size_t)i]);
}

/* Set the drives of a moment of currents and dipoles. */
static dvi_status set_impulses(const dvi__yee *y, double part, double *row)
{
  for (int i = 0; i < y->sources; i++) {
    double impulse;
    const double from_half = (part - 0.5) * y->dt;
    DVI_TRY(impulse_of(&y->source[i], y->t, from_half, 0, &impulse));
    row[i] = 0;
    row[y->drives + i] = impulse;
  }
  return DVI_OK;
}

dvi_status dvi__yee_set_moment(const dvi__yee *y)
{
  dvi__yee_moment *m = y->moment;
  if (m->is_now) return DVI_OK;
  const double since = y->t - (y->t0 + (double)y->step * y->dt);
  double *row = y->drive + (size_t)y->together * (size_t)y->drives;
  *m = (dvi__yee_moment){.yee = y, .on_faces = row, .on_edges = row + y->drives};
  m->part = since / y->dt > dvi__yee_spare(y, y->t) ? fmin(since / y->dt, 1) : 0;
  DVI_TRY(agree_on_signals(y, set_impulses(y, m->part, row)));
  dvi__yee_sample_waves(m, row, row + y->drives);
  dvi__yee_pass_moment(m);
  DVI_TRY(dvi__yee_check_ranks(y));
  m->is_now = 1;
  return DVI_OK;
}

/* ---- profiles ---- */

/* Let a source act on an edge with the profile J_e. */
static dvi_status drive_edge(dvi__yee *y, int number, int c, const int *place, double profile)
{
  if (profile == 0 || !dvi__yee_is_unknown(y, c, place) || !dvi__yee_updates(y, c, place))
    return DVI_OK;
  const double s = dvi__yee_loss(y, c, place);
  return dvi__yee_add_act(y, &y->on_edges, c, place, number,
                          -profile / (dvi__yee_star(y, c, place) * (1 + s)), 0);
}

dvi_status dvi__yee_check_inside(const dvi__yee *y, const double *x, const char *what, int number)
{
  static const char name[] = "xyz";
  for (int l = 0; l < y->axes; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    if (x[l] >= a->node[0] && x[l] <= a->node[a->cells]) continue;
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: %s %d is at %c = %g, outside of the grid from %g to %g", what, number,
                     name[l], x[l], a->node[0], a->node[a->cells]);
  }
  return DVI_OK;
}

/* Give the corner `which` (bits by axis) of the edges of direction c around a point, and its
 * weight. */
void dvi__yee_whitney(const dvi__yee *y, int component, const double *x, int which, int *place,
                      double *weight)
{
  *weight = 1;
  for (int l = 0; l < 3; l++) {
    double part;
    const dvi__yee_axis *a = &y->axis[l];
    const int cell = dvi__yee_locate(a, l < y->axes ? x[l] : 0, &part), far = which >> l & 1;
    place[l] = cell + far;
    if (dvi__yee_reaches(component, l))
      *weight *= far ? 0 : 1 / a->length[cell];
    else
      *weight *= far ? part : 1 - part;
  }
}

/* Move a place to the first node of an axis that repeats itself. */
static dvi_status wrap_place(const dvi__yee *y, int c, int *place)
{
  for (int l = 0; l < 3; l++) {
    if (place[l] < dvi__yee_places(y, c, l) || !y->axis[l].wraps) continue;
    place[l] -= y->axis[l].cells;
    if (y->axis[l].end[0].kind == DVI_YEE_BLOCH)
      return dvi__fail(DVI_UNSUPPORTED,
                       "yee: a source reaches over the end of an axis with a phase; move it");
  }
  return DVI_OK;
}

static dvi_status add_dipole(dvi__yee *y, const dvi_yee_dipole *dipole, int number, int index)
{
  DVI_TRY(dvi__yee_check_inside(y, dipole->at, "dipole", index));
  for (int c = 0; c < 3; c++) {
    if (!isfinite(dipole->along[c]))
      return dvi__fail(DVI_NOT_FINITE, "yee: dipole %d has the direction %g along an axis", index,
                       dipole->along[c]);
    for (int which = 0; which < 8 && y->slot[c] >= 0 && dipole->along[c] != 0; which++) {
      int place[3];
      double weight;
      dvi__yee_whitney(y, c, dipole->at, which, place, &weight);
      if (weight == 0) continue;
      DVI_TRY(wrap_place(y, c, place));
      DVI_TRY(drive_edge(y, number, c, place, weight * dipole->along[c]));
    }
  }
  return DVI_OK;
}

/* Integrate a density over the dual face of an edge. */
static dvi_status profile_of(const dvi__yee *y, const dvi_yee_current *current, int c, int which,
                             const int *place, double *profile)
{
  int cell[2], count[3], reaches[3];
  double lower[3][2], upper[3][2];
  *profile = 0;
  for (int l = 0; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    reaches[l] = l != c && !a->is_trivial;
    count[l] = 1;
    if (l == c)
      lower[l][0] = upper[l][0] = a->node[place[l]] + 0.5 * a->length[place[l]];
    else
      count[l] = dvi__yee_pieces(a, place[l], cell, lower[l], upper[l]);
  }
  for (int n = 0; n < count[0] * count[1] * count[2]; n++) {
    double low[3], high[3], part;
    int over_end = 0;
    for (int l = 0, rest = n; l < 3; rest /= count[l++]) {
      low[l] = lower[l][rest % count[l]];
      high[l] = upper[l][rest % count[l]];
      over_end |= y->axis[l].end[0].kind == DVI_YEE_BLOCH && l != c && place[l] == 0 &&
                  rest % count[l] == 0;
    }
    DVI_TRY(dvi__yee_integrate_box(low, high, reaches, current->density, current->density_user,
                                   which, &part));
    if (over_end && part != 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "yee: a current reaches over the end of an axis with a phase");
    *profile += part;
  }
  return DVI_OK;
}

static dvi_status add_current(dvi__yee *y, const dvi_yee_current *current, int number)
{
  for (int c = 0, which = 0; c < 3; c++) {
    int rows[2], planes[2];
    if (y->slot[c] < 0) continue;
    dvi__yee_reach(y, 1, 0, y->together - 1, rows);
    dvi__yee_reach(y, 2, 0, y->together - 1, planes);
    for (int k = planes[0]; k < planes[1]; k++)
      for (int j = rows[0]; j < rows[1]; j++)
        for (int i = 0; i < dvi__yee_places(y, c, 0); i++) {
          const int place[3] = {i, dvi__yee_around(y, 1, j), dvi__yee_around(y, 2, k)};
          double profile;
          if (place[1] >= dvi__yee_places(y, c, 1) || place[2] >= dvi__yee_places(y, c, 2))
            continue;
          DVI_TRY(profile_of(y, current, c, which, place, &profile));
          DVI_TRY(drive_edge(y, number, c, place, profile));
        }
    which++;
  }
  return DVI_OK;
}

/* ---- sources ---- */

static dvi_status check_sources(const dvi_yee_terms *terms)
{
  if (terms->currents < 0 || terms->dipoles < 0 || terms->waves < 0 ||
      (terms->currents > 0 && terms->current == NULL) ||
      (terms->dipoles > 0 && terms->dipole == NULL) || (terms->waves > 0 && terms->wave == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: %d currents, %d dipoles and %d waves are announced, and not given",
                     terms->currents, terms->dipoles, terms->waves);
  for (int i = 0; i < terms->currents; i++)
    if (terms->current[i].density == NULL || terms->current[i].signal == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "yee: current %d needs a density and a signal", i);
  for (int i = 0; i < terms->dipoles; i++)
    if (terms->dipole[i].signal == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "yee: dipole %d needs a signal", i);
  return DVI_OK;
}

dvi_status dvi__yee_make_sources(const dvi_yee_terms *terms, dvi__yee *y)
{
  DVI_TRY(check_sources(terms));
  y->source = DVI_NEW(dvi__yee_source, terms->currents + terms->dipoles);
  if (y->source == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for sources");
  for (int i = 0; i < terms->currents; i++) {
    const dvi_yee_current *current = &terms->current[i];
    y->source[y->sources] = (dvi__yee_source){.signal = current->signal,
                                              .user = current->signal_user};
    DVI_TRY(add_current(y, current, y->sources++));
  }
  for (int i = 0; i < terms->dipoles; i++) {
    const dvi_yee_dipole *dipole = &terms->dipole[i];
    y->source[y->sources] = (dvi__yee_source){
        .signal = dipole->signal, .user = dipole->user, .is_moment = dipole->is_moment};
    DVI_TRY(add_dipole(y, dipole, y->sources++, i));
  }
  y->drives = y->sources + 1;
  DVI_TRY(dvi__yee_make_waves(terms, y));
  DVI_TRY(dvi__yee_sort_acts(y, &y->on_edges));
  DVI_TRY(dvi__yee_sort_acts(y, &y->on_faces));
  y->drive = DVI_NEW(double, (size_t)(y->together + 2) * (size_t)y->drives);
  y->moment = DVI_NEW(dvi__yee_moment, 1);
  return y->drive != NULL && y->moment != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "yee: no memory for sources");
}
