/* The nodes and cells of an axis, and what its ends know. */
#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

dvi__corner dvi__moving_corner(const dvi_moving *m, int node)
{
  if (!m->periodic && (node < 0 || node >= m->nodes)) return (dvi__corner){.node = -1};
  const int turn = m->periodic ? (node + m->nodes) / m->nodes - 1 : 0;
  return (dvi__corner){.node = node - turn * m->nodes, .turn = {turn}};
}

dvi_status dvi__moving_chain(const dvi_moving *m, int first, int count, int nodes, dvi__stencils *s)
{
  *s = (dvi__stencils){.count = count,
                       .nodes = nodes,
                       .corner = DVI_NEW(dvi__corner, (size_t)count * (size_t)nodes)};
  if (s->corner == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for %d cells", count);
  for (int i = 0; i < count * nodes; i++)
    s->corner[i] = dvi__moving_corner(m, first + i / nodes + i % nodes);
  return DVI_OK;
}

static dvi_status place_nodes(const dvi_moving_terms *t, dvi_moving *m)
{
  m->node = DVI_NEW(double, m->listed);
  if (m->node == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  for (int k = 0; k <= m->cells; k++)
    m->node[k] = t->axis.node != NULL ? t->axis.node[k] : m->from + m->volume * k / m->cells;
  m->node[m->cells] = t->axis.to;
  return t->monitor != NULL ? dvi__moving_grade(t, m) : DVI_OK;
}

/* Set the numbers of end nodes that their ends fix, and the positions of reference. */
static dvi_status bound(const dvi_moving_terms *t, dvi_moving *m)
{
  const dvi_moving_end *end[2] = {&t->left, &t->right};
  m->unknown = DVI_NEW(int, m->nodes * m->numbers);
  m->known = DVI_NEW(double, m->nodes * m->numbers);
  if (m->unknown == NULL || m->known == NULL)
    return dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  for (int k = 0; k < m->nodes; k++) {
    m->known[k * m->numbers] = m->node[k];
    if (!dvi__moving_is_free(m)) m->unknown[k * m->numbers] = -1;
  }
  for (int side = 0; side < 2 && !m->periodic; side++) {
    const int first = side * m->cells * m->numbers;
    m->unknown[first] = -1;
    for (int c = 0; c < m->components && end[side]->kind == DVI_FIXED; c++) {
      m->unknown[first + 1 + c] = -1;
      if (end[side]->value != NULL) m->known[first + 1 + c] = end[side]->value[c];
    }
  }
  return DVI_OK;
}

dvi_status dvi__moving_take_axis(const dvi_moving_terms *t, dvi_moving *m)
{
  m->cells = t->axis.node != NULL ? t->axis.nodes - 1 : t->cells;
  m->periodic = t->axis.periodic != 0;
  m->nodes = m->cells + !m->periodic;
  m->listed = m->cells + 1;
  m->from = t->axis.from;
  m->volume = t->axis.to - t->axis.from;
  if (m->periodic) m->period[0] = m->volume;
  DVI_TRY(place_nodes(t, m));
  DVI_TRY(dvi__moving_chain(m, 0, m->cells, 2, &m->cell));
  return bound(t, m);
}
