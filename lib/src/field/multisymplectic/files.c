/* Saved states of lattices. The section "multisymplectic" identifies the lattice and has its times,
 * "ms-levels" three levels and the momenta of the last two, and "ms-matrix" the levels at which the
 * matrix of the steps was computed. */
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/multisymplectic/march.h"

enum { VERSION = 1, LEVELS = 5, MATRIX = 2 };

typedef struct identity {
  uint64_t lattice; /* hash of the axes, the weights, and of what the density is at some z */
  double dt, t0, t, factored_at;
  int64_t step;
} identity;

static uint64_t hash_integer(uint64_t hash, int64_t number)
{
  return dvi__hash(hash, sizeof number, &number);
}

static uint64_t hash_axes(const dvi__lattice *lattice, uint64_t hash)
{
  hash = hash_integer(hash_integer(hash, lattice->axes), lattice->components);
  hash = hash_integer(hash_integer(hash, lattice->parts), lattice->unknowns);
  hash = dvi__hash(hash, sizeof lattice->time_weight, &lattice->time_weight);
  for (int d = 0; d < lattice->axes; d++) {
    const dvi__lattice_axis *a = &lattice->axis[d];
    hash = dvi__hash(hash, sizeof a->weight, &a->weight);
    hash = dvi__hash(hash, sizeof a->is_periodic, &a->is_periodic);
    hash = dvi__hash(hash, ((size_t)a->cells + 1) * sizeof *a->node, a->node);
  }
  return dvi__hash(hash, (size_t)lattice->size * sizeof *lattice->unknown, lattice->unknown);
}

/* The derivatives of the density at some z in the first cells. A density that fails there is left
 * out. */
static uint64_t hash_density(const dvi__lattice *lattice, uint64_t hash)
{
  for (int i = 0; i < lattice->parts; i++) {
    const dvi__lattice_part *part = &lattice->part[i];
    dvi__batch b = dvi__batch_begin(lattice, part, 0, DVI__BATCH / lattice->points);
    hash = dvi__hash(hash, sizeof part->time.value, part->time.value);
    (void)dvi__fill_random((int64_t)part->variables * b.count, 1, b.z);
    if (dvi__batch_evaluate(&b, DVI__WANT_L_Z) != DVI_OK) continue;
    hash = dvi__hash(hash, (size_t)part->variables * (size_t)b.count * sizeof *b.l_z, b.l_z);
  }
  return hash;
}

static uint64_t hash_lattice(const dvi__lattice *lattice)
{
  return hash_density(lattice, hash_axes(lattice, DVI__HASH_START));
}

dvi_status dvi__lattice_save(const void *self, dvi__sections_writer *writer)
{
  const dvi__lattice_march *m = self;
  const size_t bytes = (size_t)m->lattice.size * sizeof(double);
  const double *const levels[LEVELS] = {m->before, m->now, m->next, m->p_now, m->p_next};
  const double factored_at = m->is_kept ? m->kept_at : m->factored_at;
  double *const *factored = m->is_kept ? m->kept : m->factored;
  const identity id = {hash_lattice(&m->lattice), m->lattice.dt, m->t0, m->t, factored_at, m->step};
  dvi__section_open(writer, "multisymplectic", VERSION);
  dvi__section_put(writer, &id, sizeof id);
  dvi__section_open(writer, "ms-levels", VERSION);
  for (int i = 0; i < LEVELS; i++) dvi__section_put(writer, levels[i], bytes);
  dvi__section_open(writer, "ms-matrix", VERSION);
  for (int i = 0; i < MATRIX; i++) dvi__section_put(writer, factored[i], bytes);
  return DVI_OK;
}

/* Compute the matrix where it was computed, or where it is if that fails. */
static dvi_status take_matrix(dvi__lattice_march *m, double t, const unsigned char *content)
{
  const size_t bytes = (size_t)m->lattice.size * sizeof(double);
  if (m->lattice.is_linear) return DVI_OK;
  memcpy(m->level, content, bytes);
  memcpy(m->p, content + bytes, bytes);
  dvi__lattice_keep_factor(m);
  const dvi_status status = dvi__lattice_factor(m, t, m->level, m->p);
  if (status == DVI_OK)
    m->is_kept = 0;
  else
    (void)dvi__lattice_restore_factor(m);
  return status;
}

dvi_status dvi__lattice_load(void *self, const dvi__sections *sections)
{
  dvi__lattice_march *m = self;
  const size_t bytes = (size_t)m->lattice.size * sizeof(double);
  double *const levels[LEVELS] = {m->before, m->now, m->next, m->p_now, m->p_next};
  dvi__section first, fields, matrix;
  identity id;
  DVI_TRY(dvi__section_find(sections, "multisymplectic", VERSION, sizeof id, &first));
  memcpy(&id, first.content, sizeof id);
  if (id.lattice != hash_lattice(&m->lattice) || id.dt != m->lattice.dt)
    return dvi__fail(DVI_BAD_FILE,
                     "%s: it was saved by another lattice or density, or with another step: it has "
                     "dt = %.17g, and this march %.17g; make the march from the same terms",
                     sections->name, id.dt, m->lattice.dt);
  DVI_TRY(dvi__section_find(sections, "ms-levels", VERSION, LEVELS * bytes, &fields));
  DVI_TRY(dvi__section_find(sections, "ms-matrix", VERSION, MATRIX * bytes, &matrix));
  DVI_TRY(take_matrix(m, id.factored_at, matrix.content));
  for (int i = 0; i < LEVELS; i++) memcpy(levels[i], fields.content + (size_t)i * bytes, bytes);
  m->t0 = id.t0, m->t = id.t, m->step = id.step;
  return DVI_OK;
}
