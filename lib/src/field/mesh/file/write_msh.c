/* MSH 4.1 as text. Parts become physical groups. In this format each element belongs to one entity
 * of a geometry, and each entity to some groups. So cells of one degree that belong to the same
 * parts make up an entity. Numbers of points and cells begin with 1. */
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/list.h"
#include "field/mesh/file/write.h"

/* The parts "all" and "boundary", which every mesh has, are not written. */
enum { FIRST_PART = 2, DEGREES = 4 };

/* An entity belongs to a part, and to all parts of its parent. Entity 0 belongs to none. */
typedef struct entity {
  int part, parent;       /* parent -1 for entity 0 */
  int moved_by, moved_to; /* the last part that took cells from here, and their entity */
  int64_t first, count;   /* cells, in `order` */
} entity;

/* The entities of the cells of a degree. */
typedef struct entities {
  dvi__list list;
  int *of;    /* [cells] */
  int *order; /* [cells] by entity */
} entities;

/* What is written. */
typedef struct msh {
  const dvi_mesh *mesh;
  dvi__sink *sink;
  entities degree[DEGREES];
} msh;

static entity *entity_at(const entities *of, int i)
{
  return (entity *)of->list.at + i;
}

/* ---- entities ---- */

static dvi_status add_entity(entities *to, int part, int parent)
{
  entity *added = dvi__list_add(&to->list, sizeof *added);
  if (added == NULL) return DVI_NO_MEMORY;
  *added = (entity){.part = part, .parent = parent};
  return DVI_OK;
}

/* Move the cells of a part from each entity into a new one. */
static dvi_status divide_by_part(const dvi_mesh *mesh, int p, entities *c)
{
  const dvi__part *part = mesh->part + p;
  for (int64_t i = 0; i < part->count[part->degree]; i++) {
    int *of = c->of + part->cell[part->degree][i];
    if (entity_at(c, *of)->moved_by != p) {
      DVI_TRY(add_entity(c, p, *of));
      entity_at(c, *of)->moved_by = p;
      entity_at(c, *of)->moved_to = (int)c->list.count - 1;
    }
    *of = entity_at(c, *of)->moved_to;
  }
  return DVI_OK;
}

/* Sort the cells by their entities. */
static void sort_by_entity(entities *c, int64_t cells)
{
  for (int64_t i = 0; i < cells; i++) entity_at(c, c->of[i])->count++;
  for (int i = 1; i < (int)c->list.count; i++)
    entity_at(c, i)->first = entity_at(c, i - 1)->first + entity_at(c, i - 1)->count;
  for (int i = 0; i < (int)c->list.count; i++) entity_at(c, i)->count = 0;
  for (int64_t i = 0; i < cells; i++) {
    entity *of = entity_at(c, c->of[i]);
    c->order[of->first + of->count++] = (int)i;
  }
}

static dvi_status find_entities(const dvi_mesh *mesh, int k, entities *c)
{
  c->of = DVI_NEW(int, mesh->count[k]);
  c->order = DVI_NEW(int, mesh->count[k]);
  if (c->of == NULL || c->order == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for parts");
  DVI_TRY(add_entity(c, 0, -1));
  for (int p = FIRST_PART; p < mesh->parts; p++)
    if (mesh->part[p].degree == k) DVI_TRY(divide_by_part(mesh, p, c));
  sort_by_entity(c, mesh->count[k]);
  return DVI_OK;
}

/* Cells below degree n that belong to no part are not written. */
static int is_written(const msh *m, int k, int i)
{
  return entity_at(m->degree + k, i)->count > 0 && (i > 0 || k == m->mesh->n);
}

static int entities_written(const msh *m, int k)
{
  int count = 0;
  for (int i = 0; i < (int)m->degree[k].list.count; i++) count += is_written(m, k, i);
  return count;
}

/* ---- sections ---- */

static dvi_status check_names(const dvi_mesh *mesh)
{
  for (int p = FIRST_PART; p < mesh->parts; p++)
    for (const char *c = mesh->part[p].name; *c != 0; c++)
      if (*c == '"' || (unsigned char)*c < ' ')
        return dvi__fail(DVI_UNSUPPORTED,
                         "MSH cannot hold the name of part \"%.64s\", which has a quote or a "
                         "control character",
                         mesh->part[p].name);
  return DVI_OK;
}

static void put_names(const msh *m)
{
  const dvi_mesh *mesh = m->mesh;
  if (mesh->parts == FIRST_PART) return;
  dvi__put(m->sink, "$PhysicalNames\n%d\n", mesh->parts - FIRST_PART);
  for (int p = FIRST_PART; p < mesh->parts; p++) {
    dvi__put(m->sink, "%d %d \"", mesh->part[p].degree, p - FIRST_PART + 1);
    dvi__put_bytes(m->sink, mesh->part[p].name, strlen(mesh->part[p].name));
    dvi__put(m->sink, "\"\n");
  }
  dvi__put(m->sink, "$EndPhysicalNames\n");
}

/* Gmsh passes over sections that it does not know. */
static void put_space(const msh *m)
{
  dvi__put(m->sink, "$DviSpace\n%s\n%d", m->mesh->kind == DVI_BOXES ? "boxes" : "simplices",
           m->mesh->space);
  for (int i = 0; i < m->mesh->space; i++)
    dvi__put_real(m->sink, i ? ' ' : '\n', m->mesh->metric[i]);
  for (int i = 0; i < m->mesh->space; i++)
    dvi__put_real(m->sink, i ? ' ' : '\n', m->mesh->period[i]);
  dvi__put(m->sink, "\n$EndDviSpace\n");
}

/* Put the corners of the box around the vertices of an entity. */
static void put_box(const msh *m, int k, int i)
{
  const dvi_mesh *mesh = m->mesh;
  const entity *of = entity_at(m->degree + k, i);
  const int corners = dvi__corners(mesh->kind, k);
  double least[3] = {0}, most[3] = {0};
  for (int64_t c = 0; c < of->count * corners; c++) {
    int vertex[DVI__CORNERS];
    dvi__oriented_cell(mesh, k, m->degree[k].order[of->first + c / corners], vertex);
    const double *x = mesh->point + (int64_t)vertex[c % corners] * mesh->space;
    for (int axis = 0; axis < mesh->space; axis++) {
      if (c == 0 || x[axis] < least[axis]) least[axis] = x[axis];
      if (c == 0 || x[axis] > most[axis]) most[axis] = x[axis];
    }
  }
  for (int axis = 0; axis < 3; axis++) dvi__put_real(m->sink, ' ', least[axis]);
  for (int axis = 0; axis < 3 && k > 0; axis++) dvi__put_real(m->sink, ' ', most[axis]);
}

static void put_groups(const msh *m, int k, int i)
{
  int count = 0;
  for (int c = i; c > 0; c = entity_at(m->degree + k, c)->parent) count++;
  dvi__put(m->sink, " %d", count);
  for (int c = i; c > 0; c = entity_at(m->degree + k, c)->parent)
    dvi__put(m->sink, " %d", entity_at(m->degree + k, c)->part - FIRST_PART + 1);
}

/* An entity of vertices stands at one of them. */
static void put_entities(const msh *m)
{
  dvi__put(m->sink, "$Entities\n");
  for (int k = 0; k < DEGREES; k++)
    dvi__put(m->sink, k > 0 ? " %d" : "%d", k <= m->mesh->n ? entities_written(m, k) : 0);
  dvi__put(m->sink, "\n");
  for (int k = 0; k <= m->mesh->n; k++)
    for (int i = 0; i < (int)m->degree[k].list.count; i++) {
      if (!is_written(m, k, i)) continue;
      dvi__put(m->sink, "%d", i + 1);
      put_box(m, k, i);
      put_groups(m, k, i);
      dvi__put(m->sink, k > 0 ? " 0\n" : "\n");
    }
  dvi__put(m->sink, "$EndEntities\n");
}

/* All points stand in one block, that of an entity of n-cells. */
static void put_nodes(const msh *m)
{
  const dvi_mesh *mesh = m->mesh;
  const long long points = (long long)mesh->count[0];
  int i = 0;
  while (!is_written(m, mesh->n, i)) i++;
  dvi__put(m->sink, "$Nodes\n1 %lld 1 %lld\n%d %d 0 %lld", points, points, mesh->n, i + 1, points);
  for (int64_t v = 0; v < mesh->count[0]; v++) dvi__put(m->sink, "\n%lld", (long long)v + 1);
  for (int64_t v = 0; v < mesh->count[0]; v++) dvi__put_point(m->sink, mesh, v);
  dvi__put(m->sink, "\n$EndNodes\n");
}

/* n-cells have their own numbers, so that reading keeps them. The others have those behind. */
static void put_entity(const msh *m, int k, int i, int64_t *number)
{
  const dvi_mesh *mesh = m->mesh;
  const dvi__shape shape = dvi__shape_of(mesh->kind, k);
  const dvi__shape_facts *facts = dvi__shape_facts_of + shape;
  const int64_t count = entity_at(m->degree + k, i)->count;
  const int *cell = m->degree[k].order + entity_at(m->degree + k, i)->first;
  int vertex[DVI__CORNERS];
  dvi__put(m->sink, "%d %d %d %lld\n", k, i + 1, facts->msh, (long long)count);
  for (int64_t c = 0; c < count; c++) {
    dvi__oriented_cell(mesh, k, cell[c], vertex);
    dvi__put(m->sink, "%lld", k == mesh->n ? (long long)cell[c] + 1 : (long long)++*number);
    for (int j = 0; j < facts->corners; j++)
      dvi__put(m->sink, " %d", vertex[dvi__corner_in_file(shape, j)] + 1);
    dvi__put(m->sink, "\n");
  }
}

static void put_elements(const msh *m)
{
  const int n = m->mesh->n;
  int64_t blocks = 0, cells = m->mesh->count[n], number = cells;
  for (int k = 0; k <= n; k++) blocks += entities_written(m, k);
  for (int k = 0; k < n; k++) cells += m->mesh->count[k] - entity_at(m->degree + k, 0)->count;
  dvi__put(m->sink, "$Elements\n%lld %lld 1 %lld\n", (long long)blocks, (long long)cells,
           (long long)cells);
  for (int k = 0; k <= n; k++)
    for (int i = 0; i < (int)m->degree[k].list.count; i++)
      if (is_written(m, k, i)) put_entity(m, k, i, &number);
  dvi__put(m->sink, "$EndElements\n");
}

static dvi_status put_all(msh *m)
{
  DVI_TRY(check_names(m->mesh));
  for (int k = 0; k <= m->mesh->n; k++) DVI_TRY(find_entities(m->mesh, k, m->degree + k));
  dvi__put(m->sink, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  put_names(m);
  put_space(m);
  put_entities(m);
  put_nodes(m);
  put_elements(m);
  return DVI_OK;
}

dvi_status dvi__write_msh(const dvi_mesh *mesh, int views, const dvi_view *view, dvi__sink *sink)
{
  msh m = {.mesh = mesh, .sink = sink};
  (void)views;
  (void)view;
  const dvi_status status = put_all(&m);
  for (int k = 0; k < DEGREES; k++) {
    dvi__release(m.degree[k].list.at);
    dvi__release(m.degree[k].of);
    dvi__release(m.degree[k].order);
  }
  return status;
}
