#include "field/elastic_avi/borders.h"

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* ---- who needs what ---- */

static int owns_node(const dvi__solid_avi *avi, int vertex)
{
  return dvi__owns(avi->solid->mesh, 0, vertex);
}

int dvi__solid_acts_here(const dvi_elastic *e, int64_t cell)
{
  int acts = dvi__owns(e->mesh, e->n, cell);
  for (int a = 0; a <= e->n; a++) acts |= dvi__owns(e->mesh, 0, e->vertex[cell * (e->n + 1) + a]);
  return acts;
}

/* Tell whether events of a cell, which has an own node, happen on other processes, too. */
static int is_between(const dvi__solid_avi *avi, int64_t c)
{
  int between = !dvi__owns(avi->solid->mesh, avi->n, avi->cell[c].name);
  for (int a = 0; a <= avi->n; a++) between |= !owns_node(avi, avi->cell[c].corner[a]);
  return between;
}

/* Return the least class of the cells for which a node is told or learnt, or the number of classes.
 * Cells of a node are in the order of their classes. */
static int class_of_node(const dvi__solid_avi *avi, int vertex)
{
  const int is_own = owns_node(avi, vertex);
  for (int64_t k = avi->cell_start[vertex]; k < avi->cell_start[vertex + 1]; k++)
    if (!is_own || is_between(avi, avi->cell_of[k]))
      return dvi__solid_class_of(avi, avi->cell_of[k]);
  return avi->classes;
}

/* List the nodes class by class. `class` [vertices] is room. */
static void list_nodes(const dvi__solid_avi *avi, int *class, dvi__solid_borders *b)
{
  int64_t lent = 0, borrowed = 0;
  for (int64_t v = 0; v < avi->vertices; v++) class[v] = class_of_node(avi, (int)v);
  b->first_class = avi->classes;
  for (int j = 0; j < avi->classes; j++) {
    for (int64_t v = 0; v < avi->vertices; v++) {
      if (class[v] != j) continue;
      if (owns_node(avi, (int)v))
        b->lent[lent++] = (int)v;
      else
        b->borrowed[borrowed++] = (int)v;
    }
    b->lent_end[j] = lent;
    b->borrowed_end[j] = borrowed;
    if (lent + borrowed > 0 && j < b->first_class) b->first_class = j;
  }
}

static dvi_status make(const dvi__solid_avi *avi, dvi__solid_borders *b)
{
  int *class = DVI_NEW(int, avi->vertices);
  b->lent = DVI_NEW(int, avi->vertices);
  b->borrowed = DVI_NEW(int, avi->vertices);
  b->value = DVI_NEW(double, avi->vertices * avi->n);
  const int has_memory = class && b->lent && b->borrowed && b->value;
  if (has_memory) list_nodes(avi, class, b);
  dvi__release(class);
  return has_memory
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "%s: no memory for the edge of a share", avi->method);
}

void dvi__solid_borders_destroy(dvi__solid_borders **borders)
{
  dvi__solid_borders *b = *borders;
  if (b == NULL) return;
  dvi__release(b->lent);
  dvi__release(b->borrowed);
  dvi__release(b->value);
  dvi__release(b);
  *borders = NULL;
}

dvi_status dvi__solid_borders_create(dvi__solid_avi *avi)
{
  const dvi_mesh *mesh = avi->solid->mesh;
  if (mesh->share == NULL) return DVI_OK;
  avi->borders = DVI_NEW(dvi__solid_borders, 1);
  dvi_status status = avi->borders != NULL ? make(avi, avi->borders)
                                           : dvi__fail(DVI_NO_MEMORY, "%s: no memory", avi->method);
  status = dvi__agree(mesh, status);
  double first = status == DVI_OK ? -(double)avi->borders->first_class : 0;
  if (status == DVI_OK) status = dvi__largest_of_all(mesh, 1, &first);
  if (status == DVI_OK) avi->borders->first_class = (int)-first;
  if (status != DVI_OK) dvi__solid_borders_destroy(&avi->borders);
  return status;
}

/* ---- slots ---- */

/* Give where an own node is at the time t, which its flight makes the next time, too. Returns as
 * dvi__solid_fly. */
static int find_place(const dvi__solid_avi *avi, int vertex, double t, double *place)
{
  dvi__solid_node node = avi->state.node[vertex];
  const int returned = dvi__solid_fly(avi, vertex, t, &node, NULL);
  for (int i = 0; i < avi->n; i++) place[i] = node.u[i];
  return returned;
}

/* Find the places of own nodes, component by component. */
static dvi__solid_halt find_places(dvi__solid_avi *avi, int class, double t)
{
  const dvi__solid_borders *b = avi->borders;
  dvi__solid_halt halt = {0};
  for (int64_t k = 0; k < b->lent_end[class]; k++) {
    double place[DVI__SOLID_AXES];
    const int vertex = b->lent[k], returned = find_place(avi, vertex, t, place);
    for (int i = 0; i < avi->n; i++) b->value[i * avi->vertices + vertex] = place[i];
    if (returned != 0 && halt.returned == 0)
      halt = (dvi__solid_halt){returned, avi->cell_of[avi->cell_start[vertex]], t};
  }
  return halt;
}

static dvi_status refresh_places(const dvi__solid_avi *avi)
{
  for (int i = 0; i < avi->n; i++)
    DVI_TRY(dvi__refresh(avi->solid->mesh, 0, avi->borders->value + i * avi->vertices));
  return DVI_OK;
}

dvi__solid_halt dvi__solid_trade(dvi__solid_avi *avi, int class, double t)
{
  const dvi__solid_borders *b = avi->borders;
  if (b == NULL || class < b->first_class) return (dvi__solid_halt){0};
  const dvi__solid_halt halt = find_places(avi, class, t);
  avi->is_lost = refresh_places(avi) != DVI_OK;
  for (int64_t k = 0; k < b->borrowed_end[class] && !avi->is_lost; k++) {
    dvi__solid_node *node = avi->state.node + b->borrowed[k];
    node->tau = t;
    for (int i = 0; i < avi->n; i++) {
      node->u[i] = b->value[i * avi->vertices + b->borrowed[k]];
      node->v[i] = 0;
    }
  }
  return halt;
}

/* ---- between runs ---- */

/* Set a number of all nodes of others. Numbers of a node are in the order of its members. */
static dvi_status refresh_member(const dvi__solid_avi *avi, double *first, int64_t stride)
{
  double *value = avi->borders->value;
  for (int64_t v = 0; v < avi->vertices; v++) value[v] = first[v * stride];
  DVI_TRY(dvi__refresh(avi->solid->mesh, 0, value));
  for (int64_t v = 0; v < avi->vertices; v++) first[v * stride] = value[v];
  return DVI_OK;
}

dvi_status dvi__solid_complete(dvi__solid_avi *avi)
{
  const int64_t stride = (int64_t)(sizeof *avi->state.node / sizeof(double));
  if (avi->borders == NULL) return DVI_OK;
  dvi_status status = refresh_member(avi, &avi->state.node->tau, stride);
  for (int i = 0; i < avi->n && status == DVI_OK; i++) {
    status = refresh_member(avi, &avi->state.node->u[i], stride);
    if (status == DVI_OK) status = refresh_member(avi, &avi->state.node->v[i], stride);
  }
  avi->is_lost |= status != DVI_OK;
  return status;
}

dvi_status dvi__solid_refresh(const dvi__solid_avi *avi, double *number)
{
  for (int i = 0; i < avi->n && avi->borders != NULL; i++)
    DVI_TRY(refresh_member(avi, number + i, avi->n));
  return DVI_OK;
}
