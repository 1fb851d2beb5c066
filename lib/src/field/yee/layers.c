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
  const int is_divided = axis == y->divided,
            first = y->own[axis][0] - (is_divided ? y->ghosts[0] : 0),
            last = y->own[axis][1] + (is_divided ? y->ghosts[1] : 0);
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

/* Layers along the divided axis have the sums of a plane row by row, and all others one after the
 * other. */
size_t dvi__yee_copy_sums(const dvi__yee *y, int axis, int end, int copy, int layer, int j, int k,
                          double *buffer, int takes)
{
  const dvi__yee_layers *l = &y->axis[axis].layers[end];
  const size_t across = y->divided == 2 ? y->rows[0] : 1, rows = axis == y->divided ? across : 1,
               count = DVI__YEE_DIFFERENCES * (axis == 0            ? across * (size_t)l->width
                                               : axis == y->divided ? y->width
                                                                    : (size_t)l->count * y->width);
  for (size_t row = 0; row < rows; row++) {
    const int at_row = y->divided == 2 ? j + (int)row : j;
    double *psi = l->psi + dvi__yee_psi_at(y, axis, end, copy, 0, layer, at_row, k) -
                  (axis == 0 ? 0 : DVI__YEE_LEFT);
    memcpy(takes ? psi : buffer + row * count, takes ? buffer + row * count : psi,
           count * sizeof *psi);
  }
  return rows * count;
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
