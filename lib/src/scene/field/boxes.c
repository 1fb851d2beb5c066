/* E and B of yee as vectors in the boxes of a grid, which processes may divide among themselves. */
#include "scene/field/boxes.h"

#include <string.h>

#include "text/heap.h"

/* Where a component's values are: that of a place is at `first` plus its index times `next`. */
typedef struct layout {
  int64_t first, next[3]; /* first is -1 if there is no such component */
} layout;

static layout layout_of(const dvi_yee_terms *terms, dvi_march_form form, int component)
{
  static const int corner[3] = {0}, next[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  layout found = {.first = dvi_yee_place(terms, form, component, corner)};
  for (int a = 0; a < terms->axes; a++) {
    const int64_t place = dvi_yee_place(terms, form, component, next[a]);
    if (place >= 0) found.next[a] = place - found.first;
  }
  return found;
}

/* Give the mean of a component's values around a box, each divided by its cell. A component has
 * places at both ends of the box along the axes across its cell, of which a grid that repeats
 * itself has one less. */
static double mean_in_box(const dvi_yee_terms *terms, const layout *of, unsigned along,
                          const double *values, const int *box, const double *length)
{
  double sum = 0;
  int count = 0;
  const int axes = terms->axes;
  for (unsigned corner = 0; corner < 1u << axes && of->first >= 0; corner++) {
    int64_t place = of->first;
    double size = 1;
    if ((corner & along) != 0) continue;
    for (int a = 0; a < axes; a++) {
      int index = box[a] + (int)(corner >> a & 1);
      if (terms->axis[a].end[0].kind == DVI_YEE_PERIODIC ||
          terms->axis[a].end[0].kind == DVI_YEE_BLOCH)
        index %= terms->axis[a].cells;
      if ((along >> a & 1) != 0) size *= length[a];
      place += index * of->next[a];
    }
    sum += values[place] / size;
    count++;
  }
  return count > 0 ? sum / count : 0;
}

static double length_of(const dvi_yee_terms *terms, int axis, int box)
{
  const dvi_yee_axis *a = terms->axis + axis;
  if (a->node != NULL) return a->node[box + 1] - a->node[box];
  return (a->upper - a->lower) / a->cells;
}

static void fill_vectors(const dvi_yee_terms *terms, dvi_march_form form, const double *values,
                         double *vector)
{
  int box[3] = {0}, cells[3] = {1, 1, 1};
  layout of[3];
  for (int a = 0; a < terms->axes; a++) cells[a] = terms->axis[a].cells;
  for (int component = 0; component < 3; component++)
    of[component] = layout_of(terms, form, component);
  for (box[2] = 0; box[2] < cells[2]; box[2]++)
    for (box[1] = 0; box[1] < cells[1]; box[1]++)
      for (box[0] = 0; box[0] < cells[0]; box[0]++, vector += 3) {
        double length[3];
        for (int a = 0; a < terms->axes; a++) length[a] = length_of(terms, a, box[a]);
        for (int component = 0; component < 3; component++) {
          const unsigned axis = 1u << component, along = form == DVI_FORM_E ? axis : 7u ^ axis;
          vector[component] = mean_in_box(terms, of + component, along, values, box, length);
        }
      }
}

/* ---- several processes ---- */

dvi_status dvi__boxes_agree(const dvi_yee_ranks *ranks, dvi_status status)
{
  double extreme[2] = {status, -(double)status};
  if (ranks == NULL || ranks->count < 2) return status;
  if (ranks->largest(2, extreme, ranks->user) != 0)
    return status != DVI_OK ? status : DVI_CALLBACK_FAILED;
  return (dvi_status)(extreme[1] > 0 ? -extreme[1] : extreme[0]);
}

/* The values of a form: own ones, and where they are needed those of the whole grid. A process adds
 * the bits of its values to the zeros of the others, plane by plane. */
typedef struct gathered {
  dvi_yee_terms whole; /* of one process */
  double *own, *all;
  int64_t *plane;
  const dvi_mesh *share; /* whose cells are wanted, or NULL */
  double *vector;        /* in all boxes, with a share */
} gathered;

static size_t count_boxes(const dvi_yee_terms *terms)
{
  size_t boxes = 1;
  for (int a = 0; a < terms->axes; a++) boxes *= (size_t)terms->axis[a].cells;
  return boxes;
}

static dvi_status make_room(const dvi_yee_terms *terms, const dvi_march *march, dvi_march_form form,
                            gathered *g)
{
  size_t plane = 1;
  g->whole = *terms;
  g->whole.ranks = NULL;
  for (int a = 0; a < terms->axes; a++) plane *= (size_t)terms->axis[a].cells + 1;
  plane /= (size_t)terms->axis[terms->axes - 1].cells + 1;
  g->own = dvi__heap_take((size_t)dvi_march_size(march, form), sizeof *g->own);
  g->plane = dvi__heap_take(plane, sizeof *g->plane);
  const int keeps = terms->ranks->rank == 0 || g->share != NULL;
  if (keeps) g->all = dvi__heap_take((size_t)dvi_yee_size(&g->whole, form), sizeof *g->all);
  if (g->share != NULL) g->vector = dvi__heap_take(3 * count_boxes(terms), sizeof *g->vector);
  const int good = g->own != NULL && g->plane != NULL && (g->all != NULL || !keeps) &&
                   (g->vector != NULL || g->share == NULL);
  return good ? DVI_OK : DVI_NO_MEMORY;
}

/* Fill the own rows of a plane across the last axis. Rows along x are not divided. */
static void fill_plane(const dvi_yee_terms *terms, dvi_march_form form, int component,
                       const int *at, const layout *of, const gathered *g)
{
  const int last = terms->axes - 1;
  const int64_t row = of->next[1], rows = row > 0 ? of->next[last] / row : 0;
  int index[3] = {0};
  index[last] = at[last];
  for (int64_t j = 0; j < rows; j++) {
    if (last == 2) index[1] = (int)j;
    const int64_t here = dvi_yee_place(terms, form, component, index);
    if (here >= 0) memcpy(g->plane + j * row, g->own + here, (size_t)row * sizeof *g->plane);
  }
}

/* Gather the places of a component, plane by plane of the last axis. */
static int gather_component(const dvi_yee_terms *terms, dvi_march_form form, int component,
                            const gathered *g)
{
  const dvi_yee_ranks *ranks = terms->ranks;
  const int last = terms->axes - 1;
  const layout of = layout_of(&g->whole, form, component);
  const int64_t count = of.next[last];
  int index[3] = {0}, failed = 0;
  for (; of.first >= 0 && failed == 0; index[last]++) {
    const int64_t at = dvi_yee_place(&g->whole, form, component, index);
    /* beyond the last plane there is none, or the first one again */
    if (at != of.first + index[last] * count) break;
    memset(g->plane, 0, (size_t)count * sizeof *g->plane);
    fill_plane(terms, form, component, index, &of, g);
    failed = ranks->sum((int)count, g->plane, ranks->user);
    if (g->all != NULL) memcpy(g->all + at, g->plane, (size_t)count * sizeof *g->plane);
  }
  return failed;
}

/* Give the vectors of all boxes, or of the cells of a share. */
static void take_vectors(const gathered *g, dvi_march_form form, double *vector)
{
  if (g->all == NULL) return;
  fill_vectors(&g->whole, form, g->all, g->share != NULL ? g->vector : vector);
  if (g->share == NULL) return;
  const int n = dvi_mesh_dimension(g->share);
  const int64_t *number = dvi_mesh_share_numbers(g->share, n);
  for (int64_t c = 0; c < dvi_mesh_count(g->share, n); c++)
    memcpy(vector + 3 * c, g->vector + 3 * number[c], 3 * sizeof *vector);
}

static dvi_status vectors_of_all(const dvi_yee_terms *terms, const dvi_mesh *mesh,
                                 const dvi_march *march, dvi_march_form form, double *vector)
{
  gathered g = {.share = mesh};
  dvi_status status = dvi__boxes_agree(terms->ranks, make_room(terms, march, form, &g));
  if (status == DVI_OK) status = dvi_march_sample(march, form, 0, NULL, g.own);
  for (int component = 0; component < 3 && status == DVI_OK; component++)
    if (gather_component(terms, form, component, &g) != 0) status = DVI_CALLBACK_FAILED;
  if (status == DVI_OK) take_vectors(&g, form, vector);
  dvi__heap_free(g.own);
  dvi__heap_free(g.all);
  dvi__heap_free(g.plane);
  dvi__heap_free(g.vector);
  return status;
}

dvi_status dvi__boxes_vectors(const dvi_yee_terms *terms, const dvi_mesh *mesh,
                              const dvi_march *march, dvi_march_form form, double *vector)
{
  if (terms->ranks != NULL && terms->ranks->count > 1)
    return vectors_of_all(terms, mesh, march, form, vector);
  double *values = dvi__heap_take((size_t)dvi_march_size(march, form), sizeof *values);
  dvi_status status = values != NULL ? dvi_march_sample(march, form, 0, NULL, values)
                                     : DVI_NO_MEMORY;
  if (status == DVI_OK) fill_vectors(terms, form, values, vector);
  dvi__heap_free(values);
  return status;
}
