/* The section "elastic" of a saved state: what identifies the steps, the clock, and the state. */
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/status.h"
#include "field/elastic_avi/plan.h"

enum { VERSION = 1 };

typedef struct saved {
  uint64_t hash;
  int64_t vertices, cells, is_free, size;
  dvi__solid_clock clock;
} saved;

/* Of places, masses, cells, steps and materials. Callbacks cannot be told apart. */
static uint64_t hash_numbers(uint64_t hash, int count, const double *const *number)
{
  for (int k = 0; k < count; k++) hash = dvi__hash(hash, sizeof *number[k], number[k]);
  return hash;
}

static uint64_t hash_of(const dvi__solid_avi *avi)
{
  const dvi_elastic *e = avi->solid;
  const size_t vertices = (size_t)avi->vertices, cells = (size_t)avi->cells, n = (size_t)avi->n;
  uint64_t hash = DVI__HASH_START;
  hash = dvi__hash(hash, vertices * n * sizeof *e->point, e->point);
  hash = dvi__hash(hash, vertices * sizeof *e->mass, e->mass);
  hash = dvi__hash(hash, vertices * n * sizeof *e->unknown, e->unknown);
  hash = dvi__hash(hash, cells * (n + 1) * sizeof *e->vertex, e->vertex);
  hash = dvi__hash(hash, cells * sizeof *e->material, e->material);
  hash = dvi__hash(hash, cells * sizeof *avi->step, avi->step);
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

static saved what_is(const dvi__solid_avi *avi)
{
  return (saved){.hash = hash_of(avi),
                 .vertices = avi->vertices,
                 .cells = avi->cells,
                 .is_free = avi->is_free,
                 .size = (int64_t)avi->size,
                 .clock = avi->clock};
}

void dvi__solid_avi_save(const dvi__solid_avi *avi, dvi__sections_writer *writer)
{
  const saved own = what_is(avi);
  dvi__section_open(writer, "elastic", VERSION);
  dvi__section_put(writer, &own, sizeof own);
  dvi__section_put(writer, avi->block, avi->size);
}

dvi_status dvi__solid_avi_load(dvi__solid_avi *avi, const dvi__sections *sections)
{
  const saved own = what_is(avi);
  dvi__section section;
  saved other;
  DVI_TRY(dvi__section_find(sections, "elastic", VERSION, DVI__ANY_SIZE, &section));
  if (section.size < sizeof other)
    return dvi__fail(DVI_BAD_FILE, "%s: the section elastic has %zu bytes", sections->name,
                     section.size);
  memcpy(&other, section.content, sizeof other);
  if (other.hash != own.hash || other.vertices != own.vertices || other.cells != own.cells ||
      other.is_free != own.is_free || other.size != own.size ||
      section.size != sizeof other + avi->size)
    return dvi__fail(DVI_BAD_FILE,
                     "%s: it is of a solid of %lld vertices and %lld cells with other materials, "
                     "conditions, obstacles or steps than this one of %lld and %lld",
                     sections->name, (long long)other.vertices, (long long)other.cells,
                     (long long)own.vertices, (long long)own.cells);
  memcpy(avi->block, section.content + sizeof other, avi->size);
  avi->clock = other.clock;
  avi->view->t = (double)NAN;
  dvi__solid_keep(avi);
  dvi__solid_order(avi);
  return DVI_OK;
}
