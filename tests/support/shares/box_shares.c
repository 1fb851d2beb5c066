#include "support/shares/box_shares.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"
#include "support/waves/boxes.h"

enum { STEPS = 6, OBSERVED = 9, FORMS = 2 };

/* ---- random grids ---- */

static int pulse(double t, double *value, void *user)
{
  (void)user;
  *value = exp(-(t - 1) * (t - 1));
  return 0;
}

static int swirl(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = x[1] * x[1];
  value[1] = 1 - x[0];
  value[2] = x[0] * x[1];
  return 0;
}

/* Inside of the boxes of waves. */
static int ball(const double *x, double *value, void *user)
{
  (void)user;
  const double dx = x[0] - 2.4, dy = x[1] - 2.5;
  *value = dx * dx + dy * dy < 0.3 ? 2.5 : 1;
  return 0;
}

static int loss(const double *x, double *value, void *user)
{
  (void)user;
  *value = x[1] > 2.1 && x[1] < 2.7 && x[0] < 2.7 && x[0] > 2.1 ? 0.3 : 0;
  return 0;
}

/* Terms, and what they point to. */
typedef struct grid {
  dvi_yee_terms terms;
  double node[3][16];
  double *cell[3];
  dvi_yee_current current;
  dvi_yee_dipole dipole[2];
  dvi_yee_wave wave;
  dvi_yee_probe probe[3];
  dvi_yee_flux flux[2];
} grid;

static int chosen(unsigned long long *seed, int count)
{
  return (int)(count * random_number(seed));
}

static void choose_axis(grid *g, int l, unsigned long long *seed)
{
  static const dvi_yee_boundary once[] = {DVI_YEE_PEC, DVI_YEE_PMC, DVI_YEE_ABSORBING,
                                          DVI_YEE_CPML};
  dvi_yee_axis *a = &g->terms.axis[l];
  const int is_last = l == g->terms.axes - 1, around = chosen(seed, 6), is_graded = chosen(seed, 2);
  *a = (dvi_yee_axis){.cells = is_last  ? 12 + chosen(seed, 4)
                               : l == 1 ? 5 + chosen(seed, 5)
                                        : 5,
                      .phase = 0.4 + l};
  a->upper = a->cells;
  for (int e = 0; e < 2; e++) {
    a->end[e] = (dvi_yee_end){.layers = 1 + is_last * (1 + chosen(seed, 2)), .kappa = 2};
    a->end[e].kind = around == 5  ? DVI_YEE_BLOCH
                     : around > 2 ? DVI_YEE_PERIODIC
                                  : once[chosen(seed, 4)];
  }
  for (int i = 0; i <= a->cells; i++) g->node[l][i] = i;
  for (int i = 1; i < a->cells; i++) g->node[l][i] += 0.2 * random_number(seed);
  if (is_graded) a->node = g->node[l];
}

static void choose_media(grid *g, int kind, unsigned long long *seed)
{
  dvi_yee_terms *t = &g->terms;
  size_t cells = 1;
  for (int l = 0; l < t->axes; l++) cells *= (size_t)t->axis[l].cells;
  for (int m = 0; m < 3; m++) {
    g->cell[m] = calloc(cells, sizeof(double));
    for (size_t i = 0; i < cells; i++) g->cell[m][i] = 0.5 * (m < 2) + random_number(seed);
  }
  if (kind == 1) t->eps.at = ball;
  if (kind == 2) t->eps.cell = g->cell[0], t->mu.cell = g->cell[1];
  if (kind == 3) t->sigma.at = loss, t->mu.at = ball;
  if (kind == 4) t->eps.at = ball, t->mu.cell = g->cell[1], t->sigma.cell = g->cell[2];
}

static int has_phase(const dvi_yee_terms *t)
{
  int found = 0;
  for (int l = 0; l < t->axes; l++) found |= t->axis[l].end[0].kind == DVI_YEE_BLOCH;
  return found;
}

/* Sources keep away from the ends. Waves are polarized along the last component that E has. */
static void choose_sources(grid *g, int kind, unsigned long long *seed)
{
  dvi_yee_terms *t = &g->terms;
  const double high = t->axis[t->axes - 1].cells - 3.1;
  g->current = (dvi_yee_current){.density = swirl, .signal = pulse};
  for (int i = 0; i < 2; i++) {
    g->dipole[i] = (dvi_yee_dipole){
        .at = {2.2, 2.6, 3}, .along = {1, 2, 3}, .signal = pulse, .is_moment = i};
    g->dipole[i].at[t->axes - 1] = 2.2 + (high - 2.2) * random_number(seed);
  }
  g->wave = (dvi_yee_wave){.lower = {2, 2, 2}, .upper = {3, 3, 3}, .signal = pulse};
  g->wave.lower[t->axes - 1] = 3;
  g->wave.upper[t->axes - 1] = t->axis[t->axes - 1].cells - 3;
  g->wave.direction[t->axes - 1] = 1;
  g->wave.direction[0] = chosen(seed, 2);
  g->wave.polarization[1 + (t->degree == 0)] = 1;
  if (t->axes == 2 && t->degree == 1) g->wave.direction[0] = 1, g->wave.direction[1] = 0;
  t->dipole = g->dipole, t->dipoles = 2;
  if (!has_phase(t)) t->current = &g->current, t->currents = 1;
  if (!has_phase(t) && kind == 0) t->wave = &g->wave, t->waves = 1;
}

static void choose_observables(grid *g)
{
  const int last = g->terms.axes - 1;
  const double end = g->terms.axis[last].cells;
  g->probe[0] = (dvi_yee_probe){"e", DVI_FORM_E, {1.3, 2.2, 3.1}, {1, -1, 0.3}};
  g->probe[1] = (dvi_yee_probe){"b", DVI_FORM_B, {3.3, 1.2, 2.1}, {1, 1, 0.7}};
  g->probe[2] = (dvi_yee_probe){"end", DVI_FORM_E, {3.3, 1.2, 2.1}, {1, 1, 0.7}};
  g->probe[1].at[last] = end - 0.4;
  g->probe[2].at[last] = end;
  g->flux[0] = (dvi_yee_flux){"box", {1, 1, 2}, {4, 4, 4}};
  g->flux[0].upper[last] = end - 1;
  g->flux[1] = (dvi_yee_flux){"plane", {0, 0, 0}, {5, 5, 5}};
  g->flux[1].lower[last] = g->flux[1].upper[last] = 4;
  g->terms.probe = g->probe, g->terms.probes = 3;
  g->terms.flux = g->flux, g->terms.fluxes = 2;
}

static grid *make_grid(unsigned long long seed)
{
  grid *g = calloc(1, sizeof *g);
  const int shape = chosen(&seed, 4), media = (int)(seed % 5);
  g->terms = (dvi_yee_terms){.size = sizeof g->terms,
                             .axes = shape < 2 ? 3 : 2,
                             .degree = shape < 3,
                             .threads = 1 + chosen(&seed, 2),
                             .together = 1 + chosen(&seed, 5)};
  for (int l = 0; l < g->terms.axes; l++) choose_axis(g, l, &seed);
  choose_media(g, media, &seed);
  choose_sources(g, media, &seed);
  choose_observables(g);
  return g;
}

/* ---- one process ---- */

static const dvi_march_form form_of[FORMS] = {DVI_FORM_E, DVI_FORM_B};

/* What one process has. */
struct box_trial {
  grid *g;
  int64_t size[FORMS], copies;
  int number;
  int *place[FORMS];          /* [size][3] of each cell */
  double *start[FORMS];       /* with copies */
  double *form[STEPS][FORMS]; /* with copies */
  double seen[STEPS][OBSERVED], step;
  int steps; /* from one look to the next */
  int stop;  /* the look behind which the state is saved and loaded. Odd ones start with fields */
  unsigned char *bytes; /* [bytes_size] what one process has saved there */
  size_t bytes_size;
};

static void observe(const dvi_march *march, double *seen)
{
  for (int i = 0; dvi_march_observable(march, i) != NULL; i++)
    (void)dvi_march_observe(march, i, seen + i);
}

/* Whole steps, and times between them. */
static double time_of(const box_trial *t, int s)
{
  return (s * t->steps + 0.3 * (s % 3)) * t->step;
}

static double step_of(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return facts.step;
}

/* Find the places of all cells. */
static int *places_of(const dvi_yee_terms *terms, dvi_march_form form, int64_t size)
{
  int *place = malloc(3 * (size_t)size * sizeof *place), i[3] = {0, 0, 0};
  for (int c = 0; c < 3; c++)
    for (i[2] = 0; i[2] <= (terms->axes > 2 ? terms->axis[2].cells : 0); i[2]++)
      for (i[1] = 0; i[1] <= terms->axis[1].cells; i[1]++)
        for (i[0] = 0; i[0] <= terms->axis[0].cells; i[0]++) {
          const int64_t number = dvi_yee_place(terms, form, c, i);
          if (number >= 0) memcpy(place + 3 * number, i, sizeof i);
        }
  return place;
}

static void start(dvi_march *march, double *const *values, int is_given)
{
  const dvi_march_state state = {
      .size = sizeof state, .E = is_given ? values[0] : NULL, .B = is_given ? values[1] : NULL};
  (void)dvi_march_start(march, &state);
}

static void run_whole_grid(box_trial *t)
{
  dvi_march *march = box_march(&t->g->terms);
  for (int f = 0; f < FORMS; f++) {
    t->size[f] = dvi_yee_size(&t->g->terms, form_of[f]);
    t->copies = dvi_march_size(march, form_of[f]) / t->size[f];
    t->place[f] = places_of(&t->g->terms, form_of[f], t->size[f]);
    t->start[f] = random_values(t->size[f] * t->copies, 7 + (unsigned)f);
  }
  start(march, t->start, t->stop % 2);
  t->step = step_of(march);
  for (int s = 0; s < STEPS; s++) {
    ck_assert(dvi_march_advance(march, time_of(t, s)) == DVI_OK);
    if (s == t->stop) t->bytes = save_march(march, &t->bytes_size);
    for (int f = 0; f < FORMS; f++) t->form[s][f] = sample_march(march, form_of[f]);
    observe(march, t->seen[s]);
  }
  dvi_march_destroy(&march);
}

box_trial *make_box_trial(int number)
{
  box_trial *t = calloc(1, sizeof *t);
  t->g = make_grid(1000 + (unsigned)number);
  t->number = number;
  t->stop = number % STEPS;
  t->steps = 1 + number % 7;
  run_whole_grid(t);
  return t;
}

void free_box_trial(box_trial *t)
{
  for (int f = 0; f < FORMS; f++) {
    free(t->place[f]), free(t->start[f]);
    for (int s = 0; s < STEPS; s++) free(t->form[s][f]);
  }
  for (int m = 0; m < 3; m++) free(t->g->cell[m]);
  free(t->bytes);
  free(t->g);
  free(t);
}

/* ---- several processes ---- */

static int may_divide(const dvi_yee_axis *axis, int is_there, int parts)
{
  return parts == 1 || (is_there && axis->cells / parts > 1);
}

/* Choose one of the divisions by the number of the trial. Those along two axes come more often. */
static void choose_division(const box_trial *t, dvi_yee_ranks *r)
{
  const dvi_yee_terms *terms = &t->g->terms;
  int rows[16], count = 0;
  for (int i = 1; i <= r->count; i++)
    if (r->count % i == 0 && may_divide(&terms->axis[1], 1, i) &&
        may_divide(&terms->axis[2], terms->axes > 2, r->count / i))
      for (int often = i > 1 && i < r->count ? 3 : 1; often > 0; often--) rows[count++] = i;
  r->parts[0] = 1;
  r->parts[1] = rows[t->number / 2 % count];
  r->parts[2] = r->count / r->parts[1];
}

/* Tell if a process has a place of an axis. */
static int has_place(const dvi_yee_terms *terms, const dvi_yee_ranks *r, int axis, int i)
{
  const int cells = terms->axis[axis].cells, parts = r->parts[axis],
            part = axis == 1 ? r->rank % r->parts[1] : r->rank / r->parts[1];
  return i >= cells * part / parts && (part == parts - 1 || i < cells * (part + 1) / parts);
}

/* Give the numbers in the whole grid of the cells of a process. */
static int64_t *numbers_of(const box_trial *t, const dvi_yee_ranks *r, int f, int64_t *count)
{
  int64_t *number = malloc((size_t)t->size[f] * sizeof *number);
  *count = 0;
  for (int64_t i = 0; i < t->size[f]; i++) {
    const int *place = t->place[f] + 3 * i;
    if (has_place(&t->g->terms, r, 1, place[1]) && has_place(&t->g->terms, r, 2, place[2]))
      number[(*count)++] = i;
  }
  return number;
}

static int64_t compare(const box_trial *t, const dvi_march *march, int f, int s,
                       const int64_t *number, int64_t count)
{
  double *values = sample_march(march, form_of[f]);
  int64_t wrong = 0;
  for (int64_t i = 0; i < count * t->copies; i++)
    wrong += memcmp(values + i, t->form[s][f] + i / count * t->size[f] + number[i % count],
                    sizeof *values) != 0;
  free(values);
  return wrong;
}

/* Compare the state with what one process has saved, and let a new march go on from that. Return
 * the number of failures. */
static int64_t load_anew(const box_trial *t, const dvi_yee_terms *terms, dvi_march **march)
{
  const int is_same = march_has_bytes(*march, t->bytes, t->bytes_size);
  dvi_march_destroy(march);
  return !is_same + (dvi_yee_create(terms, march) != DVI_OK) +
         (dvi_march_load_memory(*march, t->bytes, t->bytes_size) != DVI_OK);
}

/* Take the own values of a start. */
static double *own_start(const box_trial *t, int f, const int64_t *number, int64_t count)
{
  double *own = malloc((size_t)(count * t->copies) * sizeof *own);
  for (int64_t i = 0; i < count * t->copies; i++)
    own[i] = t->start[f][i / count * t->size[f] + number[i % count]];
  return own;
}

int64_t run_box_share(const box_trial *t, const dvi_yee_ranks *ranks)
{
  dvi_yee_terms terms = t->g->terms;
  dvi_march *march = NULL;
  int64_t *number[FORMS], count[FORMS], wrong = 0;
  double *own[FORMS], seen[OBSERVED] = {0};
  dvi_yee_ranks divided = *ranks;
  choose_division(t, &divided);
  terms.ranks = &divided;
  if (dvi_yee_create(&terms, &march) != DVI_OK) return -1;
  wrong += step_of(march) != t->step;
  for (int f = 0; f < FORMS; f++) {
    number[f] = numbers_of(t, &divided, f, &count[f]);
    own[f] = own_start(t, f, number[f], count[f]);
    wrong += dvi_march_size(march, form_of[f]) != count[f] * t->copies;
  }
  start(march, own, t->stop % 2);
  for (int s = 0; s < STEPS; s++) {
    wrong += dvi_march_advance(march, time_of(t, s)) != DVI_OK;
    if (s == t->stop) wrong += load_anew(t, &terms, &march);
    for (int f = 0; f < FORMS; f++) wrong += compare(t, march, f, s, number[f], count[f]);
    observe(march, seen);
    for (int i = 0; i < OBSERVED; i++) wrong += memcmp(seen + i, t->seen[s] + i, sizeof *seen) != 0;
  }
  for (int f = 0; f < FORMS; f++) free(number[f]), free(own[f]);
  dvi_march_destroy(&march);
  return wrong;
}
