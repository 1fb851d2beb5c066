/* Unknowns, patterns, and the places of stencils in them. */
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

static dvi_status no_memory(const dvi_moving *m)
{
  return dvi__fail(DVI_NO_MEMORY, "moving: no memory for %d cells", m->cells);
}

static int is_unknown(const dvi_moving *m, int node, int number)
{
  const int at_end = !m->periodic && (node == 0 || node == m->cells);
  if (number == 0) return dvi__moving_is_free(m) && !at_end;
  return !at_end || !m->fixed[node > 0];
}

static dvi_status number_unknowns(dvi_moving *m)
{
  m->unknown = DVI_NEW(int, m->nodes * m->numbers);
  if (m->unknown == NULL) return no_memory(m);
  for (int i = 0; i < m->nodes * m->numbers; i++)
    m->unknown[i] = is_unknown(m, i / m->numbers, i % m->numbers) ? m->unknowns++ : -1;
  return DVI_OK;
}

/* List the nodes at most `width` away from a node, ascending. Return their number. */
static int neighbours(const dvi_moving *m, int node, int width, int *found)
{
  int count = 0;
  for (int k = node - width; k <= node + width; k++) {
    if (!m->periodic && (k < 0 || k >= m->nodes)) continue;
    const int next = (k % m->nodes + m->nodes) % m->nodes;
    int at = count;
    while (at > 0 && found[at - 1] > next) at--;
    if (at > 0 && found[at - 1] == next) continue;
    for (int i = count++; i > at; i--) found[i] = found[i - 1];
    found[at] = next;
  }
  return count;
}

/* Make the pattern of blocks of nodes that are at most `width` apart. */
static dvi_status make_pattern(const dvi_moving *m, int width, dvi__pattern *pattern)
{
  const int n = m->unknowns, most = (2 * width + 1) * m->numbers;
  *pattern = (dvi__pattern){n, n, DVI_NEW(int, n + 1), DVI_NEW(int, (size_t)n *(size_t)most)};
  if (pattern->start == NULL || pattern->row == NULL) return no_memory(m);
  for (int i = 0, count = 0; i < m->nodes * m->numbers; i++) {
    int near[2 * DVI__STENCIL_NODES + 1];
    const int nodes = neighbours(m, i / m->numbers, width, near), column = m->unknown[i];
    if (column < 0) continue;
    for (int k = 0; k < nodes * m->numbers; k++) {
      const int row = m->unknown[near[k / m->numbers] * m->numbers + k % m->numbers];
      if (row >= 0) pattern->row[count++] = row;
    }
    pattern->start[column + 1] = count;
  }
  return DVI_OK;
}

/* Give the coordinate of number i of a stencil, or -1. */
static int coordinate(const dvi_moving *m, const dvi__stencils *of, int k, int i)
{
  const int node = of->first + k + i / m->numbers;
  if (!m->periodic && (node < 0 || node >= m->nodes)) return -1;
  return m->unknown[(node + m->nodes) % m->nodes * m->numbers + i % m->numbers];
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

dvi_status dvi__moving_lay_out(dvi_moving *m)
{
  DVI_TRY(number_unknowns(m));
  DVI_TRY(make_pattern(m, m->dispersion > 0 ? 2 : 1, &m->pattern));
  m->cell = (dvi__stencils){.count = m->cells, .nodes = 2};
  DVI_TRY(place(m, &m->pattern, &m->cell));
  if (m->dispersion > 0) {
    m->bend = (dvi__stencils){.count = m->periodic ? m->nodes : m->cells - 1, .nodes = 3};
    m->bend.first = m->periodic ? -1 : 0;
    DVI_TRY(place(m, &m->pattern, &m->bend));
  }
  if (m->motion == DVI_MOVING_EQUAL) DVI_TRY(dvi__moving_lay_out_arcs(m));
  if (m->viscosity == 0) return DVI_OK;
  DVI_TRY(make_pattern(m, 2, &m->drag_pattern));
  m->drag = (dvi__stencils){.count = m->cells, .nodes = 4, .first = -1};
  return place(m, &m->drag_pattern, &m->drag);
}
