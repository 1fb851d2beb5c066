/* Unknowns, patterns, and the places of stencils in them. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

static dvi_status no_memory(const dvi_moving *m)
{
  return dvi__fail(DVI_NO_MEMORY, "moving: no memory for %d cells", m->cells);
}

/* ---- patterns ---- */

/* The stencils of each node, number[start[node]] and so on. */
typedef struct stars {
  int *start, *number;
} stars;

/* Corners beyond an end are not counted. */
static dvi_status find_stars(const dvi_moving *m, const dvi__stencils *s, stars *of)
{
  const int corners = s->count * s->nodes;
  *of = (stars){DVI_NEW(int, m->nodes + 2), DVI_NEW(int, corners)};
  if (of->start == NULL || of->number == NULL) return no_memory(m);
  for (int i = 0; i < corners; i++)
    if (s->corner[i].node >= 0) of->start[s->corner[i].node + 2]++;
  for (int node = 0; node < m->nodes; node++) of->start[node + 2] += of->start[node + 1];
  for (int i = 0; i < corners; i++)
    if (s->corner[i].node >= 0) of->number[of->start[s->corner[i].node + 1]++] = i / s->nodes;
  return DVI_OK;
}

/* Put a number into an ascending list unless it is there. Return the new length. */
static int insert(int number, int count, int *list)
{
  int at = count;
  while (at > 0 && list[at - 1] > number) at--;
  if (at > 0 && list[at - 1] == number) return count;
  memmove(list + at + 1, list + at, (size_t)(count - at) * sizeof *list);
  list[at] = number;
  return count + 1;
}

/* Make the pattern of nodes that have a stencil in common. */
static dvi_status couple(const dvi_moving *m, const dvi__stencils *s, const stars *of,
                         dvi__pattern *pattern)
{
  const size_t most = (size_t)of->start[m->nodes] * (size_t)s->nodes;
  *pattern = (dvi__pattern){m->nodes, m->nodes, DVI_NEW(int, m->nodes + 1), DVI_NEW(int, most)};
  if (pattern->start == NULL || pattern->row == NULL) return no_memory(m);
  for (int node = 0; node < m->nodes; node++) {
    int *row = pattern->row + pattern->start[node], count = 0;
    for (int e = of->start[node]; e < of->start[node + 1]; e++)
      for (int a = 0; a < s->nodes; a++) {
        const int other = s->corner[of->number[e] * s->nodes + a].node;
        if (other >= 0) count = insert(other, count, row);
      }
    pattern->start[node + 1] = pattern->start[node] + count;
  }
  return DVI_OK;
}

/* Give the first unknown of each node, first [nodes+1]. */
static void find_first(const dvi_moving *m, int *first)
{
  for (int i = 0; i < m->nodes * m->numbers; i++) {
    if (i % m->numbers == 0) first[i / m->numbers + 1] = first[i / m->numbers];
    if (m->unknown[i] >= 0) first[i / m->numbers + 1]++;
  }
}

/* Make the pattern of unknowns whose nodes have a stencil in common. */
static dvi_status make_pattern(const dvi_moving *m, const dvi__stencils *s, dvi__pattern *pattern)
{
  stars of = {0};
  dvi__pattern nodes = {0};
  int *first = DVI_NEW(int, m->nodes + 1);
  if (first == NULL) return no_memory(m);
  find_first(m, first);
  dvi_status status = find_stars(m, s, &of);
  if (status == DVI_OK) status = couple(m, s, &of, &nodes);
  if (status == DVI_OK) status = dvi__pattern_uneven_blocks(&nodes, first, pattern);
  dvi__release(of.start);
  dvi__release(of.number);
  dvi__pattern_clear(&nodes);
  dvi__release(first);
  return status;
}

/* ---- places in them ---- */

/* Give the coordinate of number i of a stencil, or -1. */
static int coordinate(const dvi_moving *m, const dvi__stencils *s, int k, int i)
{
  const int node = s->corner[(size_t)k * (size_t)s->nodes + (size_t)(i / m->numbers)].node;
  return node < 0 ? -1 : m->unknown[node * m->numbers + i % m->numbers];
}

static dvi_status place(const dvi_moving *m, const dvi__pattern *pattern, dvi__stencils *s)
{
  const int n = s->nodes * m->numbers;
  s->entry = DVI_NEW(int, (size_t)s->count *(size_t)(n * n));
  if (s->entry == NULL) return no_memory(m);
  for (int k = 0; k < s->count; k++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        const int row = coordinate(m, s, k, i), column = coordinate(m, s, k, j);
        s->entry[((size_t)k * (size_t)n + (size_t)i) * (size_t)n + (size_t)j] =
            row < 0 || column < 0 ? -1 : dvi__pattern_find(pattern, row, column);
      }
  return DVI_OK;
}

static dvi_status number_unknowns(dvi_moving *m)
{
  for (int i = 0; i < m->nodes * m->numbers; i++)
    if (m->unknown[i] >= 0) m->unknown[i] = m->unknowns++;
  if (m->unknowns > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "moving: nothing is unknown: let the nodes move, or leave a value free");
}

dvi_status dvi__moving_lay_out(dvi_moving *m)
{
  DVI_TRY(number_unknowns(m));
  if (m->dispersion > 0 || m->viscosity > 0)
    DVI_TRY(dvi__moving_chain(m, m->periodic ? -1 : 0, m->periodic ? m->nodes : m->cells - 1, 3,
                              &m->bend));
  DVI_TRY(make_pattern(m, m->dispersion > 0 ? &m->bend : &m->cell, &m->pattern));
  DVI_TRY(place(m, &m->pattern, &m->cell));
  if (m->dispersion > 0) DVI_TRY(place(m, &m->pattern, &m->bend));
  if (m->motion == DVI_MOVING_EQUAL) DVI_TRY(dvi__moving_lay_out_arcs(m));
  if (m->viscosity == 0) return DVI_OK;
  DVI_TRY(make_pattern(m, &m->bend, &m->drag_pattern));
  DVI_TRY(dvi__moving_chain(m, -1, m->cells, 4, &m->drag));
  return place(m, &m->drag_pattern, &m->drag);
}
