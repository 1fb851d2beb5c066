/* Nearly equilateral triangles of a rectangle. The rows are at y = j/M. Even rows have the points
 * x = i/N, odd ones 0, (i + 1/2)/N for i from 0 to N - 1, and 1. With the even row a and the odd
 * row b of a strip the triangles are (a_i, a_{i+1}, b_{i+1}) and (b_i, b_{i+1}, a_i). */
#include "core/status.h"
#include "field/mesh/generate/draft.h"

/* Give the first point of a row. */
static int first_of(int across, int row)
{
  return row * (across + 1) + row / 2;
}

static void fill_row(const dvi__sizes *sizes, int row, dvi__draft *draft)
{
  const int across = sizes->cells[0], up = sizes->cells[1], is_odd = row % 2,
            last = across + is_odd;
  for (int i = 0; i <= last; i++) {
    const int v = first_of(across, row) + i;
    const double x = i == 0 ? 0 : i == last ? 1 : (i - 0.5 * is_odd) / across;
    draft->point[2 * v] = sizes->origin[0] + sizes->extent[0] * x;
    draft->point[2 * v + 1] = sizes->origin[1] + sizes->extent[1] * row / up;
    draft->side[v] = (unsigned char)((i == 0) | (i == last) << 1 | (row == 0) << 2 |
                                     (row == up) << 3);
  }
}

static int *fill_strip(int across, int strip, int *vertex)
{
  const int a = first_of(across, strip + strip % 2), b = first_of(across, strip + 1 - strip % 2);
  for (int i = 0; i < across; i++) {
    *vertex++ = a + i;
    *vertex++ = a + i + 1;
    *vertex++ = b + i + 1;
  }
  for (int i = 0; i <= across; i++) {
    *vertex++ = b + i;
    *vertex++ = b + i + 1;
    *vertex++ = a + i;
  }
  return vertex;
}

dvi_status dvi__generate_staggered(const dvi__sizes *sizes, dvi__draft *draft)
{
  static const char *const side[] = {"left", "right", "bottom", "top"};
  const int across = sizes->cells[0], up = sizes->cells[1], odd_rows = (up + 1) / 2;
  draft->terms.dimension = 2;
  for (int i = 0; i < 4; i++) draft->name[i] = side[i];
  DVI_TRY(dvi__draft_allocate(draft, "staggered", (across + 1.0) * (up + 1) + odd_rows,
                              (2.0 * across + 1) * up));
  int *vertex = draft->vertex;
  for (int row = 0; row <= up; row++) fill_row(sizes, row, draft);
  for (int strip = 0; strip < up; strip++) vertex = fill_strip(across, strip, vertex);
  return DVI_OK;
}
