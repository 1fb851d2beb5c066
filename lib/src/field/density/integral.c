/* The sums of some parts, and the patterns of their second derivatives. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for a pattern");
}

/* ---- which pairs of a group are coupled ---- */

static int *new_slots(const dvi__point_groups *g)
{
  const int64_t count = g->square[g->groups];
  int *slots = DVI_NEW(int, count);
  for (int64_t i = 0; i < count && slots != NULL; i++) slots[i] = -1;
  return slots;
}

static dvi_status allocate_slots(dvi__density_part *part, unsigned second)
{
  const dvi__point_groups *g = &part->group;
  if (second & DVI__QQ) part->slots.qq = new_slots(g);
  if (second & DVI__QV) part->slots.qv = new_slots(g);
  if (second & DVI__VV) part->slots.vv = new_slots(g);
  return (!(second & DVI__QQ) || part->slots.qq) && (!(second & DVI__QV) || part->slots.qv) &&
                 (!(second & DVI__VV) || part->slots.vv)
             ? DVI_OK
             : no_memory();
}

/* Mark rows of a with columns of b at point k. */
static void mark(const dvi__density_part *part, int64_t k, int a, int b, int size, int *square)
{
  const dvi__jet_rows *A = part->rows + a, *B = part->rows + b;
  for (int64_t i = A->start[k]; i < A->start[k + 1]; i++)
    for (int64_t j = B->start[k]; j < B->start[k + 1]; j++)
      square[A->local[i] * size + B->local[j]] = 0;
}

static void mark_pair(dvi__density_part *part, int64_t k, int a, int b)
{
  const dvi__point_groups *g = &part->group;
  const int of = g->of[k], size = (int)(g->start[of + 1] - g->start[of]);
  const int64_t shift = g->square[of];
  const int a_rate = part->given.variable[a].rate != 0, b_rate = part->given.variable[b].rate != 0;
  int *const same = a_rate ? part->slots.vv : part->slots.qq;
  if (a_rate == b_rate && same != NULL) {
    mark(part, k, a, b, size, same + shift);
    mark(part, k, b, a, size, same + shift);
  } else if (a_rate != b_rate && part->slots.qv != NULL) {
    mark(part, k, a_rate ? b : a, a_rate ? a : b, size, part->slots.qv + shift);
  }
}

static void mark_all(dvi__density_part *part)
{
  for (int64_t k = 0; k < part->points; k++)
    for (int e = 0; e < part->given.pairs; e++)
      mark_pair(part, k, part->given.pair[e][0], part->given.pair[e][1]);
}

/* ---- patterns ---- */

static int *slots_of(const dvi__density_part *part, dvi__second second)
{
  return second == DVI__QQ ? part->slots.qq : second == DVI__QV ? part->slots.qv : part->slots.vv;
}

static int compare(const void *a, const void *b)
{
  return (*(const int *)a > *(const int *)b) - (*(const int *)a < *(const int *)b);
}

/* Visit the marked pairs of all parts: count their columns, or enter their rows from next[column]
 * on. */
static void visit(const dvi__integral *integral, dvi__second second, int64_t *next, int *row)
{
  for (int p = 0; p < integral->parts; p++) {
    const dvi__point_groups *g = &integral->part[p]->group;
    const int *slots = slots_of(integral->part[p], second);
    for (int64_t of = 0; of < g->groups; of++) {
      const int64_t size = g->start[of + 1] - g->start[of];
      const int *list = g->list + g->start[of], *square = slots + g->square[of];
      for (int64_t i = 0; i < size; i++)
        for (int64_t j = 0; j < size; j++) {
          if (square[i * size + j] < 0) continue;
          if (row != NULL) row[next[list[j]]] = list[i];
          next[list[j]]++;
        }
    }
  }
}

/* Leave out repetitions in each column. */
static void compress(int n, const int64_t *first, int *row, int *start)
{
  int count = 0;
  for (int j = 0; j < n; j++) {
    const int64_t length = first[j + 1] - first[j];
    qsort(row + first[j], (size_t)length, sizeof *row, compare);
    start[j] = count;
    for (int64_t e = first[j]; e < first[j + 1]; e++)
      if (e == first[j] || row[e] != row[e - 1]) row[count++] = row[e];
  }
  start[n] = count;
}

static dvi_status make_pattern(const dvi__integral *integral, dvi__second second,
                               dvi__pattern *pattern)
{
  const int n = (int)integral->density->unknowns;
  int64_t *first = DVI_NEW(int64_t, 2 * ((int64_t)n + 1));
  pattern->rows = pattern->columns = n;
  pattern->start = DVI_NEW(int, n + 1);
  if (first == NULL || pattern->start == NULL) {
    dvi__release(first);
    return no_memory();
  }
  visit(integral, second, first + 1, NULL);
  for (int j = 0; j < n; j++) first[j + 1] += first[j];
  int64_t *next = first + n + 1;
  memcpy(next, first, (size_t)n * sizeof *next);
  pattern->row = DVI_NEW(int, first[n]);
  dvi_status status = pattern->row != NULL ? DVI_OK : no_memory();
  if (status == DVI_OK) {
    visit(integral, second, next, pattern->row);
    compress(n, first, pattern->row, pattern->start);
  }
  dvi__release(first);
  return status;
}

static void number_slots(const dvi__pattern *pattern, const dvi__point_groups *g, int *slots)
{
  for (int64_t of = 0; of < g->groups; of++) {
    const int64_t size = g->start[of + 1] - g->start[of];
    const int *list = g->list + g->start[of];
    int *square = slots + g->square[of];
    for (int64_t i = 0; i < size; i++)
      for (int64_t j = 0; j < size; j++)
        if (square[i * size + j] >= 0)
          square[i * size + j] = dvi__pattern_find(pattern, list[i], list[j]);
  }
}

static dvi_status make_second(const dvi__integral *integral, dvi__second second,
                              dvi__pattern *pattern)
{
  DVI_TRY(make_pattern(integral, second, pattern));
  for (int p = 0; p < integral->parts; p++)
    number_slots(pattern, &integral->part[p]->group, slots_of(integral->part[p], second));
  return DVI_OK;
}

static dvi_status make_patterns(dvi__integral *integral, unsigned second)
{
  for (int p = 0; p < integral->parts; p++) {
    DVI_TRY(allocate_slots(integral->part[p], second));
    mark_all(integral->part[p]);
  }
  if (second & DVI__QQ) DVI_TRY(make_second(integral, DVI__QQ, &integral->patterns.qq));
  if (second & DVI__QV) DVI_TRY(make_second(integral, DVI__QV, &integral->patterns.qv));
  if (second & DVI__VV) DVI_TRY(make_second(integral, DVI__VV, &integral->patterns.vv));
  return DVI_OK;
}

/* ---- reach ---- */

static void find_reach(dvi__integral *integral)
{
  for (int p = 0; p < integral->parts; p++) {
    const dvi__point_groups *g = &integral->part[p]->group;
    for (int64_t of = 0; of < g->groups; of++) {
      if (g->start[of + 1] == g->start[of]) continue;
      const int reach = g->list[g->start[of + 1] - 1] - g->list[g->start[of]];
      if (reach > integral->reach) integral->reach = reach;
    }
  }
}

/* Tell if the points of each coordinate's range touch no coordinate beyond its reach. Where an end
 * is the other end, as on a circle, the range of the first coordinate has all points. */
static int has_near_points(const dvi__integral *integral)
{
  for (int p = 0; p < integral->parts; p++) {
    const dvi__density_part *part = integral->part[p];
    const dvi__point_groups *g = &part->group;
    for (int64_t i = 0; i < integral->density->unknowns; i++)
      for (int64_t k = part->low[i]; k < part->high[i]; k++)
        for (int64_t e = g->start[g->of[k]]; e < g->start[g->of[k] + 1]; e++)
          if (g->list[e] < i - integral->reach || g->list[e] > i + integral->reach) return 0;
  }
  return 1;
}

/* Tell if blocks of coordinates have few points of other blocks. In a plane the points of two rows
 * of cells touch each block, unless they are nodes. */
static int has_few_points(const dvi__integral *integral)
{
  enum { BLOCK = 512 };
  const int64_t n = integral->density->unknowns;
  int64_t points = 0, visited = 0;
  for (int p = 0; p < integral->parts; p++) {
    const dvi__density_part *part = integral->part[p];
    points += part->points;
    for (int64_t first = 0; first < n; first += BLOCK)
      visited += part->high[(first + BLOCK < n ? first + BLOCK : n) - 1] - part->low[first];
  }
  return 2 * visited <= 3 * points;
}

/* ---- integrals ---- */

dvi_status dvi__integral_add(dvi__integral *integral, dvi__density_part *part)
{
  if (integral->part == NULL)
    integral->part = DVI_NEW(dvi__density_part *, integral->density->parts);
  if (integral->part == NULL) return no_memory();
  integral->part[integral->parts++] = part;
  for (int a = 0; a < part->given.variables; a++)
    integral->takes_rates |= part->given.variable[a].rate != 0;
  if (!part->given.depends_on_time) return DVI_OK;
  integral->depends_on_time = 1;
  if (part->given.time_derivative == NULL) integral->has_rate = 0;
  return DVI_OK;
}

dvi_status dvi__integral_make(const dvi_density *density, double sign, unsigned second,
                              dvi__integral *integral)
{
  integral->sign = sign;
  if (density->moving > 0) integral->depends_on_time = 1;
  if (density->is_fourier) {
    integral->has_hessian = density->unknowns <= DVI__MODES_WITH_HESSIAN;
    return DVI_OK;
  }
  DVI_TRY(make_patterns(integral, second));
  find_reach(integral);
  integral->has_hessian = 1;
  integral->has_ranges = 2 * integral->reach < density->unknowns && has_few_points(integral) &&
                         has_near_points(integral);
  return DVI_OK;
}

void dvi__integral_clear(dvi__integral *integral)
{
  dvi__pattern_clear(&integral->patterns.qq);
  dvi__pattern_clear(&integral->patterns.qv);
  dvi__pattern_clear(&integral->patterns.vv);
  dvi__release(integral->part);
  *integral = (dvi__integral){0};
}

/* ---- evaluation ---- */

int64_t dvi__integral_entries(const dvi__integral *integral, const dvi__pattern *pattern)
{
  const int64_t n = integral->density->unknowns;
  return integral->density->is_fourier ? n * n : dvi__pattern_entries(pattern);
}

static void set_zero(int64_t count, double *values)
{
  if (values != NULL) memset(values, 0, (size_t)count * sizeof *values);
}

static void set_sums(const dvi__integral *integral, const dvi__density_point *at,
                     const dvi__density_sums *s)
{
  const dvi__density_patterns *p = &integral->patterns;
  set_zero(1, s->value);
  set_zero(1, s->rate);
  set_zero(at->last - at->first, s->q);
  set_zero(at->last - at->first, s->v);
  if (s->qq != NULL) set_zero(dvi__integral_entries(integral, &p->qq), s->qq);
  if (s->qv != NULL) set_zero(dvi__integral_entries(integral, &p->qv), s->qv);
  if (s->vv != NULL) set_zero(dvi__integral_entries(integral, &p->vv), s->vv);
}

/* Take the part away that another potential has. */
static void subtract_quadratic(const dvi__integral *integral, const dvi__density_point *at,
                               const dvi__density_sums *s)
{
  const dvi__csr *K = integral->less;
  if (s->value != NULL) *s->value -= integral->less_value;
  for (int64_t i = at->first; i < at->last; i++) {
    double sum = 0;
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++)
      sum += K->value[e] * at->q[K->column[e]];
    if (s->value != NULL) *s->value -= at->q[i] * (0.5 * sum - integral->load[i]);
    if (s->q != NULL) s->q[i - at->first] -= sum - integral->load[i];
  }
  for (int64_t i = 0; i < K->rows && s->qq != NULL; i++)
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++)
      s->qq[i * K->rows + K->column[e]] -= K->value[e];
}

/* Evaluate the values that move, and those of their derivatives in time that are read. */
static int find_moving(const dvi__integral *integral, const dvi__density_point *at,
                       const dvi__density_sums *sums, double *room)
{
  const dvi_density *density = integral->density;
  const int with_second = at->take_second || sums->rate != NULL,
            with_rate = integral->takes_rates || with_second;
  return dvi__density_moving(density, at->t, room, with_rate ? room + density->moving : NULL,
                             with_second ? room + 2 * density->moving : NULL);
}

int dvi__integral_evaluate(const dvi__integral *integral, const dvi__density_point *where,
                           const dvi__density_sums *sums)
{
  const dvi_density *density = integral->density;
  dvi__density_point at = *where;
  double *room = NULL;
  int failed = 0;
  if (at.last == 0) at.last = (int)density->unknowns;
  if (density->rooms != NULL) {
    room = dvi__rooms_take(density->rooms);
    if (room == NULL) return DVI_NO_MEMORY;
  }
  set_sums(integral, &at, sums);
  if (density->moving > 0) failed = find_moving(integral, &at, sums, room);
  for (int p = 0; p < integral->parts && failed == 0; p++)
    failed = density->is_fourier
                 ? dvi__part_sum_by_transforms(integral, integral->part[p], &at, room, sums)
                 : dvi__part_sum(integral, integral->part[p], &at, room, sums);
  if (failed == 0 && integral->less != NULL) subtract_quadratic(integral, &at, sums);
  dvi__rooms_return(density->rooms, room);
  return failed;
}
