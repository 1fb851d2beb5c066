/* The numbers of a march's state at one (j, k). Files have them row by row, as far as they count,
 * so that they do not depend on how rows lie in memory and who has them. */
#include "field/yee/yee.h"

/* A list of pieces of the rows at (j, k). */
typedef struct list {
  const dvi__yee *y;
  int j, k, is_here, count;
  dvi__yee_piece *piece;
} list;

static void add(list *l, double *x, size_t at, int count)
{
  l->piece[l->count++] = (dvi__yee_piece){l->is_here ? x + at : NULL, (size_t)count};
}

static int has_row(const list *l, int component)
{
  return l->y->slot[component] >= 0 && l->j < dvi__yee_places(l->y, component, 1) &&
         l->k < dvi__yee_places(l->y, component, 2);
}

/* Add the sums of layers at one end of an axis that `layer` is the number of. */
static void add_layer(list *l, int axis, int end, int layer)
{
  const dvi__yee *y = l->y;
  const dvi__yee_layers *of = &y->axis[axis].layers[end];
  const int b = (axis + 1) % 3, c = (axis + 2) % 3,
            changed[4] = {DVI__YEE_B + b, DVI__YEE_B + c, DVI__YEE_E + b, DVI__YEE_E + c};
  for (int copy = 0; copy < y->copies; copy++)
    for (int which = 0; which < 4; which++) {
      if (!has_row(l, changed[which])) continue;
      const size_t at = l->is_here ? dvi__yee_psi_at(y, axis, end, copy, which, layer, l->j, l->k)
                                   : 0;
      if (axis == 0)
        add(l, of->psi, at + (size_t)(of->first - of->start), of->count);
      else
        add(l, of->psi, at, dvi__yee_places(y, changed[which], 0));
    }
}

static void add_layers(list *l)
{
  const int place[3] = {0, l->j, l->k};
  for (int axis = 0; axis < 3; axis++)
    for (int e = 0; e < 2; e++) {
      const dvi__yee_layers *of = &l->y->axis[axis].layers[e];
      const int layer = place[axis] - of->first;
      if (of->count > 0 && (axis == 0 || (layer >= 0 && layer < of->count)))
        add_layer(l, axis, e, layer);
    }
}

int dvi__yee_saved(const dvi__yee *y, int j, int k, dvi__yee_piece *piece)
{
  list l = {.y = y, .j = j, .k = k, .piece = piece};
  l.is_here = dvi__yee_owns(y, (const int[]){0, j, k});
  for (int component = 0; component < 6; component++) {
    if (!has_row(&l, component)) continue;
    const size_t at = l.is_here ? dvi__yee_at(y, component, j, k) : 0;
    const int count = dvi__yee_places(y, component, 0);
    for (int copy = 0; copy < y->copies; copy++) add(&l, y->state[copy], at, count);
    if (component < DVI__YEE_B && y->worn != NULL)
      add(&l, y->worn, l.is_here ? dvi__yee_at_edges(y, component, j, k) : 0, count);
  }
  add_layers(&l);
  return l.count;
}

int dvi__yee_saved_charge(const dvi__yee *y, int j, int k, dvi__yee_piece *piece)
{
  const int *rows = y->own[1], *planes = y->own[2], nodes = y->axis[0].nodes;
  *piece = (dvi__yee_piece){NULL, (size_t)nodes};
  if (dvi__yee_owns(y, (const int[]){0, j, k}))
    piece->x = y->charge + ((ptrdiff_t)(k - planes[0]) * (rows[1] - rows[0]) + j - rows[0]) * nodes;
  return 1;
}
