/* The time-stepping of Moreau and Jean, for many contacts with friction.
 *
 * Velocities may jump, and the laws of contacts hold for velocities at the end of a step:
 *
 *     q_m = q0 + theta h v0,        t_m = t0 + theta h,
 *     M (v1 - v0) = h f(t_m, q_m, v0) + H^T P,        H = (G; T)(t_m, q_m),
 *     0 <= u_N1 + e u_N0  _|_  P_N >= 0,   |P_T| <= mu P_N against u_T1   where phi(t_m, q_m) <= 0,
 *     q1 = q0 + h (theta v1 + (1 - theta) v0),
 *
 * with u_N = G v + phi_t and u_T = T v. Without contacts and with theta = 1/2 this is the leapfrog
 * drift, kick, drift, of order 2. Through hits the order is 1, and bodies penetrate each other by
 * O(h). The impulses are those of contact_law.h. Sources: Moreau 1999, sec. 4; Jean 1999. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/method.h"
#include "num/compensated.h"
#include "step/split/contact_law.h"
#include "system/term/contact.h"

enum { THETA };

static const dvi__key keys[] = {
    {"theta", NULL, DVI__POSITIVE, 0, 0,
     "where in a step forces and gaps are evaluated, 0.5 to 1; default: 0.5"},
    {0},
};

typedef struct moreau_jean {
  dvi__evaluator *evaluator;
  dvi__contact_law law;
  double theta;
  double t;                       /* t_m */
  double *q, *v0, *v1, *f, *kick; /* [n] q_m, velocities, forces, and momenta */
  double *G, *T;    /* [n], [2 n] entries of one contact; then changes of p and of q */
  double *H, *dual; /* [rows * n] rows of H, and of H M^-1 */
  double *supply;   /* [1 + symmetries] */
  double *numbers;
} moreau_jean;

/* The memory holds the impulses of all contacts, three numbers each, as guesses. */
enum { IMPULSES = 3 };

/* ---- create, destroy ---- */

static int most_tangents(const dvi_system *s)
{
  int most = 0;
  for (int k = 0; k < s->contact_count; k++)
    if (s->contacts[k].callbacks.friction > 0 && s->contacts[k].callbacks.tangent_count > most)
      most = s->contacts[k].callbacks.tangent_count;
  return most;
}

/* The most contacts that are closed together. Equal balls in space touch 12 others, which makes two
 * contacts for each of their coordinates. */
static int most_closed(const dvi_system *s)
{
  return s->contact_count < 2 * s->n + 8 ? s->contact_count : 2 * s->n + 8;
}

static dvi_status reserve(dvi__stepper *self, moreau_jean *own)
{
  const dvi_system *s = self->system;
  const size_t n = (size_t)s->n;
  DVI_TRY(dvi__contact_law_create(most_closed(s), most_tangents(s), self->counters, &own->law));
  const size_t rows = (size_t)own->law.rows_most;
  double *at = own->numbers = DVI_NEW(double, (8 + 2 * rows) * n + 1 + (size_t)s->symmetry_count);
  if (at == NULL) return dvi__fail(DVI_NO_MEMORY, "moreau-jean: no memory");
  double **const vectors[] = {&own->q, &own->v0, &own->v1, &own->f, &own->kick, &own->G, &own->T};
  for (int i = 0; i < 7; i++, at += n) *vectors[i] = at;
  own->H = own->T + 2 * n;
  own->dual = own->H + rows * n;
  own->supply = own->dual + rows * n;
  return DVI_OK;
}

static dvi_status moreau_jean_create(dvi__stepper *self)
{
  moreau_jean *own = self->own = DVI_NEW(moreau_jean, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "moreau-jean: no memory");
  if (self->settings.number[THETA] == 0) self->settings.number[THETA] = 0.5;
  own->theta = self->settings.number[THETA];
  if (!(own->theta >= 0.5 && own->theta <= 1))
    return dvi__fail(DVI_BAD_OPTION, "moreau-jean: theta = %g; 0.5 to 1 is possible", own->theta);
  self->order = 1;
  self->memory_count = IMPULSES * (size_t)self->system->contact_count;
  DVI_TRY(reserve(self, own));
  DVI_TRY(dvi__evaluator_create(self->system, 1, DVI__GRADIENTS, self->counters, &own->evaluator));
  return dvi__evaluator_prepare_symmetries(own->evaluator);
}

static void moreau_jean_destroy(dvi__stepper *self)
{
  moreau_jean *own = self->own;
  if (own == NULL) return;
  dvi__evaluator_destroy(&own->evaluator);
  dvi__contact_law_clear(&own->law);
  dvi__release(own->numbers);
  dvi__release(own);
}

/* ---- closed contacts ---- */

/* Spread the entries of column a of a pattern to a row of H, and fill in its row of H M^-1. */
static void spread_row(const dvi__stepper *self, const dvi__pattern *pattern, int a,
                       const double *entries, int row)
{
  const moreau_jean *own = self->own;
  const size_t n = (size_t)self->system->n;
  double *H = own->H + (size_t)row * n;
  memset(H, 0, n * sizeof(double));
  for (int e = pattern->start[a]; e < pattern->start[a + 1]; e++) H[pattern->row[e]] = entries[e];
  dvi__mass_solve(own->evaluator, 1, H, own->dual + (size_t)row * n);
}

static double product(size_t n, const double *a, const double *b)
{
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* Add contact k with its rows of H, of b, and its guess. v1 holds the velocity without impulses. */
static dvi_status close_contact(dvi__stepper *self, int k, double wall, double before)
{
  moreau_jean *own = self->own;
  dvi__contact_law *law = &own->law;
  const dvi__contact_term *term = &self->system->contacts[k];
  const size_t n = (size_t)self->system->n;
  const int tangents = term->callbacks.friction > 0 ? term->callbacks.tangent_count : 0;
  if (law->count == law->most)
    return dvi__fail(DVI_UNSUPPORTED,
                     "more than %d contacts are closed at t = %.9g, so that bodies lie within each "
                     "other",
                     law->most, own->t);
  const dvi__closed closed = {
      .index = k, .row = law->rows, .tangents = tangents, .mu = term->callbacks.friction};
  spread_row(self, &term->gap.gradients, 0, own->G, closed.row);
  if (tangents > 0) DVI_TRY(dvi__contact_tangent(term, own->t, own->q, own->T));
  for (int a = 0; a < tangents; a++)
    spread_row(self, &term->tangents, a, own->T, closed.row + 1 + a);
  for (int a = 0; a <= tangents; a++) {
    const int i = closed.row + a;
    law->b[i] = product(n, own->H + (size_t)i * n, own->v1);
    law->P[i] = self->memory[IMPULSES * k + a];
  }
  law->b[closed.row] += wall + term->callbacks.restitution * before;
  law->closed[law->count++] = closed;
  law->rows += 1 + tangents;
  return DVI_OK;
}

/* Find the contacts whose gap is closed at q_m. */
static dvi_status find_closed(dvi__stepper *self, double h)
{
  moreau_jean *own = self->own;
  own->law.count = own->law.rows = 0;
  for (int k = 0; k < self->system->contact_count; k++) {
    const dvi__contact_term *term = &self->system->contacts[k];
    dvi__touch touch;
    double wall;
    DVI_TRY(dvi__contact_touch(term, own->t, own->q, own->v0, own->G, &touch));
    if (touch.gap > 64 * DBL_EPSILON * (touch.size + touch.speed * fabs(h))) continue;
    DVI_TRY(dvi__holonomic_rate(&term->gap, own->t, own->q, &wall));
    DVI_TRY(close_contact(self, k, wall, touch.rate));
  }
  return DVI_OK;
}

static void fill_matrix(const dvi__stepper *self)
{
  const moreau_jean *own = self->own;
  const size_t n = (size_t)self->system->n;
  const int rows = own->law.rows;
  for (int i = 0; i < rows; i++)
    for (int j = 0; j <= i; j++)
      own->law.W[(size_t)i * (size_t)rows + (size_t)j] =
          own->law.W[(size_t)j * (size_t)rows + (size_t)i] = product(n, own->H + (size_t)i * n,
                                                                     own->dual + (size_t)j * n);
}

/* Add the impulses to the kick, and keep them as guesses. */
static void add_impulses(dvi__stepper *self)
{
  const moreau_jean *own = self->own;
  const dvi__contact_law *law = &own->law;
  const size_t n = (size_t)self->system->n;
  memset(self->memory, 0, self->memory_count * sizeof(double));
  for (int k = 0; k < law->count; k++) {
    const dvi__closed *c = &law->closed[k];
    for (int a = 0; a <= c->tangents; a++) {
      const double P = law->P[c->row + a], *H = own->H + (size_t)(c->row + a) * n;
      self->memory[IMPULSES * c->index + a] = P;
      for (size_t i = 0; i < n; i++) own->kick[i] += P * H[i];
    }
  }
}

/* ---- a step ---- */

/* Evaluate h f at (t_m, q_m, v0), and what is without a potential alone. */
static dvi_status find_kick(dvi__stepper *self, double h)
{
  const moreau_jean *own = self->own;
  const int n = self->system->n;
  DVI_TRY(dvi__potentials_gradient(own->evaluator, 1, &own->t, own->q, own->kick));
  for (int i = 0; i < n; i++) own->kick[i] *= -h;
  if (!(self->system->terms & DVI__FRICTION)) return DVI_OK;
  DVI_TRY(dvi__forces(own->evaluator, DVI__FRICTION, 1, &own->t, own->q, own->v0, own->f));
  for (int i = 0; i < n; i++) own->kick[i] += h * own->f[i];
  return DVI_OK;
}

/* Add what impulses and forces supply, with the mean velocity. `before` is the kick without
 * impulses. */
static dvi_status supply_step(dvi__stepper *self, dvi__state *state, const double *before, double h)
{
  const moreau_jean *own = self->own;
  const int n = self->system->n;
  if (state->supplied == NULL) return DVI_OK;
  DVI_TRY(dvi__forces(own->evaluator, DVI__FORCES, 1, &own->t, own->q, own->v0, own->f));
  for (int i = 0; i < n; i++) {
    own->f[i] += (own->kick[i] - before[i]) / h;
    own->v0[i] = 0.5 * (own->v0[i] + own->v1[i]);
  }
  DVI_TRY(dvi__supply(own->evaluator, 1, &h, own->f, own->q, own->v0, own->supply));
  dvi__add_compensated_all(1 + self->system->symmetry_count, state->supplied,
                           state->supplied_compensation, own->supply);
  return DVI_OK;
}

static dvi_status find_impulses(dvi__stepper *self, double h)
{
  const moreau_jean *own = self->own;
  const int n = self->system->n;
  dvi__mass_solve(own->evaluator, 1, own->kick, own->v1);
  for (int i = 0; i < n; i++) own->v1[i] += own->v0[i];
  DVI_TRY(find_closed(self, h));
  fill_matrix(self);
  if (own->law.count > 0) DVI_TRY(dvi__contact_law_solve(&((moreau_jean *)self->own)->law));
  return DVI_OK;
}

static dvi_status moreau_jean_step(dvi__stepper *self, dvi__state *state, double h)
{
  moreau_jean *own = self->own;
  const int n = self->system->n;
  const size_t bytes = (size_t)n * sizeof(double);
  if (h < 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "h = %g, but hits and friction cannot be undone by steps back in time", h);
  dvi__mass_solve(own->evaluator, 1, state->p, own->v0);
  own->t = state->t + own->theta * h;
  for (int i = 0; i < n; i++) own->q[i] = state->q[i] + own->theta * h * own->v0[i];
  DVI_TRY(find_kick(self, h));
  DVI_TRY(find_impulses(self, h));
  memcpy(own->G, own->kick, bytes);
  add_impulses(self);
  dvi__add_compensated_all(n, state->p, state->p_compensation, own->kick);
  dvi__mass_solve(own->evaluator, 1, state->p, own->v1);
  for (int i = 0; i < n; i++)
    own->T[i] = h * (own->theta * own->v1[i] + (1 - own->theta) * own->v0[i]);
  dvi__add_compensated_all(n, state->q, state->q_compensation, own->T);
  dvi__add_compensated(&state->t, &state->t_compensation, h);
  return supply_step(self, state, own->G, h);
}

static void moreau_jean_explain(const dvi__stepper *self, dvi__text *text)
{
  const moreau_jean *own = self->own;
  dvi__text_add(
      text,
      "kernel: explicit but for the impulses of closed contacts; one gradient a step\n"
      "solver: projected Gauss-Seidel sweeps, then a semismooth Newton's method, for up to "
      "%d of %d contacts at a time\n",
      own->law.most, self->system->contact_count);
  if (own->law.worst > 0)
    dvi__text_add(text,
                  "largest residual of the contacts' laws so far: %.2g of the largest impulse\n",
                  own->law.worst);
}

const dvi__method dvi__moreau_jean = {
    .name = "moreau-jean",
    .summary = "contacts with friction at the level of velocities; order 1; constant mass",
    .cite = "Moreau1999",
    .keys = keys,
    .needs = DVI__CONSTANT_MASS | DVI__CONTACT,
    .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL | DVI__FORCES | DVI__CONTACT | DVI__RUBBING,
    .takes_contacts = 1,
    .create = moreau_jean_create,
    .destroy = moreau_jean_destroy,
    .step = moreau_jean_step,
    .explain = moreau_jean_explain,
};
