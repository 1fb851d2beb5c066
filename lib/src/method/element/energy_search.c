#include "method/element/energy_search.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* Iterations for a root or a turning point. A bracket that three of the fast ones do not halve is
 * bisected. */
enum { MOST_ITERATIONS = 100 };

/* Relative distance at which a turning point is close enough, because D is flat there. */
static const double turning_point = 1e-8;

dvi_status dvi__energy_search_create(dvi__bordered *b, dvi__energy_search *search)
{
  const size_t n = (size_t)b->element.system->n;
  double *at = search->numbers = DVI_NEW(double, 4 * n);
  search->b = b;
  search->memory = DVI_NEW(double, b->element.memory_count);
  if (at == NULL || search->memory == NULL)
    return dvi__fail(DVI_NO_MEMORY, "sem: no memory for %zu coordinates", n);
  search->state = (dvi__state){
      .q = at, .p = at + n, .q_compensation = at + 2 * n, .p_compensation = at + 3 * n};
  return DVI_OK;
}

void dvi__energy_search_clear(dvi__energy_search *search)
{
  dvi__release(search->numbers);
  dvi__release(search->memory);
}

static void copy_state(size_t n, const dvi__state *from, dvi__state *to)
{
  to->t = from->t;
  to->t_compensation = from->t_compensation;
  memcpy(to->q, from->q, 4 * n * sizeof(double));
}

/* ---- trials ---- */

void dvi__energy_search_begin(dvi__energy_search *search, const dvi__state *state, double target)
{
  const dvi__stepper *element = &search->b->element;
  memcpy(search->memory, element->memory, element->memory_count * sizeof(double));
  search->from = state;
  search->target = target;
  search->tried = 0;
}

dvi_status dvi__energy_search_try(dvi__energy_search *search, double h, int sloping,
                                  dvi__mismatch *found)
{
  dvi__stepper *element = &search->b->element;
  copy_state((size_t)element->system->n, search->from, &search->state);
  memcpy(element->memory, search->memory, element->memory_count * sizeof(double));
  DVI_TRY(dvi__element_step(element, &search->state, h));
  const double *Y = dvi__element_last_path(element);
  DVI_TRY(dvi__bordered_energies(search->b, search->from, h, Y, &found->E));
  if (sloping) DVI_TRY(dvi__bordered_slope(search->b, Y, &found->slope));
  found->h = h;
  found->value = found->E.start - search->target;
  if (!search->tried || fabs(found->value) < fabs(search->best.value)) search->best = *found;
  search->tried = 1;
  return DVI_OK;
}

void dvi__energy_search_take(const dvi__energy_search *search, dvi__state *state)
{
  copy_state((size_t)search->b->element.system->n, &search->state, state);
}

int dvi__energy_solved(const dvi__mismatch *found)
{
  return fabs(found->value) <= dvi__energy_floor(&found->E);
}

/* ---- between two trials ---- */

/* Give the function whose zero is searched between two lengths, D or its slope. */
static double searched_function(const dvi__mismatch *m, int turning)
{
  return turning ? m->slope : m->value;
}

static int is_bracket(const dvi__mismatch *a, const dvi__mismatch *c, int turning)
{
  return (searched_function(a, turning) > 0) != (searched_function(c, turning) > 0);
}

/* Tell whether |D| falls from both ends into the interval. */
static int turns_towards_zero(const dvi__mismatch *a, const dvi__mismatch *c)
{
  return a->value * a->slope * (c->h - a->h) < 0 && c->value * c->slope * (a->h - c->h) < 0;
}

/* Narrow a bracket by regula falsi with Illinois' weights. In a search for a turning point, a
 * change of sign of D ends it, and a and c bracket a root. */
static dvi_status narrow_bracket(dvi__energy_search *search, dvi__mismatch *a, dvi__mismatch *c,
                                 int turning)
{
  double weight_a = 1, weight_c = 1, looked_at = HUGE_VAL;
  int side = 0;
  for (int i = 0; i < MOST_ITERATIONS; i++) {
    const double fa = weight_a * searched_function(a, turning),
                 fc = weight_c * searched_function(c, turning), width = c->h - a->h;
    const int lingers = i % 3 == 0 && fabs(width) > 0.5 * looked_at;
    double h = a->h + width * (fa / (fa - fc));
    dvi__mismatch middle;
    if (i % 3 == 0) looked_at = fabs(width);
    /* signs may be noise */
    if (lingers || !((h - a->h) / width > 0 && (h - a->h) / width < 1)) h = a->h + 0.5 * width;
    if (h == a->h || h == c->h || (turning && fabs(width) <= turning_point * fabs(h))) break;
    DVI_TRY(dvi__energy_search_try(search, h, 1, &middle));
    if (dvi__energy_solved(&middle) || (turning && is_bracket(a, &middle, 0))) {
      *c = middle;
      break;
    }
    if (is_bracket(a, &middle, turning)) {
      *c = middle;
      weight_c = 1;
      if (side == 1) weight_a *= 0.5;
      side = 1;
    } else {
      *a = middle;
      weight_a = 1;
      if (side == -1) weight_c *= 0.5;
      side = -1;
    }
  }
  return DVI_OK;
}

/* Look for a root between two neighbours. *found tells whether the best trial is one. */
static dvi_status look_between(dvi__energy_search *search, dvi__mismatch a, dvi__mismatch c,
                               int *found)
{
  if (!is_bracket(&a, &c, 0) && turns_towards_zero(&a, &c))
    DVI_TRY(narrow_bracket(search, &a, &c, 1));
  if (is_bracket(&a, &c, 0)) DVI_TRY(narrow_bracket(search, &a, &c, 0));
  *found = dvi__energy_solved(&search->best);
  return DVI_OK;
}

/* ---- along the branch ---- */

/* One of the two directions from the last length. */
typedef struct search_direction {
  dvi__mismatch last;
  double factor, bound;
  int open;
} search_direction;

/* Try the next length in this direction, and search the lengths between. The direction ends where
 * the rows have no solution. */
static dvi_status search_next_length(dvi__energy_search *search, search_direction *w, int *found)
{
  const double wanted = w->last.h * w->factor;
  const int beyond = w->factor > 1 ? fabs(wanted) >= w->bound : fabs(wanted) <= w->bound;
  dvi__mismatch next;
  w->open = !beyond;
  if (fabs(w->last.h) == w->bound) return DVI_OK;
  const dvi_status status = dvi__energy_search_try(
      search, beyond ? copysign(w->bound, wanted) : wanted, 1, &next);
  if (status != DVI_OK) {
    w->open = 0;
    return status > 0 ? DVI_OK : status;
  }
  const dvi__mismatch before = w->last;
  w->last = next;
  const dvi_status between = look_between(search, before, next, found);
  return between > 0 ? DVI_OK : between;
}

/* Enter the branch at the last length, or at the longest of its halves at which the rows have a
 * solution. */
static dvi_status enter_branch(dvi__energy_search *search, double last, double least, double most,
                               dvi__mismatch *first)
{
  double h = copysign(fmin(fmax(fabs(last), least), most), last);
  dvi_status status = dvi__energy_search_try(search, h, 1, first);
  while (status > 0 && fabs(h) > least) {
    h = copysign(fmax(0.5 * fabs(h), least), last);
    status = dvi__energy_search_try(search, h, 1, first);
  }
  return status;
}

static dvi_status search_both_directions(dvi__energy_search *search, double last, double least,
                                         double most)
{
  const double ratio = sqrt(2.0);
  dvi__mismatch first;
  int found = 0;
  DVI_TRY(enter_branch(search, last, least, most, &first));
  search_direction ways[2] = {{.last = first, .factor = ratio, .bound = most, .open = 1},
                              {.last = first, .factor = 1 / ratio, .bound = least, .open = 1}};
  found = dvi__energy_solved(&first);
  while (!found && (ways[0].open || ways[1].open))
    for (int k = 0; k < 2 && !found; k++)
      if (ways[k].open) DVI_TRY(search_next_length(search, &ways[k], &found));
  return DVI_OK;
}

dvi_status dvi__energy_search_find(dvi__energy_search *search, double last, double least,
                                   double most, dvi__mismatch *found)
{
  search->tried = 0;
  DVI_TRY(search_both_directions(search, last, least, most));
  return dvi__energy_search_try(search, search->best.h, 1, found);
}
