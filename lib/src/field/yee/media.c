/* The stars of a grid: M_1 of eps on edges, M_2 of 1/mu on faces, and losses. */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/average.h"
#include "field/yee/yee.h"

/* ---- stars ---- */

/* Give the factor of the star without a material along an axis: the dual length, or 1/length. */
static double factor_of(const dvi__yee *y, int component, int axis, int i)
{
  const dvi__yee_axis *a = &y->axis[axis];
  return dvi__yee_reaches(component, axis) ? 1 / a->length[i] : a->dual[i];
}

/* Give the star of a component without a material: dual volume over volume. */
static double vacuum_star(const dvi__yee *y, int component, const int *place)
{
  double star = 1;
  for (int l = 0; l < 3; l++) star *= factor_of(y, component, l, place[l]);
  return star;
}

void dvi__yee_stars(const dvi__yee *y, int component, const int *place, int count, double *star)
{
  const double across = factor_of(y, component, 1, place[1]),
               up = factor_of(y, component, 2, place[2]);
  const size_t at = dvi__yee_beside(y, component, place);
  const int is_face = component >= DVI__YEE_B;
  for (int i = 0; i < count; i++) star[i] = factor_of(y, component, 0, place[0] + i) * across * up;
  for (int i = 0; i < count && is_face && y->mi != NULL; i++) star[i] *= y->mi[at + (size_t)i];
  for (int i = 0; i < count && !is_face && y->ce != NULL; i++)
    star[i] /= y->ce[at + (size_t)i] * (y->loss != NULL ? 1 + y->loss[at + (size_t)i] : 1);
}

double dvi__yee_star(const dvi__yee *y, int component, const int *place)
{
  double star;
  dvi__yee_stars(y, component, place, 1, &star);
  return star;
}

/* ---- pieces of boxes ---- */

static int is_given(const dvi_yee_medium *medium)
{
  return medium->cell != NULL || medium->at != NULL;
}

/* Give the number of a box in the whole grid, and among those whose values are kept, which are
 * beside the own nodes. */
static size_t number_of(const dvi__yee *y, const int *cell)
{
  const size_t n = (size_t)y->axis[0].cells, m = (size_t)y->axis[1].cells;
  return ((size_t)cell[2] * m + (size_t)cell[1]) * n + (size_t)cell[0];
}

static size_t number_kept(const dvi__yee *y, const int *cell)
{
  size_t number = 0;
  for (int l = 2; l > 0; l--) number = number * y->rows[l - 1] + dvi__yee_row_along(y, l, cell[l]);
  return number * (size_t)y->axis[0].cells + (size_t)cell[0];
}

/* What is summed over the pieces of boxes around an edge or face. */
typedef enum quantity { PERMITTIVITY, LOSS, PERMEABILITY, ADMITTANCE } quantity;

typedef struct stars {
  const dvi_yee_terms *terms;
  const dvi__yee *y;
  quantity what;
  const dvi_yee_medium *medium; /* of the quantity */
  dvi__average function, sigma; /* its function or for losses that of eps, and that of sigma */
  double *value; /* [boxes kept] of the function, NAN where it changes. NULL: unknown */
} stars;

static stars stars_of(const dvi_yee_terms *terms, const dvi__yee *y, quantity what)
{
  const dvi__average eps = {terms->eps.at, terms->eps.user, "eps"},
                     mu = {terms->mu.at, terms->mu.user, "mu"},
                     sigma = {terms->sigma.at, terms->sigma.user, "sigma"};
  return (stars){.terms = terms,
                 .y = y,
                 .what = what,
                 .medium = what == LOSS           ? &terms->sigma
                           : what == PERMEABILITY ? &terms->mu
                                                  : &terms->eps,
                 .function = what == PERMEABILITY ? mu : eps,
                 .sigma = sigma};
}

static dvi_status add_piece(const stars *s, int c, dvi__average_box *box, const int *cell,
                            double *sum)
{
  const dvi__yee *y = s->y;
  double along = 1, across = 1;
  if (s->medium->at != NULL) {
    const double *value = s->value != NULL ? s->value + number_kept(y, cell) : NULL;
    box->value = value != NULL && !isnan(*value) ? value : NULL;
    if (s->what == LOSS) return dvi__average_loss(&s->function, &s->sigma, box, c, sum);
    return s->what == PERMEABILITY ? dvi__average_face(&s->function, box, c, sum)
                                   : dvi__average_edge(&s->function, box, c, sum);
  }
  for (int l = 0; l < y->axes; l++) *(l == c ? &along : &across) *= box->upper[l] - box->lower[l];
  const double value = s->medium->cell != NULL ? s->medium->cell[number_of(y, cell)] : 1;
  *sum += s->what == PERMEABILITY ? along / (across * value) : across / along * value;
  return DVI_OK;
}

/* The admittance is that of the means of eps and mu in the piece. */
static dvi_status add_admittance(const stars *s, int c, dvi__average_box *box, const int *cell,
                                 double *sum)
{
  const stars of_eps = stars_of(s->terms, s->y, PERMITTIVITY),
              of_mu = stars_of(s->terms, s->y, PERMEABILITY);
  double eps = 0, over_mu = 0, ratio = 1;
  DVI_TRY(add_piece(&of_eps, c, box, cell, &eps));
  DVI_TRY(add_piece(&of_mu, c, box, cell, &over_mu));
  for (int l = 0; l < s->y->axes; l++)
    ratio *= l == c ? 1 / (box->upper[l] - box->lower[l]) : box->upper[l] - box->lower[l];
  *sum += ratio * sqrt(eps * over_mu);
  return DVI_OK;
}

/* Sum the star of a component at a place over its pieces. */
static dvi_status sum_pieces(const stars *s, int component, const int *place, double *sum)
{
  const dvi__yee *y = s->y;
  int cell[3][2], count[3], at[3];
  double lower[3][2], upper[3][2];
  *sum = 0;
  for (int l = 0; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    if (!dvi__yee_reaches(component, l)) {
      count[l] = dvi__yee_pieces(a, place[l], cell[l], lower[l], upper[l]);
      continue;
    }
    count[l] = 1;
    cell[l][0] = place[l];
    lower[l][0] = a->node[place[l]];
    upper[l][0] = a->node[place[l] + 1];
  }
  for (int n = 0; n < count[0] * count[1] * count[2]; n++) {
    dvi__average_box box = {.space = y->axes};
    for (int l = 0, rest = n; l < 3; rest /= count[l++]) {
      const int piece = rest % count[l];
      at[l] = cell[l][piece];
      box.lower[l] = lower[l][piece];
      box.upper[l] = upper[l][piece];
    }
    DVI_TRY(s->what == ADMITTANCE ? add_admittance(s, component, &box, at, sum)
                                  : add_piece(s, component % 3, &box, at, sum));
  }
  return DVI_OK;
}

dvi_status dvi__yee_admittance(const dvi_yee_terms *terms, const dvi__yee *y, int c,
                               const int *place, double *mean)
{
  const stars s = stars_of(terms, y, ADMITTANCE);
  DVI_TRY(sum_pieces(&s, c, place, mean));
  *mean /= vacuum_star(y, c, place);
  return DVI_OK;
}

/* ---- arrays ---- */

static double *new_array(const dvi__yee *y, quantity what)
{
  const int slots = what == PERMEABILITY ? y->components - y->edges_slots : y->edges_slots;
  const size_t count = y->rows[0] * y->rows[1] * (size_t)slots * y->width;
  return DVI_NEW(double, count);
}

/* Find the first plane of an axis that has pieces at the own places, or places of 1/mu, and move it
 * around if the axis repeats itself. */
static int before_own(const dvi__yee *y, int axis)
{
  const int begin = dvi__yee_begin(y, axis);
  if (!dvi__yee_is_divided(y, axis) || (begin == 0 && !y->axis[axis].wraps)) return begin;
  return begin - (y->ghosts[axis][0] > 0 ? y->ghosts[axis][0] : 1);
}

/* Find the planes of an axis at which a component needs materials. They are around the axis if it
 * repeats itself. A step needs 1/mu before the planes where it updates E, too, but for the
 * component along the axis. */
static void find_range(const dvi__yee *y, int component, int axis, int *range)
{
  dvi__yee_reach(y, axis, 0, y->together - 1, range);
  if (component >= DVI__YEE_B && component % 3 != axis) range[0] = before_own(y, axis);
  const int places = dvi__yee_places(y, component, axis);
  if (!y->axis[axis].wraps && range[1] > places) range[1] = places;
}

/* Find the boxes in which a function has one value. Where each box is one piece, that is left to
 * the piece. */
static dvi_status find_values(stars *s)
{
  const dvi__yee *y = s->y;
  const size_t count = (size_t)y->axis[0].cells * y->rows[0] * y->rows[1];
  if (s->medium->at == NULL || (s->what == PERMEABILITY && y->components - y->edges_slots == 1))
    return DVI_OK;
  s->value = DVI_NEW(double, count);
  if (s->value == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for materials");
  int rows[2], planes[2];
  find_range(y, DVI__YEE_E + 1, 1, rows);
  find_range(y, DVI__YEE_E + 2, 2, planes);
  for (int k = before_own(y, 2); k < planes[1]; k++)
    for (int j = before_own(y, 1); j < rows[1]; j++)
      for (int i = 0; i < y->axis[0].cells; i++) {
        const int cell[3] = {i, dvi__yee_around(y, 1, j), dvi__yee_around(y, 2, k)};
        dvi__average_box box = {.space = y->axes};
        for (int l = 0; l < 3; l++) {
          box.lower[l] = y->axis[l].node[cell[l]];
          box.upper[l] = y->axis[l].node[cell[l] + 1];
        }
        DVI_TRY(dvi__average_value(&s->function, s->what == LOSS ? &s->sigma : NULL, &box,
                                   s->value + number_kept(y, cell)));
      }
  return DVI_OK;
}

/* Fill an array with the sums over pieces beside those of vacuum, or for eps with the inverse. */
static dvi_status fill_places(const stars *s, double *array)
{
  const dvi__yee *y = s->y;
  const int first = s->what == PERMEABILITY ? DVI__YEE_B : DVI__YEE_E;
  for (int component = first; component < first + 3; component++) {
    int rows[2], planes[2];
    if (y->slot[component] < 0) continue;
    find_range(y, component, 1, rows);
    find_range(y, component, 2, planes);
    for (int k = planes[0]; k < planes[1]; k++)
      for (int j = rows[0]; j < rows[1]; j++)
        for (int i = 0; i < dvi__yee_places(y, component, 0); i++) {
          const int place[3] = {i, dvi__yee_around(y, 1, j), dvi__yee_around(y, 2, k)};
          double sum;
          DVI_TRY(sum_pieces(s, component, place, &sum));
          const double vacuum = vacuum_star(y, component, place);
          array[dvi__yee_beside(y, component, place)] = s->what == PERMITTIVITY ? vacuum / sum
                                                                                : sum / vacuum;
        }
  }
  return DVI_OK;
}

static dvi_status fill(const dvi_yee_terms *terms, const dvi__yee *y, quantity what, double *array)
{
  stars s = stars_of(terms, y, what);
  dvi_status status = find_values(&s);
  if (status == DVI_OK) status = fill_places(&s, array);
  dvi__release(s.value);
  return status;
}

/* Set 1/mu before the first boxes of axes that repeat themselves. */
static void wrap_faces(const dvi__yee *y, double *array)
{
  const size_t block = (size_t)(y->components - y->edges_slots) * y->width,
               n = (size_t)y->axis[0].cells;
  for (size_t row = 0; row < y->rows[0] * y->rows[1] && y->axis[0].wraps; row++)
    for (size_t start = row * block; start < (row + 1) * block; start += y->width)
      array[start + DVI__YEE_LEFT - 1] = array[start + DVI__YEE_LEFT + n - 1];
  const size_t plane = y->rows[0] * block;
  const int copies_rows = y->axis[1].wraps && !dvi__yee_is_divided(y, 1),
            copies_planes = y->axis[2].wraps && !dvi__yee_is_divided(y, 2);
  for (size_t start = 0; start < y->rows[1] * plane && copies_rows; start += plane)
    for (size_t i = 0; i < block; i++)
      array[start + i] = array[start + (size_t)y->axis[1].cells * block + i];
  for (size_t i = 0; i < plane && copies_planes; i++)
    array[i] = array[(size_t)y->axis[2].cells * plane + i];
}

static dvi_status check_cells(const dvi__yee *y, const dvi_yee_medium *medium, const char *name,
                              int may_vanish)
{
  const int64_t n = y->axis[0].cells, m = y->axis[1].cells, count = n * m * y->axis[2].cells;
  if (medium->cell != NULL && medium->at != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "yee: %s is given by boxes and by a function; give one of them", name);
  for (int64_t i = 0; i < count && medium->cell != NULL; i++) {
    const double value = medium->cell[i];
    if (isfinite(value) && (value > 0 || (may_vanish && value == 0))) continue;
    return dvi__fail(isfinite(value) ? DVI_BAD_ARGUMENT : DVI_NOT_FINITE,
                     "yee: %s = %g in the box (%d, %d, %d), which must be finite and %s", name,
                     value, (int)(i % n), (int)(i / n % m), (int)(i / n / m),
                     may_vanish ? "not negative" : "positive");
  }
  return DVI_OK;
}

dvi_status dvi__yee_make_media(const dvi_yee_terms *terms, dvi__yee *y)
{
  DVI_TRY(check_cells(y, &terms->eps, "eps", 0));
  DVI_TRY(check_cells(y, &terms->mu, "mu", 0));
  DVI_TRY(check_cells(y, &terms->sigma, "sigma", 1));
  if (is_given(&terms->eps) || is_given(&terms->sigma)) y->ce = new_array(y, PERMITTIVITY);
  if (is_given(&terms->mu)) y->mi = new_array(y, PERMEABILITY);
  if ((y->ce == NULL && (is_given(&terms->eps) || is_given(&terms->sigma))) ||
      (y->mi == NULL && is_given(&terms->mu)))
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for materials");
  if (y->ce != NULL) DVI_TRY(fill(terms, y, PERMITTIVITY, y->ce));
  if (!is_given(&terms->mu)) return DVI_OK;
  DVI_TRY(fill(terms, y, PERMEABILITY, y->mi));
  wrap_faces(y, y->mi);
  return DVI_OK;
}

dvi_status dvi__yee_make_losses(const dvi_yee_terms *terms, dvi__yee *y)
{
  const size_t count = y->rows[0] * y->rows[1] * (size_t)y->edges_slots * y->width;
  if (!is_given(&terms->sigma)) return DVI_OK;
  y->loss = new_array(y, LOSS);
  y->ca = new_array(y, LOSS);
  y->worn = new_array(y, LOSS);
  y->loses = DVI_NEW(char, count / y->width);
  if (y->loss == NULL || y->ca == NULL || y->worn == NULL || y->loses == NULL)
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for losses");
  DVI_TRY(fill(terms, y, LOSS, y->loss));
  for (size_t i = 0; i < count; i++) {
    const double s = 0.5 * y->dt * y->loss[i] * y->ce[i];
    y->loss[i] = s;
    if (s > 0) y->loses[i / y->width] = 1;
    y->ca[i] = (1 - s) / (1 + s);
    y->ce[i] /= 1 + s;
  }
  return DVI_OK;
}
