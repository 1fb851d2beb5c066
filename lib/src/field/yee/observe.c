/* Energy, charge, probes and fluxes. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

typedef dvi__yee_value value;

enum { ENERGY, CHARGE, GAUSS, DIVERGENCE, FIXED };

/* ---- energy ---- */

/* Sum star E^2/2, or star B^n B^{n+1}/2 without sources, over the places of a row. */
static void add_energy_of_row(const dvi__yee *y, int component, int j, int k, dvi__block_sum *sum)
{
  const int c = component % 3, a = (c + 1) % 3, b = (c + 2) % 3, is_face = component >= DVI__YEE_B,
            places = dvi__yee_places(y, component, 0), first[3] = {0, j, k};
  double *star = y->scratch;
  dvi__yee_stars(y, component, first, places, star);
  for (int copy = 0; copy < y->copies; copy++) {
    const double *f = y->state[copy] + dvi__yee_at(y, component, j, k);
    const double *p = is_face && y->slot[b] >= 0 ? y->state[copy] + dvi__yee_at(y, b, j, k) : f;
    const double *q = is_face && y->slot[a] >= 0 ? y->state[copy] + dvi__yee_at(y, a, j, k) : f;
    const ptrdiff_t up = p != f ? y->next[a] : 0, right = q != f ? y->next[b] : 0;
    for (int i = 0; i < places; i++) {
      const double curl = is_face ? (p[i + up] - p[i]) - (q[i + right] - q[i]) : 0;
      dvi__block_sum_add(sum, 0.5 * star[i] * f[i] * (f[i] - y->dt * curl));
    }
  }
}

static double energy_of(const dvi__yee *y)
{
  dvi__block_sum sum = {.count = 0};
  for (int component = 0; component < 6; component++) {
    if (y->slot[component] < 0) continue;
    for (int k = dvi__yee_begin(y, 2); k < dvi__yee_end(y, component, 2); k++)
      for (int j = dvi__yee_begin(y, 1); j < dvi__yee_end(y, component, 1); j++)
        add_energy_of_row(y, component, j, k, &sum);
  }
  return dvi__yee_sum_of_all(y, dvi__block_sum_end(&sum));
}

/* ---- charge ---- */

/* Tell if an axis leaves a node, or a box, out of charges, or divergences. */
static int is_left_out(const dvi__yee *y, int axis, int i, int is_box)
{
  const dvi__yee_axis *a = &y->axis[axis];
  const dvi__yee_layers *l = a->layers;
  if (a->is_trivial) return 0;
  if (!is_box && (i < a->free[0] || i >= a->free[1] || dvi__yee_absorbs_at(a, i))) return 1;
  if (!is_box && a->end[0].kind == DVI_YEE_BLOCH && i == 0) return 1;
  if (is_box && a->end[0].kind == DVI_YEE_BLOCH && i == a->cells - 1) return 1;
  return (l[0].count > 0 && i < l[0].count) ||
         (l[1].count > 0 && (is_box ? i >= l[1].first : i > l[1].first));
}

static int counts(const dvi__yee *y, const int *place, int is_box)
{
  for (int l = 0; l < 3; l++)
    if (is_left_out(y, l, place[l], is_box)) return 0;
  return !dvi__yee_is_on_wave(y, place, is_box);
}

/* Give D of an edge, and with `all` what has been conducted and what currents brought there. *size
 * is the sum of the sizes of the terms. */
static double displacement(const dvi__yee *y, int c, const int *place, int all, double *size)
{
  const double E = dvi__yee_stored(y, c, place).re, star = dvi__yee_star(y, c, place);
  double worn = 0, driven = 0;
  if (all && y->worn != NULL) worn = y->worn[dvi__yee_beside(y, c, place)];
  if (all && y->sources > 0)
    driven = (1 + dvi__yee_loss(y, c, place)) *
             dvi__yee_acted(y, &y->on_edges, c, place, y->impulses);
  *size = star * (fabs(E) + fabs(worn) + fabs(driven));
  return star * (E + worn - driven);
}

/* Find D, and its size, on the edges along a divided axis before the own nodes. NULL along another
 * axis. */
static const double *displacements_below(const dvi__yee *y, int c, int all)
{
  if (!dvi__yee_is_divided(y, c) || y->slot[c] < 0) return NULL;
  const int across = 3 - c, end = dvi__yee_end(y, c, across);
  double *sent = dvi__yee_plane_sent(y);
  int place[3] = {0, 0, 0};
  place[c] = dvi__yee_last_boxes(y, c);
  for (place[across] = dvi__yee_begin(y, across); place[across] < end; place[across]++)
    for (place[0] = 0; place[0] < dvi__yee_places(y, c, 0); place[0]++)
      sent[dvi__yee_at_plane(y, c, 0, 0, place)] = displacement(
          y, c, place, all, &sent[dvi__yee_at_plane(y, c, 1, 0, place)]);
  return dvi__yee_pass_plane(y, c, 0);
}

/* Give D of an edge before a node, and its size, that of another process from `below`. */
static double displacement_before(const dvi__yee *y, int c, const int *place, int all,
                                  const double *below, double *size)
{
  if (dvi__yee_owns(y, place)) return displacement(y, c, place, all, size);
  *size = below[dvi__yee_at_plane(y, c, 1, 0, place)];
  return below[dvi__yee_at_plane(y, c, 0, 0, place)];
}

/* Give the outflow of D at a node, and the sum of the sizes of its terms. */
static double outflow(const dvi__yee *y, const int *node, int all, const double *const *below,
                      double *size)
{
  double sum = 0;
  *size = 0;
  for (int c = 0; c < 3; c++) {
    int before[3] = {node[0], node[1], node[2]};
    before[c] += node[c] > 0 ? -1 : y->axis[c].cells - 1;
    if (y->slot[c] < 0) continue;
    double size_in = 0, size_out = 0, in = 0, out = 0;
    if (node[c] > 0 || y->axis[c].wraps)
      in = displacement_before(y, c, before, all, below[c], &size_in);
    if (node[c] < y->axis[c].cells) out = displacement(y, c, node, all, &size_out);
    sum += out - in;
    *size = *size + size_in + size_out;
  }
  return sum;
}

typedef struct charges {
  double sum, largest, size; /* sum, largest change, and largest sum of sizes of terms */
} charges;

/* Visit the own nodes. Keep their outflows, or compare with those of the start. */
static void visit_own_nodes(const dvi__yee *y, int all, double *keep, const double *kept,
                            dvi__block_sum *sum, double *most)
{
  const double *below[3];
  int node[3] = {0, 0, 0};
  size_t at = 0;
  for (int c = 0; c < 3; c++) below[c] = displacements_below(y, c, all);
  for (node[2] = y->own[2][0]; node[2] < y->own[2][1]; node[2]++)
    for (node[1] = y->own[1][0]; node[1] < y->own[1][1]; node[1]++)
      for (node[0] = 0; node[0] < y->axis[0].nodes; node[0]++, at++) {
        double size;
        if (!counts(y, node, 0)) continue;
        const double flow = outflow(y, node, all, below, &size);
        if (keep != NULL) keep[at] = flow;
        const double change = flow - (kept != NULL ? kept[at] : 0);
        dvi__block_sum_add(sum, flow);
        most[0] = fmax(most[0], fabs(change));
        most[1] = fmax(most[1], size);
      }
}

static charges visit_nodes(const dvi__yee *y, int all, double *keep, const double *kept)
{
  dvi__block_sum sum = {.count = 0};
  double most[2] = {0, 0};
  if (y->degree == 1) visit_own_nodes(y, all, keep, kept, &sum, most);
  dvi__yee_largest_of_all(y, 2, most);
  return (charges){dvi__yee_sum_of_all(y, dvi__block_sum_end(&sum)), most[0], most[1]};
}

void dvi__yee_keep_charge(dvi__yee *y)
{
  (void)visit_nodes(y, 0, y->charge, NULL);
}

static double gauss_of(const dvi__yee *y)
{
  for (int i = 0; i < y->sources; i++) y->impulses[i] = y->source[i].impulse;
  const charges found = visit_nodes(y, 1, NULL, y->charge);
  return found.size > 0 ? found.largest / found.size : 0;
}

/* The largest outflow of B of a box beside the largest sum of its terms' sizes. */
static double divergence_of(const dvi__yee *y)
{
  double most[2] = {0, 0};
  int box[3] = {0, 0, 0};
  dvi__yee_pass_faces_back(y);
  for (box[2] = y->own[2][0]; box[2] < y->own[2][1] && box[2] < y->axis[2].cells; box[2]++)
    for (box[1] = y->own[1][0]; box[1] < y->own[1][1] && box[1] < y->axis[1].cells; box[1]++)
      for (box[0] = 0; box[0] < y->axis[0].cells; box[0]++) {
        double sum = 0, size = 0;
        if (!counts(y, box, 1)) continue;
        for (int c = 0; c < 3; c++) {
          int next[3] = {box[0], box[1], box[2]};
          if (y->slot[DVI__YEE_B + c] < 0 || y->axis[c].is_trivial) continue;
          next[c]++;
          const double out = dvi__yee_stored(y, DVI__YEE_B + c, next).re,
                       in = dvi__yee_stored(y, DVI__YEE_B + c, box).re;
          sum += out - in;
          size += fabs(out) + fabs(in);
        }
        most[0] = fmax(most[0], fabs(sum));
        most[1] = fmax(most[1], size);
      }
  dvi__yee_largest_of_all(y, 2, most);
  return most[1] > 0 ? most[0] / most[1] : 0;
}

/* ---- probes ---- */

/* Tell if a place of a component, which may be that of the first node behind the last one, is of
 * this process. */
static int is_own(const dvi__yee *y, int component, const int *place)
{
  int inside[3];
  for (int l = 0; l < 3; l++) {
    const int is_behind = y->axis[l].wraps && place[l] >= dvi__yee_places(y, component, l);
    inside[l] = is_behind ? place[l] - y->axis[l].cells : place[l];
  }
  return dvi__yee_owns(y, inside);
}

static double probe_value(const dvi__yee_moment *m, const dvi_yee_probe *probe)
{
  const dvi__yee *y = m->yee;
  const int first = probe->form == DVI_FORM_B ? DVI__YEE_B : DVI__YEE_E;
  dvi__accumulator sum = {.terms = 0};
  for (int c = 0; c < 3; c++)
    for (int which = 0; which < 8 && y->slot[first + c] >= 0 && probe->along[c] != 0; which++) {
      int place[3] = {0, 0, 0};
      double weight;
      dvi__yee_whitney(y, first + c, probe->at, which, place, &weight);
      if (weight == 0 || !is_own(y, first + c, place)) continue;
      const value v = first == DVI__YEE_B ? dvi__yee_B_at(m, c, place) : dvi__yee_E_at(m, c, place);
      dvi__accumulate(&sum, probe->along[c] * weight * v.re);
    }
  return dvi__yee_sum_of_all(y, &sum);
}

/* ---- fluxes ---- */

/* Tell if nodes i of an axis are its end at a magnetic conductor. */
static int is_magnetic(const dvi__yee_axis *a, int i)
{
  return (i == 0 && a->end[0].kind == DVI_YEE_PMC) ||
         (i == a->cells && a->end[1].kind == DVI_YEE_PMC);
}

/* Give M_2 B for a unit of length, the mean H along c of both sides of a plane of nodes. It is 0 on
 * a magnetic conductor. */
static double H_on_plane(const dvi__yee_moment *m, int c, int axis, const int *place)
{
  const dvi__yee *y = m->yee;
  double sum = 0, sides = 0;
  if (is_magnetic(&y->axis[axis], place[axis])) return 0;
  for (int side = 0; side < 2; side++) {
    int at[3] = {place[0], place[1], place[2]}, inside[3];
    at[axis] -= side;
    if (!y->axis[axis].wraps && (at[axis] < 0 || at[axis] >= y->axis[axis].cells)) continue;
    for (int l = 0; l < 3; l++) {
      const int places = dvi__yee_places(y, DVI__YEE_B + c, l);
      inside[l] = at[l] + (at[l] < 0 ? places : at[l] >= places ? -places : 0);
    }
    sides++;
    const double dual = y->axis[c].dual[inside[c]];
    sum += dvi__yee_star(y, DVI__YEE_B + c, inside) * dvi__yee_B_at(m, c, at).re / dual;
  }
  return sides > 0 ? sum / sides : 0;
}

/* Add the flux of E x H through the plane of nodes `at` of an axis, along the axis or against it,
 * from node lower to node upper of the others. E_b H_c - E_c H_b. */
static void add_flux_through(const dvi__yee_moment *m, int axis, int at, const int *lower,
                             const int *upper, double way, dvi__block_sum *sum)
{
  const dvi__yee *y = m->yee;
  for (int side = 0; side < 2; side++) {
    const int e = (axis + 1 + side) % 3, h = (axis + 2 - side) % 3;
    const double sign = side == 0 ? way : -way;
    int place[3] = {0, 0, 0};
    if (y->slot[e] < 0 || y->slot[DVI__YEE_B + h] < 0) continue;
    place[axis] = at;
    for (place[e] = lower[e]; place[e] < upper[e]; place[e]++)
      for (place[h] = lower[h]; place[h] <= upper[h]; place[h]++) {
        const dvi__yee_axis *a = &y->axis[h];
        const double before = place[h] > lower[h] ? 0.5 * a->length[place[h] - 1] : 0,
                     after = place[h] < upper[h] ? 0.5 * a->length[place[h]] : 0,
                     width = a->is_trivial ? place[h] == lower[h] : before + after;
        if (width == 0 || !is_own(y, e, place)) continue;
        const value E = dvi__yee_E_at(m, e, place);
        dvi__block_sum_add(sum, sign * width * E.re * H_on_plane(m, h, axis, place));
      }
  }
}

static double flux_value(const dvi__yee_moment *m, const dvi_yee_flux *flux)
{
  const dvi__yee *y = m->yee;
  int lower[3], upper[3], flat = -1;
  dvi__block_sum sum = {.count = 0};
  for (int l = 0; l < 3; l++) {
    lower[l] = l < y->axes ? dvi__yee_nearest(&y->axis[l], flux->lower[l]) : 0;
    upper[l] = l < y->axes ? dvi__yee_nearest(&y->axis[l], flux->upper[l]) : 1;
    if (l < y->axes && flux->lower[l] == flux->upper[l]) flat = l;
  }
  if (flat >= 0) add_flux_through(m, flat, lower[flat], lower, upper, 1, &sum);
  for (int l = 0; l < 3 && flat < 0 && !y->axis[l].is_trivial; l++) {
    add_flux_through(m, l, upper[l], lower, upper, 1, &sum);
    add_flux_through(m, l, lower[l], lower, upper, -1, &sum);
  }
  return dvi__yee_sum_of_all(y, dvi__block_sum_end(&sum));
}

/* ---- observables ---- */

int dvi__yee_observables(const void *self)
{
  const dvi__yee *y = self;
  return FIXED + y->probes + y->fluxes;
}

const char *dvi__yee_observable(const void *self, int i)
{
  static const char *const fixed[FIXED] = {"energy", "charge", "gauss", "divergence"};
  const dvi__yee *y = self;
  if (i < FIXED) return fixed[i];
  return i - FIXED < y->probes ? y->probe[i - FIXED].name : y->flux[i - FIXED - y->probes].name;
}

dvi_status dvi__yee_observe(const void *self, int i, double *found)
{
  const dvi__yee *y = self;
  double seen = 0;
  DVI_TRY(dvi__yee_check_ranks(y));
  dvi__yee_fill_ghosts(y, 1);
  if (i >= FIXED) DVI_TRY(dvi__yee_set_moment(y));
  switch (i) {
  case ENERGY: seen = energy_of(y); break;
  case CHARGE: seen = visit_nodes(y, 0, NULL, NULL).sum; break;
  case GAUSS: seen = gauss_of(y); break;
  case DIVERGENCE: seen = divergence_of(y); break;
  default:
    seen = i - FIXED < y->probes ? probe_value(y->moment, &y->probe[i - FIXED])
                                 : flux_value(y->moment, &y->flux[i - FIXED - y->probes]);
  }
  DVI_TRY(dvi__yee_check_ranks(y));
  *found = seen;
  return DVI_OK;
}

/* ---- checks ---- */

static dvi_status check_name(const char *name, const char *what, int i)
{
  if (name != NULL && name[0] != '\0') return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "yee: %s %d has no name", what, i);
}

static dvi_status check_probe(const dvi__yee *y, const dvi_yee_probe *probe, int i)
{
  DVI_TRY(check_name(probe->name, "probe", i));
  if (probe->form != DVI_FORM_E && probe->form != DVI_FORM_B)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: probe %s is of neither E nor B", probe->name);
  for (int c = 0; c < 3; c++)
    if (!isfinite(probe->along[c]))
      return dvi__fail(DVI_NOT_FINITE, "yee: probe %s has a direction with %g", probe->name,
                       probe->along[c]);
  return dvi__yee_check_inside(y, probe->at, "probe", i);
}

static dvi_status check_flux(const dvi__yee *y, const dvi_yee_flux *flux, int i)
{
  int flat = 0;
  DVI_TRY(check_name(flux->name, "flux", i));
  DVI_TRY(dvi__yee_check_inside(y, flux->lower, "flux", i));
  DVI_TRY(dvi__yee_check_inside(y, flux->upper, "flux", i));
  for (int l = 0; l < y->axes; l++) {
    if (flux->lower[l] > flux->upper[l])
      return dvi__fail(DVI_BAD_ARGUMENT, "yee: flux %s has its bounds the wrong way round",
                       flux->name);
    flat += flux->lower[l] == flux->upper[l];
  }
  if (flat <= 1) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "yee: flux %s is neither a box nor a rectangle", flux->name);
}

static size_t length_of(const char *name)
{
  return name != NULL ? strlen(name) + 1 : 0;
}

static const char *copy_name(const char *name, char **free_place)
{
  char *copy = *free_place;
  memcpy(copy, name, length_of(name));
  *free_place += length_of(name);
  return copy;
}

dvi_status dvi__yee_make_observables(const dvi_yee_terms *terms, dvi__yee *y)
{
  size_t length = 0;
  if (terms->probes < 0 || terms->fluxes < 0 || (terms->probes > 0 && terms->probe == NULL) ||
      (terms->fluxes > 0 && terms->flux == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: %d probes and %d fluxes are announced, and not given",
                     terms->probes, terms->fluxes);
  for (int i = 0; i < terms->probes; i++) {
    DVI_TRY(check_probe(y, &terms->probe[i], i));
    length += length_of(terms->probe[i].name);
  }
  for (int i = 0; i < terms->fluxes; i++) {
    DVI_TRY(check_flux(y, &terms->flux[i], i));
    length += length_of(terms->flux[i].name);
  }
  y->probe = dvi__duplicate(terms->probe, (size_t)terms->probes, sizeof *y->probe);
  y->flux = dvi__duplicate(terms->flux, (size_t)terms->fluxes, sizeof *y->flux);
  y->names = DVI_NEW(char, length);
  y->impulses = DVI_NEW(double, y->drives);
  if (y->probe == NULL || y->flux == NULL || y->names == NULL || y->impulses == NULL)
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for probes");
  y->probes = terms->probes;
  y->fluxes = terms->fluxes;
  char *next = y->names;
  for (int i = 0; i < y->probes; i++) y->probe[i].name = copy_name(terms->probe[i].name, &next);
  for (int i = 0; i < y->fluxes; i++) y->flux[i].name = copy_name(terms->flux[i].name, &next);
  return DVI_OK;
}
