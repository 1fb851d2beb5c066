/* Starts: values of forms to rows, and the half step from E^0 to E^{1/2}. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

static void set_values(dvi__yee *y, dvi_march_form form, const double *values)
{
  const int64_t size = dvi__yee_form_size(y, form);
  for (int64_t i = 0; i < size * y->copies && values != NULL; i++) {
    int component, place[3];
    dvi__yee_place_of(y, form, i % size, &component, place);
    const size_t at = dvi__yee_at(y, component, place[1], place[2]) + (size_t)place[0];
    y->state[i / size][at] = values[i];
  }
}

void dvi__yee_wrap_values(dvi__yee *y)
{
  for (int k = y->own[2][0]; k < y->own[2][1]; k++)
    for (int j = y->own[1][0]; j < y->own[1][1]; j++) dvi__yee_wrap_rows(y, j, k);
  dvi__yee_pass_edges(y);
  dvi__yee_pass_faces(y);
  dvi__yee_spoil_ghosts(y);
}

/* Give no field to edges on conductors. */
static void clear_conductors(dvi__yee *y)
{
  const int64_t size = dvi__yee_form_size(y, DVI_FORM_E);
  for (int64_t i = 0; i < size; i++) {
    int component, place[3];
    dvi__yee_place_of(y, DVI_FORM_E, i, &component, place);
    const int is_kept = dvi__yee_is_unknown(y, component, place);
    const size_t at = dvi__yee_at(y, component, place[1], place[2]) + (size_t)place[0];
    for (int copy = 0; copy < y->copies && !is_kept; copy++) y->state[copy][at] = 0;
  }
}

/* Move E from t_0 to half a step later: (1 + s) E+ = E + dt/2 M_1^-1 (d_1^T M_2 B - J). As in a
 * step, no conductor makes it grow. */
static void take_half_step(dvi__yee *y, int has_B)
{
  if (!has_B && y->loss == NULL && y->wall == NULL && y->on_edges.count == 0) return;
  const int64_t size = dvi__yee_form_size(y, DVI_FORM_E);
  const dvi__yee_moment m = {.yee = y, .part = 0, .on_faces = y->drive, .on_edges = y->drive};
  for (int64_t i = 0; i < size; i++) {
    int component, place[3];
    dvi__yee_place_of(y, DVI_FORM_E, i, &component, place);
    dvi__yee_start_edge(&m, component, place, has_B);
  }
}

static void clear(dvi__yee *y)
{
  const size_t beside = y->rows[0] * y->rows[1] * (size_t)y->edges_slots * y->width;
  for (int copy = 0; copy < y->copies; copy++) memset(y->state[copy], 0, y->size * sizeof(double));
  for (int l = 0; l < 3; l++)
    for (int e = 0; e < 2; e++) {
      dvi__yee_layers *layers = &y->axis[l].layers[e];
      if (layers->count > 0)
        memset(layers->psi, 0, (size_t)y->copies * layers->psi_count * sizeof(double));
    }
  if (y->worn != NULL) memset(y->worn, 0, beside * sizeof(double));
}

/* Make room for the charges of a start with a field. Without one there are none. */
static dvi_status make_charge(dvi__yee *y, int has_field)
{
  const size_t count = dvi__yee_count_nodes(y);
  if (!has_field || y->degree == 0 || y->charge != NULL) return DVI_OK;
  y->charge = DVI_NEW(double, count);
  return y->charge != NULL ? DVI_OK
                           : dvi__fail(DVI_NO_MEMORY, "yee: no memory for %zu charges", count);
}

static dvi_status prepare(dvi__yee *y, double t, int has_field)
{
  DVI_TRY(make_charge(y, has_field));
  DVI_TRY(dvi__yee_start_sources(y, t));
  return dvi__yee_ask_waves(y, t + 0.5 * y->dt);
}

/* Memory and signals are asked for before anything changes. A form has a start if one of the
 * processes has it. */
dvi_status dvi__yee_start(void *self, const dvi_march_state *state)
{
  dvi__yee *y = self;
  const int lost = dvi__yee_begin_ranks(y);
  double has[2] = {state->E != NULL, state->B != NULL};
  dvi__yee_largest_of_all(y, 2, has);
  const dvi_status status = dvi__yee_agree(y, prepare(y, state->t, has[0] > 0));
  if (status != DVI_OK) {
    dvi__yee_lose_ranks(y, lost);
    return status;
  }
  dvi__yee_start_waves(y);
  dvi__yee_restart_impulses(y);
  y->t0 = y->t = state->t;
  y->step = 0;
  y->moment->is_now = 0;
  clear(y);
  set_values(y, DVI_FORM_E, state->E);
  set_values(y, DVI_FORM_B, state->B);
  if (has[0] > 0) clear_conductors(y);
  dvi__yee_wrap_values(y);
  if (y->charge != NULL) dvi__yee_keep_charge(y);
  take_half_step(y, has[1] > 0);
  dvi__yee_wrap_values(y);
  return dvi__yee_check_ranks(y);
}
