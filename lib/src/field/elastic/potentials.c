#include "field/elastic/potentials.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { NUMBERS = DVI__SOLID_NUMBERS };

/* ---- shares of what a cell stores ---- */

/* Functions of a share return as dvi__solid_force. That of forces is for several cells. */
static int share_forces(const dvi_elastic *e, dvi__solid_share share, int64_t first, int count,
                        const double *u, double *f, int *failed)
{
  const int numbers = (e->n + 1) * e->n;
  if (share != DVI__SOLID_STIFFNESS) {
    const int returned = dvi__solid_forces(e, first, count, u, f, failed);
    if (share == DVI__SOLID_STORED || returned != 0) return returned;
  }
  for (int c = 0; c < count; c++) {
    double rest[NUMBERS] = {0}, *own = f + c * numbers;
    dvi__solid_rest_force(e, first + c, u + c * numbers, rest);
    for (int k = 0; k < numbers; k++)
      own[k] = share == DVI__SOLID_STIFFNESS ? rest[k] : own[k] - rest[k];
  }
  return 0;
}

static int share_energy(const dvi_elastic *e, dvi__solid_share share, int64_t cell, const double *u,
                        double *energy)
{
  double f[NUMBERS] = {0};
  *energy = 0;
  if (share != DVI__SOLID_STIFFNESS) {
    const int returned = dvi__solid_stored(e, cell, u, energy);
    if (returned != 0 || share == DVI__SOLID_STORED) return returned;
  }
  double quadratic = 0;
  dvi__solid_rest_force(e, cell, u, f);
  for (int k = 0; k < (e->n + 1) * e->n; k++) quadratic -= f[k] * u[k] / 2;
  *energy = share == DVI__SOLID_STIFFNESS ? quadratic : *energy - quadratic;
  return 0;
}

static int share_stiffness(const dvi_elastic *e, dvi__solid_share share, int64_t cell,
                           const double *u, double *K)
{
  double rest[NUMBERS * NUMBERS];
  const int numbers = (e->n + 1) * e->n;
  const int returned = dvi__solid_stiffness(e, cell, share == DVI__SOLID_STIFFNESS ? NULL : u, K);
  if (share != DVI__SOLID_REST || returned != 0) return returned;
  (void)dvi__solid_stiffness(e, cell, NULL, rest);
  for (int k = 0; k < numbers * numbers; k++) K[k] -= rest[k];
  return 0;
}

/* ---- sums over cells ---- */

/* A reason for the number that a callback returns at a cell, unless there is one. */
static int because(const dvi_elastic *e, int64_t cell, int returned)
{
  if (returned == DVI__GIVEN_INSIDE) return returned;
  const dvi__cell_name name = dvi__name_cell(e->mesh, e->n, cell);
  if (returned < 0) return dvi__return_because(returned, "at %s", name.text);
  return dvi__return_because(
      returned, "%s is inverted, or deformed to where its law is not defined", name.text);
}

static int cell_value(double t, const double *q, double *V, void *user)
{
  const dvi__solid_potential *of = user;
  const dvi_elastic *e = of->system->elastic;
  *V = 0;
  for (int64_t c = 0; c < e->cells; c++) {
    double u[NUMBERS], energy;
    int returned = dvi__solid_gather_unknowns(e, c, t, q, u);
    if (returned == 0) returned = share_energy(e, of->share, c, u, &energy);
    if (returned != 0) return because(e, c, returned);
    *V += energy;
  }
  return 0;
}

static int cell_gradient(double t, const double *q, double *V_q, void *user)
{
  const dvi__solid_potential *of = user;
  const dvi_elastic *e = of->system->elastic;
  const int numbers = (e->n + 1) * e->n;
  memset(V_q, 0, (size_t)e->unknowns * sizeof *V_q);
  for (int64_t first = 0; first < e->cells; first += DVI__SOLID_BATCH) {
    double u[DVI__SOLID_BATCH * NUMBERS], f[DVI__SOLID_BATCH * NUMBERS] = {0};
    const int64_t left = e->cells - first;
    const int count = left < DVI__SOLID_BATCH ? (int)left : DVI__SOLID_BATCH;
    int returned = 0, failed = 0;
    for (int c = 0; c < count && returned == 0; c++, failed = c)
      returned = dvi__solid_gather_unknowns(e, first + c, t, q, u + c * numbers);
    if (returned == 0) returned = share_forces(e, of->share, first, count, u, f, &failed);
    if (returned != 0) return because(e, first + failed, returned);
    for (int k = 0; k < count * numbers; k++) f[k] = -f[k];
    for (int c = 0; c < count; c++) dvi__solid_scatter(e, first + c, f + c * numbers, V_q);
  }
  return 0;
}

static int cell_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi__solid_potential *of = user;
  const dvi_elastic *e = of->system->elastic;
  const dvi__solid_pattern *pattern = &of->system->pattern;
  const size_t entries = (size_t)pattern->matrix.start[pattern->matrix.rows];
  if (of->share == DVI__SOLID_STIFFNESS) {
    memcpy(V_qq, pattern->matrix.value, entries * sizeof *V_qq);
    return 0;
  }
  memset(V_qq, 0, entries * sizeof *V_qq);
  for (int64_t c = 0; c < e->cells; c++) {
    double u[NUMBERS], K[NUMBERS * NUMBERS];
    int returned = dvi__solid_gather_unknowns(e, c, t, q, u);
    if (returned == 0) returned = share_stiffness(e, of->share, c, u, K);
    if (returned != 0) return because(e, c, returned);
    dvi__solid_add_matrix(e, pattern, c, K, V_qq);
  }
  return 0;
}

static int cell_rate(double t, const double *q, double *V_t, void *user)
{
  const dvi__solid_potential *of = user;
  const dvi_elastic *e = of->system->elastic;
  *V_t = 0;
  for (int64_t c = 0; c < e->cells; c++) {
    double u[NUMBERS], f[NUMBERS], rate[NUMBERS];
    int failed, returned = dvi__solid_driven_rates(e, c, t, rate);
    if (returned == 0) continue;
    if (returned > 0) returned = dvi__solid_gather_unknowns(e, c, t, q, u);
    if (returned == 0) returned = share_forces(e, of->share, c, 1, u, f, &failed);
    if (returned != 0) return because(e, c, returned);
    for (int k = 0; k < (e->n + 1) * e->n; k++) *V_t -= f[k] * rate[k];
  }
  return 0;
}

/* Of a system that does not depend on time no term has a rate. */
static int has_rates(const dvi_elastic *e)
{
  return e->is_driven || !e->has_steady_loads;
}

dvi_potential dvi__solid_cell_potential(dvi__solid_potential *part, const char *name)
{
  const dvi__solid_system *s = part->system;
  const int is_quadratic = part->share == DVI__SOLID_STIFFNESS;
  return (dvi_potential){.name = name,
                         .value = cell_value,
                         .gradient = cell_gradient,
                         .hessian = cell_hessian,
                         .qq = {.start = s->start, .row = s->pattern.matrix.column},
                         .rate = has_rates(s->elastic) ? cell_rate : NULL,
                         .quadratic = is_quadratic,
                         .fast = is_quadratic,
                         .fastest = is_quadratic ? s->elastic->fastest : 0,
                         .user = part};
}

/* ---- the stiffness at rest ---- */

static int matrix_gradient_range(double t, const double *q, int first, int last, double *V_q,
                                 void *user)
{
  const dvi__solid_system *s = user;
  const dvi__csr *K = &s->pattern.matrix;
  (void)t;
  for (int i = first; i < last; i++) {
    double sum = 0;
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++) sum += K->value[e] * q[K->column[e]];
    V_q[i - first] = sum + s->pull[i];
  }
  return 0;
}

static int matrix_value(double t, const double *q, double *V, void *user)
{
  const dvi__solid_system *s = user;
  const dvi__csr *K = &s->pattern.matrix;
  (void)t;
  *V = s->held;
  for (int64_t i = 0; i < K->rows; i++) {
    double sum = 0;
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++) sum += K->value[e] * q[K->column[e]];
    *V += q[i] * (sum / 2 + s->pull[i]);
  }
  return 0;
}

static int matrix_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi__csr *K = &((const dvi__solid_system *)user)->pattern.matrix;
  (void)t, (void)q;
  memcpy(V_qq, K->value, (size_t)K->start[K->rows] * sizeof *V_qq);
  return 0;
}

static int no_rate(double t, const double *q, double *V_t, void *user)
{
  (void)t, (void)q, (void)user;
  *V_t = 0;
  return 0;
}

static int reach_of(const dvi__csr *K)
{
  int reach = 0;
  for (int64_t i = 0; i < K->rows; i++)
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++)
      if (llabs(i - K->column[e]) > reach) reach = (int)llabs(i - K->column[e]);
  return reach;
}

dvi_potential dvi__solid_matrix_potential(dvi__solid_system *s, const char *name)
{
  return (dvi_potential){.name = name,
                         .value = matrix_value,
                         .gradient_range = matrix_gradient_range,
                         .reach = reach_of(&s->pattern.matrix),
                         .hessian = matrix_hessian,
                         .qq = {.start = s->start, .row = s->pattern.matrix.column},
                         .rate = has_rates(s->elastic) ? no_rate : NULL,
                         .quadratic = 1,
                         .fast = 1,
                         .fastest = s->elastic->fastest,
                         .user = s};
}

dvi_status dvi__solid_make_pull(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  const int n = e->n;
  s->pull = DVI_NEW(double, e->unknowns);
  if (s->pull == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a system");
  for (int64_t c = 0; c < e->cells; c++) {
    double u[NUMBERS], f[NUMBERS] = {0}, energy;
    dvi__solid_gather(e, c, e->steady, u);
    dvi__solid_rest_force(e, c, u, f);
    (void)share_energy(e, DVI__SOLID_STIFFNESS, c, u, &energy);
    for (int k = 0; k < (n + 1) * n; k++) f[k] = -f[k];
    dvi__solid_scatter(e, c, f, s->pull);
    s->held += energy;
  }
  return DVI_OK;
}

/* ---- loads ---- */

static int load_gradient(double t, const double *q, double *V_q, void *user)
{
  const dvi__solid_system *s = user;
  const dvi_elastic *e = s->elastic;
  (void)q;
  for (int64_t i = 0; i < e->unknowns; i++) V_q[i] = s->load != NULL ? -s->load[i] : 0;
  for (int64_t c = 0; c < e->cells && s->load == NULL; c++) {
    double f[NUMBERS] = {0};
    if (e->load_start[c] == e->load_start[c + 1]) continue;
    const int returned = dvi__solid_add_load(e, c, t, f);
    if (returned != 0) return because(e, c, -abs(returned));
    for (int k = 0; k < (e->n + 1) * e->n; k++) f[k] = -f[k];
    dvi__solid_scatter(e, c, f, V_q);
  }
  return 0;
}

/* Give minus the sum of f.u over cells, with u the displacements or the rates. Returns as
 * callbacks do. */
static int sum_work(const dvi_elastic *e, double t, const double *q, int is_rate, double *sum)
{
  *sum = 0;
  for (int64_t c = 0; c < e->cells; c++) {
    double u[NUMBERS], f[NUMBERS] = {0};
    if (e->load_start[c] == e->load_start[c + 1]) continue;
    int returned = is_rate ? dvi__solid_driven_rates(e, c, t, u)
                           : dvi__solid_gather_unknowns(e, c, t, q, u);
    if (returned >= 0 && (is_rate || returned == 0)) returned = dvi__solid_add_load(e, c, t, f);
    if (returned != 0) return because(e, c, -abs(returned));
    for (int k = 0; k < (e->n + 1) * e->n; k++) *sum -= f[k] * u[k];
  }
  return 0;
}

static int load_value(double t, const double *q, double *V, void *user)
{
  const dvi__solid_system *s = user;
  if (s->load == NULL || s->elastic->is_driven) return sum_work(s->elastic, t, q, 0, V);
  *V = s->held_load;
  for (int64_t i = 0; i < s->elastic->unknowns; i++) *V -= s->load[i] * q[i];
  return 0;
}

/* Of steady loads. */
static int load_rate(double t, const double *q, double *V_t, void *user)
{
  return sum_work(((const dvi__solid_system *)user)->elastic, t, q, 1, V_t);
}

static int no_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user;
  return 0;
}

/* The rate of a load is not known. Without it methods for which time is an unknown are refused. */
dvi_potential dvi__solid_load_potential(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  return (dvi_potential){.name = "load",
                         .value = load_value,
                         .gradient = load_gradient,
                         .hessian = no_hessian,
                         .qq = {.start = s->no_start, .row = s->no_start},
                         .rate = e->is_driven && e->has_steady_loads ? load_rate : NULL,
                         .quadratic = 1,
                         .user = s};
}

dvi_status dvi__solid_make_load(dvi__solid_system *s)
{
  const dvi_elastic *e = s->elastic;
  if (e->load_count == 0 || !e->has_steady_loads) return DVI_OK;
  s->load = DVI_NEW(double, e->unknowns);
  if (s->load == NULL) return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for loads");
  for (int64_t c = 0; c < e->cells; c++) {
    double u[NUMBERS] = {0}, f[NUMBERS] = {0};
    const int returned = dvi__solid_add_load(e, c, 0, f);
    if (returned != 0)
      return dvi__fail(DVI_CALLBACK_FAILED, "elastic: a load returned %d at cell %lld", returned,
                       (long long)c);
    dvi__solid_gather(e, c, e->steady, u);
    for (int k = 0; k < (e->n + 1) * e->n; k++) s->held_load -= f[k] * u[k];
    dvi__solid_scatter(e, c, f, s->load);
  }
  return DVI_OK;
}
