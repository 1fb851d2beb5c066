/* The sizes of a grid, the numbers of its cells, and integrals over them. */
#include <math.h>

#include "core/status.h"
#include "field/yee/ranks.h"

enum { VECTOR = 8, POINTS = 5 };

/* ---- the grid ---- */

static dvi_status check_terms(const dvi_yee_terms *terms)
{
  if (terms == NULL || terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: set terms.size to sizeof(dvi_yee_terms)");
  if (terms->axes < 1 || terms->axes > 3)
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: a grid has 1 to 3 axes, not %d", terms->axes);
  const int is_right = terms->axes == 3   ? terms->degree == 1
                       : terms->axes == 2 ? terms->degree == 0 || terms->degree == 1
                                          : terms->degree == 0;
  if (is_right) return DVI_OK;
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "yee: E has the degree %d on %d axes; set 1 on three, 1 or 0 on two for (Ex, Ey) "
      "or Ez, and 0 on one",
      terms->degree, terms->axes);
}

/* Number the components that the grid has, E first. */
static void set_slots(dvi__yee *y)
{
  enum { EX = 1, EY = 2, EZ = 4, BX = 8, BY = 16, BZ = 32 };
  const unsigned set = y->axes == 3     ? EX | EY | EZ | BX | BY | BZ
                       : y->axes == 1   ? EY | BZ
                       : y->degree == 0 ? EZ | BX | BY
                                        : EX | EY | BZ;
  y->components = y->edges_slots = 0;
  for (int c = 0; c < 6; c++) {
    y->slot[c] = set >> c & 1 ? y->components++ : -1;
    if (c == 2) y->edges_slots = y->components;
  }
}

/* Count the cells of a component that this process has, or all. */
static int64_t count_cells(const dvi__yee *y, int component)
{
  int64_t count = 1;
  for (int l = 0; l < 3; l++) count *= dvi__yee_end(y, component, l) - dvi__yee_begin(y, l);
  return y->slot[component] >= 0 ? count : 0;
}

static int64_t count_all(const dvi__yee *y, int component)
{
  int64_t count = 1;
  for (int l = 0; l < 3; l++) count *= dvi__yee_places(y, component, l);
  return y->slot[component] >= 0 ? count : 0;
}

static void count_unknowns(dvi__yee *y)
{
  y->unknowns = y->faces = 0;
  for (int c = 0; c < 3; c++) {
    int64_t count = y->slot[c] >= 0;
    for (int l = 0; l < 3; l++)
      count *= c == l ? y->axis[l].cells
                      : (y->axis[l].free[1] > y->axis[l].free[0]
                             ? y->axis[l].free[1] - y->axis[l].free[0]
                             : 0);
    y->unknowns += count;
    y->faces += count_all(y, DVI__YEE_B + c);
  }
}

/* Give the box behind the last own one of an axis. */
static int last_box(const dvi__yee *y, int l)
{
  return y->own[l][1] < y->axis[l].cells ? y->own[l][1] : y->axis[l].cells;
}

/* Half of the address space is enough for all. */
static dvi_status set_sizes(const dvi_yee_terms *terms, dvi__yee *y)
{
  const size_t places = (size_t)y->axis[0].cells + 1;
  double size = 1;
  y->count = (places + VECTOR - 1) / VECTOR * VECTOR;
  y->width = y->count + DVI__YEE_LEFT;
  DVI_TRY(dvi__yee_divide(terms, y));
  for (int l = 1; l < 3; l++) {
    const int margins = dvi__yee_margin(y, l, 0) + dvi__yee_margin(y, l, 1);
    y->rows[l - 1] = (size_t)(last_box(y, l) - y->own[l][0]) + (size_t)margins;
  }
  size = (double)y->width * (double)y->rows[0] * (double)y->rows[1] * y->components;
  if (size > 1e15)
    return dvi__fail(DVI_BAD_SIZE, "yee: a grid of %d x %d x %d boxes is too large",
                     y->axis[0].cells, y->axis[1].cells, y->axis[2].cells);
  y->next[0] = 1;
  y->next[1] = y->axis[1].is_trivial ? 0 : (ptrdiff_t)(y->width * (size_t)y->components);
  y->next[2] = y->axis[2].is_trivial ? 0
                                     : (ptrdiff_t)(y->width * (size_t)y->components * y->rows[0]);
  y->size = y->width * (size_t)y->components * y->rows[0] * y->rows[1];
  return DVI_OK;
}

dvi_status dvi__yee_make_grid(const dvi_yee_terms *terms, dvi__yee *y)
{
  DVI_TRY(check_terms(terms));
  y->axes = terms->axes;
  y->degree = terms->degree;
  y->copies = 1;
  for (int l = 0; l < 3; l++) {
    DVI_TRY(dvi__yee_make_axis(l < y->axes ? &terms->axis[l] : NULL, l, &y->axis[l]));
    if (y->axis[l].end[0].kind == DVI_YEE_BLOCH) y->copies = 2;
  }
  set_slots(y);
  count_unknowns(y);
  return set_sizes(terms, y);
}

/* ---- numbers of cells ---- */

static int first_of(dvi_march_form form)
{
  return form == DVI_FORM_B ? DVI__YEE_B : DVI__YEE_E;
}

/* Make a grid for a question about it alone, and release it by clear_grid. */
static dvi_status make_bare_grid(const dvi_yee_terms *terms, dvi__yee *y)
{
  *y = (dvi__yee){.axes = 0};
  return dvi__yee_make_grid(terms, y);
}

static void clear_grid(dvi__yee *y)
{
  for (int l = 0; l < 3; l++) dvi__yee_clear_axis(&y->axis[l]);
}

int64_t dvi__yee_form_size(const dvi__yee *y, dvi_march_form form)
{
  int64_t count = 0;
  for (int c = 0; c < 3 && form != DVI_FORM_A; c++) count += count_cells(y, first_of(form) + c);
  return count;
}

int64_t dvi__yee_whole_size(const dvi__yee *y, dvi_march_form form)
{
  int64_t count = 0;
  for (int c = 0; c < 3; c++) count += count_all(y, first_of(form) + c);
  return count;
}

size_t dvi__yee_count_nodes(const dvi__yee *y)
{
  size_t count = 1;
  for (int l = 0; l < 3; l++) count *= (size_t)(y->own[l][1] - y->own[l][0]);
  return count;
}

int64_t dvi__yee_whole_number(const dvi__yee *y, int component, const int *place)
{
  int64_t number = 0;
  for (int l = 2; l >= 0; l--) number = number * dvi__yee_places(y, component, l) + place[l];
  for (int c = component - component % 3; c < component; c++) number += count_all(y, c);
  return number;
}

int64_t dvi_yee_size(const dvi_yee_terms *terms, dvi_march_form form)
{
  dvi__yee y;
  const int64_t size = make_bare_grid(terms, &y) == DVI_OK ? dvi__yee_form_size(&y, form) : 0;
  clear_grid(&y);
  return size;
}

static int64_t number_of(const dvi__yee *y, dvi_march_form form, int c, const int *index)
{
  int64_t number = 0;
  if (form == DVI_FORM_A || c < 0 || c > 2 || y->slot[first_of(form) + c] < 0) return -1;
  for (int l = 2; l >= 0; l--) {
    const int begin = dvi__yee_begin(y, l), end = dvi__yee_end(y, first_of(form) + c, l),
              i = l < y->axes ? index[l] : 0;
    if (i < begin || i >= end) return -1;
    number = number * (end - begin) + i - begin;
  }
  for (int before = 0; before < c; before++) number += count_cells(y, first_of(form) + before);
  return number;
}

int64_t dvi_yee_place(const dvi_yee_terms *terms, dvi_march_form form, int component,
                      const int *index)
{
  dvi__yee y;
  const int64_t number = index != NULL && make_bare_grid(terms, &y) == DVI_OK
                             ? number_of(&y, form, component, index)
                             : -1;
  if (index != NULL) clear_grid(&y);
  return number;
}

void dvi__yee_place_of(const dvi__yee *y, dvi_march_form form, int64_t number, int *component,
                       int *place)
{
  int c = 0;
  while (number >= count_cells(y, first_of(form) + c))
    number -= count_cells(y, first_of(form) + c++);
  *component = first_of(form) + c;
  for (int l = 0; l < 3; l++) {
    const int begin = dvi__yee_begin(y, l), count = dvi__yee_end(y, *component, l) - begin;
    place[l] = begin + (int)(number % count);
    number /= count;
  }
}

/* ---- integrals ---- */

/* Gauss's rule with 5 points on [-1, 1] (Abramowitz and Stegun 1964, table 25.4). */
static const double gauss_node[POINTS] = {-0.90617984593866399, -0.53846931010568309, 0,
                                          0.53846931010568309, 0.90617984593866399};
static const double gauss_weight[POINTS] = {0.23692688505618909, 0.47862867049936647,
                                            0.56888888888888889, 0.47862867049936647,
                                            0.23692688505618909};

dvi_status dvi__yee_integrate_box(const double *lower, const double *upper, const int *reaches,
                                  dvi_form_function *function, void *user, int which, double *sum)
{
  int points = 1;
  *sum = 0;
  for (int l = 0; l < 3; l++) points *= reaches[l] ? POINTS : 1;
  for (int p = 0; p < points; p++) {
    double x[3] = {0}, value[3] = {0}, weight = 1;
    for (int l = 0, rest = p; l < 3; l++) {
      x[l] = lower[l];
      if (!reaches[l]) continue;
      const double half = 0.5 * (upper[l] - lower[l]);
      x[l] = lower[l] + half * (1 + gauss_node[rest % POINTS]);
      weight *= half * gauss_weight[rest % POINTS];
      rest /= POINTS;
    }
    const int failed = function(x, value, user);
    if (failed != 0 || !isfinite(value[which]))
      return dvi__fail(failed != 0 ? DVI_CALLBACK_FAILED : DVI_NOT_FINITE,
                       failed != 0 ? "yee: a function of the place returned %g at (%g, %g, %g)"
                                   : "yee: a function of the place gave %g at (%g, %g, %g)",
                       failed != 0 ? failed : value[which], x[0], x[1], x[2]);
    *sum += weight * value[which];
  }
  return DVI_OK;
}

static dvi_status integrate_cell(const dvi__yee *y, int component, const int *place,
                                 dvi_form_function *function, void *user, double *value)
{
  double lower[3], upper[3];
  int reaches[3], which = 0;
  for (int l = 0; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    reaches[l] = !a->is_trivial && dvi__yee_reaches(component, l);
    lower[l] = a->node[place[l]];
    upper[l] = a->node[place[l] + reaches[l]];
  }
  for (int c = component < DVI__YEE_B ? DVI__YEE_E : DVI__YEE_B; c < component; c++)
    which += y->slot[c] >= 0;
  return dvi__yee_integrate_box(lower, upper, reaches, function, user, which, value);
}

dvi_status dvi_yee_integrate(const dvi_yee_terms *terms, dvi_march_form form,
                             dvi_form_function *function, void *user, double *values)
{
  dvi__yee y;
  if (function == NULL || values == NULL || (form != DVI_FORM_E && form != DVI_FORM_B))
    return dvi__fail(DVI_BAD_ARGUMENT, "yee: a function of E or B, and a place for its integrals, "
                                       "are needed");
  dvi_status status = make_bare_grid(terms, &y);
  const int64_t size = status == DVI_OK ? dvi__yee_form_size(&y, form) : 0;
  for (int64_t i = 0; i < size && status == DVI_OK; i++) {
    int component, place[3] = {0, 0, 0};
    dvi__yee_place_of(&y, form, i, &component, place);
    status = integrate_cell(&y, component, place, function, user, values + i);
  }
  clear_grid(&y);
  return status;
}
