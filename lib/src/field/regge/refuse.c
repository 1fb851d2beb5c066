/* Simplices that do not exist, in words. */
#include <stdio.h>
#include <string.h>

#include "core/status.h"
#include "field/mesh/complex.h"
#include "field/regge/regge.h"

enum { LIST_SIZE = 320 };

/* Volumes and derivatives of other lengths might overflow. */
static const double shortest = 1e-60, longest = 1e60;

/* List the lengths of a face's edges. */
static void list_lengths(int n, const double *length, int k, const int *corner, const int *vertex,
                         char *list)
{
  list[0] = '\0';
  for (int a = 0; a <= k; a++)
    for (int b = a + 1; b <= k; b++) {
      const size_t at = strlen(list);
      (void)snprintf(list + at, LIST_SIZE - at, "%s%.6g (%d %d)", at > 0 ? ", " : "",
                     length[dvi__pair(n, corner[a], corner[b])], vertex[corner[a]],
                     vertex[corner[b]]);
    }
}

static dvi_status refuse_cell(const dvi_regge *r, int64_t cell, const double *length)
{
  const int n = r->n, set = dvi__missing_face(n, length),
            *vertex = r->mesh->corner[n] + cell * (n + 1);
  int64_t number[DVI__CORNER_SETS];
  int corner[DVI__SIMPLEX_CORNERS];
  char list[LIST_SIZE];
  if (set == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "regge: %s has no volume",
                     dvi__name_cell(r->mesh, n, cell).text);
  dvi__number_faces(r->mesh, cell, number);
  const int k = dvi__corners_of_set(set, corner) - 1;
  const dvi__cell_name name = dvi__name_cell(r->mesh, k, number[set]);
  list_lengths(n, length, k, corner, vertex, list);
  if (k == 2)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "regge: %s does not exist with the lengths %s: each side must be shorter than "
                     "the two others together",
                     name.text, list);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "regge: %s does not exist in Euclidean space with the lengths %s, although its "
                   "faces do: its volume would not be above 0",
                   name.text, list);
}

static dvi_status refuse_length(const dvi_regge *r, int64_t edge, double length)
{
  const dvi__cell_name name = dvi__name_cell(r->mesh, 1, edge);
  if (length > 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "regge: %s has the length %g, and %g to %g are possible: choose another unit",
                     name.text, length, shortest, longest);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "regge: %s has the length %g, and lengths are positive numbers, because the "
                   "signature is Euclidean",
                   name.text, length);
}

dvi_status dvi__regge_measure_cell(const dvi_regge *r, const double *length, int64_t cell,
                                   dvi__measured_simplex *simplex)
{
  const int *edge = r->edge + cell * r->pairs;
  double own[DVI__PAIRS];
  for (int e = 0; e < r->pairs; e++) {
    own[e] = length[edge[e]];
    if (!(own[e] >= shortest && own[e] <= longest)) return refuse_length(r, edge[e], own[e]);
  }
  return dvi__simplex_measure(r->n, own, simplex) ? DVI_OK : refuse_cell(r, cell, own);
}
