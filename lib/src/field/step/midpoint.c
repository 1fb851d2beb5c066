/* The implicit midpoint rule for waves on shares of a mesh. With q_m = q0 + x the equations of a
 * step (docs/methods/midpoint.md) are
 *
 *     M x - h/2 p0 + h^2/4 (K q_m - load + w V_u(q_m)) = 0,
 *     q1 = q0 + 2 x,      p1 = p0 - h (K q_m - load + w V_u(q_m)).
 *
 * The Jacobian is M + h^2/4 (K + w V_uu). All processes solve together (field/model/on_all.h). */
#include "field/step/midpoint.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/model/on_all.h"
#include "field/step/observables.h"
#include "field/step/saved.h"

typedef struct midpoint {
  const dvi_field *field;
  dvi_matrix d;
  dvi__on_all solver;
  dvi__march_place at;
  /* [cells] values and momenta of the form at t_n, and at t_{n-1}. Those of others are refreshed */
  double *q, *p, *q_before, *p_before;
  double *x, *middle, *force, *slope; /* [unknowns] */
  int is_lost;                        /* processes could not give each other their values */
} midpoint;

/* ---- the equations of a step ---- */

static dvi_status refuse(int failed)
{
  return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "march: the potential returned %d", failed);
}

/* Refuse derivatives of the potential at own unknowns that are not finite. */
static dvi_status check(const dvi_field *f, const double *derivative)
{
  for (int64_t i = 0; i < f->unknowns; i++)
    if (dvi__owns(f->mesh, 0, f->unknown[i]))
      DVI_TRY(dvi__field_check_datum(f, "derivative of the potential", 0, derivative[i], 0,
                                     f->unknown[i]));
  return DVI_OK;
}

/* Set the middle to q0 + x, and the force to K q - load + w V_u there, of own unknowns. */
static dvi_status find_force(midpoint *m, const double *x)
{
  const dvi_field *f = m->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  for (int64_t i = 0; i < f->unknowns; i++) m->middle[i] = m->q[f->unknown[i]] + x[i];
  dvi_matrix_multiply(&K, 0, m->middle, m->force);
  for (int64_t i = 0; i < f->unknowns; i++) m->force[i] -= f->load[i];
  if (f->potential.density == NULL) return DVI_OK;
  const dvi__density density = {.first = m->slope};
  const int failed = dvi__field_density(f, m->middle, 0, f->unknowns, &density);
  if (failed != 0) return refuse(failed);
  for (int64_t i = 0; i < f->unknowns; i++) m->force[i] += m->slope[i];
  return check(f, m->slope);
}

static dvi_status residual(void *of, const double *x, double *r)
{
  midpoint *m = of;
  const dvi_field *f = m->field;
  const double h = m->at.dt;
  DVI_TRY(find_force(m, x));
  for (int64_t i = 0; i < f->unknowns; i++)
    r[i] = f->mass.value[i] * x[i] - h / 2 * m->p[f->unknown[i]] + h * h / 4 * m->force[i];
  return DVI_OK;
}

static dvi_status diagonal(void *of, const double *x, double *d)
{
  midpoint *m = of;
  const dvi_field *f = m->field;
  const dvi__density density = {.second = d};
  for (int64_t i = 0; i < f->unknowns; i++) m->middle[i] = m->q[f->unknown[i]] + x[i];
  const int failed = dvi__field_density(f, m->middle, 0, f->unknowns, &density);
  if (failed != 0) return refuse(failed);
  DVI_TRY(check(f, d));
  for (int64_t i = 0; i < f->unknowns; i++) d[i] *= m->at.dt * m->at.dt / 4;
  return DVI_OK;
}

/* ---- a step ---- */

static double time_of(const midpoint *m, int64_t n)
{
  return m->at.t0 + (double)n * m->at.dt;
}

static dvi_status explain(const midpoint *m, dvi_status status, const dvi__elliptic_report *report)
{
  if (status == DVI_NOT_CONVERGED)
    (void)dvi__fail(status,
                    "%s: Newton's method left a residual of %.2g after %d corrections and %lld "
                    "iterations",
                    report->why, report->residual, report->corrections,
                    (long long)report->iterations);
  return dvi__fail_in(status,
                      "march: midpoint: step %lld from t = %.9g with h = %.6g failed; the state is "
                      "unchanged, try a smaller step",
                      (long long)m->at.n + 1, time_of(m, m->at.n), m->at.dt);
}

/* Nothing changes until the solution is there. The force is known of own unknowns alone. */
static dvi_status step(midpoint *m)
{
  const dvi_field *f = m->field;
  dvi__elliptic_report report = {0};
  for (int64_t i = 0; i < f->unknowns; i++)
    m->x[i] = m->at.dt / 2 * (m->p[f->unknown[i]] / f->mass.value[i]);
  dvi_status status = m->solver.kind->solve(m->solver.solver, m->x, &report);
  if (status == DVI_OK) status = dvi__agree(f->mesh, find_force(m, m->x));
  if (status != DVI_OK) return explain(m, status, &report);
  memcpy(m->q_before, m->q, (size_t)f->cells * sizeof *m->q);
  memcpy(m->p_before, m->p, (size_t)f->cells * sizeof *m->p);
  for (int64_t i = 0; i < f->unknowns; i++) {
    m->q[f->unknown[i]] += 2 * m->x[i];
    m->p[f->unknown[i]] -= m->at.dt * m->force[i];
  }
  m->at.n++;
  status = dvi__refresh(f->mesh, 0, m->p);
  m->is_lost = status != DVI_OK;
  return status;
}

/* The march stands in the last step: t_{n-1} < t <= t_n. */
static dvi_status advance(void *self, double t)
{
  midpoint *m = self;
  const double rounding = 8 * DBL_EPSILON * fmax(fabs(t), fabs(m->at.t0));
  while (time_of(m, m->at.n) < t - rounding) {
    const dvi_status status = step(m);
    if (status == DVI_OK) continue;
    m->at.t = fmax(m->at.t, time_of(m, m->at.n));
    return status;
  }
  m->at.t = t;
  return DVI_OK;
}

static dvi_status start(void *self, const dvi_march_state *state)
{
  midpoint *m = self;
  const dvi_field *f = m->field;
  if (state->B != NULL)
    return dvi__agree(f->mesh,
                      dvi__fail(DVI_UNSUPPORTED, "march: midpoint starts from A and E; B is dA"));
  m->at.t0 = m->at.t = state->t;
  m->at.n = 0;
  memcpy(m->q, f->fixed, (size_t)f->cells * sizeof *m->q);
  memset(m->p, 0, (size_t)f->cells * sizeof *m->p);
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (state->A != NULL) m->q[c] = state->A[c];
    if (state->E != NULL) m->p[c] = -f->mass.value[i] * state->E[c];
  }
  dvi_status status = dvi__refresh(f->mesh, 0, m->q);
  if (status == DVI_OK) status = dvi__refresh(f->mesh, 0, m->p);
  memcpy(m->q_before, m->q, (size_t)f->cells * sizeof *m->q);
  memcpy(m->p_before, m->p, (size_t)f->cells * sizeof *m->p);
  m->is_lost = status != DVI_OK;
  return status;
}

/* ---- what can be seen ---- */

static double time(const void *self)
{
  return ((const midpoint *)self)->at.t;
}

static int64_t size(const void *self, dvi_march_form form)
{
  const midpoint *m = self;
  return form == DVI_FORM_B ? m->d.rows : m->field->cells;
}

/* Give a number on the straight line of the last step. */
static double between(const midpoint *m, const double *before, const double *now, int64_t cell)
{
  const double left = (time_of(m, m->at.n) - m->at.t) / m->at.dt;
  return left > 1e-12 ? now[cell] - left * (now[cell] - before[cell]) : now[cell];
}

static double A_at(const midpoint *m, int64_t cell)
{
  return between(m, m->q_before, m->q, cell);
}

static double E_at(const midpoint *m, int64_t cell)
{
  const int i = m->field->number[cell];
  return i < 0 ? 0 : -between(m, m->p_before, m->p, cell) / m->field->mass.value[i];
}

static double B_at(const midpoint *m, int64_t edge)
{
  double sum = 0;
  for (int64_t e = dvi__first_entry(&m->d, edge); e < dvi__first_entry(&m->d, edge + 1); e++)
    sum += m->d.sign[e] * A_at(m, m->d.column[e]);
  return sum;
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  const midpoint *m = self;
  for (int64_t i = 0; i < count; i++) {
    const int64_t c = cell != NULL ? cell[i] : i;
    values[i] = form == DVI_FORM_A ? A_at(m, c) : form == DVI_FORM_E ? E_at(m, c) : B_at(m, c);
  }
  return DVI_OK;
}

/* Add w V at the middle, of own unknowns. */
static dvi_status add_density(midpoint *m, dvi__block_sum *sum)
{
  const dvi_field *f = m->field;
  for (int64_t i = 0; i < f->unknowns && f->potential.density != NULL; i++) {
    double value;
    if (!dvi__owns(f->mesh, 0, f->unknown[i])) continue;
    const int failed = dvi__field_density(f, m->middle, i, i + 1, &(dvi__density){.sum = &value});
    if (failed != 0) return refuse(failed);
    dvi__block_sum_add(sum, value);
  }
  return DVI_OK;
}

/* p.M^-1 p/2 + q.(K q/2 - load) + the sum of w V at t_n, and the energy of the fixed values. On the
 * line between the ends of a step, stiff modes have less. */
static dvi_status energy(const void *self, double *value)
{
  midpoint *m = (midpoint *)self;
  const dvi_field *f = m->field;
  dvi__block_sum sum = {.count = 0};
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    m->middle[i] = m->q[c];
    if (!dvi__owns(f->mesh, 0, c)) continue;
    const double v = m->p[c] / f->mass.value[i],
                 half = 0.5 * dvi__field_row(f, &f->stiffness, i, m->q);
    dvi__block_sum_add(&sum, 0.5 * m->p[c] * v);
    dvi__block_sum_add(&sum, m->q[c] * (half - f->load[i]));
  }
  DVI_TRY(dvi__agree(f->mesh, add_density(m, &sum)));
  DVI_TRY(dvi__sum_of_all(f->mesh, dvi__block_sum_end(&sum), value));
  *value += f->rest;
  return DVI_OK;
}

static int observables(const void *self)
{
  return dvi__field_observables(((const midpoint *)self)->field);
}

static const char *observable(const void *self, int i)
{
  return dvi__field_observable(((const midpoint *)self)->field, i);
}

static dvi_status observe(const void *self, int i, double *value)
{
  const dvi__observed march = {.sample = sample, .energy = energy, .of = self};
  return dvi__field_observe(((const midpoint *)self)->field, &march, i, value);
}

static void facts(const void *self, dvi_march_facts *facts)
{
  const midpoint *m = self;
  *facts = (dvi_march_facts){.step = m->at.dt,
                             .longest = m->at.dt,
                             .bound = (double)INFINITY,
                             .steps = m->at.n,
                             .updates = m->at.n * dvi__whole_count(m->field->mesh, 1)};
}

/* ---- files ---- */

enum { VERSION = 1, PIECES = 4 };

static dvi__saved_march saved_of(const midpoint *m, dvi__piece piece[PIECES])
{
  double *const forms[PIECES] = {m->q, m->p, m->q_before, m->p_before};
  for (int i = 0; i < PIECES; i++) piece[i] = (dvi__piece){0, m->field->cells, forms[i]};
  return (dvi__saved_march){.method = "midpoint",
                            .version = VERSION,
                            .mesh = m->field->mesh,
                            .at = (dvi__march_place *)&m->at,
                            .pieces = PIECES,
                            .piece = piece};
}

static dvi_status save(const void *self, dvi__sections_writer *writer)
{
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(self, piece);
  return dvi__saved_march_put(&march, writer);
}

static dvi_status load(void *self, const dvi__sections *sections)
{
  midpoint *m = self;
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(m, piece);
  DVI_TRY(dvi__saved_march_take(&march, sections));
  m->is_lost = 0;
  return DVI_OK;
}

static dvi_status agree(const void *self, dvi_status status)
{
  return dvi__agree(((const midpoint *)self)->field->mesh, status);
}

static int is_lost(const void *self)
{
  return ((const midpoint *)self)->is_lost;
}

static int writes(const void *self)
{
  return dvi__is_first(((const midpoint *)self)->field->mesh);
}

/* ---- create ---- */

static void destroy(void *self)
{
  midpoint *m = self;
  if (m == NULL) return;
  dvi__on_all_clear(&m->solver);
  dvi__release(m->q);
  dvi__release(m->x);
  dvi__release(m);
}

static dvi_status make_own(midpoint *m)
{
  const dvi_field *f = m->field;
  DVI_TRY(dvi_mesh_incidence(f->mesh, 0, &m->d));
  m->q = DVI_NEW(double, 4 * f->cells);
  m->x = DVI_NEW(double, 4 * f->unknowns);
  if (!m->q || !m->x) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a state");
  double **const forms[] = {&m->p, &m->q_before, &m->p_before},
                 **const unknowns[] = {&m->middle, &m->force, &m->slope};
  for (int i = 0; i < 3; i++) *forms[i] = m->q + (i + 1) * f->cells;
  for (int i = 0; i < 3; i++) *unknowns[i] = m->x + (i + 1) * f->unknowns;
  return DVI_OK;
}

static dvi_status make(midpoint *m)
{
  const dvi_field *f = m->field;
  const dvi__field_equations equations = {.field = f,
                                          .mass = 1,
                                          .stiffness = m->at.dt * m->at.dt / 4,
                                          .residual = residual,
                                          .diagonal = f->potential.density != NULL ? diagonal
                                                                                   : NULL,
                                          .of = m};
  DVI_TRY(dvi__agree(f->mesh, make_own(m)));
  DVI_TRY(dvi__on_all_create(&equations, &m->solver));
  return dvi__field_hash(f, &m->at.hash);
}

static const dvi__march_kind kind = {
    .name = "midpoint",
    .destroy = destroy,
    .start = start,
    .advance = advance,
    .time = time,
    .size = size,
    .sample = sample,
    .observables = observables,
    .observable = observable,
    .observe = observe,
    .facts = facts,
    .save = save,
    .load = load,
    .agree = agree,
    .writes = writes,
    .is_lost = is_lost,
    .has_parts = 1,
};

static dvi_status check_field(const dvi_field *field)
{
  if (field->mesh->share == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: midpoint is a march of shares (dvi_mesh_cut); a whole "
                     "mesh has it by dvi_field_system");
  if (!field->is_wave)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: midpoint on shares is for waves, and this field is Maxwell's: take "
                     "leapfrog");
  return DVI_OK;
}

/* Every step is stable. Without one, a part of leapfrog's bound is taken. */
static dvi_status choose_step(const dvi_field *field, const dvi__march_plan *plan, double *dt)
{
  double bound;
  *dt = plan->step;
  return plan->step > 0 ? DVI_OK : dvi__choose_step(field, plan, dt, &bound);
}

dvi_status dvi__midpoint_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march)
{
  double dt;
  DVI_TRY(check_field(field));
  DVI_TRY(dvi__refuse_options(kind.name, plan));
  DVI_TRY(choose_step(field, plan, &dt));
  midpoint *m = DVI_NEW(midpoint, 1);
  dvi_status status = dvi__agree(field->mesh,
                                 m != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory"));
  if (status == DVI_OK) {
    m->field = field;
    m->at.dt = dt;
    status = make(m);
  }
  if (status != DVI_OK) {
    destroy(m);
    return status;
  }
  status = dvi__agree(field->mesh, dvi__march_wrap(&kind, m, march));
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}
