/* The laws of a field, measured on a march: energy, charge, reciprocity, gauge invariance, and the
 * multisymplectic form formula.
 *
 * Reciprocity: the step is linear, and its matrices are symmetric, so that f.E(t) after the impulse
 * g equals g.E(t) after the impulse f. Gauge invariance: A and A + d chi have the same E and B.
 *
 * The form formula of leapfrog on a set R of n-cells with the stars M^R of their parts alone,
 * for two motions a and b, and w = a.M_k^R E_b - b.M_k^R E_a on R:
 *
 *     dt sum_n sum_s ( a r_b - b r_a )  =  w^{N-1/2} - w^{1/2},
 *     r = M_k^R (E^{n+1/2} - E^{n-1/2})/dt - d^T M_{k+1}^R B^n,
 *
 * with the sum over the k-cells s on the boundary of R, since r vanishes inside. What the two-form
 * loses in R leaves through its boundary (Marsden, Patrick and Shkoller 1998; Stern 2009, sec.
 * 3.5). */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/algebra/random.h"
#include "field/forms/star.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

/* Two marches, and room for the forms of each. */
typedef struct laws {
  const dvi_field *field;
  dvi_march_options how;
  dvi_march *march[2];
  double unit; /* the longest step */
  double of_B; /* largest B at the start, because losses take it away */
  int steps, is_leapfrog;
  int64_t cells, faces;
  double *E[2], *B[2], *A[2];
  double *f[2]; /* [unknowns] impulses */
  dvi_law *law;
  int count;
} laws;

static void add(laws *s, const char *name, double error, int is_exact)
{
  s->law[s->count++] = (dvi_law){.name = name, .error = error, .is_exact = is_exact};
}

/* ---- starts ---- */

static dvi_status begin(laws *s, int which, const double *E, const double *A)
{
  const dvi_march_state state = {.size = sizeof state, .E = E, .A = A};
  return dvi_march_start(s->march[which], &state);
}

static dvi_status sample(laws *s, int which)
{
  DVI_TRY(dvi_march_sample(s->march[which], DVI_FORM_E, 0, NULL, s->E[which]));
  return dvi_march_sample(s->march[which], DVI_FORM_B, 0, NULL, s->B[which]);
}

static dvi_status run(laws *s, int which)
{
  DVI_TRY(dvi_march_advance(s->march[which], s->steps * s->unit));
  return sample(s, which);
}

static double largest(int64_t count, const double *a)
{
  double most = 0;
  for (int64_t i = 0; i < count; i++) most = fmax(most, fabs(a[i]));
  return most;
}

/* ---- energy and charge ---- */

static dvi_status observe(laws *s, const char *name, double *value)
{
  for (int i = 0; dvi_march_observable(s->march[0], i) != NULL; i++)
    if (strcmp(dvi_march_observable(s->march[0], i), name) == 0)
      return dvi_march_observe(s->march[0], i, value);
  return dvi__fail(DVI_BAD_ARGUMENT, "laws: the march has no \"%s\"", name);
}

/* Asynchronous steps conserve no energy exactly. */
static dvi_status look_at_energy(laws *s)
{
  double first = 0, now = 0, worst = 0;
  DVI_TRY(begin(s, 0, s->E[0], s->A[0]));
  DVI_TRY(sample(s, 0));
  s->of_B = largest(s->faces, s->B[0]);
  DVI_TRY(observe(s, "energy", &first));
  for (int n = 1; n <= s->steps; n++) {
    DVI_TRY(dvi_march_advance(s->march[0], n * s->unit));
    DVI_TRY(observe(s, "energy", &now));
    worst = fmax(worst, fabs(now / first - 1));
  }
  if (s->field->damping.rows == 0 && s->field->currents == 0)
    add(s, "energy", worst, s->is_leapfrog);
  if (s->field->degree == 0) return DVI_OK;
  DVI_TRY(observe(s, "gauss", &now));
  add(s, "gauss", now, 1);
  return DVI_OK;
}

/* d B, beside the largest B. */
static dvi_status look_at_divergence(laws *s)
{
  dvi_matrix d;
  const int k = s->field->degree + 1;
  double worst = 0;
  if (k >= s->field->mesh->n) return DVI_OK;
  DVI_TRY(sample(s, 0));
  DVI_TRY(dvi_mesh_incidence(s->field->mesh, k, &d));
  double *sum = DVI_NEW(double, d.rows);
  if (sum == NULL) return dvi__fail(DVI_NO_MEMORY, "laws: no memory");
  dvi_matrix_multiply(&d, 0, s->B[0], sum);
  const double size = fmax(s->of_B, largest(d.columns, s->B[0]));
  worst = largest(d.rows, sum);
  dvi__release(sum);
  add(s, "divergence", size > 0 ? worst / size : worst, 1);
  return DVI_OK;
}

/* ---- reciprocity ---- */

/* Set E to M^-1 f. */
static dvi_status answer_of(const laws *s, const double *f, double *E)
{
  const dvi_field *field = s->field;
  const dvi_matrix M = dvi__csr_view(&field->mass, 1);
  dvi__definite solver;
  double *x = DVI_NEW(double, field->unknowns);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "laws: no memory");
  dvi_status status = dvi__definite_create(&M, field->mesh->n, &solver);
  if (status == DVI_OK) status = dvi__definite_solve(&solver, f, x, NULL);
  dvi__definite_clear(&solver);
  memset(E, 0, (size_t)s->cells * sizeof *E);
  for (int64_t i = 0; i < field->unknowns && status == DVI_OK; i++) E[field->unknown[i]] = x[i];
  dvi__release(x);
  return status;
}

static double work_of(const laws *s, const double *f, const double *E, double *size)
{
  double sum = 0;
  for (int64_t i = 0; i < s->field->unknowns; i++) {
    const double term = f[i] * E[s->field->unknown[i]];
    sum += term;
    *size += fabs(term);
  }
  return sum;
}

static dvi_status look_at_reciprocity(laws *s)
{
  double size = 0;
  if (!s->is_leapfrog || s->field->currents > 0 || s->field->is_wave) return DVI_OK;
  for (int i = 0; i < 2; i++) {
    DVI_TRY(answer_of(s, s->f[i], s->E[i]));
    (void)work_of(s, s->f[1 - i], s->E[i], &size); /* roundings are those of the start */
    DVI_TRY(begin(s, i, s->E[i], NULL));
    /* in the middle of a step E is what the march has */
    DVI_TRY(dvi_march_advance(s->march[i], (s->steps + 0.5) * s->unit));
    DVI_TRY(sample(s, i));
  }
  const double there = work_of(s, s->f[1], s->E[0], &size),
               back = work_of(s, s->f[0], s->E[1], &size);
  add(s, "reciprocity", size > 0 ? fabs(there - back) / size : 0, 1);
  return DVI_OK;
}

/* ---- gauge ---- */

/* Add the gradient of random values at vertices without an edge that is held. */
static dvi_status add_gradient(const laws *s, double *A)
{
  dvi_matrix d;
  DVI_TRY(dvi_mesh_incidence(s->field->mesh, 0, &d));
  double *chi = DVI_NEW(double, d.columns);
  if (chi == NULL) return dvi__fail(DVI_NO_MEMORY, "laws: no memory");
  (void)dvi__fill_random(d.columns, 77, chi);
  for (int64_t e = 0; e < d.rows; e++)
    for (int64_t i = dvi__first_entry(&d, e);
         i < dvi__first_entry(&d, e + 1) && s->field->number[e] < 0; i++)
      chi[d.column[i]] = 0;
  for (int64_t e = 0; e < d.rows; e++)
    for (int64_t i = dvi__first_entry(&d, e); i < dvi__first_entry(&d, e + 1); i++)
      A[e] += d.sign[i] * chi[d.column[i]];
  dvi__release(chi);
  return DVI_OK;
}

/* What the error of the gauge law is measured with. */
typedef struct gauge {
  dvi_matrix d, M1, M2;
  double *room; /* [cells + 2*faces] */
} gauge;

/* Give x.M x with all its terms above 0, because stars may have negative entries. */
static double square(const dvi_matrix *M, const double *x, double *room)
{
  double sum = 0;
  dvi_matrix_multiply(M, 0, x, room);
  for (int64_t i = 0; i < M->rows; i++) sum += fabs(x[i] * room[i]);
  return sum;
}

/* Twice the energy. */
static double energy_of(const laws *s, const gauge *g, int which)
{
  return square(&g->M1, s->E[which], g->room) + square(&g->M2, s->B[which], g->room);
}

/* Twice the energy of B if nothing in dA cancelled, of whose roundings fields are made. */
static double energy_of_terms(const laws *s, const gauge *g, int which)
{
  double *size = g->room + s->cells + s->faces;
  for (int64_t f = 0; f < s->faces; f++) {
    size[f] = 0;
    for (int64_t i = dvi__first_entry(&g->d, f); i < dvi__first_entry(&g->d, f + 1); i++)
      size[f] += fabs(s->A[which][g->d.column[i]]);
  }
  return square(&g->M2, size, g->room);
}

/* Run from A and E = 0, because a static E would make A and its roundings grow. Fields may be large
 * at the start, because losses take them away, and A at the end, because losses charge nodes. */
static dvi_status run_gauge(laws *s, const gauge *g, int which, double *most)
{
  DVI_TRY(begin(s, which, NULL, s->A[which]));
  DVI_TRY(sample(s, which));
  const double start = energy_of(s, g, which) + energy_of_terms(s, g, which);
  DVI_TRY(run(s, which));
  DVI_TRY(dvi_march_sample(s->march[which], DVI_FORM_A, 0, NULL, s->A[which]));
  *most = fmax(*most, fmax(start, energy_of_terms(s, g, which)));
  return DVI_OK;
}

/* The error is that of the energy norm, in which roundings keep their size on their way. */
static dvi_status measure_gauge(laws *s, const gauge *g)
{
  double most = 0;
  (void)dvi__fill_random(s->cells, 5, s->A[0]);
  memcpy(s->A[1], s->A[0], (size_t)s->cells * sizeof(double));
  DVI_TRY(add_gradient(s, s->A[1]));
  for (int i = 0; i < 2; i++) DVI_TRY(run_gauge(s, g, i, &most));
  for (int64_t c = 0; c < s->cells; c++) s->E[0][c] -= s->E[1][c];
  for (int64_t f = 0; f < s->faces; f++) s->B[0][f] -= s->B[1][f];
  const double error = energy_of(s, g, 0);
  add(s, "gauge", sqrt(most > 0 ? error / most : error), 1);
  return DVI_OK;
}

static dvi_status look_at_gauge(laws *s)
{
  gauge g;
  if (s->field->degree != 1) return DVI_OK;
  DVI_TRY(dvi_mesh_incidence(s->field->mesh, 1, &g.d));
  DVI_TRY(dvi_star_matrix(s->field->star, 1, &g.M1));
  DVI_TRY(dvi_star_matrix(s->field->star, 2, &g.M2));
  g.room = DVI_NEW(double, s->cells + 2 * s->faces);
  if (g.room == NULL) return dvi__fail(DVI_NO_MEMORY, "laws: no memory");
  const dvi_status status = measure_gauge(s, &g);
  dvi__release(g.room);
  return status;
}

/* ---- the multisymplectic form formula ---- */

/* A set of n-cells with its stars, and two motions in the middle of three times. */
typedef struct region {
  laws *laws;
  char *inside, *is_boundary; /* [n-cells], [k-cells] */
  dvi__csr M1, M2;
  dvi_matrix d;
  double *A[2][3]; /* [k-cells] at t_{n-1}, t_n, t_{n+1} */
  double *row[2], *flux, *curl;
  double *room, sum, size;
} region;

static int has_entries(const dvi__csr *matrix, int64_t row)
{
  for (int64_t e = matrix->start[row]; e < matrix->start[row + 1]; e++)
    if (matrix->value[e] != 0) return 1;
  return 0;
}

/* Mark the k-cells to whose rows cells outside contribute. */
static dvi_status mark_boundary(region *r)
{
  const dvi_star *star = r->laws->field->star;
  const int k = r->laws->field->degree;
  dvi__csr M1 = {0}, M2 = {0};
  dvi_status status = dvi__star_of_part(star, k, r->inside, 0, &M1);
  if (status == DVI_OK) status = dvi__star_of_part(star, k + 1, r->inside, 0, &M2);
  for (int64_t s = 0; s < M1.rows && status == DVI_OK; s++)
    r->is_boundary[s] = has_entries(&M1, s) != 0;
  for (int64_t f = 0; f < M2.rows && status == DVI_OK; f++)
    for (int64_t i = dvi__first_entry(&r->d, f); i < dvi__first_entry(&r->d, f + 1); i++)
      if (has_entries(&M2, f)) r->is_boundary[r->d.column[i]] = 1;
  dvi__csr_clear(&M1);
  dvi__csr_clear(&M2);
  return status;
}

static void clear_region(region *r)
{
  dvi__csr_clear(&r->M1);
  dvi__csr_clear(&r->M2);
  dvi__release(r->inside);
  dvi__release(r->is_boundary);
  dvi__release(r->room);
}

static dvi_status make_region(laws *s, region *r)
{
  const dvi_mesh *mesh = s->field->mesh;
  uint64_t state = 3;
  *r = (region){.laws = s};
  r->inside = DVI_NEW(char, mesh->count[mesh->n]);
  r->is_boundary = DVI_NEW(char, s->cells);
  r->room = DVI_NEW(double, 9 * s->cells + 2 * s->faces);
  if (!r->inside || !r->is_boundary || !r->room) {
    (void)dvi__fail(DVI_NO_MEMORY, "laws: no memory");
    return DVI_NO_MEMORY;
  }
  for (int i = 0; i < 2; i++)
    for (int at = 0; at < 3; at++) r->A[i][at] = r->room + (3 * i + at) * s->cells;
  for (int i = 0; i < 2; i++) r->row[i] = r->room + (6 + i) * s->cells;
  r->curl = r->room + 8 * s->cells;
  r->flux = r->curl + s->cells;
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    double choice;
    state = dvi__fill_random(1, state, &choice);
    r->inside[c] = choice > 0;
  }
  DVI_TRY(dvi_mesh_incidence(mesh, s->field->degree, &r->d));
  DVI_TRY(dvi__star_of_part(s->field->star, s->field->degree, r->inside, 1, &r->M1));
  DVI_TRY(dvi__star_of_part(s->field->star, s->field->degree + 1, r->inside, 1, &r->M2));
  return mark_boundary(r);
}

/* Set row to M_k^R (E^{n+1/2} - E^{n-1/2})/dt - d^T M_{k+1}^R d A^n, with E = -A'. */
static void find_row(region *r, int which)
{
  const double dt = r->laws->unit, *const *A = (const double *const *)r->A[which];
  const dvi_matrix M1 = dvi__csr_view(&r->M1, 1), M2 = dvi__csr_view(&r->M2, 1);
  const int64_t cells = r->laws->cells, faces = r->laws->faces;
  double *B = r->flux, *H = r->flux + faces;
  for (int64_t s = 0; s < cells; s++) r->curl[s] = -(A[2][s] - 2 * A[1][s] + A[0][s]) / (dt * dt);
  dvi_matrix_multiply(&M1, 0, r->curl, r->row[which]);
  dvi_matrix_multiply(&r->d, 0, A[1], B);
  dvi_matrix_multiply(&M2, 0, B, H);
  dvi_matrix_multiply(&r->d, 1, H, r->curl);
  for (int64_t s = 0; s < cells; s++) r->row[which][s] -= r->curl[s];
}

/* Add sign times the two-form w^{n+1/2}. */
static void add_two_form(region *r, int at, double sign)
{
  const double dt = r->laws->unit;
  const dvi_matrix M1 = dvi__csr_view(&r->M1, 1);
  for (int i = 0; i < 2; i++) {
    const double *a = r->A[i][at], *b = r->A[1 - i][at], *next = r->A[1 - i][at + 1];
    for (int64_t s = 0; s < r->laws->cells; s++) r->curl[s] = -(next[s] - b[s]) / dt;
    dvi_matrix_multiply(&M1, 0, r->curl, r->row[0]);
    for (int64_t s = 0; s < r->laws->cells; s++) {
      r->sum += (i == 0 ? sign : -sign) * a[s] * r->row[0][s];
      r->size += fabs(a[s] * r->row[0][s]);
    }
  }
}

static void add_boundary(region *r)
{
  const double dt = r->laws->unit;
  find_row(r, 0);
  find_row(r, 1);
  for (int64_t s = 0; s < r->laws->cells; s++) {
    if (!r->is_boundary[s]) continue;
    const double forth = dt * r->A[0][1][s] * r->row[1][s],
                 back = dt * r->A[1][1][s] * r->row[0][s];
    r->sum += forth - back;
    r->size += fabs(forth) + fabs(back);
  }
}

/* Move the three times on by a step. */
static dvi_status advance(region *r, int n)
{
  for (int i = 0; i < 2; i++) {
    double *oldest = r->A[i][0];
    r->A[i][0] = r->A[i][1];
    r->A[i][1] = r->A[i][2];
    r->A[i][2] = oldest;
    DVI_TRY(dvi_march_advance(r->laws->march[i], n * r->laws->unit));
    DVI_TRY(dvi_march_sample(r->laws->march[i], DVI_FORM_A, 0, NULL, oldest));
  }
  return DVI_OK;
}

static dvi_status follow(region *r)
{
  laws *s = r->laws;
  for (int i = 0; i < 2; i++) {
    (void)dvi__fill_random(s->cells, 11 + (uint64_t)i, s->A[i]);
    (void)dvi__fill_random(s->cells, 21 + (uint64_t)i, s->E[i]);
    DVI_TRY(begin(s, i, s->E[i], s->A[i]));
    DVI_TRY(dvi_march_sample(s->march[i], DVI_FORM_A, 0, NULL, r->A[i][2]));
  }
  DVI_TRY(advance(r, 1));
  for (int n = 2; n <= s->steps; n++) {
    DVI_TRY(advance(r, n));
    if (n == 2) add_two_form(r, 0, 1);
    add_boundary(r);
  }
  add_two_form(r, 1, -1);
  return DVI_OK;
}

static dvi_status look_at_two_form(laws *s)
{
  region r;
  if (!s->is_leapfrog || s->field->damping.rows > 0 || s->field->currents > 0 ||
      s->field->is_wave || s->field->star->kind == DVI_SPECTRAL)
    return DVI_OK;
  dvi_status status = make_region(s, &r);
  if (status == DVI_OK) status = follow(&r);
  if (status == DVI_OK) add(s, "multisymplectic", r.size > 0 ? fabs(r.sum) / r.size : 0, 1);
  clear_region(&r);
  return status;
}

/* ---- all ---- */

static void clear(laws *s)
{
  for (int i = 0; i < 2; i++) dvi_march_destroy(&s->march[i]);
  dvi__release(s->E[0]);
}

/* Give one of the marches its room, and fill it at random. */
static void share_room(laws *s, int i, double *room)
{
  s->E[i] = room;
  s->A[i] = s->E[i] + s->cells;
  s->B[i] = s->A[i] + s->cells;
  s->f[i] = s->B[i] + s->faces;
  (void)dvi__fill_random(s->cells, 31 + (uint64_t)i, s->E[i]);
  (void)dvi__fill_random(s->cells, 41 + (uint64_t)i, s->A[i]);
  (void)dvi__fill_random(s->field->unknowns, 51 + (uint64_t)i, s->f[i]);
}

static dvi_status make(laws *s)
{
  dvi_march_facts facts;
  for (int i = 0; i < 2; i++) DVI_TRY(dvi_march_create(s->field, &s->how, &s->march[i]));
  dvi_march_facts_of(s->march[0], &facts);
  s->unit = facts.longest;
  s->is_leapfrog = strcmp(facts.method, "leapfrog") == 0;
  s->cells = dvi_march_size(s->march[0], DVI_FORM_E);
  s->faces = dvi_march_size(s->march[0], DVI_FORM_B);
  const int64_t numbers = 2 * s->cells + s->faces + s->field->unknowns;
  s->E[0] = DVI_NEW(double, 2 * numbers);
  if (s->E[0] == NULL) {
    (void)dvi__fail(DVI_NO_MEMORY, "laws: no memory");
    return DVI_NO_MEMORY;
  }
  share_room(s, 0, s->E[0]);
  share_room(s, 1, s->E[0] + numbers);
  return DVI_OK;
}

dvi_status dvi_field_laws(const dvi_field *field, const dvi_march_options *options, int steps,
                          dvi_law *law, int *count)
{
  const dvi_march_options defaults = {.size = sizeof defaults};
  if (field == NULL || law == NULL || count == NULL || steps < 2)
    return dvi__fail(DVI_BAD_ARGUMENT, "laws: a field, at least 2 steps, and room for the laws are "
                                       "needed");
  DVI_TRY(dvi__refuse_share(field->mesh, "laws: a measurement"));
  laws s = {
      .field = field, .how = options != NULL ? *options : defaults, .steps = steps, .law = law};
  s.how.potential = 1;
  dvi_status status = make(&s);
  if (status == DVI_OK) status = look_at_energy(&s);
  if (status == DVI_OK) status = look_at_divergence(&s);
  if (status == DVI_OK) status = look_at_reciprocity(&s);
  if (status == DVI_OK) status = look_at_gauge(&s);
  if (status == DVI_OK) status = look_at_two_form(&s);
  clear(&s);
  if (status == DVI_OK) *count = s.count;
  return status;
}
