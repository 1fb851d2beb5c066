/* The laws of a solid, measured on a march that begins at random.
 *
 * The forces of a cell have no sum and no torque at the places of its nodes, and they act on all of
 * them at one time. So momentum and angular momentum stay, whatever the steps are. Steps of several
 * lengths have no energy of their own, and the energy at rest of their limit is only close to
 * constant (Lew, Marsden, Ortiz and West 2003). The linear law knows turns of X in place of those
 * of X + u. */
#include <float.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/random.h"
#include "field/elastic/system.h"
#include "field/elastic_avi/march.h"
#include "field/mesh/share.h"

enum { MOMENTA = 2 * DVI__SOLID_AXES };

/* Strains at the start are about this large: small beside what inverts a cell, and large beside
 * roundings. */
static const double strain = 0.01;

typedef struct laws {
  const dvi_elastic *solid;
  dvi__solid_avi *avi;
  double *u, *rate; /* [vertices*n] the start */
  int n, momenta;   /* of which the first n are no turns */
} laws;

/* ---- what a solid has ---- */

static int is_damped(const dvi_elastic *e)
{
  for (int i = 0; i < e->material_count; i++)
    if (e->materials[i].alpha > 0 || e->materials[i].beta > 0) return 1;
  return 0;
}

/* Nothing works on the solid, and it begins close to rest. */
static int has_energy(const dvi_elastic *e)
{
  if (is_damped(e) || e->obstacles > 0 || e->is_driven) return 0;
  if (e->load_count > 0 && !e->has_steady_loads) return 0;
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    if (e->steady[k] != 0) return 0;
  return 1;
}

/* Momenta that nothing changes. */
static int momenta_of(const dvi_elastic *e)
{
  const int is_free = e->unknowns == e->vertices * e->n && e->load_count == 0 && e->obstacles == 0;
  if (!is_free || is_damped(e)) return 0;
  return !dvi__solid_has_turns(e) ? e->n : e->n == 3 ? 6 : 3;
}

/* ---- the start ---- */

/* The least height of a cell, the inverse of the largest gradient. */
static double least_height(const dvi_elastic *e)
{
  double most = 0;
  for (int64_t i = 0; i < e->cells * (e->n + 1); i++) {
    double square = 0;
    for (int j = 0; j < e->n; j++) square += e->gradient[i * e->n + j] * e->gradient[i * e->n + j];
    most = fmax(most, square);
  }
  return 1 / sqrt(most);
}

static dvi_status stored_at(const laws *s, const double *u, double *stored)
{
  dvi_elastic_energies energies;
  DVI_TRY(dvi_elastic_energy(s->solid, 0, u, NULL, NULL, &energies));
  *stored = energies.stored;
  return DVI_OK;
}

/* Displacements and rates at random, with as much kinetic as stored energy. */
static dvi_status begin(const laws *s)
{
  const dvi_elastic *e = s->solid;
  const int64_t numbers = e->vertices * e->n;
  const double height = least_height(e);
  double at_rest, stored, kinetic = 0;
  DVI_TRY(stored_at(s, s->u, &at_rest));
  (void)dvi__fill_random(numbers, 61, s->u);
  (void)dvi__fill_random(numbers, 71, s->rate);
  for (int64_t k = 0; k < numbers; k++) {
    s->u[k] = e->unknown[k] < 0 ? 0 : strain * height * s->u[k];
    if (e->unknown[k] < 0) s->rate[k] = 0;
    kinetic += 0.5 * e->mass[k / e->n] * s->rate[k] * s->rate[k];
  }
  DVI_TRY(stored_at(s, s->u, &stored));
  for (int64_t k = 0; k < numbers; k++) s->rate[k] *= sqrt(fmax(stored - at_rest, 0) / kinetic);
  return dvi__solid_avi_start(s->avi, 0, s->u, s->rate);
}

/* ---- what is measured ---- */

/* What has been seen at the start, and the largest changes beside the largest sizes. */
typedef struct record {
  double momentum[MOMENTA], change[MOMENTA], size[MOMENTA];
  double energy, energy_change, energy_size;
} record;

static dvi_status look(const laws *s, int is_start, record *seen)
{
  DVI_TRY(dvi__solid_avi_look(s->avi));
  const dvi_elastic_energies *e = &s->avi->view->energies;
  const double energy = e->kinetic + e->stored + e->load;
  if (is_start) seen->energy = energy;
  seen->energy_change = fmax(seen->energy_change, fabs(energy - seen->energy));
  seen->energy_size = fmax(seen->energy_size, e->kinetic + e->stored);
  for (int k = 0; k < s->momenta; k++) {
    double now, size;
    DVI_TRY(dvi__solid_momentum(s->avi, k, &now, &size));
    if (is_start) seen->momentum[k] = now;
    seen->change[k] = fmax(seen->change[k], fabs(now - seen->momentum[k]));
    seen->size[k] = fmax(seen->size[k], size);
  }
  return DVI_OK;
}

static dvi_law law_of(const record *seen, const char *name, int first, int end)
{
  double error = 0;
  for (int k = first; k < end; k++)
    error = fmax(error, seen->change[k] / fmax(seen->size[k], DBL_MIN));
  return (dvi_law){.name = name, .error = error, .is_exact = 1};
}

static dvi_status measure(const laws *s, int steps, dvi_law *law, int *count)
{
  record seen = {0};
  int found = 0;
  DVI_TRY(begin(s));
  DVI_TRY(look(s, 1, &seen));
  for (int i = 1; i <= steps; i++) {
    DVI_TRY(dvi__solid_avi_advance(s->avi, i * s->avi->longest));
    DVI_TRY(look(s, 0, &seen));
  }
  if (s->momenta > 0) law[found++] = law_of(&seen, "momentum", 0, s->n);
  if (s->momenta > s->n) law[found++] = law_of(&seen, "angular", s->n, s->momenta);
  if (has_energy(s->solid))
    law[found++] = (dvi_law){.name = "energy",
                             .error = seen.energy_change / fmax(seen.energy_size, DBL_MIN)};
  *count = found;
  return DVI_OK;
}

dvi_status dvi_elastic_laws(const dvi_elastic *elastic, const dvi_march_options *options, int steps,
                            dvi_law *law, int *count)
{
  dvi__solid_request request;
  if (elastic == NULL || law == NULL || count == NULL || steps < 2)
    return dvi__fail(DVI_BAD_ARGUMENT, "laws: a solid, at least 2 steps, and room for the laws are "
                                       "needed");
  *count = 0;
  DVI_TRY(dvi__refuse_share(elastic->mesh, "laws: a solid"));
  DVI_TRY(dvi__solid_ask(elastic, options, &request));
  laws s = {.solid = elastic, .n = elastic->n, .momenta = momenta_of(elastic)};
  if (s.momenta == 0 && !has_energy(elastic)) return DVI_OK;
  DVI_TRY(dvi__solid_avi_create(elastic, &request, &s.avi));
  s.u = DVI_NEW(double, elastic->vertices * elastic->n);
  s.rate = DVI_NEW(double, elastic->vertices * elastic->n);
  const dvi_status status = s.u != NULL && s.rate != NULL
                                ? measure(&s, steps, law, count)
                                : dvi__fail(DVI_NO_MEMORY, "laws: no memory");
  dvi__release(s.u);
  dvi__release(s.rate);
  dvi__solid_avi_destroy(&s.avi);
  return status;
}
