#include "field/mesh/shape.h"

int dvi__corners(dvi_cell_kind kind, int k)
{
  return kind == DVI_BOXES ? 1 << k : k + 1;
}

int dvi__facets(dvi_cell_kind kind, int k)
{
  return kind == DVI_BOXES ? 2 * k : k + 1;
}

static void facet_of_box(int k, int slot, int *corner)
{
  const int axis = slot / 2, is_far = slot % 2, below = (1 << axis) - 1;
  for (int c = 0; c < 1 << (k - 1); c++)
    corner[c] = (c & below) | is_far << axis | (c & ~below) << 1;
}

void dvi__facet_corners(dvi_cell_kind kind, int k, int slot, int *corner)
{
  if (kind == DVI_BOXES)
    facet_of_box(k, slot, corner);
  else
    for (int c = 0; c < k; c++) corner[c] = c < slot ? c : c + 1;
}

int dvi__facet_sign(dvi_cell_kind kind, int slot)
{
  if (kind == DVI_BOXES) return (slot / 2 + slot) % 2 == 0 ? -1 : 1;
  return slot % 2 == 0 ? 1 : -1;
}

static int position(int count, const int *list, int corner)
{
  int at = 0;
  while (at < count && list[at] != corner) at++;
  return at;
}

static int parity(int count, const int *order)
{
  int sign = 1;
  for (int i = 0; i < count; i++)
    for (int j = i + 1; j < count; j++)
      if (order[i] > order[j]) sign = -sign;
  return sign;
}

static int relative_of_simplices(int k, const int *a, const int *b)
{
  int order[DVI__CORNERS];
  for (int c = 0; c <= k; c++) {
    order[c] = position(k + 1, b, a[c]);
    if (order[c] > k) return 0;
  }
  return parity(k + 1, order);
}

/* Each axis of the box `a` is one of the box `b`, in its direction or against it. */
static int relative_of_boxes(int k, const int *a, const int *b)
{
  const int corners = 1 << k, first = position(corners, b, a[0]);
  int step[DVI__CORNERS] = {0}, axis[DVI_MESH_DIMENSION_MAX], sign = 1;
  if (first == corners) return 0;
  for (int i = 0; i < k; i++) {
    step[i] = position(corners, b, a[1 << i]) ^ first;
    axis[i] = position(k, (const int[]){1, 2, 4, 8}, step[i]);
    if (axis[i] == k) return 0;
    if (first & step[i]) sign = -sign;
  }
  for (int c = 0; c < corners; c++) {
    int at = first;
    for (int i = 0; i < k; i++) at ^= c >> i & 1 ? step[i] : 0;
    if (b[at] != a[c]) return 0;
  }
  return sign * parity(k, axis);
}

int dvi__relative_orientation(dvi_cell_kind kind, int k, const int *a, const int *b)
{
  return kind == DVI_BOXES ? relative_of_boxes(k, a, b) : relative_of_simplices(k, a, b);
}
