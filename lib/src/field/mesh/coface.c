#include "field/mesh/coface.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/volume.h"

/* ---- neighbours ---- */

/* Chains of the n-cells at each facet. A place is facets per cell times cell, plus slot. */
typedef struct chains {
  int *head; /* [facets] the first place, or -1 */
  int *next; /* [cells*slots] the next place with the same facet, or -1 */
} chains;

/* Later places go in front, so the last cell is entered first. */
static void link_places(const dvi_mesh *mesh, const chains *c)
{
  const int64_t facets = mesh->n > 0 ? mesh->count[mesh->n - 1] : 0,
                places = mesh->count[mesh->n] * dvi__facets(mesh->kind, mesh->n);
  for (int64_t f = 0; f < facets; f++) c->head[f] = -1;
  for (int64_t at = places - 1; at >= 0; at--) {
    const int facet = mesh->facet[mesh->n][at];
    c->next[at] = c->head[facet];
    c->head[facet] = (int)at;
  }
}

static int have_equal_facets(const dvi_mesh *mesh, int a, int b)
{
  const int slots = dvi__facets(mesh->kind, mesh->n);
  const int *of_a = mesh->facet[mesh->n] + (size_t)a * (size_t)slots,
            *of_b = mesh->facet[mesh->n] + (size_t)b * (size_t)slots;
  for (int i = 0; i < slots; i++) {
    int j = 0;
    while (j < slots && of_b[j] != of_a[i]) j++;
    if (j == slots) return 0;
  }
  return 1;
}

static dvi_status refuse_double(const dvi_mesh *mesh, int a, int b)
{
  const dvi__cell_name cell = dvi__name_cell(mesh, mesh->n, b);
  return dvi__fail(DVI_BAD_ARGUMENT, "mesh: %s is given twice, and is cell %d, too", cell.text, a);
}

/* Note the cells at a facet, and look for equal ones among those of which it is the first facet. */
static dvi_status note_cells(dvi_mesh *mesh, const chains *c, int64_t facet)
{
  const int slots = dvi__facets(mesh->kind, mesh->n);
  int count = 0;
  for (int at = c->head[facet]; at >= 0; at = c->next[at], count++) {
    if (count < 2) mesh->coface[2 * facet + count] = at / slots;
    if (at % slots != 0) continue;
    for (int other = c->head[facet]; other >= 0; other = c->next[other])
      if (other / slots < at / slots && have_equal_facets(mesh, at / slots, other / slots))
        return refuse_double(mesh, other / slots, at / slots);
  }
  if (count > 2 && mesh->branching < 0) mesh->branching = facet;
  return DVI_OK;
}

static dvi_status note_all(dvi_mesh *mesh, const chains *c)
{
  const int64_t facets = mesh->count[mesh->n - 1];
  link_places(mesh, c);
  for (int64_t i = 0; i < 2 * facets; i++) mesh->coface[i] = -1;
  for (int64_t f = 0; f < facets; f++) DVI_TRY(note_cells(mesh, c, f));
  return DVI_OK;
}

dvi_status dvi__coface_build(dvi_mesh *mesh)
{
  const int64_t facets = mesh->count[mesh->n - 1];
  const chains c = {
      DVI_NEW(int, facets),
      DVI_NEW(int, mesh->count[mesh->n] * dvi__facets(mesh->kind, mesh->n)),
  };
  mesh->coface = DVI_NEW(int, 2 * facets);
  mesh->branching = -1;
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "mesh: no memory for neighbours");
  if (c.head != NULL && c.next != NULL && mesh->coface != NULL) status = note_all(mesh, &c);
  dvi__release(c.head);
  dvi__release(c.next);
  return status;
}

/* ---- orientation ---- */

/* Give the sign of a facet in the boundary of its cell. */
static int sign_in(const dvi_mesh *mesh, int cell, int64_t facet)
{
  const int slots = dvi__facets(mesh->kind, mesh->n);
  for (int slot = 0; slot < slots; slot++) {
    const size_t at = (size_t)cell * (size_t)slots + (size_t)slot;
    if (mesh->facet[mesh->n][at] == facet) return mesh->sign[mesh->n][at];
  }
  return 0;
}

/* Tell whether the two cells at a facet are coherent, so that it vanishes in their boundary. */
static int is_coherent(const dvi_mesh *mesh, const int8_t *orientation, int64_t facet)
{
  const int a = mesh->coface[2 * facet], b = mesh->coface[2 * facet + 1];
  return b < 0 ||
         orientation[a] * sign_in(mesh, a, facet) + orientation[b] * sign_in(mesh, b, facet) == 0;
}

static dvi_status refuse_folded(const dvi_mesh *mesh, int64_t facet)
{
  const dvi__cell_name a = dvi__name_cell(mesh, mesh->n, mesh->coface[2 * facet]),
                       b = dvi__name_cell(mesh, mesh->n, mesh->coface[2 * facet + 1]);
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "mesh: %s and %s lie on the same side of their common %s: one of them is inverted", a.text,
      b.text, dvi__degree_name(mesh->kind, mesh->n - 1));
}

/* Of three cells at a facet two lie on one side of it. */
static dvi_status refuse_overlap(const dvi_mesh *mesh)
{
  const dvi__cell_name facet = dvi__name_cell(mesh, mesh->n - 1, mesh->branching);
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "mesh: %s belongs to more than two cells, of which two lie on the same side",
                   facet.text);
}

static dvi_status orient_as_space(dvi_mesh *mesh)
{
  if (mesh->branching >= 0) return refuse_overlap(mesh);
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++)
    mesh->orientation[c] = (int8_t)dvi__cell_handedness(mesh, c);
  for (int64_t f = 0; f < mesh->count[mesh->n - 1]; f++)
    if (!is_coherent(mesh, mesh->orientation, f)) return refuse_folded(mesh, f);
  return DVI_OK;
}

/* Give the neighbours of a cell their orientation, if they have none. Returns the new length of
 * the queue. */
static int64_t orient_neighbours(dvi_mesh *mesh, int cell, int *queue, int64_t length)
{
  const int slots = dvi__facets(mesh->kind, mesh->n);
  for (int slot = 0; slot < slots; slot++) {
    const size_t at = (size_t)cell * (size_t)slots + (size_t)slot;
    const int64_t facet = mesh->facet[mesh->n][at];
    const int *pair = mesh->coface + 2 * facet, other = pair[0] == cell ? pair[1] : pair[0];
    if (other < 0 || mesh->orientation[other] != 0) continue;
    mesh->orientation[other] = (int8_t)(-mesh->orientation[cell] * mesh->sign[mesh->n][at] *
                                        sign_in(mesh, other, facet));
    queue[length++] = other;
  }
  return length;
}

static void orient_components(dvi_mesh *mesh, const int8_t *given, int *queue)
{
  int64_t length = 0, done = 0;
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    if (mesh->orientation[c] != 0) continue;
    mesh->orientation[c] = given[c];
    queue[length++] = (int)c;
    for (; done < length; done++) length = orient_neighbours(mesh, queue[done], queue, length);
  }
}

dvi_status dvi__coface_orient(dvi_mesh *mesh, const int8_t *given)
{
  const int64_t cells = mesh->count[mesh->n];
  mesh->orientation = DVI_NEW(int8_t, cells);
  int *queue = DVI_NEW(int, cells);
  if (mesh->orientation == NULL || queue == NULL) {
    dvi__release(queue);
    return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for orientations");
  }
  dvi_status status = DVI_OK;
  int coherent = mesh->branching < 0;
  if (mesh->space == mesh->n)
    status = orient_as_space(mesh);
  else
    orient_components(mesh, given, queue);
  for (int64_t f = 0; f < mesh->count[mesh->n - 1] && coherent; f++)
    coherent = is_coherent(mesh, mesh->orientation, f);
  dvi__release(queue);
  if (coherent) return status;
  dvi__release(mesh->orientation);
  mesh->orientation = NULL;
  return status;
}
