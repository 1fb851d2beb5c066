/* Rayleigh's damping, the force -D u' with D = sum_K alpha_K M_K + beta_K K_K (Rayleigh 1877, sec.
 * 81), where M_K is a cell's part of the lumped mass and K_K its stiffness at rest. */
#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/system.h"

enum { NUMBERS = DVI__SOLID_NUMBERS };

static int is_damped(const dvi_elastic *e, int64_t cell)
{
  const dvi__solid_material *m = e->materials + e->material[cell];
  return m->alpha > 0 || m->beta > 0;
}

/* Give D of a cell. */
static void find_damping(const dvi_elastic *e, int64_t cell, double *D)
{
  const int numbers = (e->n + 1) * e->n;
  const dvi__solid_material *m = e->materials + e->material[cell];
  const double part = m->rho * e->volume[cell] / (e->n + 1);
  (void)dvi__solid_stiffness(e, cell, NULL, D);
  for (int k = 0; k < numbers * numbers; k++) D[k] *= m->beta;
  for (int k = 0; k < numbers; k++) D[k * numbers + k] += m->alpha * part;
}

/* Add the forces of nodes that conditions move. */
static int add_driven(const dvi_elastic *e, double t, double *F)
{
  const int numbers = (e->n + 1) * e->n;
  for (int64_t c = 0; c < e->cells; c++) {
    double rate[NUMBERS], D[NUMBERS * NUMBERS], f[NUMBERS] = {0};
    if (!is_damped(e, c)) continue;
    const int found = dvi__solid_driven_rates(e, c, t, rate);
    if (found < 0) return found;
    if (found == 0) continue;
    find_damping(e, c, D);
    for (int r = 0; r < numbers; r++)
      for (int k = 0; k < numbers; k++) f[r] -= D[r * numbers + k] * rate[k];
    dvi__solid_scatter(e, c, f, F);
  }
  return 0;
}

static int damping_value(double t, const double *q, const double *v, double *F, void *user)
{
  const dvi__solid_system *s = user;
  const dvi__csr *pattern = &s->pattern.matrix;
  (void)q;
  for (int64_t i = 0; i < pattern->rows; i++) {
    F[i] = 0;
    for (int64_t e = pattern->start[i]; e < pattern->start[i + 1]; e++)
      F[i] -= s->damping[e] * v[pattern->column[e]];
  }
  return s->elastic->is_driven ? add_driven(s->elastic, t, F) : 0;
}

/* The pattern's columns are the rows of the symmetric matrix. */
static int damping_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                            void *user)
{
  const dvi__solid_system *s = user;
  const int64_t entries = s->pattern.matrix.start[s->pattern.matrix.rows];
  (void)t, (void)q, (void)v, (void)F_q;
  for (int64_t e = 0; F_v != NULL && e < entries; e++) F_v[e] = -s->damping[e];
  return 0;
}

dvi_status dvi__solid_make_damping(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  int64_t damped = 0;
  for (int64_t c = 0; c < e->cells; c++) damped += is_damped(e, c);
  if (damped == 0) return DVI_OK;
  s->damping = DVI_NEW(double, s->pattern.matrix.start[s->pattern.matrix.rows]);
  if (s->damping == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for damping");
  for (int64_t c = 0; c < e->cells; c++) {
    double D[NUMBERS * NUMBERS];
    if (!is_damped(e, c)) continue;
    find_damping(e, c, D);
    dvi__solid_add_matrix(e, &s->pattern, c, D, s->damping);
  }
  s->force = (dvi_force){.name = "damping",
                         .value = damping_value,
                         .jacobian = damping_jacobian,
                         .by_q = {.start = s->no_start, .row = s->no_start},
                         .by_v = {.start = s->start, .row = s->pattern.matrix.column},
                         .user = s};
  return DVI_OK;
}
