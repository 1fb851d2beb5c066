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

static dvi__saved_march saved_of(const dvi__leapfrog *l, dvi__piece piece[PIECES])
{
  find_pieces(l, piece);
  return (dvi__saved_march){.method = "leapfrog",
                            .version = VERSION,
                            .mesh = l->field->mesh,
                            .at = (dvi__march_place *)&l->at,
                            .pieces = PIECES,
                            .piece = piece};
}

dvi_status dvi__leapfrog_save(const void *self, dvi__sections_writer *writer)
{
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(self, piece);
  return dvi__saved_march_put(&march, writer);
}

dvi_status dvi__leapfrog_load(void *self, const dvi__sections *sections)
{
  dvi__leapfrog *l = self;
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(l, piece);
  DVI_TRY(dvi__saved_march_take(&march, sections));
  l->changed = -1;
  l->is_lost = 0;
  return DVI_OK;
}
