/* Leapfrog on a mesh: Yee's scheme on boxes, Bossavit and Kettunen's on other meshes.
 *
 * A is linear in time between the times t_n = t_0 + n dt. With the rectangle rule for E and the
 * values at t_n for B the discrete action of a step is
 *
 *     dt/2 E.M_k E - dt/2 B^n.M_{k+1} B^n - dt J^n.A^n,    E = -(A^{n+1} - A^n)/dt,  B = dA ,
 *
 * whose stationarity conditions solve themselves:
 *
 *     B^{n+1} = B^n - dt d E^{n+1/2},
 *     M_k (E^{n+1/2} - E^{n-1/2}) = dt (d^T M_{k+1} B^n - J^n - S (E^{n+1/2} + E^{n-1/2})/2) .
 *
 * Without S and J, E.M_k E/2 + B^n.M_{k+1} B^{n+1}/2 is conserved. Order 2, multisymplectic.
 * Source: Yee 1966; Bossavit and Kettunen 1999; Stern 2009, secs. 3.3 and 3.4. */
#include "field/step/leapfrog.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/mesh/share.h"
#include "field/step/leapfrog_state.h"
#include "field/step/observables.h"
#include "field/step/saved.h"
#include "field/step/source.h"
#include "field/step/sweep.h"
#include "field/step/terms.h"

/* ---- right sides ---- */

/* Give what currents and a wave's source add at the unknown i. Both push A, and E = -A'. */
static double push(const dvi__leapfrog *l, int64_t i)
{
  double sum = l->source != NULL ? -l->source[i] : 0;
  for (int c = 0; c < l->field->currents; c++) {
    const dvi__current *J = l->field->current + c;
    const int64_t k = dvi__current_entry(J, i);
    if (k < J->count && J->unknown[k] == i) sum -= J->weight[k] * l->J[c];
  }
  return sum;
}

/* Give a row of S E. */
static double damp(const dvi__leapfrog *l, int64_t i)
{
  const dvi_field *f = l->field;
  return f->damping.rows > 0 ? dvi__field_row(f, &f->damping, i, l->E) : 0;
}

/* Give the unknown i of d^T M_{k+1} B - J - S E, with a diagonal star. */
static double force(const dvi__leapfrog *l, int64_t i)
{
  return dvi__sweep_curl(&l->sweep, l->field->unknown[i], l->H) + push(l, i) - damp(l, i);
}

/* Set right [unknowns] to it with another star. */
static void find_right(const dvi__leapfrog *l, double factor)
{
  const dvi_field *f = l->field;
  const dvi__leapfrog_solver *s = &l->solver;
  const double *H = l->sweep.is_diagonal ? l->H : s->H; /* n-forms are diagonal, and above 0 */
  if (!l->sweep.is_diagonal) dvi_matrix_multiply(&s->M2, 0, l->H, s->H);
  dvi_matrix_multiply(&s->d, 1, H, s->curl);
  for (int64_t i = 0; i < f->unknowns; i++) {
    const double source = l->source != NULL ? l->source[i] : 0;
    s->right[i] = factor * (s->curl[f->unknown[i]] - source - damp(l, i));
  }
  dvi__add_currents(f, -factor, l->J, s->right);
}

/* ---- stars that are not diagonal ---- */

/* Set x to A^-1 right, with the matrix A = M + dt/2 S of a step, or A = M. */
static dvi_status solve(const dvi__leapfrog *l, const dvi__products *A)
{
  return dvi__conjugate_gradients(A, 1e-15, l->solver.right, l->solver.x, NULL);
}

/* ---- a step ---- */

static double time_of(const dvi__leapfrog *l, int64_t n)
{
  return l->at.t0 + (double)n * l->at.dt;
}

static void drift(dvi__leapfrog *l)
{
  const double dt = l->at.dt;
  dvi__sweep_H(&l->sweep, dt, l->E, l->H);
  for (int64_t c = 0; c < l->field->cells && l->A != NULL; c++) l->A[c] -= dt * l->E[c];
  for (int c = 0; c < l->field->currents; c++) {
    l->J[c] = l->impulse[c] / dt;
    l->charge.delivered[c] += l->impulse[c];
  }
}

static dvi_status kick(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  dvi__sweep_E(&l->sweep, l->keep, l->gain, l->H, l->E);
  for (int64_t i = 0; i < f->unknowns && l->source != NULL; i++)
    l->E[f->unknown[i]] -= l->gain[f->unknown[i]] * l->source[i];
  for (int c = 0; c < f->currents; c++) {
    const dvi__current *J = f->current + c;
    for (int64_t k = 0; k < J->count; k++) {
      const int cell = f->unknown[J->unknown[k]];
      l->E[cell] -= l->gain[cell] * (J->weight[k] * l->J[c]);
    }
  }
  return dvi__refresh(f->mesh, f->degree, l->E);
}

static dvi_status kick_by_solution(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  find_right(l, l->at.dt);
  DVI_TRY(solve(l, &l->solver.of_step));
  for (int64_t i = 0; i < f->unknowns; i++) l->E[f->unknown[i]] += l->solver.x[i];
  return DVI_OK;
}

/* Integrate the signals over the step, before anything changes. */
static dvi_status find_impulses(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  if (f->currents == 0) return DVI_OK;
  const double t = time_of(l, l->at.n + 1);
  return dvi__agree(f->mesh, dvi__find_impulses(f, t, l->at.dt / 2, l->impulse));
}

/* What has overflowed once stays: no later sum is finite. E feels all of it but A, so that it is
 * enough to look at both where the state can be seen. Called on all processes. */
static dvi_status check_overflow(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  dvi_status status = dvi__check_finite(f, "E", l->E, l->at.t);
  if (status == DVI_OK && l->A != NULL) status = dvi__check_finite(f, "A", l->A, l->at.t);
  status = dvi__agree(f->mesh, status);
  l->is_lost = status != DVI_OK;
  return status;
}

/* A solution that fails leaves the state as it was. Values that do not arrive leave none. */
static dvi_status step(dvi__leapfrog *l)
{
  dvi_status status = DVI_OK;
  DVI_TRY(find_impulses(l));
  if (l->gain == NULL) memcpy(l->solver.kept, l->state, (size_t)l->numbers * sizeof *l->state);
  drift(l);
  if (l->gain != NULL)
    status = kick(l);
  else
    status = kick_by_solution(l);
  l->at.n += status == DVI_OK;
  l->is_lost = status != DVI_OK && l->gain != NULL;
  if (status != DVI_OK && l->gain == NULL)
    memcpy(l->state, l->solver.kept, (size_t)l->numbers * sizeof *l->state);
  return status;
}

static dvi_status advance(void *self, double t)
{
  dvi__leapfrog *l = self;
  const double rounding = 8 * DBL_EPSILON * fmax(fabs(t), fabs(l->at.t0));
  while (time_of(l, l->at.n + 1) <= t + rounding) {
    const dvi_status status = step(l);
    if (status == DVI_OK) continue;
    l->at.t = fmax(l->at.t, time_of(l, l->at.n));
    return status;
  }
  l->at.t = t;
  return check_overflow(l);
}

/* ---- a start ---- */

/* Take what is given, of each cell by its owner, and B = dA otherwise. */
static dvi_status take(dvi__leapfrog *l, const dvi_march_state *state)
{
  const dvi_field *f = l->field;
  double *A = l->A != NULL ? l->A : l->spare, *B = l->spare + f->cells;
  memset(l->state, 0, (size_t)l->numbers * sizeof *l->state);
  memcpy(A, f->fixed, (size_t)f->cells * sizeof *A);
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (state->A != NULL) A[c] = state->A[c];
    if (state->E != NULL) l->E[c] = state->E[c];
  }
  for (int c = 0; c < f->currents; c++) l->J[c] = l->impulse[c];
  DVI_TRY(dvi__refresh(f->mesh, f->degree, A));
  for (int64_t b = 0; b < l->sweep.faces; b++)
    B[b] = state->B != NULL ? state->B[b] : dvi__sweep_d(&l->sweep, b, A);
  DVI_TRY(dvi__refresh(f->mesh, f->degree + 1, B));
  for (int64_t b = 0; b < l->sweep.faces; b++) l->H[b] = l->sweep.weight[b] * B[b];
  return DVI_OK;
}

/* Set E^{1/2} = E^0 + dt/2 M^-1 (d^T M_{k+1} B^0 - J^0 - S E^{1/2}). */
static dvi_status half_kick(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  const double half = l->at.dt / 2;
  if (l->gain == NULL) {
    find_right(l, half);
    DVI_TRY(solve(l, &l->solver.of_step));
  }
  for (int64_t i = 0; i < f->unknowns; i++) {
    double *E = l->E + f->unknown[i];
    if (l->gain == NULL) {
      *E += l->solver.x[i];
      continue;
    }
    if (l->keep != NULL) *E *= f->mass.value[i] * l->inverse[i];
    *E += half * (dvi__sweep_curl(&l->sweep, f->unknown[i], l->H) + push(l, i)) * l->inverse[i];
  }
  return dvi__refresh(f->mesh, f->degree, l->E);
}

/* Whether damping moves charge. */
static int moves_charge(const dvi_field *field)
{
  return field->degree > 0 && field->is_damped;
}

/* Give the integral of E up to t_{n+1/2}, or NULL without damping: S times its change is the charge
 * that moved, as the trapezoids (E^{n-1/2} + E^{n+1/2}) dt/2 of the steps add up to it. */
static const double *integral_of_E(const dvi__leapfrog *l)
{
  if (!moves_charge(l->field)) return NULL;
  for (int64_t c = 0; c < l->field->cells; c++) l->spare[c] = l->at.dt / 2 * l->E[c] - l->A[c];
  return l->spare;
}

static dvi_status start(void *self, const dvi_march_state *state)
{
  dvi__leapfrog *l = self;
  const dvi__march_place before = l->at;
  l->at.t0 = l->at.t = state->t;
  l->at.n = 0;
  dvi_status status = dvi__agree(
      l->field->mesh, dvi__find_first_currents(l->field, state->t, l->at.dt / 2, l->impulse));
  if (status == DVI_OK) {
    if (l->gain == NULL) memcpy(l->solver.kept, l->state, (size_t)l->numbers * sizeof(double));
    status = take(l, state);
    if (status == DVI_OK) status = half_kick(l);
    if (status == DVI_OK) status = check_overflow(l);
    l->is_lost = status != DVI_OK && l->gain != NULL;
    if (status != DVI_OK && l->gain == NULL)
      memcpy(l->state, l->solver.kept, (size_t)l->numbers * sizeof(double));
  }
  if (status != DVI_OK) l->at = before;
  if (status == DVI_OK) dvi__charge_start(&l->charge, l->E, integral_of_E(l));
  l->changed = -1;
  return status;
}

/* ---- what can be seen ---- */

static double time(const void *self)
{
  return ((const dvi__leapfrog *)self)->at.t;
}

static int64_t size(const void *self, dvi_march_form form)
{
  const dvi__leapfrog *l = self;
  if (form == DVI_FORM_A && l->A == NULL) return 0;
  return form == DVI_FORM_B ? l->sweep.faces : l->sweep.cells;
}

/* Find E' at t_n of a star that is not diagonal, M E' = d^T M_{k+1} B^n - J^n - S E^{n+1/2}. */
static dvi_status find_change(dvi__leapfrog *l)
{
  if (l->gain != NULL || l->changed == l->at.n) return DVI_OK;
  find_right(l, 1);
  DVI_TRY(solve(l, &l->solver.of_mass));
  for (int64_t i = 0; i < l->field->unknowns; i++) l->change[l->field->unknown[i]] = l->solver.x[i];
  l->changed = l->at.n;
  return DVI_OK;
}

/* Give E at a time after t_n: E^{n+1/2} and its rate at t_n. At t_0 this is the start, and without
 * losses it is at t_n the mean of E^{n-1/2} and E^{n+1/2}. */
static double E_after(const dvi__leapfrog *l, double after, int64_t cell)
{
  const int i = l->field->number[cell];
  if (i < 0) return 0;
  const double rate = l->gain != NULL ? force(l, i) / l->field->mass.value[i] : l->change[cell];
  return l->E[cell] + (after - l->at.dt / 2) * rate;
}

static double B_after(const dvi__leapfrog *l, double after, int64_t face)
{
  return l->H[face] / l->sweep.weight[face] - after * dvi__sweep_d(&l->sweep, face, l->E);
}

static dvi_status sample(const void *self, dvi_march_form form, int64_t count, const int *cell,
                         double *values)
{
  const dvi__leapfrog *l = self;
  const double after = l->at.t - time_of(l, l->at.n);
  if (form == DVI_FORM_E) DVI_TRY(find_change((dvi__leapfrog *)self));
  for (int64_t i = 0; i < count; i++) {
    const int64_t c = cell != NULL ? cell[i] : i;
    values[i] = form == DVI_FORM_A   ? l->A[c] - after * l->E[c]
                : form == DVI_FORM_E ? E_after(l, after, c)
                                     : B_after(l, after, c);
  }
  return DVI_OK;
}

/* Of a share, E where not all cells around are here is known by the owner alone. */
static dvi_status show(const void *self, dvi_march_form form, int64_t count, const int *cell,
                       double *values)
{
  const dvi__leapfrog *l = self;
  if (form == DVI_FORM_E && cell != NULL)
    DVI_TRY(dvi__check_owned(l->field->mesh, l->field->degree, count, cell));
  DVI_TRY(sample(self, form, count, cell, values));
  if (form != DVI_FORM_E || cell != NULL) return DVI_OK;
  return dvi__refresh(l->field->mesh, l->field->degree, values);
}

/* E.M_k E/2 + B^n.M_{k+1} B^{n+1}/2 - source.(A^n + A^{n+1})/2 */
static dvi_status energy(const void *self, double *value)
{
  const dvi__leapfrog *l = self;
  const dvi_field *f = l->field;
  double *next = l->spare, *product = l->spare + l->sweep.faces;
  dvi__block_sum sum = {.count = 0};
  dvi_matrix M;
  DVI_TRY(dvi_star_matrix(f->star, f->degree + 1, &M));
  for (int64_t b = 0; b < l->sweep.faces; b++) next[b] = B_after(l, l->at.dt, b);
  dvi_matrix_multiply(&M, 0, next, product);
  for (int64_t b = 0; b < l->sweep.faces; b++)
    if (dvi__owns(f->mesh, f->degree + 1, b))
      dvi__block_sum_add(&sum, 0.5 * B_after(l, 0, b) * product[b]);
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->unknown[i];
    if (!dvi__owns(f->mesh, f->degree, c)) continue;
    dvi__block_sum_add(&sum, 0.5 * dvi__field_row(f, &f->mass, i, l->E) * l->E[c]);
    if (l->source != NULL)
      dvi__block_sum_add(&sum, -l->source[i] * (l->A[c] - l->at.dt / 2 * l->E[c]));
  }
  return dvi__sum_of_all(f->mesh, dvi__block_sum_end(&sum), value);
}

static dvi_status charge_error(const void *self, double *error)
{
  const dvi__leapfrog *l = self;
  return dvi__charge_error(&l->charge, l->E, integral_of_E(l), error);
}

static int observables(const void *self)
{
  return dvi__field_observables(((const dvi__leapfrog *)self)->field);
}

static const char *observable(const void *self, int i)
{
  return dvi__field_observable(((const dvi__leapfrog *)self)->field, i);
}

static dvi_status observe(const void *self, int i, double *value)
{
  const dvi__observed march = {
      .sample = sample, .energy = energy, .charge_error = charge_error, .of = self};
  return dvi__field_observe(((const dvi__leapfrog *)self)->field, &march, i, value);
}

static void facts(const void *self, dvi_march_facts *facts)
{
  const dvi__leapfrog *l = self;
  *facts = (dvi_march_facts){.step = l->at.dt,
                             .longest = l->at.dt,
                             .bound = l->bound,
                             .steps = l->at.n,
                             .updates = l->at.n *
                                        dvi__whole_count(l->field->mesh, l->field->degree + 1)};
}

/* ---- several processes ---- */

static dvi_status agree(const void *self, dvi_status status)
{
  return dvi__agree(((const dvi__leapfrog *)self)->field->mesh, status);
}

static int is_lost(const void *self)
{
  return ((const dvi__leapfrog *)self)->is_lost;
}

static int writes(const void *self)
{
  return dvi__is_first(((const dvi__leapfrog *)self)->field->mesh);
}

/* ---- create ---- */

static void destroy(void *self)
{
  dvi__leapfrog *l = self;
  if (l == NULL) return;
  double *const arrays[] = {l->state,  l->impulse, l->keep,        l->gain,  l->inverse,
                            l->source, l->spare,   l->solver.room, l->change};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  dvi__charge_clear(&l->charge);
  dvi__csr_clear(&l->solver.left);
  dvi__sweep_clear(&l->sweep);
  dvi__release(l);
}

/* Lay the state out in one block. */
static dvi_status make_state(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  const int64_t cells = f->cells, faces = l->sweep.faces, A = l->keeps_A ? cells : 0;
  l->numbers = cells + faces + A + f->currents + dvi__charge_numbers(f);
  l->state = DVI_NEW(double, l->numbers);
  l->impulse = DVI_NEW(double, f->currents);
  l->spare = DVI_NEW(double, 2 * faces + cells);
  if (!l->state || !l->impulse || !l->spare)
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for a state of %lld numbers",
                     (long long)l->numbers);
  l->E = l->state;
  l->H = l->E + cells;
  l->A = l->keeps_A ? l->H + faces : NULL;
  l->J = l->H + faces + A;
  return dvi__charge_create(f, l->J + f->currents, &l->charge);
}

static dvi_status make_coefficients(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  l->gain = DVI_NEW(double, f->cells);
  l->inverse = DVI_NEW(double, f->unknowns);
  if (f->damping.rows > 0) l->keep = DVI_NEW(double, f->cells);
  if (!l->gain || !l->inverse || (f->damping.rows > 0 && !l->keep))
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for coefficients");
  dvi__fill_coefficients(f, l->at.dt, l->keep, l->gain, l->inverse);
  return DVI_OK;
}

/* Make the matrices of a step and the room of its solutions. */
static dvi_status make_solver(dvi__leapfrog *l)
{
  const dvi_field *f = l->field;
  dvi__leapfrog_solver *s = &l->solver;
  const int64_t n = f->unknowns, faces = l->sweep.faces;
  DVI_TRY(dvi_mesh_incidence(f->mesh, f->degree, &s->d));
  DVI_TRY(dvi_star_matrix(f->star, f->degree + 1, &s->M2));
  s->room = DVI_NEW(double, faces + f->cells + 7 * n + l->numbers);
  l->change = DVI_NEW(double, f->cells);
  if (!s->room || !l->change) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a solver");
  s->H = s->room;
  s->curl = s->H + faces;
  s->right = s->curl + f->cells;
  s->x = s->right + n;
  s->kept = s->x + n;
  DVI_TRY(dvi__make_left(f, l->at.dt, &s->left));
  s->matrix = dvi__csr_view(&s->left, 1);
  s->mass = dvi__csr_view(&f->mass, 1);
  s->of_step = dvi__products_of(&s->matrix);
  s->of_mass = dvi__products_of(&s->mass);
  s->of_step.work = s->of_mass.work = s->kept + l->numbers;
  return DVI_OK;
}

/* Make what a process has by itself. */
static dvi_status make_own(dvi__leapfrog *l, int threads)
{
  const dvi_field *f = l->field;
  DVI_TRY(dvi__sweep_create(f, threads, &l->sweep));
  DVI_TRY(make_state(l));
  if (f->mass_is_diagonal && l->sweep.is_diagonal) return make_coefficients(l);
  DVI_TRY(dvi__refuse_share_but(f->mesh, "march: leapfrog with a star that is not diagonal",
                                f->is_wave ? "midpoint, the circumcentric star"
                                           : "the circumcentric star"));
  return make_solver(l);
}

static dvi_status make(dvi__leapfrog *l, int threads)
{
  const dvi_field *f = l->field;
  DVI_TRY(dvi__agree(f->mesh, make_own(l, threads)));
  DVI_TRY(dvi__refresh(f->mesh, f->degree + 1, l->sweep.weight));
  DVI_TRY(dvi__wave_source(f, &l->source));
  return dvi__field_hash(f, &l->at.hash);
}

static const dvi__march_kind kind = {
    .name = "leapfrog",
    .destroy = destroy,
    .start = start,
    .advance = advance,
    .time = time,
    .size = size,
    .sample = show,
    .observables = observables,
    .observable = observable,
    .observe = observe,
    .facts = facts,
    .save = dvi__leapfrog_save,
    .load = dvi__leapfrog_load,
    .agree = agree,
    .writes = writes,
    .is_lost = is_lost,
    .has_parts = 1,
};

dvi_status dvi__leapfrog_create(const dvi_field *field, const dvi__march_plan *plan,
                                dvi_march **march)
{
  double dt, bound;
  DVI_TRY(dvi__refuse_options(kind.name, plan));
  DVI_TRY(dvi__choose_step(field, plan, &dt, &bound));
  dvi__leapfrog *l = DVI_NEW(dvi__leapfrog, 1);
  dvi_status status = dvi__agree(field->mesh,
                                 l != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory"));
  if (status == DVI_OK) {
    l->field = field;
    l->at.dt = dt;
    l->bound = bound;
    l->keeps_A = field->is_wave || plan->potential || moves_charge(field);
    l->changed = -1;
    status = make(l, plan->threads);
  }
  if (status != DVI_OK) {
    destroy(l);
    return status;
  }
  status = dvi__agree(field->mesh, dvi__march_wrap(&kind, l, march));
  if (status != DVI_OK) dvi_march_destroy(march);
  return status;
}
