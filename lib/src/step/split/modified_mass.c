#include "step/split/modified_mass.h"

#include <string.h>

#include "step/split/quadratic.h"
#include "core/memory.h"
#include "core/status.h"
#include "num/eigen.h"

typedef struct kept_factor {
  dvi__linear *linear;
  double square; /* h^2 of the factored matrix (0 before the first) */
} kept_factor;

struct dvi__modified_mass {
  dvi__evaluator *evaluator;
  dvi_counters *counters;
  dvi__quadratic parts;
  double *matrix;  /* matrix in the order of its pattern */
  double *full;    /* [n*n] the same matrix where a full one is factored, else NULL */
  int is_positive; /* not 0 if the mass is positive */
  kept_factor kept[DVI__LENGTHS_MOST];
  int count, oldest; /* number of kept factors, and the oldest of them */
};

/* Return 1 if a matrix in the order of the pattern is positive. */
static int full_is_positive(const dvi__modified_mass *m, const double *values)
{
  const dvi__pattern *pattern = &m->parts.pattern;
  const size_t n = (size_t)pattern->columns;
  memset(m->full, 0, n * n * sizeof *m->full);
  for (size_t j = 0; j < n; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      m->full[j * n + (size_t)pattern->row[e]] = values[e];
  return dvi__is_positive_definite(pattern->columns, m->full);
}

/* Examine the mass. A mass with fewer entries than a sparse matrix is sparse, too. */
static dvi_status look_at_mass(dvi__modified_mass *m)
{
  const size_t n = (size_t)m->parts.pattern.columns;
  if (dvi__linear_kind_of(m->kept[0].linear) == DVI__LINEAR_DENSE) {
    m->full = DVI_NEW(double, (n * n));
    if (m->full == NULL)
      return dvi__fail(DVI_NO_MEMORY, "modified mass: no memory for %zu x %zu numbers", n, n);
  }
  m->is_positive = m->full != NULL ? full_is_positive(m, m->parts.mass)
                                   : dvi__mass_is_positive(m->evaluator);
  return DVI_OK;
}

/* Prefer L D L^T for a sparse matrix that has to be positive definite. LU takes twice the memory
 * and the operations, and a system of equations then takes half as long again. */
static dvi_status prefer_definite(dvi__modified_mass *m)
{
  dvi__linear **linear = &m->kept[0].linear;
  if (!m->is_positive || m->full != NULL) return DVI_OK;
  dvi__linear_destroy(linear);
  return dvi__linear_create(&m->parts.pattern, DVI__LINEAR_DEFINITE, m->counters, linear);
}

static dvi_status modified_mass_initialise(dvi__modified_mass *m, const dvi_system *system,
                                           dvi_counters *counters)
{
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__HESSIANS, counters, &m->evaluator));
  DVI_TRY(dvi__quadratic_fill(system, m->evaluator, &m->parts));
  m->matrix = DVI_NEW(double, dvi__pattern_entries(&m->parts.pattern));
  if (m->matrix == NULL) return dvi__fail(DVI_NO_MEMORY, "modified mass: no memory");
  m->counters = counters;
  m->count = 1;
  DVI_TRY(dvi__linear_create(&m->parts.pattern, DVI__LINEAR_AUTO, counters, &m->kept[0].linear));
  DVI_TRY(look_at_mass(m));
  return prefer_definite(m);
}

dvi_status dvi__modified_mass_create(const dvi_system *system, dvi_counters *counters,
                                     dvi__modified_mass **mass)
{
  dvi__modified_mass *made = *mass = DVI_NEW(dvi__modified_mass, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "modified mass: no memory");
  const dvi_status status = modified_mass_initialise(made, system, counters);
  if (status != DVI_OK) dvi__modified_mass_destroy(mass);
  return status;
}

void dvi__modified_mass_destroy(dvi__modified_mass **mass)
{
  dvi__modified_mass *m = *mass;
  if (m == NULL) return;
  for (int k = 0; k < m->count; k++) dvi__linear_destroy(&m->kept[k].linear);
  dvi__quadratic_clear(&m->parts);
  dvi__release(m->matrix);
  dvi__release(m->full);
  dvi__evaluator_destroy(&m->evaluator);
  dvi__release(m);
  *mass = NULL;
}

dvi_status dvi__modified_mass_keep(dvi__modified_mass *m, int count)
{
  dvi__linear *first = m->kept[0].linear;
  const dvi__linear_kind kind = dvi__linear_kind_of(first);
  for (; m->count < count; m->count++) {
    dvi__linear **linear = &m->kept[m->count].linear;
    DVI_TRY(kind == DVI__LINEAR_SPARSE
                ? dvi__linear_create_like(first, kind, m->counters, linear)
                : dvi__linear_create(&m->parts.pattern, kind, m->counters, linear));
  }
  return DVI_OK;
}

/* Return 1 if the matrix has the signature of the mass. From h = 0 on the signature is constant
 * until the matrix is singular. Longer steps would jump through infinity. */
static int is_as_the_mass(const dvi__modified_mass *m, const dvi__linear *linear)
{
  if (!m->is_positive) return dvi__linear_sign(linear) == dvi__mass_sign(m->evaluator);
  return m->full != NULL ? full_is_positive(m, m->matrix) : dvi__linear_is_definite(linear, 1);
}

static dvi_status modified_mass_factor(dvi__modified_mass *m, double square, kept_factor *kept)
{
  kept->square = 0;
  for (int e = 0; e < dvi__pattern_entries(&m->parts.pattern); e++)
    m->matrix[e] = m->parts.mass[e] + 0.25 * square * m->parts.stiffness[e];
  const dvi_status status = dvi__linear_factor(kept->linear, m->matrix);
  if (status != DVI_OK && status != DVI_SINGULAR) return status;
  if (status == DVI_SINGULAR || !is_as_the_mass(m, kept->linear))
    return dvi__fail(
        DVI_NOT_CONVERGED, "M + h^2/4 K is singular at this length or at a shorter one: %s",
        m->is_positive ? "the Hessian K of the fast potentials has negative directions, along "
                         "which motion grows too much in a step"
                       : "the mass M is indefinite, and K outweighs it along some direction");
  kept->square = square;
  return DVI_OK;
}

dvi_status dvi__modified_mass_solve(dvi__modified_mass *m, double h, double *x)
{
  int k = 0;
  while (k < m->count && m->kept[k].square != h * h) k++;
  if (k == m->count) {
    k = m->oldest;
    DVI_TRY(modified_mass_factor(m, h * h, &m->kept[k]));
    m->oldest = k + 1 < m->count ? k + 1 : 0;
  }
  dvi__linear_solve(m->kept[k].linear, x);
  return DVI_OK;
}

const dvi__pattern *dvi__modified_mass_pattern(const dvi__modified_mass *m)
{
  return &m->parts.pattern;
}

const char *dvi__modified_mass_solver(const dvi__modified_mass *m)
{
  return dvi__linear_name(m->kept[0].linear);
}
