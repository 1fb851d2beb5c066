/* Saved states of leapfrog. The section "leapfrog" identifies the march and has its times, "forms"
 * the values of the whole mesh, the currents and the charges. */
#include <string.h>

#include "core/status.h"
#include "field/mesh/share.h"
#include "field/step/leapfrog_state.h"
#include "field/step/saved.h"
#include "field/step/terms.h"

enum { VERSION = 2, PIECES = 5 };

/* List the parts of the state in the order of make_state. */
static void find_pieces(const dvi__leapfrog *l, dvi__piece piece[PIECES])
{
  const dvi_field *f = l->field;
  const int64_t A = l->keeps_A ? f->cells : 0, currents = 2 * (int64_t)f->currents;
  piece[0] = (dvi__piece){f->degree, f->cells, l->E};
  piece[1] = (dvi__piece){f->degree + 1, l->sweep.faces, l->H};
  piece[2] = (dvi__piece){f->degree, A, l->A};
  piece[3] = (dvi__piece){-1, currents, l->J};
  piece[4] = (dvi__piece){f->degree - 1, dvi__charge_numbers(f) - f->currents, l->charge.start};
}

dvi_status dvi__leapfrog_save(const void *self, dvi__sections_writer *writer)
{
  const dvi__leapfrog *l = self;
  dvi__piece piece[PIECES];
  find_pieces(l, piece);
  dvi__section_open(writer, "leapfrog", VERSION);
  dvi__section_put(writer, &l->at, sizeof l->at);
  dvi__section_open(writer, "forms", 1);
  return dvi__pieces_put(l->field->mesh, PIECES, piece, writer);
}

/* Find what was saved, and refuse what another march has saved. */
static dvi_status find_saved(const dvi__leapfrog *l, const dvi__sections *sections, int64_t numbers,
                             dvi__leapfrog_place *at, dvi__section *forms)
{
  dvi__section found;
  DVI_TRY(dvi__section_find(sections, "leapfrog", VERSION, sizeof *at, &found));
  memcpy(at, found.content, sizeof *at);
  if (at->hash != l->at.hash || at->dt != l->at.dt)
    return dvi__fail(DVI_BAD_FILE,
                     "march: %s is of another field, or of another step: it has dt = %.17g, and "
                     "this march %.17g",
                     sections->name, at->dt, l->at.dt);
  return dvi__section_find(sections, "forms", 1, (size_t)numbers * sizeof(double), forms);
}

dvi_status dvi__leapfrog_load(void *self, const dvi__sections *sections)
{
  dvi__leapfrog *l = self;
  const dvi_mesh *mesh = l->field->mesh;
  dvi__piece piece[PIECES];
  dvi__section forms = {0};
  dvi__leapfrog_place at;
  find_pieces(l, piece);
  const int64_t numbers = dvi__pieces_size(mesh, PIECES, piece);
  DVI_TRY(dvi__agree(mesh, find_saved(l, sections, numbers, &at, &forms)));
  DVI_TRY(dvi__check_same(mesh, sections->name, sections->size, sections->bytes));
  l->at = at;
  dvi__pieces_take(mesh, PIECES, piece, forms.content);
  l->changed = -1;
  l->is_lost = 0;
  return DVI_OK;
}
