#include "support/waves/lattices.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

/* ---- densities ---- */

static int kinetic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int i = 0; i < count; i++) {
    if (l != NULL) l[i] = z[i] * z[i] / 2;
    if (l_z != NULL) l_z[i] = z[i];
    if (l_zz != NULL) l_zz[i] = 1;
  }
  return 0;
}

/* Variables are the derivatives along the axes, and the pairs the diagonal. */
static int stiffness(int count, double t, const double *x, const double *z, double *l, double *l_z,
                     double *l_zz, void *user)
{
  const int axes = ((const lattice *)user)->axes;
  (void)t, (void)x;
  for (int i = 0; i < count && l != NULL; i++) l[i] = 0;
  for (int i = 0; i < axes * count; i++) {
    if (l != NULL) l[i % count] -= z[i] * z[i] / 2;
    if (l_z != NULL) l_z[i] = -z[i];
    if (l_zz != NULL) l_zz[i] = -1;
  }
  return 0;
}

static void potential_at(const char *V, double u, double *value, double *slope, double *bend)
{
  *value = *slope = *bend = 0;
  if (strcmp(V, "mass") == 0) *value = u * u / 2, *slope = u, *bend = 1;
  if (strcmp(V, "sine") == 0) *value = 1 - cos(u), *slope = sin(u), *bend = cos(u);
  if (strcmp(V, "quartic") == 0)
    *value = (u * u - 1) * (u * u - 1) / 4, *slope = u * (u * u - 1), *bend = 3 * u * u - 1;
}

static int potential(int count, double t, const double *x, const double *z, double *l, double *l_z,
                     double *l_zz, void *user)
{
  (void)t, (void)x;
  for (int i = 0; i < count; i++) {
    double value, slope, bend;
    potential_at(((const lattice *)user)->V, z[i], &value, &slope, &bend);
    if (l != NULL) l[i] = -value;
    if (l_z != NULL) l_z[i] = -slope;
    if (l_zz != NULL) l_zz[i] = -bend;
  }
  return 0;
}

/* z = (u, u_t, u_x, u_y ..), with all pairs. */
static int whole(int count, double t, const double *x, const double *z, double *l, double *l_z,
                 double *l_zz, void *user)
{
  const int variables = 2 + ((const lattice *)user)->axes;
  (void)t, (void)x;
  if (l_zz != NULL)
    memset(l_zz, 0, (size_t)(variables * (variables + 1) / 2 * count) * sizeof *l_zz);
  for (int i = 0; i < count; i++) {
    double value, slope, bend;
    potential_at(((const lattice *)user)->V, z[i], &value, &slope, &bend);
    if (l != NULL) l[i] = -value;
    if (l_z != NULL) l_z[i] = -slope;
    if (l_zz != NULL) l_zz[i] = -bend;
    for (int a = 1; a < variables; a++) {
      const double sign = a == 1 ? 1 : -1, v = z[a * count + i];
      if (l != NULL) l[i] += sign * v * v / 2;
      if (l_z != NULL) l_z[a * count + i] = sign * v;
      if (l_zz != NULL) l_zz[(a * (a + 1) / 2 + a) * count + i] = sign;
    }
  }
  return 0;
}

/* Born and Infeld: l = -sqrt(1 - u_t^2 + u_x^2), whose waves in one direction keep their shape, as
 * u_t^2 = u_x^2. z = (u_t, u_x). */
static int born_infeld(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int i = 0; i < count; i++) {
    const double v = z[i], w = z[count + i], square = 1 - v * v + w * w, root = sqrt(square);
    if (!(square > 0)) return 1;
    if (l != NULL) l[i] = -root;
    if (l_z != NULL) l_z[i] = v / root, l_z[count + i] = -w / root;
    if (l_zz != NULL) {
      l_zz[i] = (1 + w * w) / (square * root);
      l_zz[count + i] = -v * w / (square * root);
      l_zz[2 * count + i] = -(1 - v * v) / (square * root);
    }
  }
  return 0;
}

static const dvi_jet slopes[] = {{.rate = 1}, {.order = {1, 0, 0}}};
const dvi_density_part lattice_strings = {
    .kind = DVI_DENSITY_GENERAL, .variable = slopes, .variables = 2, .density = born_infeld};

/* ---- terms ---- */

static const dvi_jet jets[] = {{.component = 0},
                               {.rate = 1},
                               {.order = {1, 0, 0}},
                               {.order = {0, 1, 0}},
                               {.order = {0, 0, 1}}};
static const int diagonal[3][2] = {{0, 0}, {1, 1}, {2, 2}};

static void set_density(lattice *w)
{
  dvi_multisymplectic_terms *terms = &w->terms;
  terms->part = w->part;
  if (w->in_one) {
    w->part[0] = (dvi_density_part){.kind = DVI_DENSITY_GENERAL,
                                    .variable = jets,
                                    .variables = 2 + w->axes,
                                    .density = whole,
                                    .user = w};
    terms->parts = 1;
    return;
  }
  w->part[0] = (dvi_density_part){
      .kind = DVI_DENSITY_KINETIC, .variable = jets + 1, .variables = 1, .density = kinetic};
  w->part[1] = (dvi_density_part){.kind = DVI_DENSITY_QUADRATIC,
                                  .variable = jets + 2,
                                  .variables = w->axes,
                                  .pair = diagonal,
                                  .pairs = w->axes,
                                  .density = stiffness,
                                  .user = w};
  w->part[2] = (dvi_density_part){.kind = DVI_DENSITY_POTENTIAL,
                                  .variable = jets,
                                  .variables = 1,
                                  .density = potential,
                                  .user = w};
  terms->parts = strcmp(w->V, "none") == 0 ? 2 : 3;
}

const dvi_multisymplectic_terms *lattice_terms(lattice *w)
{
  dvi_multisymplectic_terms *terms = &w->terms;
  if (w->axes == 0) w->axes = 1;
  if (w->cells == 0) w->cells = 20;
  if (w->from == 0 && w->to == 0) w->to = 2 * acos(-1);
  if (w->V == NULL) w->V = "none";
  *terms = (dvi_multisymplectic_terms){.size = sizeof *terms,
                                       .axis = w->axis,
                                       .axes = w->axes,
                                       .components = 1,
                                       .weights = {.time = w->time, .levels = w->levels},
                                       .step = w->step,
                                       .mean_rate = w->mean_rate};
  for (int d = 0; d < w->axes; d++) {
    w->axis[d] = (dvi_axis){.from = w->from, .to = w->to, .periodic = !w->fixed};
    terms->cells[d] = w->cells;
    terms->weights.space[d] = w->space;
  }
  set_density(w);
  w->condition = (dvi_density_condition){.part = "boundary", .component = -1, .kind = DVI_FIXED};
  terms->condition = &w->condition;
  terms->conditions = w->fixed != 0;
  return terms;
}

dvi_march *lattice_march(lattice *w)
{
  dvi_march *march = NULL;
  const dvi_status status = dvi_multisymplectic_create(lattice_terms(w), &march);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  return march;
}

/* ---- fields ---- */

/* Set values [vertices] of a field at a time, at places [axes*vertices]. */
static void evaluate(const lattice *w, int64_t vertices, const double *x, double t,
                     lattice_field *u, const void *of, double *values)
{
  for (int64_t i = 0; i < vertices; i++) {
    double place[3];
    for (int d = 0; d < w->axes; d++) place[d] = x[d * vertices + i];
    values[i] = u(t, place, of);
  }
}

void lattice_start(dvi_march *march, const lattice *w, lattice_field *u, const void *of)
{
  const int64_t vertices = dvi_multisymplectic_vertices(&w->terms, NULL);
  double *x = calloc((size_t)(6 * vertices), sizeof *x), *A = x + 3 * vertices, *E = A + vertices,
         *after = E + vertices;
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  dvi_multisymplectic_vertices(&w->terms, x);
  /* without the mean rate, that at 0 by a difference, with errors of h^2 and of eps/h */
  const double h = w->mean_rate ? facts.step : 1e-5, from = w->mean_rate ? 0 : -h;
  evaluate(w, vertices, x, 0, u, of, A);
  evaluate(w, vertices, x, from, u, of, E);
  evaluate(w, vertices, x, h, u, of, after);
  for (int64_t i = 0; i < vertices; i++) E[i] = -(after[i] - E[i]) / (h - from);
  const dvi_status status = dvi_march_start(
      march, &(dvi_march_state){.size = sizeof(dvi_march_state), .A = A, .E = E});
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  free(x);
}

double lattice_distance(const dvi_march *march, const lattice *w, lattice_field *u, const void *of)
{
  const int64_t vertices = dvi_multisymplectic_vertices(&w->terms, NULL);
  double *x = calloc((size_t)(5 * vertices), sizeof *x), *A = x + 3 * vertices,
         *exact = A + vertices, largest = 0;
  dvi_multisymplectic_vertices(&w->terms, x);
  ck_assert_int_eq(dvi_march_sample(march, DVI_FORM_A, 0, NULL, A), DVI_OK);
  evaluate(w, vertices, x, dvi_march_time(march), u, of, exact);
  for (int64_t i = 0; i < vertices; i++) largest = fmax(largest, fabs(A[i] - exact[i]));
  free(x);
  return largest;
}
