/* The section "elastic" of a saved state: what identifies the steps, the clock, and the state, in
 * the order of the whole mesh. */
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/elastic_avi/borders.h"
#include "field/mesh/share.h"
#include "field/step/saved.h"

enum { VERSION = 2, PIECES_MOST = 2 * DVI__SOLID_AXES + 4 };

typedef struct saved {
  uint64_t hash;
  int64_t vertices, cells, is_free, numbers;
  dvi__solid_clock clock;
} saved;

/* ---- hashes ---- */

/* Of places, masses, cells, steps and materials. Callbacks cannot be told apart. */
static uint64_t hash_numbers(uint64_t hash, int count, const double *const *number)
{
  for (int k = 0; k < count; k++) hash = dvi__hash(hash, sizeof *number[k], number[k]);
  return hash;
}

static uint64_t hash_node(const dvi_elastic *e, int64_t v)
{
  const int64_t number = dvi__whole_number(e->mesh, 0, v);
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof number, &number);
  hash = dvi__hash(hash, (size_t)e->n * sizeof *e->point, e->point + v * e->n);
  hash = dvi__hash(hash, sizeof *e->mass, e->mass + v);
  for (int i = 0; i < e->n; i++) {
    const int is_given = e->unknown[v * e->n + i] < 0;
    hash = dvi__hash(hash, sizeof is_given, &is_given);
  }
  return hash;
}

static uint64_t hash_cell(const dvi__solid_avi *avi, int64_t c)
{
  const dvi_elastic *e = avi->solid;
  const dvi__solid_cell *cell = avi->cell + c;
  const int64_t number = dvi__whole_number(e->mesh, e->n, cell->name);
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof number, &number);
  for (int a = 0; a <= e->n; a++) {
    const int64_t vertex = dvi__whole_number(e->mesh, 0, cell->corner[a]);
    hash = dvi__hash(hash, sizeof vertex, &vertex);
  }
  hash = dvi__hash(hash, sizeof cell->material, &cell->material);
  return dvi__hash(hash, sizeof cell->step, &cell->step);
}

static uint64_t hash_terms(const dvi_elastic *e, uint64_t hash)
{
  for (int i = 0; i < e->material_count; i++) {
    const dvi__solid_material *m = e->materials + i;
    hash = dvi__hash(hash, sizeof m->law, &m->law);
    hash = hash_numbers(
        hash, 6,
        (const double *const[]){&m->lambda, &m->mu, &m->mooney, &m->rho, &m->alpha, &m->beta});
  }
  for (int i = 0; i < e->obstacles; i++) {
    const dvi_obstacle *o = e->obstacle + i;
    hash = dvi__hash(hash, sizeof o->kind, &o->kind);
    hash = dvi__hash(hash, sizeof o->point, o->point);
    hash = dvi__hash(hash, sizeof o->normal, o->normal);
    hash = hash_numbers(hash, 3,
                        (const double *const[]){&o->radius, &o->restitution, &o->friction});
  }
  return hash;
}

/* The sum of the hashes of nodes and cells does not depend on the division. */
static dvi_status find_hash(const dvi__solid_avi *avi, uint64_t *hash)
{
  const dvi_elastic *e = avi->solid;
  uint64_t sum = 0;
  for (int64_t v = 0; v < e->vertices; v++)
    if (dvi__owns(e->mesh, 0, v)) sum += hash_node(e, v);
  for (int64_t c = 0; c < e->cells; c++)
    if (dvi__owns(e->mesh, e->n, avi->cell[c].name)) sum += hash_cell(avi, c);
  DVI_TRY(dvi__sum_modulo(e->mesh, &sum));
  *hash = hash_terms(e, dvi__hash(DVI__HASH_START, sizeof sum, &sum));
  return DVI_OK;
}

/* ---- the numbers of a state ---- */

/* Numbers by the mesh's nodes and cells, some of them in memory of their own. */
typedef struct record {
  const dvi__solid_avi *avi;
  double *room;
  int pieces;
  dvi__piece piece[PIECES_MOST];
} record;

static double *member_of(dvi__solid_node *node, int k, int n)
{
  return k < n ? &node->u[k] : k < 2 * n ? &node->v[k - n] : &node->tau;
}

static void add_piece(record *r, int degree, int64_t count, void *value)
{
  r->piece[r->pieces++] = (dvi__piece){degree, count, value};
}

/* List the numbers: u, v and tau, counts of free steps, works, and what shares have not. */
static dvi_status lay_out(const dvi__solid_avi *avi, record *r)
{
  const int members = 2 * avi->n + 1;
  const dvi__solid_state *s = &avi->state;
  const int64_t counts = s->count != NULL ? avi->cells : 0,
                works = s->worked != NULL ? avi->vertices : 0;
  *r = (record){.avi = avi, .room = DVI_NEW(double, members * avi->vertices + counts)};
  if (r->room == NULL) return dvi__fail(DVI_NO_MEMORY, "%s: no memory for a state", avi->method);
  for (int k = 0; k < members; k++) add_piece(r, 0, avi->vertices, r->room + k * avi->vertices);
  add_piece(r, avi->n, counts, r->room + members * avi->vertices);
  add_piece(r, 0, works, s->worked);
  const size_t listed = (size_t)avi->vertices * sizeof *s->node +
                        (size_t)(counts + works) * sizeof(double);
  add_piece(r, -1, (int64_t)((avi->size - listed) / sizeof(double)), (char *)avi->block + listed);
  return DVI_OK;
}

static void gather(const record *r)
{
  const dvi__solid_avi *avi = r->avi;
  const int members = 2 * avi->n + 1;
  double *count = r->room + members * avi->vertices;
  for (int64_t i = 0; i < members * avi->vertices; i++)
    r->room[i] = *member_of(avi->state.node + i % avi->vertices, (int)(i / avi->vertices), avi->n);
  for (int64_t c = 0; c < avi->cells && avi->state.count != NULL; c++)
    memcpy(count + avi->cell[c].name, avi->state.count + c, sizeof *count);
}

static void scatter(const record *r)
{
  const dvi__solid_avi *avi = r->avi;
  const int members = 2 * avi->n + 1;
  const double *count = r->room + members * avi->vertices;
  for (int64_t i = 0; i < members * avi->vertices; i++)
    *member_of(avi->state.node + i % avi->vertices, (int)(i / avi->vertices), avi->n) = r->room[i];
  for (int64_t c = 0; c < avi->cells && avi->state.count != NULL; c++)
    memcpy(avi->state.count + c, count + avi->cell[c].name, sizeof *count);
}

/* ---- the section ---- */

static dvi_status find_saved(const record *r, saved *own)
{
  const dvi__solid_avi *avi = r->avi;
  const dvi_mesh *mesh = avi->solid->mesh;
  *own = (saved){.vertices = dvi__whole_count(mesh, 0),
                 .cells = dvi__whole_count(mesh, avi->n),
                 .is_free = avi->is_free,
                 .numbers = dvi__pieces_size(mesh, r->pieces, r->piece, NULL),
                 .clock = avi->clock};
  return find_hash(avi, &own->hash);
}

dvi_status dvi__solid_avi_save(const dvi__solid_avi *avi, dvi__sections_writer *writer)
{
  const dvi_mesh *mesh = avi->solid->mesh;
  record r;
  saved own;
  dvi_status status = dvi__agree(mesh, lay_out(avi, &r));
  if (status == DVI_OK) status = find_saved(&r, &own);
  if (status == DVI_OK && r.room != NULL) {
    gather(&r);
    dvi__section_open(writer, "elastic", VERSION);
    dvi__section_put(writer, &own, sizeof own);
    status = dvi__pieces_put(mesh, r.pieces, r.piece, writer);
  }
  dvi__release(r.room);
  return status;
}

/* Find a state that was saved by the same solid. `held` are numbers in the section. */
static dvi_status find_state(const dvi__sections *sections, const saved *own, int64_t held,
                             saved *other, const unsigned char **numbers)
{
  dvi__section section;
  DVI_TRY(dvi__section_find(sections, "elastic", VERSION, DVI__ANY_SIZE, &section));
  if (section.size < sizeof *other)
    return dvi__fail(DVI_BAD_FILE, "%s: the section elastic has %zu bytes", sections->name,
                     section.size);
  memcpy(other, section.content, sizeof *other);
  *numbers = section.content + sizeof *other;
  if (other->hash == own->hash && other->vertices == own->vertices && other->cells == own->cells &&
      other->is_free == own->is_free && other->numbers == own->numbers &&
      section.size == sizeof *other + (size_t)held * sizeof(double))
    return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "%s: it is of a solid of %lld vertices and %lld cells with other materials, "
                   "conditions, obstacles or steps than this one of %lld and %lld",
                   sections->name, (long long)other->vertices, (long long)other->cells,
                   (long long)own->vertices, (long long)own->cells);
}

static dvi_status load(dvi__solid_avi *avi, const dvi__sections *sections, const record *r)
{
  const dvi_mesh *mesh = avi->solid->mesh;
  const unsigned char *numbers = NULL;
  saved own, other;
  DVI_TRY(find_saved(r, &own));
  const int64_t held = dvi__pieces_size(mesh, r->pieces, r->piece, sections->parts);
  DVI_TRY(dvi__agree(mesh, find_state(sections, &own, held, &other, &numbers)));
  DVI_TRY(dvi__check_same(mesh, sections->name, sections->size, sections->bytes));
  DVI_TRY(dvi__pieces_take(mesh, r->pieces, r->piece, sections, numbers));
  scatter(r);
  avi->clock = other.clock;
  avi->view->t = (double)NAN;
  avi->is_lost = 0;
  dvi__solid_keep(avi);
  dvi__solid_order(avi);
  return DVI_OK;
}

dvi_status dvi__solid_avi_load(dvi__solid_avi *avi, const dvi__sections *sections)
{
  record r;
  dvi_status status = dvi__agree(avi->solid->mesh, lay_out(avi, &r));
  if (status == DVI_OK && r.room != NULL) status = load(avi, sections, &r);
  dvi__release(r.room);
  return status;
}
