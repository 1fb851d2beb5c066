/* Who the neighbours are, and which cells have nodes of several processes. */
#include "field/elastic_avi/neighbours.h"

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

static dvi_status no_memory(const dvi__solid_avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for the neighbours of %lld cells", avi->method,
                   (long long)avi->active);
}

static int owner_of(const dvi__solid_avi *avi, int64_t c, int a)
{
  return avi->solid->mesh->share->owner[0][avi->cell[c].corner[a]];
}

/* Give the owners of the nodes of a cell but this process, each once. */
static int find_others(const dvi__solid_avi *avi, int64_t c, int others[DVI__SOLID_NODES])
{
  const int rank = avi->solid->mesh->share->ranks.rank;
  int count = 0;
  for (int a = 0; a <= avi->n; a++) {
    const int owner = owner_of(avi, c, a);
    int is_known = owner == rank;
    for (int k = 0; k < count; k++) is_known |= others[k] == owner;
    if (!is_known) others[count++] = owner;
  }
  return count;
}

/* Number the cells that have other owners, and count those of each process. */
static void number_edges(const dvi__solid_avi *avi, int64_t *cells)
{
  dvi__solid_neighbours *s = avi->neighbours;
  for (int64_t c = 0; c < avi->active; c++) {
    int others[DVI__SOLID_NODES];
    const int count = find_others(avi, c, others);
    s->edge_of[c] = count > 0 ? (int)s->edges++ : -1;
    for (int k = 0; k < count; k++) s->links += cells[others[k]]++ == 0;
  }
}

/* Make the links in the order of the processes. `cells` [processes] become their numbers. */
static dvi_status make_links(const dvi__solid_avi *avi, int64_t *cells)
{
  dvi__solid_neighbours *s = avi->neighbours;
  int made = 0;
  s->link = DVI_NEW(dvi__solid_link, s->links);
  if (s->link == NULL) return no_memory(avi);
  for (int r = 0; made < s->links; r++) {
    if (cells[r] == 0) continue;
    dvi__solid_link *link = s->link + made;
    link->rank = r;
    link->cell = DVI_NEW(int, cells[r]);
    link->out = DVI_NEW(double, DVI__SOLID_MESSAGE);
    link->in = DVI_NEW(double, DVI__SOLID_MESSAGE);
    if (!link->cell || !link->out || !link->in) return no_memory(avi);
    cells[r] = made++;
  }
  return DVI_OK;
}

static void fill_edge(const dvi__solid_avi *avi, int64_t c, const int64_t *link_of)
{
  dvi__solid_neighbours *s = avi->neighbours;
  dvi__solid_edge *e = s->edge + s->edge_of[c];
  int others[DVI__SOLID_NODES];
  e->links = find_others(avi, c, others);
  for (int k = 0; k < e->links; k++) {
    dvi__solid_link *link = s->link + link_of[others[k]];
    e->link[k] = (int)link_of[others[k]];
    e->place_in[k] = link->cells;
    link->cell[link->cells++] = (int)c;
  }
  for (int a = 0; a <= avi->n; a++) {
    if (owner_of(avi, c, a) != avi->solid->mesh->share->ranks.rank) continue;
    e->own |= (uint8_t)(1U << a);
    s->first[avi->cell[c].corner[a]] = (int)c;
  }
}

static dvi_status make(const dvi__solid_avi *avi)
{
  dvi__solid_neighbours *s = avi->neighbours;
  int64_t *cells = DVI_NEW(int64_t, avi->solid->mesh->share->ranks.count);
  s->edge_of = DVI_NEW(int, avi->active);
  s->first = DVI_NEW(int, avi->vertices);
  dvi_status status = cells && s->edge_of && s->first ? DVI_OK : no_memory(avi);
  if (status == DVI_OK && cells != NULL && s->first != NULL) {
    for (int64_t v = 0; v < avi->vertices; v++) s->first[v] = -1;
    number_edges(avi, cells);
    s->edge = DVI_NEW(dvi__solid_edge, s->edges);
    status = s->edge != NULL ? make_links(avi, cells) : no_memory(avi);
  }
  for (int64_t c = 0; c < avi->active && status == DVI_OK; c++)
    if (s->edge_of[c] >= 0) fill_edge(avi, c, cells);
  dvi__release(cells);
  return status;
}

void dvi__solid_neighbours_destroy(dvi__solid_neighbours **neighbours)
{
  dvi__solid_neighbours *s = *neighbours;
  if (s == NULL) return;
  for (int k = 0; k < s->links && s->link != NULL; k++) {
    dvi__release(s->link[k].cell);
    dvi__release(s->link[k].out);
    dvi__release(s->link[k].in);
  }
  dvi__release(s->link);
  dvi__release(s->edge);
  dvi__release(s->edge_of);
  dvi__release(s->first);
  dvi__release(s);
  *neighbours = NULL;
}

dvi_status dvi__solid_neighbours_create(dvi__solid_avi *avi)
{
  const dvi_mesh *mesh = avi->solid->mesh;
  if (mesh->share == NULL || !avi->is_free) return DVI_OK;
  avi->neighbours = DVI_NEW(dvi__solid_neighbours, 1);
  const dvi_status status = dvi__agree(mesh, avi->neighbours != NULL ? make(avi) : no_memory(avi));
  if (status != DVI_OK) dvi__solid_neighbours_destroy(&avi->neighbours);
  return status;
}
