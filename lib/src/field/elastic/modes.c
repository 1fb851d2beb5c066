/* Small vibrations about rest, K x = omega^2 M x, without the rigid motions that conditions
 * allow. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/rigid.h"
#include "field/elastic/system.h"
#include "field/mesh/share.h"
#include "field/pencil/on_share.h"

enum { DEFAULT_COUNT = 6 };

/* ---- matrices ---- */

static dvi_status make_mass(const dvi_elastic *e, double **mass)
{
  *mass = DVI_NEW(double, e->unknowns);
  if (*mass == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a mass");
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    if (e->unknown[k] >= 0) (*mass)[e->unknown[k]] = e->mass[k / e->n];
  return DVI_OK;
}

static dvi_matrix view_diagonal(int64_t rows, const double *value)
{
  return (dvi_matrix){.rows = rows, .columns = rows, .width = 1, .symmetric = 1, .value = value};
}

/* ---- the fastest one ---- */

/* List the coordinates that are unknowns. */
static dvi_status list_places(const dvi_elastic *e, int **place)
{
  *place = DVI_NEW(int, e->unknowns);
  if (*place == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a frequency");
  for (int64_t k = 0; k < e->vertices * e->n; k++)
    if (e->unknown[k] >= 0) (*place)[e->unknown[k]] = (int)k;
  return DVI_OK;
}

dvi_status dvi__solid_find_fastest(const dvi_elastic *e, const dvi__csr *K, const double *mass)
{
  double bound = 0;
  int *place = NULL;
  const dvi_matrix stiffness = dvi__csr_view(K, 1), diagonal = view_diagonal(e->unknowns, mass);
  const dvi__pencil pencil = {.K = &stiffness, .M = &diagonal, .dimension = e->n};
  if (e->fastest > 0) return DVI_OK;
  dvi_status status = dvi__agree(e->mesh, list_places(e, &place));
  const dvi__cell_unknowns unknowns = {.mesh = e->mesh,
                                       .components = e->n,
                                       .count = e->unknowns,
                                       .total = e->whole_unknowns,
                                       .place = place};
  if (status == DVI_OK) status = dvi__largest_on_share(&pencil, &unknowns, &bound);
  dvi__release(place);
  if (status == DVI_OK)
    ((dvi_elastic *)e)->fastest = sqrt(fmax(bound, 0)); /* the same in every thread */
  return status;
}

dvi_status dvi_elastic_fastest(const dvi_elastic *elastic, double *omega)
{
  if (elastic == NULL || omega == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a solid and a place for a frequency are needed");
  dvi__csr K = {0};
  double *mass = NULL;
  dvi_status status = DVI_OK;
  if (!(elastic->fastest > 0)) {
    status = dvi__solid_rest_stiffness(elastic, &K);
    if (status == DVI_OK) status = make_mass(elastic, &mass);
    status = dvi__agree(elastic->mesh, status);
    if (status == DVI_OK) status = dvi__solid_find_fastest(elastic, &K, mass);
  }
  *omega = elastic->fastest;
  dvi__csr_clear(&K);
  dvi__release(mass);
  return status;
}

/* ---- modes ---- */

typedef struct modes {
  const dvi_elastic *elastic;
  dvi__csr K;
  double *mass, *value, *vector; /* [unknowns], [asked], [asked][unknowns] */
  dvi__rigid rigid;
  int count, asked;
} modes;

static void clear(modes *m)
{
  dvi__csr_clear(&m->K);
  dvi__rigid_clear(&m->rigid);
  dvi__release(m->mass);
  dvi__release(m->value);
  dvi__release(m->vector);
}

/* With rigid motions K is semidefinite. A shift below 0, of the size of the lowest eigenvalues,
 * makes it definite: entries of K over those of M are about c^2/h^2, and a length of the mesh about
 * h N^(1/n) with N nodes. */
static double shift_below_zero(const modes *m)
{
  const dvi_elastic *e = m->elastic;
  double k = 0, mass = 0;
  for (int64_t i = 0; i < e->unknowns; i++) {
    k += m->K.value[dvi__csr_find(&m->K, i, (int)i)];
    mass += m->mass[i];
  }
  return -0.1 * k / mass * pow((double)e->vertices, -2.0 / e->n);
}

static double product(const modes *m, const double *x, const double *y)
{
  double sum = 0;
  for (int64_t i = 0; i < m->elastic->unknowns; i++) sum += x[i] * m->mass[i] * y[i];
  return sum;
}

/* Take rigid motions, and the modes that were kept, out of a mode. Returns 0 if nothing is left. */
static int purify(const modes *m, int kept, double *x)
{
  const int64_t n = m->elastic->unknowns;
  dvi__rigid_remove(&m->rigid, x);
  for (int k = 0; k < kept; k++) {
    const double *other = m->vector + k * n, part = product(m, x, other);
    for (int64_t i = 0; i < n; i++) x[i] -= part * other[i];
  }
  const double square = product(m, x, x);
  if (square < 1e-3) return 0;
  for (int64_t i = 0; i < n; i++) x[i] /= sqrt(square);
  return 1;
}

/* Move the modes that are not rigid motions to the front. Where parts of a body turn about each
 * other, their turns, of frequency 0, come mixed with these. Returns their number. */
static int drop_rigid(modes *m)
{
  const size_t n = (size_t)m->elastic->unknowns;
  int kept = 0;
  for (int i = 0; i < m->asked; i++) {
    double *x = m->vector + (size_t)i * n;
    if (dvi__rigid_share(&m->rigid, x) > 1e-6 && !purify(m, kept, x)) continue;
    m->value[kept] = m->value[i];
    if (kept != i) memcpy(m->vector + (size_t)kept * n, x, n * sizeof *x);
    kept++;
  }
  return kept;
}

static void spread(const modes *m, const double *vector, double *mode)
{
  const dvi_elastic *e = m->elastic;
  const int64_t numbers = e->vertices * e->n;
  for (int i = 0; i < m->count && mode != NULL; i++)
    for (int64_t k = 0; k < numbers; k++)
      mode[i * numbers + k] = e->unknown[k] >= 0 ? vector[i * e->unknowns + e->unknown[k]] : 0;
}

static dvi_status find(modes *m, double shift, double *eigenvalue, double *mode)
{
  const dvi_elastic *e = m->elastic;
  const int64_t most = e->unknowns - m->rigid.count;
  if (m->count < 1 || m->count > most)
    return dvi__fail(DVI_BAD_SIZE,
                     "elastic: %d modes of %lld displacements, of which %lld are rigid motions: "
                     "take 1 to %lld",
                     m->count, (long long)e->unknowns, (long long)m->rigid.count, (long long)most);
  m->asked = m->count + (int)m->rigid.count;
  m->value = DVI_NEW(double, m->asked);
  m->vector = DVI_NEW(double, m->asked * e->unknowns);
  if (m->value == NULL || m->vector == NULL)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for %d modes", m->asked);
  const dvi_matrix stiffness = dvi__csr_view(&m->K, 1), mass = view_diagonal(e->unknowns, m->mass);
  const dvi__pencil pencil = {.K = &stiffness, .M = &mass, .dimension = e->n};
  if (shift == 0 && m->rigid.count > 0) shift = shift_below_zero(m);
  DVI_TRY(dvi__modes_near(&pencil, shift, m->asked, m->value, m->vector));
  const int kept = drop_rigid(m), first = dvi__first_of_nearest(kept, m->value, m->count, shift);
  memcpy(eigenvalue, m->value + first, (size_t)m->count * sizeof *eigenvalue);
  spread(m, m->vector + (int64_t)first * e->unknowns, mode);
  return DVI_OK;
}

dvi_status dvi_elastic_modes(const dvi_elastic *elastic, const dvi_modes_options *options,
                             double *eigenvalue, double *mode, int64_t *zeros)
{
  const dvi_modes_options defaults = {.size = sizeof defaults};
  if (options == NULL) options = &defaults;
  if (elastic == NULL || eigenvalue == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a solid and eigenvalues are needed");
  if (options->size != sizeof defaults)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: set options.size to sizeof(dvi_modes_options)");
  DVI_TRY(dvi__refuse_share(elastic->mesh, "elastic: modes"));
  modes m = {.elastic = elastic, .count = options->count != 0 ? options->count : DEFAULT_COUNT};
  dvi_status status = dvi__solid_rest_stiffness(elastic, &m.K);
  if (status == DVI_OK) status = make_mass(elastic, &m.mass);
  if (status == DVI_OK) status = dvi__rigid_create(elastic, &m.rigid);
  if (status == DVI_OK) status = find(&m, options->shift, eigenvalue, mode);
  if (status == DVI_OK && zeros != NULL) *zeros = m.rigid.count;
  clear(&m);
  return status;
}
