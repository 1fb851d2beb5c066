/* Saved states of marches. The section "schroedinger" identifies the equation and has the times,
 * "psi" the amplitude, and what rounding dropped of it. */
#include <string.h>

#include "core/hash.h"
#include "core/status.h"
#include "field/schroedinger/march.h"

enum { VERSION = 1 };

typedef struct identity {
  uint64_t equation; /* hash of the equation and of the method */
  double dt, t0, t;
  int64_t step;
} identity;

static uint64_t hash_numbers(uint64_t hash, int64_t count, const double *x)
{
  return x != NULL ? dvi__hash(hash, (size_t)count * sizeof *x, x) : hash;
}

static uint64_t hash_integer(uint64_t hash, int64_t number)
{
  return dvi__hash(hash, sizeof number, &number);
}

static uint64_t hash_equation(const dvi__wave_march *m)
{
  const dvi_schroedinger *s = m->s;
  uint64_t hash = hash_integer(hash_integer(DVI__HASH_START, m->method.stages), m->method.order);
  hash = hash_integer(hash_integer(hash, s->functions), s->depends_on_time);
  hash = hash_numbers(hash_numbers(hash, 1, &s->hbar), 1, &s->mass);
  hash = dvi__hash(hash, (size_t)s->free * sizeof *s->place, s->place);
  hash = hash_numbers(hash_numbers(hash, s->dimension * s->points, s->x), s->points, s->weight);
  hash = hash_numbers(hash_numbers(hash, s->points, s->still), s->points, s->beta);
  if (s->is_fourier) return hash_numbers(hash, s->free, s->diagonal);
  return hash_numbers(hash, s->T.start[s->free], s->T.value);
}

dvi_status dvi__wave_save(const void *self, dvi__sections_writer *writer)
{
  const dvi__wave_march *m = self;
  const identity id = {hash_equation(m), m->dt, m->t0, m->t, m->step};
  const size_t size = (size_t)(2 * m->s->free) * sizeof *m->z;
  dvi__section_open(writer, "schroedinger", VERSION);
  dvi__section_put(writer, &id, sizeof id);
  dvi__section_open(writer, "psi", VERSION);
  dvi__section_put(writer, m->z, size);
  dvi__section_put(writer, m->compensation, size);
  return DVI_OK;
}

static dvi_status find_identity(const dvi__wave_march *m, const dvi__sections *sections,
                                identity *id)
{
  dvi__section found;
  DVI_TRY(dvi__section_find(sections, "schroedinger", VERSION, sizeof *id, &found));
  memcpy(id, found.content, sizeof *id);
  if (id->equation == hash_equation(m) && id->dt == m->dt) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "%s: it was saved by another equation, method or step: it has dt = %.17g, and "
                   "this march %.17g; make the march from the same terms",
                   sections->name, id->dt, m->dt);
}

dvi_status dvi__wave_load(void *self, const dvi__sections *sections)
{
  dvi__wave_march *m = self;
  const size_t size = (size_t)(2 * m->s->free) * sizeof *m->z;
  identity id;
  dvi__section psi;
  DVI_TRY(find_identity(m, sections, &id));
  DVI_TRY(dvi__section_find(sections, "psi", VERSION, 2 * size, &psi));
  memcpy(m->z, psi.content, size);
  memcpy(m->compensation, psi.content + size, size);
  m->t0 = id.t0;
  m->t = id.t;
  m->step = id.step;
  m->view->is_now = 0;
  return DVI_OK;
}
