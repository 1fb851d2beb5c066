#include "scene/terms/callbacks.h"

#include <stdio.h>
#include <string.h>

#include "expr/compile/program.h"
#include "scene/terms/fault.h"

/* ---- evaluations ---- */

static int value_at(dvi__scene_term *term, int count, const double *const *x, double *value)
{
  return dvi__fault_check(term, count, x, 0, dvi__function_value(term->function, count, x, value));
}

static int gradient_at(dvi__scene_term *term, int count, const double *const *x,
                       double *const *gradient)
{
  return dvi__fault_check(term, count, x, 0,
                          dvi__function_gradient(term->function, count, x, gradient));
}

static int second_at(dvi__scene_term *term, int count, const double *const *x,
                     double *const *values)
{
  return dvi__fault_check(term, count, x, 0,
                          dvi__function_second(term->function, count, x, values));
}

int dvi__term_value(double t, const double *q, const double *velocity_or_momentum, double *value,
                    void *user)
{
  const double *x[DVI__BLOCKS] = {&t, q, velocity_or_momentum, NULL};
  return value_at(user, 1, x, value);
}

/* ---- potentials ---- */

static int term_potential_value(int count, const double *t, const double *q, double *V, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, NULL};
  return value_at(user, count, x, V);
}

static int term_potential_gradient(int count, const double *t, const double *q, double *V_q,
                                   void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__COORDINATES] = V_q};
  return gradient_at(user, count, x, gradient);
}

static int term_potential_hessian(int count, const double *t, const double *q, double *V_qq,
                                  void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, NULL};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QQ] = V_qq};
  return second_at(user, count, x, values);
}

static int term_potential_rate(int count, const double *t, const double *q, double *V_t, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__TIME] = V_t};
  return gradient_at(user, count, x, gradient);
}

/* Compute Taylor coefficients. The first coefficients of the curve are its point. */
static int term_potential_taylor(int degree, const double *t, const double *q, double *V,
                                 double *V_q, double *V_qq, void *user)
{
  const dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {t, q, NULL, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__COORDINATES] = V_q},
         *values[DVI__PAIRS] = {[DVI__PAIR_QQ] = V_qq};
  return dvi__fault_check(term, 1, x, 1,
                          dvi__function_series(term->function, degree, x, V, gradient, values));
}

bool dvi__term_pattern(dvi_scene *scene, dvi__scene_term *term, int pair, dvi_pattern *pattern,
                       int *full)
{
  const dvi_status status = dvi__function_pattern(term->function, pair, pattern, full);
  if (status != DVI_OK)
    return dvi__scene_too_large(scene, "the pattern of the second derivatives", status);
  if (*full) *pattern = (dvi_pattern){0};
  return true;
}

/* Blocks by which gradients are derived. */
static const char of_coordinates[DVI__BLOCKS] = {[DVI__COORDINATES] = 1};
static const char of_motion[DVI__BLOCKS] = {[DVI__COORDINATES] = 1, [DVI__VELOCITIES] = 1};
static const char of_velocities[DVI__BLOCKS] = {[DVI__VELOCITIES] = 1};
static const char of_multipliers[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = 1};

/* Make the programs of large expressions now, since they may be refused. They are the value's, and
 * the gradient's by these blocks. */
static bool prepare_large(dvi_scene *scene, const dvi__scene_term *term, const char *blocks)
{
  enum { ALWAYS_FIT = DVI__ROWS_MAX / 32 }; /* nodes of a kernel, whose programs then fit */
  const dvi__kernel *largest = NULL;
  for (int k = 0; k < dvi__function_kernel_count(term->function); k++) {
    const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
    if (kernel->root >= ALWAYS_FIT && (largest == NULL || kernel->root > largest->root))
      largest = kernel;
  }
  if (largest == NULL) return true;
  const dvi_status status = dvi__function_prepare(term->function, 1, blocks, NULL);
  return status == DVI_OK ||
         dvi__complain(scene->complaint, status, largest->graph->node[largest->root].span, "%s",
                       dvi__too_large(status));
}

bool dvi__make_potential(dvi_scene *scene, const char *name, dvi__scene_term *term,
                         dvi_potential *potential)
{
  int full;
  *potential = (dvi_potential){.name = name,
                               .value_batch = term_potential_value,
                               .gradient_batch = term_potential_gradient,
                               .hessian_batch = term_potential_hessian,
                               .rate_batch = term_potential_rate,
                               .taylor = term_potential_taylor,
                               .user = term};
  return prepare_large(scene, term, of_coordinates) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QQ, &potential->qq, &full);
}

/* ---- Lagrangians ---- */

static int term_lagrangian_value(int count, const double *t, const double *q, const double *v,
                                 double *L, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  return value_at(user, count, x, L);
}

static int term_lagrangian_gradient(int count, const double *t, const double *q, const double *v,
                                    double *L_q, double *L_v, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__COORDINATES] = L_q, [DVI__VELOCITIES] = L_v};
  return gradient_at(user, count, x, gradient);
}

static int term_lagrangian_hessian(int count, const double *t, const double *q, const double *v,
                                   double *L_qq, double *L_qv, double *L_vv, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  double *values[DVI__PAIRS] = {
      [DVI__PAIR_QQ] = L_qq, [DVI__PAIR_QV] = L_qv, [DVI__PAIR_VV] = L_vv};
  return second_at(user, count, x, values);
}

static int term_lagrangian_rate(int count, const double *t, const double *q, const double *v,
                                double *L_t, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__TIME] = L_t};
  return gradient_at(user, count, x, gradient);
}

static int term_lagrangian_taylor(int degree, const double *t, const double *q, const double *v,
                                  double *L, double *L_q, double *L_v, double *L_qq, double *L_qv,
                                  double *L_vv, void *user)
{
  const dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__COORDINATES] = L_q, [DVI__VELOCITIES] = L_v};
  double *values[DVI__PAIRS] = {
      [DVI__PAIR_QQ] = L_qq, [DVI__PAIR_QV] = L_qv, [DVI__PAIR_VV] = L_vv};
  return dvi__fault_check(term, 1, x, 1,
                          dvi__function_series(term->function, degree, x, L, gradient, values));
}

bool dvi__make_lagrangian(dvi_scene *scene, dvi__scene_term *term, dvi_lagrangian *lagrangian)
{
  int full;
  *lagrangian = (dvi_lagrangian){.value_batch = term_lagrangian_value,
                                 .gradient_batch = term_lagrangian_gradient,
                                 .hessian_batch = term_lagrangian_hessian,
                                 .rate_batch = term_lagrangian_rate,
                                 .taylor = term_lagrangian_taylor,
                                 .user = term};
  return prepare_large(scene, term, of_motion) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QQ, &lagrangian->qq, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QV, &lagrangian->qv, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_VV, &lagrangian->vv, &full);
}

/* ---- one-forms: alpha is the gradient of alpha(q).w by w ---- */

static int term_form_components(const double *q, const double *p, double *gradient_w, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {NULL, q, p, term->none};
  double *gradient[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = gradient_w};
  return gradient_at(term, 1, x, gradient);
}

int dvi__term_generator(const double *q, double *xi, void *user)
{
  return term_form_components(q, NULL, xi, user);
}

static int term_form_gradient(const double *q, double *alpha_q, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {NULL, q, NULL, term->none};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QW] = alpha_q};
  return second_at(term, 1, x, values);
}

static int term_form_hessian(const double *q, const double *w, double *alpha_w_qq, void *user)
{
  const double *x[DVI__BLOCKS] = {NULL, q, NULL, w};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QQ] = alpha_w_qq};
  return second_at(user, 1, x, values);
}

bool dvi__make_one_form(dvi_scene *scene, dvi__scene_term *term, dvi_one_form *form)
{
  int full;
  *form = (dvi_one_form){.value = dvi__term_generator,
                         .gradient = term_form_gradient,
                         .hessian = term_form_hessian,
                         .user = term};
  return prepare_large(scene, term, of_multipliers) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QW, &form->gradients, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QQ, &form->qq, &full);
}

/* ---- forces: F is the gradient of F(t,q,v).w by w, or that of -R by v ---- */

static int term_force_value(double t, const double *q, const double *v, double *F, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {&t, q, v, term->none, term->scene->inputs};
  double *gradient[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = F};
  return gradient_at(term, 1, x, gradient);
}

static int term_force_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                               void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {&t, q, v, term->none, term->scene->inputs};
  double *values[DVI__PAIRS] = {[DVI__PAIR_WQ] = F_q, [DVI__PAIR_WV] = F_v};
  return second_at(term, 1, x, values);
}

/* Return 1 if no velocity occurs in a function. */
static int is_without_velocity(const dvi__scene_term *term)
{
  for (int k = 0; k < dvi__function_kernel_count(term->function); k++) {
    const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
    for (int i = 0; i < kernel->input_count; i++)
      if (!kernel->input[i].is_data && kernel->input[i].block == DVI__VELOCITIES) return 0;
  }
  return 1;
}

bool dvi__make_force(dvi_scene *scene, dvi__scene_term *term, dvi_force *force)
{
  int full;
  *force = (dvi_force){.name = "forces",
                       .value = term_force_value,
                       /* with factors forces are differenced in the charts */
                       .jacobian = dvi__has_factors(scene) ? NULL : term_force_jacobian,
                       .without_velocity = is_without_velocity(term),
                       .user = term};
  return prepare_large(scene, term, of_multipliers) &&
         dvi__term_pattern(scene, term, DVI__PAIR_WQ, &force->by_q, &full) &&
         (force->without_velocity ||
          dvi__term_pattern(scene, term, DVI__PAIR_WV, &force->by_v, &full));
}

static int term_dissipation_value(int count, const double *t, const double *q, const double *v,
                                  double *F, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__VELOCITIES] = F};
  return gradient_at(user, count, x, gradient);
}

static int term_dissipation_jacobian(int count, const double *t, const double *q, const double *v,
                                     double *F_q, double *F_v, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, v, NULL};
  double *values[DVI__PAIRS] = {[DVI__PAIR_VQ] = F_q, [DVI__PAIR_VV] = F_v};
  return second_at(user, count, x, values);
}

bool dvi__make_dissipation(dvi_scene *scene, dvi__scene_term *term, dvi_force *force)
{
  int full;
  *force = (dvi_force){.name = "dissipation",
                       .value_batch = term_dissipation_value,
                       /* with factors forces are differenced in the charts */
                       .jacobian_batch = dvi__has_factors(scene) ? NULL : term_dissipation_jacobian,
                       .user = term};
  return prepare_large(scene, term, of_velocities) &&
         dvi__term_pattern(scene, term, DVI__PAIR_VQ, &force->by_q, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_VV, &force->by_v, &full);
}

/* ---- holonomic constraints: phi is the gradient of phi(t,q).w by w ---- */

static int term_holonomic_value(int points, const double *t, const double *q, double *phi,
                                void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {t, q, NULL, term->none};
  double *gradient[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = phi};
  return gradient_at(term, points, x, gradient);
}

static int term_holonomic_gradient(int points, const double *t, const double *q, double *phi_q,
                                   void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {t, q, NULL, term->none};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QW] = phi_q};
  return second_at(term, points, x, values);
}

static int term_holonomic_hessian(double t, const double *q, const double *w, double *phi_w_qq,
                                  void *user)
{
  const double *x[DVI__BLOCKS] = {&t, q, NULL, w};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QQ] = phi_w_qq};
  return second_at(user, 1, x, values);
}

/* The entries of the rate stand at the front, and move to their rows from the back. */
static int term_rate_of_rows(double t, const double *q, double *rows_t, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {&t, q, NULL, term->none};
  double *values[DVI__PAIRS] = {[DVI__PAIR_TW] = rows_t};
  const int returned = second_at(term, 1, x, values);
  for (int a = term->count - 1; a >= 0; a--)
    rows_t[a] = term->tw.start[a] < term->tw.start[a + 1] ? rows_t[term->tw.start[a]] : 0;
  return returned;
}

/* ---- nonholonomic constraints: A v + a is the gradient of (A v + a).w by w ---- */

static int term_nonholonomic_value(double t, const double *q, double *A, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {&t, q, term->none, term->none};
  double *values[DVI__PAIRS] = {[DVI__PAIR_VW] = A};
  return second_at(term, 1, x, values);
}

static int term_nonholonomic_affine(double t, const double *q, double *a, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {&t, q, term->none, term->none};
  double *gradient[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = a};
  return gradient_at(term, 1, x, gradient);
}

static int term_nonholonomic_derivative(double t, const double *q, const double *v, double *Av_q,
                                        void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {&t, q, v, term->none};
  double *values[DVI__PAIRS] = {[DVI__PAIR_WQ] = Av_q};
  return second_at(term, 1, x, values);
}

bool dvi__make_nonholonomic(dvi_scene *scene, const char *name, dvi__scene_term *term, bool affine,
                            dvi_nonholonomic *nonholonomic)
{
  int full;
  *nonholonomic = (dvi_nonholonomic){.name = name,
                                     .count = term->count,
                                     .value = term_nonholonomic_value,
                                     .affine = affine ? term_nonholonomic_affine : NULL,
                                     .derivative = term_nonholonomic_derivative,
                                     .user = term};
  return prepare_large(scene, term, of_multipliers) &&
         dvi__term_pattern(scene, term, DVI__PAIR_VW, &nonholonomic->transposed, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_WQ, &nonholonomic->by_q, &full);
}

/* ---- Hamiltonians with constraints ---- */

static int term_hamiltonian_gradient(double t, const double *q, const double *p, double *H_q,
                                     double *H_p, void *user)
{
  const double *x[DVI__BLOCKS] = {&t, q, p, NULL};
  double *gradient[DVI__BLOCKS] = {[DVI__COORDINATES] = H_q, [DVI__VELOCITIES] = H_p};
  return gradient_at(user, 1, x, gradient);
}

static int term_hamiltonian_hessian(double t, const double *q, const double *p, double *H_qq,
                                    double *H_qp, double *H_pp, void *user)
{
  const double *x[DVI__BLOCKS] = {&t, q, p, NULL};
  double *values[DVI__PAIRS] = {
      [DVI__PAIR_QQ] = H_qq, [DVI__PAIR_QV] = H_qp, [DVI__PAIR_VV] = H_pp};
  return second_at(user, 1, x, values);
}

bool dvi__make_hamiltonian(dvi_scene *scene, dvi__scene_term *term, dvi_hamiltonian *hamiltonian)
{
  int full;
  *hamiltonian = (dvi_hamiltonian){.value = dvi__term_value,
                                   .gradient = term_hamiltonian_gradient,
                                   .hessian = term_hamiltonian_hessian,
                                   .user = term};
  return prepare_large(scene, term, of_motion) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QQ, &hamiltonian->qq, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QV, &hamiltonian->qp, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_VV, &hamiltonian->pp, &full);
}

static void reverse_entries(double *first, double *end)
{
  for (; first < end; first++) {
    const double kept = *--end;
    *end = *first;
    *first = kept;
  }
}

/* Join the columns of d phi/dq and d phi/dp to columns of both. Each column of the latter moves in
 * front of the rest of the former. There is no memory but the result's. */
static void join_columns(int count, const int *q_start, const int *p_start, double *phi_z)
{
  double *to = phi_z;
  for (int a = 0; a < count; a++) {
    to += q_start[a + 1] - q_start[a];
    double *from = to + (q_start[count] - q_start[a + 1]),
           *end = from + (p_start[a + 1] - p_start[a]);
    reverse_entries(to, from);
    reverse_entries(from, end);
    reverse_entries(to, end);
    to += p_start[a + 1] - p_start[a];
  }
}

static int term_constraint_gradient(const double *q, const double *p, double *phi_z, void *user)
{
  dvi__scene_term *term = user;
  const double *x[DVI__BLOCKS] = {NULL, q, p, term->none};
  double *values[DVI__PAIRS] = {
      [DVI__PAIR_QW] = phi_z, [DVI__PAIR_VW] = phi_z + term->qw.start[term->count]};
  const int returned = second_at(term, 1, x, values);
  if (returned == 0) join_columns(term->count, term->qw.start, term->vw.start, phi_z);
  return returned;
}

static int term_constraint_hessian(const double *q, const double *p, const double *w, double *qq,
                                   double *qp, double *pp, void *user)
{
  const double *x[DVI__BLOCKS] = {NULL, q, p, w};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QQ] = qq, [DVI__PAIR_QV] = qp, [DVI__PAIR_VV] = pp};
  return second_at(user, 1, x, values);
}

/* Find a pattern of `rows` rows with its entries, even if it is full. */
static bool explicit_pattern(dvi_scene *scene, dvi__scene_term *term, int pair, int rows,
                             dvi_pattern *pattern)
{
  int full;
  if (!dvi__term_pattern(scene, term, pair, pattern, &full)) return false;
  if (!full) return true;
  const size_t n = (size_t)rows, columns = (size_t)term->count;
  int *start = dvi__arena_take(&scene->arena, columns + 1, sizeof *start),
      *row = dvi__arena_take(&scene->arena, n * columns, sizeof *row);
  if (start == NULL || row == NULL) return dvi__scene_no_memory(scene);
  for (size_t j = 0; j <= columns; j++) start[j] = (int)(j * n);
  for (size_t e = 0; e < n * columns; e++) row[e] = (int)(e % n);
  *pattern = (dvi_pattern){start, row};
  return true;
}

bool dvi__make_holonomic(dvi_scene *scene, const char *name, dvi__scene_term *term,
                         dvi_holonomic *holonomic)
{
  int full;
  *holonomic = (dvi_holonomic){.name = name,
                               .count = term->count,
                               .value_batch = term_holonomic_value,
                               .gradient_batch = term_holonomic_gradient,
                               .hessian = term_holonomic_hessian,
                               .user = term};
  term->none = dvi__arena_take(&scene->arena, (size_t)term->count * DVI_HOLONOMIC_POINTS,
                               sizeof *term->none);
  if (term->none == NULL) return dvi__scene_no_memory(scene);
  if (!prepare_large(scene, term, of_multipliers) ||
      !dvi__term_pattern(scene, term, DVI__PAIR_QW, &holonomic->gradients, &full) ||
      !dvi__term_pattern(scene, term, DVI__PAIR_QQ, &holonomic->qq, &full) ||
      !explicit_pattern(scene, term, DVI__PAIR_TW, 1, &term->tw))
    return false;
  if (term->tw.start[term->count] > 0) holonomic->rate = term_rate_of_rows;
  return true;
}

/* ---- vector potentials: A is the gradient of A(t,q).w by w, which w does not change ---- */

static int term_vector_value(int count, const double *t, const double *q, double *A, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, q};
  double *gradient[DVI__BLOCKS] = {[DVI__MULTIPLIERS] = A};
  return gradient_at(user, count, x, gradient);
}

static int term_vector_gradient(int count, const double *t, const double *q, double *A_q,
                                void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, q};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QW] = A_q};
  return second_at(user, count, x, values);
}

static int term_vector_hessian(int count, const double *t, const double *q, const double *w,
                               double *A_w_qq, void *user)
{
  const double *x[DVI__BLOCKS] = {t, q, NULL, w};
  double *values[DVI__PAIRS] = {[DVI__PAIR_QQ] = A_w_qq};
  return second_at(user, count, x, values);
}

bool dvi__make_vector_potential(dvi_scene *scene, dvi__scene_term *term, dvi_vector_potential *A)
{
  int full;
  *A = (dvi_vector_potential){.value_batch = term_vector_value,
                              .gradient_batch = term_vector_gradient,
                              .hessian_batch = term_vector_hessian,
                              .rate = term_rate_of_rows,
                              .user = term};
  return prepare_large(scene, term, of_multipliers) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QW, &A->gradients, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QQ, &A->qq, &full) &&
         explicit_pattern(scene, term, DVI__PAIR_TW, 1, &term->tw);
}

/* ---- contacts ---- */

static int term_tangent(double t, const double *q, double *T, void *user)
{
  dvi__scene_term *const term = ((dvi__scene_term *)user)->beside;
  const double *x[DVI__BLOCKS] = {&t, q, term->none, term->none};
  double *values[DVI__PAIRS] = {[DVI__PAIR_VW] = T};
  return second_at(term, 1, x, values);
}

static int term_gap(double t, const double *q, double *phi, void *user)
{
  return term_holonomic_value(1, &t, q, phi, user);
}

static int term_gap_gradient(double t, const double *q, double *phi_q, void *user)
{
  return term_holonomic_gradient(1, &t, q, phi_q, user);
}

bool dvi__make_contact(dvi_scene *scene, dvi__scene_term *gap, dvi__scene_term *tangent,
                       dvi_contact *contact)
{
  dvi_holonomic phi;
  int full;
  if (!dvi__make_holonomic(scene, contact->name, gap, &phi)) return false;
  contact->gap = term_gap;
  contact->gradient = term_gap_gradient;
  contact->rate = phi.rate;
  contact->gradients = phi.gradients;
  contact->user = gap;
  gap->beside = tangent;
  if (tangent == NULL) return true;
  contact->tangent = term_tangent;
  contact->tangent_count = tangent->count;
  return prepare_large(scene, tangent, of_multipliers) &&
         dvi__term_pattern(scene, tangent, DVI__PAIR_VW, &contact->tangents, &full);
}

/* Join the gradients' patterns. Each column has the rows of q, then those of p. */
static bool join_patterns(dvi_scene *scene, const dvi__scene_term *term, dvi_pattern *joined)
{
  const int count = term->count, *q_start = term->qw.start, *p_start = term->vw.start;
  const size_t entries = (size_t)q_start[count] + (size_t)p_start[count];
  int *start = dvi__arena_take(&scene->arena, (size_t)count + 1, sizeof *start),
      *row = dvi__arena_take(&scene->arena, entries + 1, sizeof *row);
  if (start == NULL || row == NULL) return dvi__scene_no_memory(scene);
  int at = 0;
  for (int a = 0; a < count; a++) {
    start[a] = at;
    for (int e = q_start[a]; e < q_start[a + 1]; e++) row[at++] = term->qw.row[e];
    for (int e = p_start[a]; e < p_start[a + 1]; e++) row[at++] = term->n + term->vw.row[e];
  }
  start[count] = at;
  *joined = (dvi_pattern){start, row};
  return true;
}

bool dvi__make_constraint(dvi_scene *scene, dvi__scene_term *term, dvi_constraint *constraint)
{
  int full;
  *constraint = (dvi_constraint){.count = term->count,
                                 .value = term_form_components,
                                 .gradient = term_constraint_gradient,
                                 .hessian = term_constraint_hessian,
                                 .user = term};
  return prepare_large(scene, term, of_multipliers) &&
         explicit_pattern(scene, term, DVI__PAIR_QW, term->n, &term->qw) &&
         explicit_pattern(scene, term, DVI__PAIR_VW, term->n, &term->vw) &&
         join_patterns(scene, term, &constraint->gradients) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QQ, &constraint->qq, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_QV, &constraint->qp, &full) &&
         dvi__term_pattern(scene, term, DVI__PAIR_VV, &constraint->pp, &full);
}
