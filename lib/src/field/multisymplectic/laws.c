/* The form formula and Noether's theorem on a set of cells in space and time.
 *
 * Of the action S of any set of cells, with the second derivative H, and any two solutions V and W
 * of the linearised equations, (H V).W = (H W).V by symmetry. At vertices that have all their cells
 * in the set H V and H W vanish. So does the sum over the other vertices of V.H W - W.H V. In the
 * same way the sum over the latter of dS/du.xi(u) vanishes for a symmetry xi. Values that are fixed
 * count among the latter. Source: Marsden, Patrick and Shkoller 1998, sec. 4. */
#include "field/multisymplectic/laws.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "num/finite.h"

enum { WAYS = 2 };

typedef struct laws {
  dvi__history history;
  double *way[WAYS];       /* [(steps+1)*size] solutions of the linearised equations */
  double *image[WAYS];     /* [(steps+1)*size] H times them */
  double *slope, *xi;      /* [(steps+1)*size] dS/du, [size] */
  double *lower, *upper;   /* [size] */
  char *is_in, *is_inside; /* [steps*cells], [(steps+1)*vertices] */
  uint64_t seed;
  dvi_law *law;
  int count;
} laws;

static void add(laws *s, const char *name, double error)
{
  s->law[s->count++] = (dvi_law){name, error, error < 1e-11};
}

/* ---- memory ---- */

static void clear(laws *s)
{
  dvi__release(s->history.u);
  for (int i = 0; i < WAYS; i++) {
    dvi__release(s->way[i]);
    dvi__release(s->image[i]);
  }
  dvi__release(s->slope);
  dvi__release(s->xi);
  dvi__release(s->is_in);
  dvi__release(s->is_inside);
  dvi__lattice_march_clear(&s->history.march);
}

static dvi_status allocate(laws *s)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  const size_t size = (size_t)lattice->size, levels = (size_t)s->history.steps + 1;
  int is_good = 1;
  double **const place[] = {&s->history.u, &s->way[0],   &s->way[1],
                            &s->image[0],  &s->image[1], &s->slope};
  for (size_t i = 0; i < sizeof place / sizeof *place; i++) {
    *place[i] = DVI_NEW(double, levels *size);
    is_good = is_good && *place[i] != NULL;
  }
  s->xi = DVI_NEW(double, 3 * size);
  s->is_in = DVI_NEW(char, (levels - 1) * (size_t)lattice->cells);
  s->is_inside = DVI_NEW(char, levels *(size_t)lattice->vertices);
  if (!is_good || s->xi == NULL || s->is_in == NULL || s->is_inside == NULL)
    return dvi__fail(DVI_NO_MEMORY, "multisymplectic: no memory for %d levels",
                     s->history.steps + 1);
  s->lower = s->xi + size;
  s->upper = s->lower + size;
  return DVI_OK;
}

/* ---- motions ---- */

static dvi_status start(laws *s, const dvi_march_state *given)
{
  dvi__lattice_march *m = &s->history.march;
  dvi_march_state state = {.size = sizeof state, .A = s->way[0], .E = s->way[1]};
  if (given != NULL) return dvi__lattice_start(m, given);
  s->seed = dvi__fill_random(m->lattice.size, s->seed, s->way[0]);
  s->seed = dvi__fill_random(m->lattice.size, s->seed, s->way[1]);
  return dvi__lattice_start(m, &state);
}

static dvi_status follow(laws *s, const dvi_march_state *given)
{
  dvi__history *h = &s->history;
  dvi__lattice_march *m = &h->march;
  const size_t size = (size_t)m->lattice.size;
  DVI_TRY(start(s, given));
  h->t = m->t0;
  memcpy(h->u, m->now, size * sizeof *h->u);
  for (int n = 1; n <= h->steps; n++) {
    memcpy(h->u + (size_t)n * size, m->next, size * sizeof *h->u);
    if (n < h->steps) DVI_TRY(dvi__lattice_step(m));
  }
  return DVI_OK;
}

/* Set `change` to the right side of the equations of a level of a solution, whose next level is a
 * guess, and give its solution by the matrix of the row above. */
static dvi_status linearised_change(laws *s, const double *v, int n)
{
  dvi__lattice_march *m = &s->history.march;
  const dvi__lattice *lattice = &m->lattice;
  for (int side = 0; side < 2; side++) {
    const dvi__row row = dvi__history_row(&s->history, s->history.u, n - 1 + side),
                   of = dvi__history_row(&s->history, v, n - 1 + side);
    DVI_TRY(dvi__row_second(lattice, &row, &of, s->lower, s->upper));
    const double *part = side == 0 ? s->upper : s->lower;
    for (int64_t i = 0; i < lattice->size; i++) {
      const int k = lattice->unknown[i];
      if (k >= 0) m->change[k] = part[i] + (side == 0 ? 0 : m->change[k]);
    }
  }
  return dvi__lattice_solver_solve(&m->solver, m->change);
}

/* Advance the solutions by a level. A second solution takes the first one's error away. */
static dvi_status advance_ways(laws *s, int n)
{
  dvi__lattice_march *m = &s->history.march;
  const dvi__lattice *lattice = &m->lattice;
  const dvi__row row = dvi__history_row(&s->history, s->history.u, n);
  DVI_TRY(dvi__lattice_factor(m, row.t, row.u[0], row.u[1]));
  for (int w = 0; w < 2 * WAYS; w++) {
    double *v = s->way[w % WAYS], *next = v + (n + 1) * lattice->size;
    DVI_TRY(linearised_change(s, v, n));
    for (int64_t i = 0; i < lattice->size; i++)
      if (lattice->unknown[i] >= 0) next[i] += m->change[lattice->unknown[i]];
  }
  return DVI_OK;
}

static dvi_status linearise(laws *s)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  for (int w = 0; w < WAYS; w++) {
    memset(s->way[w], 0, ((size_t)s->history.steps + 1) * (size_t)lattice->size * sizeof(double));
    s->seed = dvi__fill_random(2 * lattice->size, s->seed, s->way[w]);
    for (int64_t i = 0; i < 2 * lattice->size; i++)
      if (lattice->unknown[i % lattice->size] < 0) s->way[w][i] = 0;
  }
  for (int n = 1; n < s->history.steps; n++) DVI_TRY(advance_ways(s, n));
  return DVI_OK;
}

/* ---- a set of cells ---- */

/* A vertex is inside if all cells around it are in the set. */
static int is_inside(const laws *s, int n, int64_t vertex)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  if (n == 0 || n == s->history.steps) return 0;
  for (int c = 0; c < lattice->corners; c++) {
    const int64_t cell = dvi__lattice_cell_at(lattice, vertex, c);
    if (cell >= 0 &&
        !(s->is_in[(n - 1) * lattice->cells + cell] && s->is_in[n * lattice->cells + cell]))
      return 0;
  }
  return 1;
}

/* Take each cell but for one in 12. Around half of all vertices is inside then. */
static void choose_cells(laws *s)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  for (int n = 0; n < s->history.steps; n++)
    for (int64_t cell = 0; cell < lattice->cells; cell++) {
      double number;
      s->seed = dvi__fill_random(1, s->seed, &number);
      s->is_in[n * lattice->cells + cell] = number < 0.5 - 1.0 / 12;
    }
  for (int n = 0; n <= s->history.steps; n++)
    for (int64_t v = 0; v < lattice->vertices; v++)
      s->is_inside[n * lattice->vertices + v] = (char)is_inside(s, n, v);
}

static void accumulate(const laws *s, int n, double *sums)
{
  const int64_t size = s->history.march.lattice.size;
  for (int64_t i = 0; i < size; i++) {
    sums[n * size + i] += s->lower[i];
    sums[(n + 1) * size + i] += s->upper[i];
  }
}

/* Compute H V, H W and dS/du. */
static dvi_status differentiate(laws *s)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  for (int n = 0; n < s->history.steps; n++) {
    dvi__row row = dvi__history_row(&s->history, s->history.u, n);
    row.is_in = s->is_in + n * lattice->cells;
    DVI_TRY(dvi__row_gradient(lattice, &row, s->lower, s->upper));
    accumulate(s, n, s->slope);
    for (int w = 0; w < WAYS; w++) {
      const dvi__row v = dvi__history_row(&s->history, s->way[w], n);
      DVI_TRY(dvi__row_second(lattice, &row, &v, s->lower, s->upper));
      accumulate(s, n, s->image[w]);
    }
  }
  return DVI_OK;
}

/* ---- laws ---- */

static int counts_as_inside(const laws *s, int64_t place)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  const int64_t n = place / lattice->size, i = place % lattice->size;
  return lattice->unknown[i] >= 0 && s->is_inside[n * lattice->vertices + i % lattice->vertices];
}

static void measure_forms(laws *s)
{
  const int64_t places = (s->history.steps + 1) * s->history.march.lattice.size;
  double sum = 0, terms = 0, inside = 0, rim = 0;
  for (int64_t i = 0; i < places; i++) {
    const double size = fabs(s->image[0][i]) + fabs(s->image[1][i]),
                 there = s->way[1][i] * s->image[0][i], back = s->way[0][i] * s->image[1][i];
    if (counts_as_inside(s, i)) {
      inside = fmax(inside, size);
      continue;
    }
    rim = fmax(rim, size);
    sum += there - back;
    terms += fabs(there) + fabs(back);
  }
  add(s, "multisymplectic", terms > 0 ? fabs(sum) / terms : 0);
  add(s, "linearised", rim > 0 ? inside / rim : 0);
}

static dvi_status measure_symmetry(laws *s, const dvi_multisymplectic_symmetry *symmetry,
                                   double *worst)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  double sum = 0, terms = 0;
  for (int n = 0; n <= s->history.steps; n++) {
    const double *u = s->history.u + n * lattice->size, *slope = s->slope + n * lattice->size;
    const int failed = symmetry->field(lattice->vertices, u, s->xi, symmetry->user);
    if (failed != 0 || dvi__first_not_finite((size_t)lattice->size, s->xi) >= 0)
      return dvi__fail(failed > 0    ? DVI_CALLBACK_RETRY
                       : failed == 0 ? DVI_NOT_FINITE
                                     : DVI_CALLBACK_FAILED,
                       "multisymplectic: the symmetry %s failed with %d, or is not finite",
                       symmetry->name, failed);
    for (int64_t i = 0; i < lattice->size; i++) {
      if (counts_as_inside(s, n * lattice->size + i)) continue;
      sum += slope[i] * s->xi[i];
      terms += fabs(slope[i] * s->xi[i]);
    }
  }
  *worst = fmax(*worst, terms > 0 ? fabs(sum) / terms : 0);
  return DVI_OK;
}

static dvi_status measure(laws *s)
{
  const dvi__lattice *lattice = &s->history.march.lattice;
  double worst = 0, local[1 + DVI_AXES_MAX] = {0};
  choose_cells(s);
  DVI_TRY(differentiate(s));
  measure_forms(s);
  for (int i = 0; i < lattice->symmetries; i++)
    DVI_TRY(measure_symmetry(s, &lattice->symmetry[i], &worst));
  if (lattice->symmetries > 0) add(s, "noether", worst);
  if (!dvi__has_local_laws(lattice)) return DVI_OK;
  DVI_TRY(dvi__local_laws(&s->history, local));
  add(s, "energy", local[0]);
  add(s, "momentum", fmax(local[1], fmax(local[2], local[3])));
  return DVI_OK;
}

dvi_status dvi_multisymplectic_laws(const dvi_multisymplectic_terms *terms,
                                    const dvi_march_state *given, int steps, uint64_t seed,
                                    dvi_law *law, int *count)
{
  laws s = {.seed = seed + 1, .law = law, .history.steps = steps};
  if (law == NULL || count == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: places for the laws are needed");
  *count = 0;
  if (steps < 2 || steps > 1000000)
    return dvi__fail(DVI_BAD_ARGUMENT, "multisymplectic: %d steps; 2 to 1000000 are possible",
                     steps);
  if (given != NULL && (given->size != sizeof *given || !isfinite(given->t)))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "multisymplectic: set start.size to sizeof(dvi_march_state), and a finite t");
  dvi_status status = dvi__lattice_march_make(terms, &s.history.march);
  if (status == DVI_OK) status = allocate(&s);
  if (status == DVI_OK) status = follow(&s, given);
  if (status == DVI_OK) status = linearise(&s);
  if (status == DVI_OK) status = measure(&s);
  if (status == DVI_OK) *count = s.count;
  clear(&s);
  return status;
}
