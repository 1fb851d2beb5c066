/* The growth of small vibrations of a solid about rest under its steps.
 *
 * With the stiffness K at rest the steps are linear, and their monodromy matrix maps (u, v) right
 * after the events of one time to those a common period later. Rigid motions, of which the forces
 * know nothing, make it defective, u = u_0 + v t. So they are taken out of u, orthogonally in the
 * scalar product of the mass. Those of v stay where they are without dampings, and are left out at
 * the start. A damping beta K remembers which displacements w it has answered (event.c), so that
 * its state is (u, w - u, v), and searches measure it by
 *
 *     u.K u + v.M v + sum over K of (w - u).beta K (w - u)/h_K. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/rigid.h"
#include "field/elastic_avi/march.h"
#include "field/mesh/share.h"
#include "field/step/classes.h"
#include "field/step/growth.h"

/* Events that a search may cost, unless the user asks for a span. */
static const double events_wanted = 2e7;

enum { NUMBERS = DVI__SOLID_NUMBERS };

typedef struct vibrations {
  const dvi_elastic *solid;
  dvi__solid_avi *avi;
  dvi__csr K;
  dvi__rigid rigid;
  int64_t n;
  double *mass, *inverse, *A, *D; /* [unknowns] */
  double *memory;                 /* [viscous*NUMBERS] w - u */
} vibrations;

/* ---- passages ---- */

/* Give displacements of the nodes of a cell. */
static void gather(const dvi__solid_avi *avi, int64_t c, double *u)
{
  const int n = avi->n, *corner = avi->cell[c].corner;
  for (int a = 0; a <= n; a++)
    for (int i = 0; i < n; i++) u[a * n + i] = avi->state.node[corner[a]].u[i];
}

/* Add factor times the displacements of the nodes of viscous cells to numbers of these cells. */
static void add_displacements(const dvi__solid_avi *avi, double factor, double *numbers)
{
  for (int64_t c = 0; c < avi->active; c++) {
    double u[NUMBERS] = {0};
    if (!(avi->cell[c].kind & DVI__CELL_VISCOUS)) continue;
    gather(avi, c, u);
    for (int k = 0; k < (avi->n + 1) * avi->n; k++)
      numbers[(int64_t)NUMBERS * avi->cell[c].viscous + k] += factor * u[k];
  }
}

/* Stand right after the events of the time 0. */
static void put_state(const vibrations *s)
{
  dvi__solid_avi *avi = s->avi;
  const dvi_elastic *e = s->solid;
  memset(avi->block, 0, avi->size);
  for (int64_t v = 0; v < e->vertices; v++) {
    dvi__solid_node *node = avi->state.node + v;
    node->inverse = 1 / e->mass[v];
    for (int i = 0; i < e->n; i++) {
      const int k = e->unknown[v * e->n + i];
      if (k < 0) continue;
      node->u[i] = s->A[k];
      node->v[i] = s->D[k] * s->inverse[k];
    }
  }
  const size_t remembered = (size_t)avi->viscous_count * NUMBERS * sizeof(double);
  if (remembered > 0) memcpy(avi->state.stretch, s->memory, remembered);
  add_displacements(avi, 1, avi->state.stretch);
  avi->clock = (dvi__solid_clock){.allowed = avi->band};
  dvi__solid_order(avi);
}

static void take_state(const vibrations *s)
{
  const dvi__solid_avi *avi = s->avi;
  const dvi_elastic *e = s->solid;
  for (int64_t k = 0; k < e->vertices * e->n; k++) {
    const int at = e->unknown[k];
    if (at < 0) continue;
    s->A[at] = avi->state.node[k / e->n].u[k % e->n];
    s->D[at] = avi->state.node[k / e->n].v[k % e->n] * s->mass[at];
  }
  const size_t remembered = (size_t)avi->viscous_count * NUMBERS * sizeof(double);
  if (remembered > 0) memcpy(s->memory, avi->state.stretch, remembered);
  add_displacements(avi, -1, s->memory);
}

/* Forces of small strains and conditions that hold do not fail. */
static dvi_status carry(void *of, double t)
{
  const vibrations *s = of;
  put_state(s);
  (void)dvi__solid_run(s->avi, t * (1 + 4 * DBL_EPSILON));
  take_state(s);
  return DVI_OK;
}

static double stored_in(const vibrations *s, const double *u)
{
  double sum = 0;
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t at = s->K.start[i]; at < s->K.start[i + 1]; at++)
      sum += u[i] * s->K.value[at] * u[s->K.column[at]];
  return 0.5 * sum;
}

static dvi_status energy_at(void *of, double t, double *energy)
{
  const vibrations *s = of;
  const dvi__solid_view *view = s->avi->view;
  if (t > 0)
    (void)dvi__solid_run(s->avi, t);
  else
    put_state(s);
  s->avi->clock.t = t;
  DVI_TRY(dvi__solid_avi_see(s->avi));
  dvi_elastic_project(s->solid, view->u, NULL, s->A, NULL, NULL);
  *energy = stored_in(s, s->A);
  for (int64_t k = 0; k < s->solid->vertices * s->solid->n; k++)
    *energy += 0.5 * s->solid->mass[k / s->solid->n] * view->rate[k] * view->rate[k];
  return DVI_OK;
}

/* ---- strains ---- */

static void stiffness(const dvi__flow *flow, double *K)
{
  const vibrations *s = flow->of;
  for (int64_t i = 0; i < s->n; i++)
    for (int64_t at = s->K.start[i]; at < s->K.start[i + 1]; at++)
      K[s->K.column[at] * s->n + i] += s->K.value[at];
}

/* Stored and kinetic energy are equal. A damping has answered u + v h/2, as at a start. */
static void scatter(const dvi__flow *flow)
{
  const vibrations *s = flow->of;
  double kinetic = 0;
  for (int64_t k = 0; k < s->n; k++) {
    s->A[k] = dvi__random_between((uint64_t)(2 * k));
    s->D[k] = dvi__random_between((uint64_t)(2 * k + 1));
  }
  dvi__rigid_remove(&s->rigid, s->A);
  dvi__rigid_remove(&s->rigid, s->D);
  for (int64_t k = 0; k < s->n; k++) kinetic += 0.5 * s->mass[k] * s->D[k] * s->D[k];
  const double stored = stored_in(s, s->A);
  for (int64_t k = 0; k < s->n; k++) {
    s->A[k] *= 0.5 / sqrt(stored);
    s->D[k] *= 0.5 / sqrt(kinetic) * s->mass[k];
  }
  const dvi__solid_avi *avi = s->avi;
  const dvi_elastic *e = s->solid;
  for (int64_t c = 0; c < avi->active; c++)
    for (int k = 0; k < (e->n + 1) * e->n && avi->cell[c].kind & DVI__CELL_VISCOUS; k++) {
      const int64_t v = avi->cell[c].corner[k / e->n];
      const int at = e->unknown[v * e->n + k % e->n];
      s->memory[(int64_t)NUMBERS * avi->cell[c].viscous + k] =
          at >= 0 ? 0.5 * avi->step[c] * s->D[at] * s->inverse[at] : 0;
    }
}

static void put(const dvi__flow *flow, const double *strain)
{
  const vibrations *s = flow->of;
  memcpy(s->A, strain, (size_t)s->n * sizeof(double));
  memcpy(s->memory, strain + s->n, (size_t)(flow->strains - s->n) * sizeof(double));
}

static void take(const dvi__flow *flow, double *strain)
{
  const vibrations *s = flow->of;
  dvi__rigid_remove(&s->rigid, s->A);
  memcpy(strain, s->A, (size_t)s->n * sizeof(double));
  memcpy(strain + s->n, s->memory, (size_t)(flow->strains - s->n) * sizeof(double));
}

static void weigh(const dvi__flow *flow, const double *strain, double *image)
{
  const vibrations *s = flow->of;
  const dvi__solid_avi *avi = s->avi;
  const dvi_matrix K = dvi__csr_view(&s->K, 1);
  dvi_matrix_multiply(&K, 0, strain, image);
  for (int64_t c = 0; c < avi->active; c++) {
    if (!(avi->cell[c].kind & DVI__CELL_VISCOUS)) continue;
    const int64_t at = s->n + (int64_t)NUMBERS * avi->cell[c].viscous;
    dvi__solid_resist(avi, c, strain + at, image + at);
    for (int k = 0; k < NUMBERS; k++) image[at + k] /= -avi->step[c];
  }
}

static const dvi__flow_strain strains_of_solids = {
    .stiffness = stiffness, .scatter = scatter, .put = put, .take = take, .weigh = weigh};

/* ---- the report ---- */

static void clear(vibrations *s)
{
  dvi__csr_clear(&s->K);
  dvi__rigid_clear(&s->rigid);
  dvi__release(s->mass);
  dvi__release(s->inverse);
  dvi__release(s->A);
  dvi__release(s->D);
  dvi__release(s->memory);
  dvi__solid_avi_destroy(&s->avi);
}

static dvi_status prepare(vibrations *s)
{
  const dvi_elastic *e = s->solid;
  s->n = e->unknowns;
  s->mass = DVI_NEW(double, s->n);
  s->inverse = DVI_NEW(double, s->n);
  s->A = DVI_NEW(double, s->n);
  s->D = DVI_NEW(double, s->n);
  s->memory = DVI_NEW(double, s->avi->viscous_count *NUMBERS);
  if (!s->mass || !s->inverse || !s->A || !s->D || !s->memory)
    return dvi__fail(DVI_NO_MEMORY, "stability: no memory for %lld displacements", (long long)s->n);
  for (int64_t k = 0; k < e->vertices * e->n; k++) {
    if (e->unknown[k] < 0) continue;
    s->mass[e->unknown[k]] = e->mass[k / e->n];
    s->inverse[e->unknown[k]] = 1 / e->mass[k / e->n];
  }
  DVI_TRY(dvi__solid_rest_stiffness(e, &s->K));
  return dvi__rigid_create(e, &s->rigid);
}

static dvi_status find_growth(vibrations *s, double span, dvi_stability *report)
{
  const dvi__solid_avi *avi = s->avi;
  DVI_TRY(prepare(s));
  const dvi__flow flow = {.n = s->n,
                          .M1 = s->mass,
                          .inverse = s->inverse,
                          .A = s->A,
                          .D = s->D,
                          .has_losses = avi->decay != NULL || avi->viscous_count > 0,
                          .has_memory = avi->viscous_count > 0,
                          .strains = s->n + NUMBERS * avi->viscous_count,
                          .strain = &strains_of_solids,
                          .carry = carry,
                          .energy = energy_at,
                          .of = s};
  const dvi__schedule schedule = {
      .count = avi->active, .step = avi->step, .longest = avi->longest, .events = events_wanted};
  report->period = avi->is_free
                       ? dvi__common_period(avi->active, avi->step, avi->shortest, avi->longest)
                       : avi->longest;
  DVI_TRY(dvi__find_growth(&flow, &schedule, span, report));
  report->is_stable = report->growth <= 1 + report->resolution;
  dvi__say_steps(report, avi->shortest, avi->longest, avi->is_free ? 0 : avi->classes);
  return DVI_OK;
}

dvi_status dvi_elastic_stability(const dvi_elastic *elastic, const dvi_march_options *options,
                                 double span, dvi_stability *report)
{
  dvi__solid_request request;
  dvi_stability found = {0};
  vibrations s = {.solid = elastic};
  if (elastic == NULL || report == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "stability: a solid and a place for the report are needed");
  if (!(span >= 0) || isinf(span))
    return dvi__fail(DVI_BAD_ARGUMENT, "stability: the span is %g; 0 or more are possible", span);
  DVI_TRY(dvi__refuse_share(elastic->mesh, "stability: a solid"));
  DVI_TRY(dvi__solid_ask(elastic, options, &request));
  if (request.is_equal)
    return dvi__fail(DVI_UNSUPPORTED, "stability: verlet has equal steps, which are stable below "
                                      "their bound; ask for avi");
  request.is_linear = 1;
  request.threads = 1;
  DVI_TRY(dvi__solid_avi_create(elastic, &request, &s.avi));
  const dvi_status status = find_growth(&s, span, &found);
  if (status == DVI_OK) *report = found;
  clear(&s);
  return status;
}
