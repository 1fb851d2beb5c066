#include "action/modified_mass.h"

#include "core/memory.h"
#include "core/status.h"

struct dvi__modified_mass {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi__pattern pattern;
  dvi__linear *linear;
  double *mass, *stiffness, *matrix; /* in the order of the pattern */
  double square;                     /* h^2 of the matrix that is factored; 0: none is */
};

static dvi_status no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "modified mass: no memory");
}

/* The values of a part at their places in the whole. */
static dvi_status spread(const dvi__pattern *part, double sign, const double *values, const dvi__pattern *whole, double *to)
{
  int *where = DVI_NEW(int, dvi__pattern_entries(part));
  if (where == NULL) return no_memory();
  dvi__pattern_embed(part, whole, where);
  for (int e = 0; e < dvi__pattern_entries(part); e++) to[where[e]] = sign * values[e];
  dvi__release(where);
  return DVI_OK;
}

/* L_qq = -K, which is the same everywhere. */
static dvi_status find_stiffness(dvi__modified_mass *m)
{
  const dvi_system *s = m->system;
  const double t = 0;
  double *origin = DVI_NEW(double, s->n), *L_qq = DVI_NEW(double, dvi__pattern_entries(&s->qq));
  dvi_status status = origin != NULL && L_qq != NULL ? DVI_OK : no_memory();
  if (status == DVI_OK) {
    status = dvi__lagrangian_hessian(m->evaluator, 1, &t, origin, NULL, L_qq, NULL, NULL);
    if (status != DVI_OK) status = dvi__fail_in(status, "quadratic potentials at t = 0, q = 0");
  }
  if (status == DVI_OK) status = spread(&s->qq, -1, L_qq, &m->pattern, m->stiffness);
  dvi__release(origin);
  dvi__release(L_qq);
  return status;
}

static dvi_status fill(dvi__modified_mass *m, dvi_counters *counters)
{
  const dvi_system *s = m->system;
  DVI_TRY(dvi__evaluator_create(s, 1, DVI__HESSIANS, counters, &m->evaluator));
  DVI_TRY(dvi__pattern_union(&s->vv, &s->qq, &m->pattern));
  const int entries = dvi__pattern_entries(&m->pattern);
  m->mass = DVI_NEW(double, entries);
  m->stiffness = DVI_NEW(double, entries);
  m->matrix = DVI_NEW(double, entries);
  if (!m->mass || !m->stiffness || !m->matrix) return no_memory();
  DVI_TRY(spread(&s->vv, 1, s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values, &m->pattern, m->mass));
  DVI_TRY(find_stiffness(m));
  return dvi__linear_create(&m->pattern, DVI__LINEAR_AUTO, counters, &m->linear);
}

dvi_status dvi__modified_mass_create(const dvi_system *system, dvi_counters *counters, dvi__modified_mass **mass)
{
  dvi__modified_mass *made = *mass = DVI_NEW(dvi__modified_mass, 1);
  if (made == NULL) return no_memory();
  made->system = system;
  const dvi_status status = fill(made, counters);
  if (status != DVI_OK) dvi__modified_mass_destroy(mass);
  return status;
}

void dvi__modified_mass_destroy(dvi__modified_mass **mass)
{
  dvi__modified_mass *m = *mass;
  if (m == NULL) return;
  dvi__linear_destroy(&m->linear);
  dvi__evaluator_destroy(&m->evaluator);
  dvi__pattern_clear(&m->pattern);
  dvi__release(m->mass);
  dvi__release(m->stiffness);
  dvi__release(m->matrix);
  dvi__release(m);
  *mass = NULL;
}

/* The determinant keeps the sign that it has at h = 0 until the matrix is singular; longer steps would jump through infinity. */
static dvi_status factor(dvi__modified_mass *m, double square)
{
  m->square = 0;
  for (int e = 0; e < dvi__pattern_entries(&m->pattern); e++) m->matrix[e] = m->mass[e] + 0.25 * square * m->stiffness[e];
  const dvi_status status = dvi__linear_factor(m->linear, m->matrix);
  if (status != DVI_OK && status != DVI_SINGULAR) return status;
  if (status == DVI_SINGULAR || dvi__linear_sign(m->linear) != dvi__mass_sign(m->evaluator))
    return dvi__fail(
        DVI_NOT_CONVERGED,
        "M + h^2/4 K is singular at this length or at a shorter one: the Hessian K of the fast potentials is indefinite, and "
        "their motion grows too much in a step");
  m->square = square;
  return DVI_OK;
}

dvi_status dvi__modified_mass_solve(dvi__modified_mass *m, double h, double *x)
{
  if (m->square != h * h) DVI_TRY(factor(m, h * h));
  dvi__linear_solve(m->linear, x);
  return DVI_OK;
}

const dvi__pattern *dvi__modified_mass_pattern(const dvi__modified_mass *m)
{
  return &m->pattern;
}

dvi__linear_kind dvi__modified_mass_kind(const dvi__modified_mass *m)
{
  return dvi__linear_kind_of(m->linear);
}
