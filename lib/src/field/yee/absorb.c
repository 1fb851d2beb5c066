/* Absorbing ends. A wave that leaves at a right angle has the tangential H = sqrt(eps/mu) E at the
 * end, which is Mur's condition of first order in its impedance form, that of Silver and Mueller
 * (Mur 1981; Monk 2003, sec. 1.4.3). The end has it by a current S E, where S is the star of the
 * end itself with the admittance sqrt(eps/mu) of the boxes behind it, as on meshes
 * (field/model/damping.c). An edge where two ends meet has the sum of theirs. The boxes at the end
 * have half dual boxes, as before a PMC end, and a step is
 *
 *     E+ = E' - (E' + E) s/(1 + s + s0),   s = dt S/(2 M_1),
 *
 * with E' of the step without S, and s0 of conductors. A step takes dt E.S E out of the energy, for
 * the mean E of E+ and E, whatever comes, so that the bound of steps is that without S. */
#include "core/memory.h"
#include "core/status.h"
#include "field/yee/yee.h"

/* Give the number of the row of E_c among those of edges. */
static size_t row_of(const dvi__yee *y, int c, int j, int k)
{
  return dvi__yee_at_edges(y, c, j, k) / y->width;
}

/* Give the sum over the absorbing ends of an edge of 1/length of the half box there, or 0. */
static double openness(const dvi__yee *y, int c, const int *place)
{
  double sum = 0;
  if (!dvi__yee_is_unknown(y, c, place)) return 0;
  for (int l = 0; l < y->axes; l++)
    if (l != c && dvi__yee_absorbs_at(&y->axis[l], place[l])) sum += 1 / y->axis[l].dual[place[l]];
  return sum;
}

/* ---- creation ---- */

/* Work on all rows at which this process updates E. */
static dvi_status for_rows(const dvi_yee_terms *terms, const dvi__yee *y,
                           dvi_status (*work)(const dvi_yee_terms *terms, const dvi__yee *y, int c,
                                              int j, int k))
{
  int rows[2], planes[2];
  dvi__yee_reach(y, 1, 0, y->together - 1, rows);
  dvi__yee_reach(y, 2, 0, y->together - 1, planes);
  for (int c = 0; c < 3; c++)
    for (int k = planes[0]; k < planes[1] && y->slot[c] >= 0; k++)
      for (int j = rows[0]; j < rows[1]; j++)
        DVI_TRY(work(terms, y, c, dvi__yee_around(y, 1, j), dvi__yee_around(y, 2, k)));
  return DVI_OK;
}

static dvi_status count_row(const dvi_yee_terms *terms, const dvi__yee *y, int c, int j, int k)
{
  int place[3] = {0, j, k};
  (void)terms;
  for (; place[0] < dvi__yee_places(y, c, 0); place[0]++)
    y->wall_first[row_of(y, c, j, k) + 1] += openness(y, c, place) > 0;
  return DVI_OK;
}

/* Count the places of each row, and let each row begin where the one before it ends. */
static void count_places(const dvi__yee *y)
{
  const size_t rows = y->rows[0] * y->rows[1] * (size_t)y->edges_slots;
  (void)for_rows(NULL, y, count_row);
  for (size_t row = 0; row < rows; row++) y->wall_first[row + 1] += y->wall_first[row];
}

static dvi_status set_wall(const dvi_yee_terms *terms, const dvi__yee *y, int c, const int *place,
                           dvi__yee_wall *wall)
{
  double admittance;
  DVI_TRY(dvi__yee_admittance(terms, y, c, place, &admittance));
  wall->place = place[0];
  wall->s = 0.5 * y->dt * admittance * openness(y, c, place) * dvi__yee_over_eps(y, c, place);
  wall->part = wall->s / (1 + wall->s + dvi__yee_conduction(y, c, place));
  return DVI_OK;
}

/* Set the places of a row, which come in order. */
static dvi_status set_row(const dvi_yee_terms *terms, const dvi__yee *y, int c, int j, int k)
{
  const size_t row = row_of(y, c, j, k);
  dvi__yee_wall *next = y->wall + y->wall_first[row];
  int place[3] = {0, j, k};
  if (y->wall_first[row] == y->wall_first[row + 1]) return DVI_OK;
  for (; place[0] < dvi__yee_places(y, c, 0); place[0]++)
    if (openness(y, c, place) > 0) DVI_TRY(set_wall(terms, y, c, place, next++));
  return DVI_OK;
}

static int has_absorbing_ends(const dvi__yee *y)
{
  int found = 0;
  for (int l = 0; l < y->axes; l++)
    for (int e = 0; e < 2; e++) found |= y->axis[l].end[e].kind == DVI_YEE_ABSORBING;
  return found;
}

dvi_status dvi__yee_make_walls(const dvi_yee_terms *terms, dvi__yee *y)
{
  const size_t rows = y->rows[0] * y->rows[1] * (size_t)y->edges_slots;
  if (!has_absorbing_ends(y)) return DVI_OK;
  y->wall_first = DVI_NEW(int64_t, rows + 1);
  if (y->wall_first != NULL) {
    count_places(y);
    y->wall = DVI_NEW(dvi__yee_wall, y->wall_first[rows]);
  }
  if (y->wall == NULL) return dvi__fail(DVI_NO_MEMORY, "yee: no memory for absorbing ends");
  return for_rows(terms, y, set_row);
}

/* ---- steps ---- */

/* Give the places of a row of E_c on absorbing ends, and their number. */
static const dvi__yee_wall *walls_of(const dvi__yee *y, int c, int j, int k, int64_t *count)
{
  const int64_t *first = y->wall_first + row_of(y, c, j, k);
  *count = first[1] - first[0];
  return y->wall + first[0];
}

int64_t dvi__yee_count_walls(const dvi__yee *y, int c, int j, int k)
{
  int64_t count;
  (void)walls_of(y, c, j, k, &count);
  return count;
}

void dvi__yee_keep_before(const dvi__yee *y, int c, int j, int k, const double *e, double *before)
{
  int64_t count;
  const dvi__yee_wall *wall = walls_of(y, c, j, k, &count);
  for (int64_t i = 0; i < count; i++) before[wall[i].place] = e[wall[i].place];
}

void dvi__yee_absorb(const dvi__yee *y, int c, int j, int k, const double *before, double *e)
{
  int64_t count;
  const dvi__yee_wall *wall = walls_of(y, c, j, k, &count);
  for (int64_t i = 0; i < count; i++) {
    double *x = e + wall[i].place;
    *x -= wall[i].part * (*x + before[wall[i].place]);
  }
}

/* A row on an end has all of its unknowns there, and another one at most its first and last. With
 * absorbing ends an edge has an entry if it has openness. */
double dvi__yee_wall_loss(const dvi__yee *y, int c, const int *place)
{
  int64_t count;
  if (openness(y, c, place) == 0) return 0;
  const dvi__yee_wall *wall = walls_of(y, c, place[1], place[2], &count), *last = wall + count - 1;
  if (wall->place == place[0]) return wall->s;
  return last->place == place[0] ? last->s : wall[place[0] - wall->place].s;
}
