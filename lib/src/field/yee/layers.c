/* Absorbing layers: the memory of their sums psi (Roden and Gedney 2000).
 *
 * A layer across y or z is a plane of rows, and each row has its sums beside it. The layers along x
 * are the ends of rows, and their sums at one (j, k) follow each other. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/yee.h"

/* Tell if all of the layers are across planes at which this process does not work. */
static int is_elsewhere(const dvi__yee *y, int axis, const dvi__yee_layers *l)
{
  const int first = y->own[axis][0] - y->ghosts[axis][0],
            last = y->own[axis][1] + y->ghosts[axis][1];
  return l->first >= last || l->first + l->count <= first;
}

static size_t count_psi(const dvi__yee *y, int axis, int end)
{
  const dvi__yee_layers *l = &y->axis[axis].layers[end];
  if (is_elsewhere(y, axis, l)) return 0;
  const size_t rows = axis == 0   ? y->rows[0] * y->rows[1] * (size_t)l->width
                      : axis == 1 ? y->rows[1] * (size_t)l->count * y->width
                                  : y->rows[0] * (size_t)l->count * y->width;
  return DVI__YEE_DIFFERENCES * rows;
}

size_t dvi__yee_psi_at(const dvi__yee *y, int axis, int end, int copy, int which, int layer, int j,
                       int k)
{
  const dvi__yee_layers *l = &y->axis[axis].layers[end];
  const size_t number = (size_t)which, row = dvi__yee_row(y, j, k), left = row % y->rows[0],
               below = row / y->rows[0], at = (size_t)copy * l->psi_count,
               layers = (size_t)l->count;
  if (axis == 0) return at + (row * DVI__YEE_DIFFERENCES + number) * (size_t)l->width;
  const size_t across = axis == 1 ? below : left;
  return at + ((across * layers + (size_t)layer) * DVI__YEE_DIFFERENCES + number) * y->width +
         DVI__YEE_LEFT;
}

/* The four sums of a row in a layer follow each other. */
size_t dvi__yee_copy_sums(const dvi__yee *y, int j, int k, double *buffer, int takes)
{
  const int place[3] = {0, j, k};
  size_t copied = 0;
  for (int axis = 0; axis < 3; axis++)
    for (int e = 0; e < 2; e++) {
      const dvi__yee_layers *l = &y->axis[axis].layers[e];
      const int layer = axis == 0 ? 0 : place[axis] - l->first;
      if (l->count == 0 || layer < 0 || layer >= l->count) continue;
      const size_t width = axis == 0 ? (size_t)l->width : y->width,
                   count = DVI__YEE_DIFFERENCES * width;
      for (int copy = 0; copy < y->copies; copy++, copied += count) {
        double *psi = l->psi + dvi__yee_psi_at(y, axis, e, copy, 0, layer, j, k) -
                      (axis == 0 ? 0 : DVI__YEE_LEFT);
        memcpy(takes ? psi : buffer + copied, takes ? buffer + copied : psi, count * sizeof *psi);
      }
    }
  return copied;
}

dvi_status dvi__yee_make_layers(dvi__yee *y)
{
  for (int axis = 0; axis < 3; axis++)
    for (int end = 0; end < 2; end++) {
      dvi__yee_layers *l = &y->axis[axis].layers[end];
      if (l->count == 0) continue;
      l->psi_count = count_psi(y, axis, end);
      l->psi = DVI_NEW(double, (size_t)y->copies * l->psi_count);
      if (l->psi == NULL)
        return dvi__fail(DVI_NO_MEMORY, "yee: no memory for %zu sums of absorbing layers",
                         l->psi_count);
    }
  return DVI_OK;
}
