/* A field as a mechanical system, whose coordinates are the unknowns. */
#include <limits.h>
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "field/model/field.h"

/* ---- the elastic potential, q.K q/2 - load.q - J(t).q + that of the fixed values ---- */

/* Evaluate the signals of the currents. Returns as callbacks do. */
static int find_signals(const dvi_field *f, double t, double *signal)
{
  for (int c = 0; c < f->currents; c++) {
    const int failed = f->current[c].signal(t, signal + c, f->current[c].user);
    if (failed != 0) return failed;
  }
  return 0;
}

/* Subtract J of the unknowns `first` to `last`-1 from V_q. */
static void subtract_currents(const dvi_field *f, const double *signal, int first, int last,
                              double *V_q)
{
  for (int c = 0; c < f->currents; c++) {
    const dvi__current *J = f->current + c;
    for (int64_t k = dvi__current_entry(J, first); k < J->count && J->unknown[k] < last; k++)
      V_q[J->unknown[k] - first] -= signal[c] * J->weight[k];
  }
}

static int elastic_gradient_range(double t, const double *q, int first, int last, double *V_q,
                                  void *user)
{
  const dvi_field *f = user;
  const int64_t *start = f->stiffness.start;
  const int *column = f->stiffness.column;
  const double *value = f->stiffness.value;
  double signal[DVI__CURRENTS];
  const int failed = find_signals(f, t, signal);
  for (int i = first; i < last && failed == 0; i++) {
    double sum = 0;
    for (int64_t e = start[i]; e < start[i + 1]; e++) sum += value[e] * q[column[e]];
    V_q[i - first] = sum - f->load[i];
  }
  if (failed == 0) subtract_currents(f, signal, first, last, V_q);
  return failed;
}

static int elastic_gradient(double t, const double *q, double *V_q, void *user)
{
  return elastic_gradient_range(t, q, 0, (int)((const dvi_field *)user)->unknowns, V_q, user);
}

static int elastic_value(double t, const double *q, double *V, void *user)
{
  const dvi_field *f = user;
  const dvi__csr *K = &f->stiffness;
  double signal[DVI__CURRENTS];
  const int failed = find_signals(f, t, signal);
  *V = f->rest;
  for (int64_t i = 0; i < f->unknowns && failed == 0; i++) {
    double sum = 0;
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++) sum += K->value[e] * q[K->column[e]];
    *V += q[i] * (0.5 * sum - f->load[i]);
  }
  for (int c = 0; c < f->currents && failed == 0; c++)
    for (int64_t k = 0; k < f->current[c].count; k++)
      *V -= q[f->current[c].unknown[k]] * signal[c] * f->current[c].weight[k];
  return failed;
}

/* The pattern's columns are the rows of the symmetric matrix. */
static int elastic_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi__csr *K = &((const dvi_field *)user)->stiffness;
  (void)t;
  (void)q;
  for (int64_t e = 0; e < K->start[K->rows]; e++) V_qq[e] = K->value[e];
  return 0;
}

/* ---- the density ---- */

static int density_value(double t, const double *q, double *V, void *user)
{
  const dvi_field *f = user;
  (void)t;
  return dvi__field_density(f, q, 0, f->unknowns, &(dvi__density){.sum = V});
}

static int density_gradient_range(double t, const double *q, int first, int last, double *V_q,
                                  void *user)
{
  (void)t;
  return dvi__field_density(user, q, first, last, &(dvi__density){.first = V_q});
}

static int density_gradient(double t, const double *q, double *V_q, void *user)
{
  return density_gradient_range(t, q, 0, (int)((const dvi_field *)user)->unknowns, V_q, user);
}

static int density_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi_field *f = user;
  (void)t;
  return dvi__field_density(f, q, 0, f->unknowns, &(dvi__density){.second = V_qq});
}

/* ---- the force -S v of conductors and absorbing walls ---- */

static int loss_value(double t, const double *q, const double *v, double *F, void *user)
{
  const dvi__csr *S = &((const dvi_field *)user)->damping;
  (void)t, (void)q;
  for (int64_t i = 0; i < S->rows; i++) {
    F[i] = 0;
    for (int64_t e = S->start[i]; e < S->start[i + 1]; e++) F[i] -= S->value[e] * v[S->column[e]];
  }
  return 0;
}

/* The pattern's columns are the rows of the symmetric matrix. */
static int loss_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                         void *user)
{
  const dvi__csr *S = &((const dvi_field *)user)->damping;
  (void)t, (void)q, (void)v, (void)F_q;
  for (int64_t e = 0; F_v != NULL && e < S->start[S->rows]; e++) F_v[e] = -S->value[e];
  return 0;
}

/* ---- patterns ---- */

static int *copy_start(const dvi__csr *matrix)
{
  int *start = DVI_NEW(int, matrix->rows + 1);
  for (int64_t i = 0; i <= matrix->rows && start != NULL; i++) start[i] = (int)matrix->start[i];
  return start;
}

static void find_reach(dvi_field *f)
{
  const dvi__csr *K = &f->stiffness;
  for (int64_t i = 0; i < K->rows; i++)
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++)
      if (llabs(i - K->column[e]) > f->reach) f->reach = (int)llabs(i - K->column[e]);
}

static dvi_status lay_out(dvi_field *f)
{
  if (f->stiff_start != NULL) return DVI_OK;
  if (f->stiffness.start[f->unknowns] > INT_MAX || f->mass.start[f->unknowns] > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "field: an int cannot count %lld entries of a system's matrix",
                     (long long)f->stiffness.start[f->unknowns]);
  f->stiff_start = copy_start(&f->stiffness);
  f->mass_start = copy_start(&f->mass);
  f->diagonal_start = DVI_NEW(int, f->unknowns + 1);
  f->no_start = DVI_NEW(int, f->unknowns + 1);
  f->damping_start = DVI_NEW(int, f->unknowns + 1);
  if (!f->stiff_start || !f->mass_start || !f->diagonal_start || !f->no_start || !f->damping_start)
    return dvi__fail(DVI_NO_MEMORY, "field: no memory for patterns");
  for (int i = 0; i <= f->unknowns; i++) f->diagonal_start[i] = i;
  for (int i = 0; i <= f->damping.rows && f->damping.rows > 0; i++)
    f->damping_start[i] = (int)f->damping.start[i];
  find_reach(f);
  return DVI_OK;
}

/* ---- terms ---- */

static dvi_potential elastic_term(dvi_field *f)
{
  return (dvi_potential){.name = f->is_wave ? "elastic" : "magnetic",
                         .value = elastic_value,
                         .gradient = elastic_gradient,
                         .gradient_range = elastic_gradient_range,
                         .reach = f->reach,
                         .hessian = elastic_hessian,
                         .qq = {.start = f->stiff_start, .row = f->stiffness.column},
                         .quadratic = 1,
                         .fast = 1,
                         .fastest = f->fastest,
                         .user = f};
}

static dvi_potential density_term(dvi_field *f)
{
  return (dvi_potential){.name = "density",
                         .value = density_value,
                         .gradient = density_gradient,
                         .gradient_range = density_gradient_range,
                         .hessian = density_hessian,
                         .qq = {.start = f->diagonal_start, .row = f->diagonal_start},
                         .user = f};
}

static dvi_force loss_term(dvi_field *f)
{
  return (dvi_force){.name = "losses",
                     .value = loss_value,
                     .jacobian = loss_jacobian,
                     .by_q = {.start = f->no_start, .row = f->no_start},
                     .by_v = {.start = f->damping_start, .row = f->damping.column},
                     .user = f};
}

static dvi_mass mass_term(const dvi_field *f)
{
  if (f->mass_is_diagonal) return (dvi_mass){.diagonal = f->mass.value};
  return (dvi_mass){.values = f->mass.value,
                    .pattern = {.start = f->mass_start, .row = f->mass.column}};
}

static int translate(const double *q, double *xi, void *user)
{
  const dvi_matrix D = dvi__csr_view(&((const dvi__translation *)user)->D, 0);
  dvi_matrix_multiply(&D, 0, q, xi);
  return 0;
}

static void declare_symmetries(dvi_field *f)
{
  for (int i = 0; i < f->translations; i++)
    f->symmetry[i] = (dvi_symmetry){
        .name = f->translation[i].name, .generator = translate, .user = f->translation + i};
}

dvi_status dvi_field_system_terms(dvi_field *field, dvi_system_terms *terms)
{
  if (field == NULL || terms == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field and a place for terms are needed");
  DVI_TRY(dvi__refuse_share(field->mesh, "field: a mechanical system"));
  const int is_new = field->stiff_start == NULL;
  DVI_TRY(lay_out(field));
  double fastest;
  DVI_TRY(dvi_field_fastest(field, &fastest));
  if (is_new && field->is_wave) DVI_TRY(dvi__field_find_translations(field));
  field->potentials[0] = elastic_term(field);
  field->potentials[1] = density_term(field);
  field->loss = loss_term(field);
  declare_symmetries(field);
  *terms = (dvi_system_terms){.dimension = (int)field->unknowns,
                              .mass = mass_term(field),
                              .potentials = field->potentials,
                              .potential_count = field->potential.density != NULL ? 2 : 1,
                              .symmetries = field->translations > 0 ? field->symmetry : NULL,
                              .symmetry_count = field->translations,
                              .forces = field->damping.rows > 0 ? &field->loss : NULL,
                              .force_count = field->damping.rows > 0,
                              .autonomous = field->currents == 0};
  return DVI_OK;
}

dvi_status dvi_field_system(dvi_field *field, dvi_system **system)
{
  dvi_system_terms terms;
  DVI_TRY(dvi_field_system_terms(field, &terms));
  return dvi_system_create(&terms, system);
}
