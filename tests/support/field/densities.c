#include "support/field/densities.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

/* ---- parts ---- */

static int square(int count, const double *z, double scale, double *l, double *l_z, double *l_zz)
{
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = 0.5 * scale * z[k] * z[k];
    if (l_z != NULL) l_z[k] = scale * z[k];
    if (l_zz != NULL) l_zz[k] = scale;
  }
  return 0;
}

static int kinetic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  return square(count, z, 1, l, l_z, l_zz);
}

static int elastic(int count, double t, const double *x, const double *z, double *l, double *l_z,
                   double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  return square(count, z, -1, l, l_z, l_zz);
}

static int elastic_2d(int count, double t, const double *x, const double *z, double *l, double *l_z,
                      double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    if (l != NULL) l[k] = -0.5 * (z[k] * z[k] + z[count + k] * z[count + k]);
    for (int a = 0; a < 2; a++) {
      if (l_z != NULL) l_z[a * count + k] = -z[a * count + k];
      if (l_zz != NULL) l_zz[a * count + k] = -1;
    }
  }
  return 0;
}

static int klein_gordon(int count, double t, const double *x, const double *z, double *l,
                        double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  return square(count, z, -2.25, l, l_z, l_zz);
}

static int sine_gordon(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double s = sin(0.5 * z[k]);
    if (l != NULL) l[k] = -2 * s * s;
    if (l_z != NULL) l_z[k] = -sin(z[k]);
    if (l_zz != NULL) l_zz[k] = -cos(z[k]);
  }
  return 0;
}

static int double_well(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user)
{
  (void)t, (void)x, (void)user;
  for (int k = 0; k < count; k++) {
    const double u = z[k], s = u * u - 1;
    if (l != NULL) l[k] = -0.25 * s * s;
    if (l_z != NULL) l_z[k] = -s * u;
    if (l_zz != NULL) l_zz[k] = 1 - 3 * u * u;
  }
  return 0;
}

static const dvi_jet rate = {.rate = 1}, value = {0}, slope = {.order = {1}},
                     slopes[2] = {{.order = {1, 0}}, {.order = {0, 1}}};
static const int diagonal[2][2] = {{0, 0}, {1, 1}};

const dvi_density_part kinetic_part = {
    .kind = DVI_DENSITY_KINETIC, .variable = &rate, .variables = 1, .density = kinetic};
const dvi_density_part elastic_part = {.name = "elastic",
                                       .kind = DVI_DENSITY_QUADRATIC,
                                       .variable = &slope,
                                       .variables = 1,
                                       .density = elastic};
const dvi_density_part elastic_part_2d = {.name = "elastic",
                                          .kind = DVI_DENSITY_QUADRATIC,
                                          .variable = slopes,
                                          .variables = 2,
                                          .pair = diagonal,
                                          .pairs = 2,
                                          .density = elastic_2d};
const dvi_density_part klein_gordon_part = {.name = "mass of Klein and Gordon",
                                            .kind = DVI_DENSITY_QUADRATIC,
                                            .variable = &value,
                                            .variables = 1,
                                            .density = klein_gordon};
const dvi_density_part sine_gordon_part = {.name = "pendula",
                                           .kind = DVI_DENSITY_POTENTIAL,
                                           .variable = &value,
                                           .variables = 1,
                                           .density = sine_gordon};
const dvi_density_part double_well_part = {.name = "double well",
                                           .kind = DVI_DENSITY_POTENTIAL,
                                           .variable = &value,
                                           .variables = 1,
                                           .density = double_well};

/* ---- fields ---- */

dvi_space *make_density_space(const char *kind, int dimension, double from, double to, int periodic)
{
  dvi_axis axis[DVI_AXES_MAX] = {{0}};
  dvi_space *space = NULL;
  for (int d = 0; d < dimension; d++)
    axis[d] = (dvi_axis){.from = from, .to = to, .periodic = periodic};
  const dvi_space_options options = {
      .size = sizeof options, .kind = kind, .axis = axis, .axes = dimension};
  ck_assert_msg(dvi_space_create(&options, &space) == DVI_OK, "%s", dvi_last_error());
  return space;
}

density_field make_density_of(dvi_space *space, dvi_density_terms terms)
{
  density_field field = {.space = space};
  terms.size = sizeof terms;
  terms.space = space;
  if (terms.components == 0) terms.components = 1;
  ck_assert_msg(dvi_density_create(&terms, &field.density) == DVI_OK, "%s", dvi_last_error());
  if (dvi_density_system(field.density, &field.system) != DVI_OK) check_words("no rates");
  (void)dvi_density_unknowns(field.density, &field.n);
  field.places = terms.components * dvi_space_functions(space);
  field.q = calloc((size_t)field.n, sizeof(double));
  field.p = calloc((size_t)field.n, sizeof(double));
  field.U = calloc((size_t)field.places, sizeof(double));
  return field;
}

density_field make_density(dvi_space *space, const dvi_density_part *part, int parts,
                           const dvi_density_condition *condition, int conditions)
{
  return make_density_of(
      space, (dvi_density_terms){
                 .part = part, .parts = parts, .condition = condition, .conditions = conditions});
}

void end_density(density_field *field)
{
  dvi_system_destroy(&field->system);
  dvi_density_destroy(&field->density);
  dvi_space_destroy(&field->space);
  free(field->q);
  free(field->p);
  free(field->U);
}

void set_density(density_field *field, field_function *u, field_function *rate_of, void *user)
{
  double *rates = calloc((size_t)field->places, sizeof(double));
  if (u != NULL) ck_assert_int_eq(dvi_space_interpolate(field->space, u, user, field->U), DVI_OK);
  if (rate_of != NULL)
    ck_assert_int_eq(dvi_space_interpolate(field->space, rate_of, user, rates), DVI_OK);
  ck_assert_msg(dvi_density_project(field->density, field->U, rates, field->q, NULL, field->p) ==
                    DVI_OK,
                "%s", dvi_last_error());
  free(rates);
}

void check_density(const density_field *field, double tolerance)
{
  double *state = calloc((size_t)(2 * field->n), sizeof(double));
  for (int64_t i = 0; i < 2 * field->n; i++) state[i] = 0.8 * sin(1.7 * (double)(i + 1));
  ck_assert_msg(dvi_system_check(field->system, 0.3, state, state + field->n, tolerance, NULL) ==
                    DVI_OK,
                "%s", dvi_last_error());
  free(state);
}

void run_density(density_field *field, const char *method, double t, double h, int steps)
{
  dvi_integrator *integrator = NULL;
  ck_assert_msg(dvi_integrator_create(field->system, method, &integrator) == DVI_OK, "%s: %s",
                method, dvi_last_error());
  ck_assert_msg(dvi_integrator_start(integrator, t, field->q, field->p) == DVI_OK, "%s: %s", method,
                dvi_last_error());
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s: %s", method, dvi_last_error());
  memcpy(field->q, dvi_integrator_q(integrator), (size_t)field->n * sizeof(double));
  memcpy(field->p, dvi_integrator_p(integrator), (size_t)field->n * sizeof(double));
  dvi_integrator_destroy(&integrator);
}

double density_at(const density_field *field, double t, const double *x)
{
  const int order[DVI_AXES_MAX] = {0};
  double u;
  ck_assert_int_eq(dvi_density_lift(field->density, t, field->q, field->U), DVI_OK);
  ck_assert_msg(dvi_space_evaluate(field->space, order, field->U, 1, x, &u) == DVI_OK, "%s",
                dvi_last_error());
  return u;
}

int pendula_start(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 1.5 + 0.5 * cos(x[k]);
  return 0;
}

int pendula_rate(int64_t count, const double *x, double *f, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) f[k] = 0.3 * sin(x[k]);
  return 0;
}

int sine_datum(int64_t count, double t, const double *x, double *datum, void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) datum[k] = sin(t - x[k]);
  return 0;
}

int sine_datum_rates(int64_t count, double t, const double *x, double *first, double *second,
                     void *user)
{
  (void)user;
  for (int64_t k = 0; k < count; k++) first[k] = cos(t - x[k]);
  for (int64_t k = 0; k < count && second != NULL; k++) second[k] = -sin(t - x[k]);
  return 0;
}
