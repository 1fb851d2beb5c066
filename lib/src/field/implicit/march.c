/* Marches of waves on shares of a mesh by implicit steps (field/implicit/step.h). */
#include "field/implicit/march.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/implicit/options.h"
#include "field/mesh/share.h"
#include "field/step/observables.h"
#include "field/step/saved.h"

typedef struct implicit {
  const dvi__march_kind *kind;
  const dvi_field *field;
  const dvi__rule *rule;
  dvi_matrix d;
  dvi__implicit_step *step;
  dvi__march_place at;
  double *numbers;
  dvi__implicit_state now, before; /* at t_n, and at t_{n-1} */
  double *place;                   /* [unknowns] */
  int is_lost;                     /* processes could not give each other their values */
} implicit;

/* ---- a step ---- */

static double time_of(const implicit *m, int64_t n)
{
  return m->at.t0 + (double)n * m->at.dt;
}

static dvi_status explain(const implicit *m, dvi_status status, const dvi__elliptic_report *report)
{
  if (status == DVI_NOT_CONVERGED)
    (void)dvi__fail(status,
                    "%s: Newton's method left a residual of %.2g after %d corrections and %lld "
                    "iterations",
                    report->why, report->residual, report->corrections,
                    (long long)report->iterations);
  return dvi__fail_in(status,
                      "march: %s: step %lld from t = %.9g with h = %.6g failed; the state is "
                      "unchanged, try a smaller step",
                      m->kind->name, (long long)m->at.n + 1, time_of(m, m->at.n), m->at.dt);
}

/* The new state takes the place of the one before the last. */
static dvi_status step(implicit *m)
{
  const dvi__implicit_state next = m->before;
  dvi__elliptic_report report;
  const dvi_status status = dvi__implicit_take(m->step, &m->now, &next, &m->is_lost, &report);
  if (status != DVI_OK) return m->is_lost ? status : explain(m, status, &report);
  m->before = m->now;
  m->now = next;
  m->at.n++;
  return DVI_OK;
}

/* The march stands in the last step: t_{n-1} < t <= t_n. */
static dvi_status advance(void *self, double t)
{
  implicit *m = self;
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
  implicit *m = self;
  const dvi_field *f = m->field;
  if (state->B != NULL)
    return dvi__agree(f->mesh, dvi__fail(DVI_UNSUPPORTED, "march: %s starts from A and E; B is dA",
                                         m->kind->name));
  m->at.t0 = m->at.t = state->t;
  m->at.n = 0;
  m->step->knows_force = 0;
  memcpy(m->now.q, f->fixed, (size_t)f->cells * sizeof *m->now.q);
  memset(m->now.p, 0, (size_t)f->cells * sizeof *m->now.p);
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (state->A != NULL) m->now.q[c] = state->A[c];
    if (state->E != NULL) m->now.p[c] = -f->mass.value[i] * state->E[c];
  }
  dvi_status status = dvi__refresh(f->mesh, 0, m->now.q);
  if (status == DVI_OK) status = dvi__refresh(f->mesh, 0, m->now.p);
  memcpy(m->before.q, m->now.q, (size_t)f->cells * sizeof *m->now.q);
  memcpy(m->before.p, m->now.p, (size_t)f->cells * sizeof *m->now.p);
  m->is_lost = status != DVI_OK;
  return status;
}

/* ---- what can be seen ---- */

static double time(const void *self)
{
  return ((const implicit *)self)->at.t;
}

static int64_t size(const void *self, dvi_march_form form)
{
  const implicit *m = self;
  return form == DVI_FORM_B ? m->d.rows : m->field->cells;
}

/* Return the part of the last step that is left. */
static double left_of(const implicit *m)
{
  const double left = (time_of(m, m->at.n) - m->at.t) / m->at.dt;
  return left > 1e-12 ? left : 0;
}

/* How the velocities at the ends of the last step differ from its mean, times h. */
static void find_bends(const implicit *m, int64_t cell, double *first, double *last)
{
  const int i = m->field->number[cell];
  *first = *last = 0;
  if (i < 0 || m->rule->is_straight) return;
  const double mean = m->now.q[cell] - m->before.q[cell], per = m->at.dt / m->field->mass.value[i];
  *first = per * m->before.p[cell] - mean;
  *last = per * m->now.p[cell] - mean;
}

static double A_at(const implicit *m, int64_t cell)
{
  const double left = left_of(m), gone = 1 - left;
  double first, last;
  if (left == 0) return m->now.q[cell];
  find_bends(m, cell, &first, &last);
  return m->now.q[cell] - left * (m->now.q[cell] - m->before.q[cell]) +
         left * gone * (left * first - gone * last);
}

/* Of a straight line the momenta are straight, too. */
static double momentum_at(const implicit *m, int64_t cell, double mass)
{
  const double left = left_of(m), gone = 1 - left;
  double first, last;
  if (left == 0) return m->now.p[cell];
  if (m->rule->is_straight) return m->now.p[cell] - left * (m->now.p[cell] - m->before.p[cell]);
  find_bends(m, cell, &first, &last);
  return mass / m->at.dt *
         (m->now.q[cell] - m->before.q[cell] + left * (left - 2 * gone) * first +
          gone * (gone - 2 * left) * last);
}

static double E_at(const implicit *m, int64_t cell)
{
  const int i = m->field->number[cell];
  if (i < 0) return 0;
  const double mass = m->field->mass.value[i];
  return -momentum_at(m, cell, mass) / mass;
}

static double B_at(const implicit *m, int64_t edge)
{
  double sum = 0;
  for (int64_t e = dvi__first_entry(&m->d, edge); e < dvi__first_entry(&m->d, edge + 1); e++)
    sum += m->d.sign[e] * A_at(m, m->d.column[e]);
  return sum;
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  const implicit *m = self;
  for (int64_t i = 0; i < count; i++) {
    const int64_t c = cell != NULL ? cell[i] : i;
    values[i] = form == DVI_FORM_A ? A_at(m, c) : form == DVI_FORM_E ? E_at(m, c) : B_at(m, c);
  }
  return DVI_OK;
}

/* Add w V at t_n, of own unknowns. */
static dvi_status add_density(const implicit *m, dvi__block_sum *sum)
{
  const dvi_field *f = m->field;
  if (f->potential.density == NULL) return DVI_OK;
  for (int64_t i = 0; i < f->unknowns; i++) m->place[i] = m->now.q[f->unknown[i]];
  for (int64_t i = 0; i < f->unknowns; i++) {
    double value;
    if (!dvi__owns(f->mesh, 0, f->unknown[i])) continue;
    const int failed = dvi__field_density(f, m->place, i, i + 1, &(dvi__density){.sum = &value});
    if (failed != 0) return dvi__implicit_refuse(failed);
    dvi__block_sum_add(sum, value);
  }
  return DVI_OK;
}

/* p.M^-1 p/2 + q.(K q/2 - load) + the sum of w V at t_n, and the energy of the fixed values. On the
 * line between the ends of a step, stiff modes have less. */
static dvi_status energy(const void *self, double *value)
{
  const implicit *m = self;
  const dvi_field *f = m->field;
  dvi__block_sum sum = {.count = 0};
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (!dvi__owns(f->mesh, 0, c)) continue;
    const double v = m->now.p[c] / f->mass.value[i],
                 half = 0.5 * dvi__field_row(f, &f->stiffness, i, m->now.q);
    dvi__block_sum_add(&sum, 0.5 * m->now.p[c] * v);
    dvi__block_sum_add(&sum, m->now.q[c] * (half - f->load[i]));
  }
  DVI_TRY(dvi__agree(f->mesh, add_density(m, &sum)));
  DVI_TRY(dvi__sum_of_all(f->mesh, dvi__block_sum_end(&sum), value));
  *value += f->rest;
  return DVI_OK;
}

static int observables(const void *self)
{
  return dvi__field_observables(((const implicit *)self)->field);
}

static const char *observable(const void *self, int i)
{
  return dvi__field_observable(((const implicit *)self)->field, i);
}

static dvi_status observe(const void *self, int i, double *value)
{
  const dvi__observed march = {.sample = sample, .energy = energy, .of = self};
  return dvi__field_observe(((const implicit *)self)->field, &march, i, value);
}

static void facts(const void *self, dvi_march_facts *facts)
{
  const implicit *m = self;
  *facts = (dvi_march_facts){.step = m->at.dt,
                             .longest = m->at.dt,
                             .bound = (double)INFINITY,
                             .steps = m->at.n,
                             .updates = m->at.n * dvi__whole_count(m->field->mesh, 1)};
}

/* ---- files ---- */

enum { VERSION = 1, PIECES = 4 };

static dvi__saved_march saved_of(const implicit *m, dvi__piece piece[PIECES])
{
  double *const forms[PIECES] = {m->now.q, m->now.p, m->before.q, m->before.p};
  for (int i = 0; i < PIECES; i++) piece[i] = (dvi__piece){0, m->field->cells, forms[i]};
  return (dvi__saved_march){.method = m->rule->name,
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
  implicit *m = self;
  dvi__piece piece[PIECES];
  const dvi__saved_march march = saved_of(m, piece);
  DVI_TRY(dvi__saved_march_take(&march, sections));
  m->is_lost = m->step->knows_force = 0;
  return DVI_OK;
}

static dvi_status agree(const void *self, dvi_status status)
{
  return dvi__agree(((const implicit *)self)->field->mesh, status);
}

static int is_lost(const void *self)
{
  return ((const implicit *)self)->is_lost;
}

static int writes(const void *self)
{
  return dvi__is_first(((const implicit *)self)->field->mesh);
}

/* ---- create ---- */

static void destroy(void *self)
{
  implicit *m = self;
  if (m == NULL) return;
  dvi__implicit_step_destroy(&m->step);
  dvi__release(m->numbers);
  dvi__release(m);
}

static dvi_status make_own(implicit *m)
{
  const dvi_field *f = m->field;
  double **const forms[] = {&m->now.q, &m->now.p, &m->before.q, &m->before.p, &m->place};
  DVI_TRY(dvi_mesh_incidence(f->mesh, 0, &m->d));
  m->numbers = DVI_NEW(double, 4 * f->cells + f->unknowns);
  if (m->numbers == NULL) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a state");
  for (int i = 0; i < 5; i++) *forms[i] = m->numbers + i * f->cells;
  return DVI_OK;
}

static dvi_status make(implicit *m)
{
  DVI_TRY(dvi__agree(m->field->mesh, make_own(m)));
  DVI_TRY(dvi__implicit_step_create(m->field, m->rule, m->at.dt, &m->step));
  return dvi__field_hash(m->field, &m->at.hash);
}

/* The same functions by the name of each method. */
#define KIND(NAME)                                                                        \
  {                                                                                       \
    .name = (NAME), .destroy = destroy, .start = start, .advance = advance, .time = time, \
    .size = size, .sample = sample, .observables = observables, .observable = observable, \
    .observe = observe, .facts = facts, .save = save, .load = load, .agree = agree,       \
    .writes = writes, .is_lost = is_lost,                                                 \
  }

static const dvi__march_kind midpoint = KIND("midpoint"), imex = KIND("imex"),
                             galerkin = KIND("galerkin");

static dvi_status check_field(const dvi_field *field, const char *method)
{
  if (field->mesh->share == NULL)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: %s is a march of shares (dvi_mesh_cut); a whole mesh has it by "
                     "dvi_field_system",
                     method);
  if (!field->is_wave)
    return dvi__fail(DVI_UNSUPPORTED,
                     "march: %s on shares is for waves, and this field is Maxwell's: take leapfrog",
                     method);
  return DVI_OK;
}

/* Every step is stable. Without one, a part of leapfrog's bound is taken. */
static dvi_status choose_step(const dvi_field *field, const dvi__march_plan *plan, double *dt)
{
  double bound;
  *dt = plan->step;
  return plan->step > 0 ? DVI_OK : dvi__choose_step(field, plan, dt, &bound);
}

static dvi_status create(const implicit *wanted, const dvi__march_plan *plan, dvi_march **march)
{
  const dvi_mesh *mesh = wanted->field->mesh;
  double dt;
  DVI_TRY(check_field(wanted->field, wanted->kind->name));
  DVI_TRY(choose_step(wanted->field, plan, &dt));
  implicit *m = DVI_NEW(implicit, 1);
  dvi_status status = dvi__agree(mesh,
                                 m != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory"));
  if (status == DVI_OK) {
    *m = *wanted;
    m->at.dt = dt;
    status = make(m);
  }
  if (status != DVI_OK) {
    destroy(m);
    return status;
  }
  status = dvi__agree(mesh, dvi__march_wrap(m->kind, m, march));
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}

static dvi_status create_plain(const implicit *wanted, const dvi__march_plan *plan,
                               dvi_march **march)
{
  DVI_TRY(dvi__refuse_options(wanted->kind->name, plan));
  return create(wanted, plan, march);
}

dvi_status dvi__midpoint_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march)
{
  const implicit wanted = {.kind = &midpoint, .rule = &dvi__midpoint_rule, .field = field};
  return create_plain(&wanted, plan, march);
}

dvi_status dvi__imex_create(const dvi_field *field, const dvi__march_plan *plan, dvi_march **march)
{
  const implicit wanted = {.kind = &imex, .rule = &dvi__imex_rule, .field = field};
  return create_plain(&wanted, plan, march);
}

dvi_status dvi__galerkin_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march)
{
  implicit wanted = {.kind = &galerkin, .field = field};
  DVI_TRY(dvi__galerkin_rule(plan->options, &wanted.rule));
  return create(&wanted, plan, march);
}
