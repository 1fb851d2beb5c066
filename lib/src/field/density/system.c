/* A field as a mechanical system, whose coordinates are the unknowns. */
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

/* ---- potentials of parts ---- */

static int part_value(double t, const double *q, double *V, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q},
                                &(dvi__density_sums){.value = V});
}

static int part_gradient(double t, const double *q, double *V_q, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q},
                                &(dvi__density_sums){.q = V_q});
}

static int part_gradient_range(double t, const double *q, int first, int last, double *V_q,
                               void *user)
{
  const dvi__density_point at = {.t = t, .q = q, .first = first, .last = last};
  return first < last ? dvi__integral_evaluate(user, &at, &(dvi__density_sums){.q = V_q}) : 0;
}

static int part_hessian(double t, const double *q, double *V_qq, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q},
                                &(dvi__density_sums){.qq = V_qq});
}

static int part_rate(double t, const double *q, double *V_t, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q},
                                &(dvi__density_sums){.rate = V_t});
}

/* ---- the potential q.K q/2 - load.q + rest ---- */

static int quadratic_value(double t, const double *q, double *V, void *user)
{
  const dvi_density *d = user;
  const dvi__csr *K = &d->stiffness;
  (void)t;
  *V = d->rest;
  for (int64_t i = 0; i < K->rows; i++) {
    double sum = 0;
    for (int64_t e = K->start[i]; e < K->start[i + 1]; e++) sum += K->value[e] * q[K->column[e]];
    *V += q[i] * (0.5 * sum - d->load[i]);
  }
  return 0;
}

static int quadratic_gradient_range(double t, const double *q, int first, int last, double *V_q,
                                    void *user)
{
  const dvi_density *d = user;
  (void)t;
  dvi__multiply_rows(&d->stiffness, &d->repeated, first, last, q, V_q);
  for (int i = first; i < last && d->has_load; i++) V_q[i - first] -= d->load[i];
  return 0;
}

static int quadratic_gradient(double t, const double *q, double *V_q, void *user)
{
  return quadratic_gradient_range(t, q, 0, (int)((const dvi_density *)user)->unknowns, V_q, user);
}

/* The pattern's columns are the rows of the symmetric matrix. */
static int quadratic_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi__csr *K = &((const dvi_density *)user)->stiffness;
  (void)t, (void)q;
  memcpy(V_qq, K->value, (size_t)K->start[K->rows] * sizeof *V_qq);
  return 0;
}

/* With a load that depends on time the gradient is summed over the points. */
static int moving_value(double t, const double *q, double *V, void *user)
{
  return part_value(t, q, V, &((dvi_density *)user)->quadratic);
}

static int moving_gradient(double t, const double *q, double *V_q, void *user)
{
  return part_gradient(t, q, V_q, &((dvi_density *)user)->quadratic);
}

static int moving_rate(double t, const double *q, double *V_t, void *user)
{
  return part_rate(t, q, V_t, &((dvi_density *)user)->quadratic);
}

static int no_rate(double t, const double *q, double *V_t, void *user)
{
  (void)t, (void)q, (void)user;
  *V_t = 0;
  return 0;
}

/* ---- the vector potential of values that move, A(t) = M_ID G'(t) ---- */

static int vector_value(double t, const double *q, double *A, void *user)
{
  (void)q;
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t}, &(dvi__density_sums){.v = A});
}

static int vector_rate(double t, const double *q, double *A_t, void *user)
{
  (void)q;
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .take_second = 1},
                                &(dvi__density_sums){.v = A_t});
}

/* A does not depend on q. */
static int vector_gradient(double t, const double *q, double *A_q, void *user)
{
  (void)t, (void)q, (void)A_q, (void)user;
  return 0;
}

static int vector_hessian(double t, const double *q, const double *w, double *A_w_qq, void *user)
{
  (void)t, (void)q, (void)w, (void)A_w_qq, (void)user;
  return 0;
}

/* ---- one-forms ---- */

static int form_value(const double *q, double *alpha, void *user)
{
  return dvi__integral_evaluate(&((dvi_density *)user)->one_form, &(dvi__density_point){.q = q},
                                &(dvi__density_sums){.v = alpha});
}

static int form_gradient(const double *q, double *alpha_q, void *user)
{
  dvi_density *d = user;
  if (!d->is_linear)
    return dvi__integral_evaluate(&d->one_form, &(dvi__density_point){.q = q},
                                  &(dvi__density_sums){.qv = alpha_q});
  const dvi__csr *gradients = &d->gradients;
  memcpy(alpha_q, gradients->value, (size_t)gradients->start[gradients->rows] * sizeof *alpha_q);
  return 0;
}

/* alpha.w is the Lagrangian at the velocity w. */
static int form_hessian(const double *q, const double *w, double *alpha_w_qq, void *user)
{
  dvi_density *d = user;
  if (d->is_linear) return 0;
  return dvi__integral_evaluate(&d->one_form, &(dvi__density_point){.q = q, .v = w},
                                &(dvi__density_sums){.qq = alpha_w_qq});
}

/* ---- general Lagrangians ---- */

static int general_value(double t, const double *q, const double *v, double *L, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q, .v = v},
                                &(dvi__density_sums){.value = L});
}

static int general_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                            void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q, .v = v},
                                &(dvi__density_sums){.q = L_q, .v = L_v});
}

static int general_hessian(double t, const double *q, const double *v, double *L_qq, double *L_qv,
                           double *L_vv, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q, .v = v},
                                &(dvi__density_sums){.qq = L_qq, .qv = L_qv, .vv = L_vv});
}

static int general_rate(double t, const double *q, const double *v, double *L_t, void *user)
{
  return dvi__integral_evaluate(user, &(dvi__density_point){.t = t, .q = q, .v = v},
                                &(dvi__density_sums){.rate = L_t});
}

/* ---- symmetries ---- */

/* A field that is moved to larger x by a has the values u(x - a), so that xi = -D q with the
 * derivative along an axis. */
static int translate(const double *q, double *xi, void *user)
{
  const struct dvi__field_translation *translation = user;
  const dvi_density *d = translation->density;
  const int order[DVI_AXES_MAX] = {translation->axis == 0, translation->axis == 1,
                                   translation->axis == 2};
  memset(xi, 0, (size_t)d->unknowns * sizeof *xi);
  for (int64_t i = 0; i < d->unknowns; i++) {
    const int64_t function = d->unknown[i] % d->functions;
    const dvi__fourier_image image = dvi__fourier_derivative(d->space, order, function);
    const int other = d->number[d->unknown[i] - function + image.other];
    if (other >= 0) xi[other] -= image.factor * q[i];
  }
  return 0;
}

static void declare_translations(dvi_density *d, unsigned placed_axes)
{
  for (int axis = 0; axis < d->dimension && d->is_fourier; axis++) {
    if ((placed_axes >> axis & 1) != 0) continue;
    struct dvi__field_translation *translation = d->translation + d->translations;
    translation->density = d;
    translation->axis = axis;
    (void)snprintf(translation->name, sizeof translation->name, "momentum_%s",
                   dvi_space_axis(d->space, axis));
    d->symmetry[d->translations++] = (dvi_symmetry){
        .name = translation->name, .generator = translate, .user = translation};
  }
}

/* ---- patterns ---- */

static int *copy_start(const dvi__csr *matrix)
{
  int *start = DVI_NEW(int, matrix->rows + 1);
  for (int64_t i = 0; i <= matrix->rows && start != NULL; i++) start[i] = (int)matrix->start[i];
  return start;
}

static dvi_status lay_out(dvi_density *d)
{
  const int64_t n = d->unknowns;
  if (d->stiffness.start[n] > INT_MAX || (d->mass.rows > 0 && d->mass.start[n] > INT_MAX))
    return dvi__fail(DVI_BAD_SIZE, "density: an int cannot count %lld entries of a matrix",
                     (long long)d->stiffness.start[n]);
  d->no_start = DVI_NEW(int, n + 1);
  d->stiffness_start = copy_start(&d->stiffness);
  if (d->mass.rows > 0) d->mass_start = copy_start(&d->mass);
  if (d->gradients.rows > 0) d->gradients_start = copy_start(&d->gradients);
  d->potential_term = DVI_NEW(dvi_potential, d->potentials + 1);
  return d->no_start && d->stiffness_start && (d->mass.rows == 0 || d->mass_start) &&
                 (d->gradients.rows == 0 || d->gradients_start) && d->potential_term
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "density: no memory for a system");
}

static dvi_pattern view(const dvi__pattern *pattern)
{
  return (dvi_pattern){.start = pattern->start, .row = pattern->row};
}

/* ---- terms ---- */

/* Rates are declared for methods that take time as an unknown, where time counts. */
static int is_autonomous(const dvi_density *d)
{
  int depends = d->moving > 0;
  for (int p = 0; p < d->parts; p++) depends |= d->part[p].given.depends_on_time;
  return !depends;
}

/* Ranges of the quadratic potential are rows of its matrix, whatever points it has. */
static dvi_potential quadratic_term(dvi_density *d)
{
  const int moves = d->quadratic.depends_on_time && !d->has_rest, is_static = is_autonomous(d),
            has_ranges = !moves && !d->is_fourier && 2 * d->quadratic.reach < d->unknowns;
  return (dvi_potential){.name = "quadratic",
                         .value = moves ? moving_value : quadratic_value,
                         .gradient = moves ? moving_gradient : quadratic_gradient,
                         .gradient_range = has_ranges ? quadratic_gradient_range : NULL,
                         .reach = has_ranges ? d->quadratic.reach : 0,
                         .hessian = quadratic_hessian,
                         .qq = {.start = d->stiffness_start, .row = d->stiffness.column},
                         .rate = is_static               ? NULL
                                 : !moves                ? no_rate
                                 : d->quadratic.has_rate ? moving_rate
                                                         : NULL,
                         .fast = 1,
                         .quadratic = 1,
                         .fastest = d->fastest,
                         .user = d};
}

/* A Hessian is declared if the field has it, full without a pattern. */
static dvi_potential part_term(const dvi_density *d, dvi__integral *integral)
{
  return (dvi_potential){.name = integral->part[0]->name,
                         .value = part_value,
                         .gradient = part_gradient,
                         .gradient_range = integral->has_ranges ? part_gradient_range : NULL,
                         .reach = integral->has_ranges ? integral->reach : 0,
                         .hessian = integral->has_hessian ? part_hessian : NULL,
                         .without_hessian = !integral->has_hessian,
                         .qq = view(&integral->patterns.qq),
                         .rate = !is_autonomous(d) && integral->has_rate ? part_rate : NULL,
                         .user = integral};
}

static dvi_mass mass_term(const dvi_density *d)
{
  if (d->mass_scalar != 0) return (dvi_mass){.scalar = d->mass_scalar};
  if (d->mass_is_diagonal) return (dvi_mass){.diagonal = d->mass.value};
  return (dvi_mass){.values = d->mass.value,
                    .pattern = {.start = d->mass_start, .row = d->mass.column}};
}

static dvi_vector_potential vector_term(dvi_density *d)
{
  return (dvi_vector_potential){.value = vector_value,
                                .gradient = vector_gradient,
                                .hessian = vector_hessian,
                                .rate = vector_rate,
                                .gradients = {.start = d->no_start, .row = d->no_start},
                                .qq = {.start = d->no_start, .row = d->no_start},
                                .user = &d->kinetic};
}

static dvi_one_form form_term(dvi_density *d)
{
  const dvi_pattern gradients = {.start = d->gradients_start, .row = d->gradients.column},
                    none = {.start = d->no_start, .row = d->no_start};
  return (dvi_one_form){.value = form_value,
                        .gradient = form_gradient,
                        .hessian = form_hessian,
                        .gradients = gradients,
                        .qq = d->is_linear ? none : view(&d->one_form.patterns.qq),
                        .user = d};
}

static dvi_lagrangian general_term(dvi_density *d)
{
  const dvi__density_patterns *patterns = &d->lagrangian.patterns;
  return (dvi_lagrangian){.value = general_value,
                          .gradient = general_gradient,
                          .hessian = d->lagrangian.has_hessian ? general_hessian : NULL,
                          .qq = view(&patterns->qq),
                          .qv = view(&patterns->qv),
                          .vv = view(&patterns->vv),
                          .rate = !is_autonomous(d) && d->lagrangian.has_rate ? general_rate : NULL,
                          .user = &d->lagrangian};
}

/* Tell if a variable at a point has coordinates, and if it has values that move. */
static int is_free(const dvi__jet_rows *rows, int64_t k)
{
  return rows->start[k + 1] > rows->start[k];
}

static int is_moving(const dvi__jet_rows *rows, int64_t k)
{
  return rows->moving.rows > 0 && rows->moving.start[k + 1] > rows->moving.start[k];
}

/* Tell if a pair of rates at a point is one of a coordinate and of a value that moves. With masses
 * at the nodes there is no such point, A is 0, and explicit methods apply. */
static int has_vector_potential(const dvi_density *d)
{
  for (int p = 0; p < d->kinetic.parts && d->moving > 0; p++) {
    const dvi__density_part *part = d->kinetic.part[p];
    for (int e = 0; e < part->given.pairs; e++) {
      const dvi__jet_rows *a = part->rows + part->given.pair[e][0],
                          *b = part->rows + part->given.pair[e][1];
      for (int64_t k = 0; k < part->points; k++)
        if ((is_free(a, k) && is_moving(b, k)) || (is_free(b, k) && is_moving(a, k))) return 1;
    }
  }
  return 0;
}

static void declare_dynamics(dvi_density *d)
{
  if (d->mass.rows > 0) d->terms.mass = mass_term(d);
  if (has_vector_potential(d)) {
    d->vector_potential_term = vector_term(d);
    d->terms.vector_potential = &d->vector_potential_term;
  }
  if (d->one_form.parts > 0) {
    d->one_form_term = form_term(d);
    d->terms.one_form = &d->one_form_term;
  }
  if (d->lagrangian.parts > 0) {
    d->lagrangian_term = general_term(d);
    d->terms.lagrangian = &d->lagrangian_term;
  }
}

dvi_status dvi__density_make_terms(dvi_density *density, const dvi_density_terms *terms)
{
  dvi_density *d = density;
  int count = 0;
  DVI_TRY(lay_out(d));
  if (d->quadratic.parts > 0) d->potential_term[count++] = quadratic_term(d);
  for (int i = 0; i < d->potentials; i++)
    d->potential_term[count++] = part_term(d, d->potential + i);
  if (terms->translations) declare_translations(d, terms->placed_axes);
  d->terms = (dvi_system_terms){.dimension = (int)d->unknowns,
                                .potentials = count > 0 ? d->potential_term : NULL,
                                .potential_count = count,
                                .symmetries = d->translations > 0 ? d->symmetry : NULL,
                                .symmetry_count = d->translations,
                                .autonomous = is_autonomous(d)};
  declare_dynamics(d);
  return DVI_OK;
}

dvi_status dvi_density_system_terms(const dvi_density *density, dvi_system_terms *terms)
{
  if (density == NULL || terms == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: a field and a place for terms are needed");
  if (density->mass.rows == 0 && density->one_form.parts == 0 && density->lagrangian.parts == 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "density: the field has no rates: add a kinetic part, a one-form or a general "
                     "part, or solve for its static state");
  *terms = density->terms;
  return DVI_OK;
}

dvi_status dvi_density_system(const dvi_density *density, dvi_system **system)
{
  dvi_system_terms terms;
  DVI_TRY(dvi_density_system_terms(density, &terms));
  return dvi_system_create(&terms, system);
}
