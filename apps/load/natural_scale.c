#include "load/natural_scale.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/density.h"

static void read_state(const problem *scene, const dvi_integrator *integrator, double *state)
{
  memcpy(state, dvi_integrator_q(integrator), (size_t)scene->nq * sizeof *state);
  memcpy(state + scene->nq, dvi_integrator_p(integrator), (size_t)scene->nv * sizeof *state);
}

bool natural_scale_start(natural_scale *s, const problem *scene, const dvi_integrator *integrator)
{
  const size_t numbers = (size_t)scene->nq + (size_t)scene->nv;
  const size_t invariants = (size_t)dvi_system_invariant_count(scene->system);
  *s = (natural_scale){.scene = scene,
                       .invariants = (int)invariants,
                       .apart = scene->terms->one_form == NULL || has_field(scene) ? 1 : 0,
                       .chance = 1};
  s->room = calloc(2 * (numbers + invariants), sizeof *s->room);
  if (s->room == NULL) return library_error(DVI_NO_MEMORY) == DONE;
  s->start = s->room;
  s->mixed = s->start + numbers;
  s->value = s->mixed + numbers;
  s->changed = s->value + invariants;
  read_state(scene, integrator, s->start);
  return true;
}

void natural_scale_clear(natural_scale *s)
{
  free(s->room);
  s->room = NULL;
}

/* Return the high bit of a linear congruential generator (constants of Numerical Recipes). */
static bool random_bit(natural_scale *s)
{
  s->chance = s->chance * 1664525U + 1013904223U;
  return (s->chance >> 31 & 1U) != 0;
}

/* Add the changes that the mixed state makes in invariants first to end - 1. Returns 1, or 0 if the
 * state is not possible. */
static int add_changes(natural_scale *s, dvi_integrator *integrator, int first, int end)
{
  if (dvi_system_invariants(s->scene->system, dvi_integrator_time(integrator), s->mixed,
                            s->mixed + s->scene->nq, s->value) != DVI_OK)
    return 0;
  for (int i = first; i < end; i++) {
    double there;
    if (dvi_integrator_invariant(integrator, i, &there) == DVI_OK)
      s->changed[i] += fabs(s->value[i] - there);
  }
  return 1;
}

void natural_scale_look(natural_scale *s, dvi_integrator *integrator)
{
  const int nq = s->scene->nq, numbers = nq + s->scene->nv;
  read_state(s->scene, integrator, s->mixed);
  for (int i = 0; i < numbers; i++)
    if (random_bit(s)) s->mixed[i] = s->start[i];
  s->looks += add_changes(s, integrator, s->apart, s->invariants);
  if (s->apart == 0) return;
  read_state(s->scene, integrator, s->mixed);
  memcpy(s->mixed, s->start, (size_t)nq * sizeof *s->mixed);
  s->energy_looks += add_changes(s, integrator, 0, s->apart);
}

double natural_scale_of(const natural_scale *s, int invariant)
{
  const int looks = invariant < s->apart ? s->energy_looks : s->looks;
  const double mean = looks > 0 ? s->changed[invariant] / looks : 0.0;
  return isfinite(mean) ? mean : 0.0;
}
