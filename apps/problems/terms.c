/* The terms of a problem's system, which are kept with the problem, and their one-point shapes. */
#include "entry.h"

/* Copy an array into the problem's memory. NULL for an empty array. */
static void *keep_array(problem *made, const void *array, int count, size_t size, int *lost)
{
  if (count == 0) return NULL;
  void *copy = problem_allocate(made, (size_t)count, size);
  if (copy)
    memcpy(copy, array, (size_t)count * size);
  else
    *lost = 1;
  return copy;
}

/* Keep the struct and the arrays of terms. All that these point to belongs to the problem
 * anyway. */
static dvi_system_terms *keep_terms(problem *made, const dvi_system_terms *terms)
{
  int lost = 0;
  dvi_system_terms *kept = keep_array(made, terms, 1, sizeof *terms, &lost);
  if (!kept) return NULL;
  kept->lagrangian = keep_array(made, terms->lagrangian, terms->lagrangian != NULL,
                                sizeof *terms->lagrangian, &lost);
  kept->vector_potential = keep_array(made, terms->vector_potential,
                                      terms->vector_potential != NULL,
                                      sizeof *terms->vector_potential, &lost);
  kept->one_form = keep_array(made, terms->one_form, terms->one_form != NULL,
                              sizeof *terms->one_form, &lost);
  kept->hamiltonian = keep_array(made, terms->hamiltonian, terms->hamiltonian != NULL,
                                 sizeof *terms->hamiltonian, &lost);
  kept->constraint = keep_array(made, terms->constraint, terms->constraint != NULL,
                                sizeof *terms->constraint, &lost);
  kept->potentials = keep_array(made, terms->potentials, terms->potential_count,
                                sizeof *terms->potentials, &lost);
  kept->forces = keep_array(made, terms->forces, terms->force_count, sizeof *terms->forces, &lost);
  kept->holonomics = keep_array(made, terms->holonomics, terms->holonomic_count,
                                sizeof *terms->holonomics, &lost);
  kept->nonholonomics = keep_array(made, terms->nonholonomics, terms->nonholonomic_count,
                                   sizeof *terms->nonholonomics, &lost);
  kept->noise = keep_array(made, terms->noise, terms->noise != NULL, sizeof *terms->noise, &lost);
  kept->symmetries = keep_array(made, terms->symmetries, terms->symmetry_count,
                                sizeof *terms->symmetries, &lost);
  kept->factors = keep_array(made, terms->factors, terms->factor_count, sizeof *terms->factors,
                             &lost);
  kept->invariants = keep_array(made, terms->invariants, terms->invariant_count,
                                sizeof *terms->invariants, &lost);
  return lost ? NULL : kept;
}

dvi_status problem_system(problem *made, const dvi_system_terms *terms)
{
  made->terms = keep_terms(made, terms);
  return made->terms ? dvi_system_create(made->terms, &made->system) : DVI_NO_MEMORY;
}

dvi_status problem_potential_system(problem *made, int count, const dvi_potential *potentials)
{
  const dvi_system_terms terms = {.dimension = made->nq,
                                  .mass = {.scalar = 1.0},
                                  .potentials = potentials,
                                  .potential_count = count,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

dvi_status problem_one_form_system(problem *made, const dvi_one_form *form,
                                   const dvi_potential *hamiltonian, int symmetry_count,
                                   const dvi_symmetry *symmetries)
{
  const dvi_system_terms terms = {.dimension = made->nq,
                                  .one_form = form,
                                  .potentials = hamiltonian,
                                  .potential_count = 1,
                                  .symmetries = symmetries,
                                  .symmetry_count = symmetry_count,
                                  .autonomous = 1};
  return problem_system(made, &terms);
}

/* One-point callbacks, whose `user` is the declared term, and which hand it their point as a batch
 * of one. Ranges are of one point anyway. */

static int one_point_value(double t, const double *q, double *V, void *user)
{
  const dvi_potential *own = user;
  return own->value_batch ? own->value_batch(1, &t, q, V, own->user)
                          : own->value(t, q, V, own->user);
}

static int one_point_gradient(double t, const double *q, double *V_q, void *user)
{
  const dvi_potential *own = user;
  return own->gradient_batch ? own->gradient_batch(1, &t, q, V_q, own->user)
                             : own->gradient(t, q, V_q, own->user);
}

static int one_point_gradient_range(double t, const double *q, int first, int last, double *V_q,
                                    void *user)
{
  const dvi_potential *own = user;
  return own->gradient_range(t, q, first, last, V_q, own->user);
}

static int one_point_hessian(double t, const double *q, double *V_qq, void *user)
{
  const dvi_potential *own = user;
  return own->hessian_batch ? own->hessian_batch(1, &t, q, V_qq, own->user)
                            : own->hessian(t, q, V_qq, own->user);
}

static int one_point_lagrangian_value(double t, const double *q, const double *v, double *L,
                                      void *user)
{
  const dvi_lagrangian *own = user;
  return own->value_batch ? own->value_batch(1, &t, q, v, L, own->user)
                          : own->value(t, q, v, L, own->user);
}

static int one_point_lagrangian_gradient(double t, const double *q, const double *v, double *L_q,
                                         double *L_v, void *user)
{
  const dvi_lagrangian *own = user;
  return own->gradient_batch ? own->gradient_batch(1, &t, q, v, L_q, L_v, own->user)
                             : own->gradient(t, q, v, L_q, L_v, own->user);
}

static int one_point_lagrangian_hessian(double t, const double *q, const double *v, double *L_qq,
                                        double *L_qv, double *L_vv, void *user)
{
  const dvi_lagrangian *own = user;
  return own->hessian_batch ? own->hessian_batch(1, &t, q, v, L_qq, L_qv, L_vv, own->user)
                            : own->hessian(t, q, v, L_qq, L_qv, L_vv, own->user);
}

static int one_point_rate(double t, const double *q, double *V_t, void *user)
{
  const dvi_potential *own = user;
  return own->rate_batch ? own->rate_batch(1, &t, q, V_t, own->user)
                         : own->rate(t, q, V_t, own->user);
}

static int one_point_lagrangian_rate(double t, const double *q, const double *v, double *L_t,
                                     void *user)
{
  const dvi_lagrangian *own = user;
  return own->rate_batch ? own->rate_batch(1, &t, q, v, L_t, own->user)
                         : own->rate(t, q, v, L_t, own->user);
}

static int one_point_taylor(int degree, const double *t, const double *q, double *V, double *V_q,
                            double *V_qq, void *user)
{
  const dvi_potential *own = user;
  return own->taylor(degree, t, q, V, V_q, V_qq, own->user);
}

static int one_point_lagrangian_taylor(int degree, const double *t, const double *q,
                                       const double *v, double *L, double *L_q, double *L_v,
                                       double *L_qq, double *L_qv, double *L_vv, void *user)
{
  const dvi_lagrangian *own = user;
  return own->taylor(degree, t, q, v, L, L_q, L_v, L_qq, L_qv, L_vv, own->user);
}

static int one_point_force(double t, const double *q, const double *v, double *F, void *user)
{
  const dvi_force *own = user;
  return own->value_batch ? own->value_batch(1, &t, q, v, F, own->user)
                          : own->value(t, q, v, F, own->user);
}

static int one_point_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                              void *user)
{
  const dvi_force *own = user;
  return own->jacobian_batch ? own->jacobian_batch(1, &t, q, v, F_q, F_v, own->user)
                             : own->jacobian(t, q, v, F_q, F_v, own->user);
}

static dvi_force one_point_force_of(const dvi_force *declared)
{
  return (dvi_force){.name = declared->name,
                     .value = one_point_force,
                     .jacobian = declared->jacobian || declared->jacobian_batch ? one_point_jacobian
                                                                                : NULL,
                     .by_q = declared->by_q,
                     .by_v = declared->by_v,
                     .without_velocity = declared->without_velocity,
                     .user = (void *)declared};
}

static int one_point_rows(double t, const double *q, double *phi, void *user)
{
  const dvi_holonomic *own = user;
  return own->value_batch ? own->value_batch(1, &t, q, phi, own->user)
                          : own->value(t, q, phi, own->user);
}

static int one_point_row_gradients(double t, const double *q, double *phi_q, void *user)
{
  const dvi_holonomic *own = user;
  return own->gradient_batch ? own->gradient_batch(1, &t, q, phi_q, own->user)
                             : own->gradient(t, q, phi_q, own->user);
}

static int one_point_row_hessian(double t, const double *q, const double *w, double *phi_w_qq,
                                 void *user)
{
  const dvi_holonomic *own = user;
  return own->hessian(t, q, w, phi_w_qq, own->user);
}

static int one_point_row_rate(double t, const double *q, double *phi_t, void *user)
{
  const dvi_holonomic *own = user;
  return own->rate(t, q, phi_t, own->user);
}

static dvi_holonomic one_point_holonomic(const dvi_holonomic *declared)
{
  dvi_holonomic made = *declared;
  made.value = one_point_rows;
  made.gradient = one_point_row_gradients;
  made.value_batch = NULL;
  made.gradient_batch = NULL;
  made.hessian = declared->hessian ? one_point_row_hessian : NULL;
  made.rate = declared->rate ? one_point_row_rate : NULL;
  made.user = (void *)declared;
  return made;
}

static dvi_potential one_point_potential(const dvi_potential *declared)
{
  return (dvi_potential){
      .name = declared->name,
      .value = one_point_value,
      .gradient = declared->gradient || declared->gradient_batch ? one_point_gradient : NULL,
      .hessian = declared->hessian || declared->hessian_batch ? one_point_hessian : NULL,
      .qq = declared->qq,
      .gradient_range = declared->gradient_range ? one_point_gradient_range : NULL,
      .reach = declared->reach,
      .rate = declared->rate || declared->rate_batch ? one_point_rate : NULL,
      .user = (void *)declared,
      .fast = declared->fast,
      .quadratic = declared->quadratic,
      .taylor = declared->taylor ? one_point_taylor : NULL};
}

static dvi_lagrangian one_point_lagrangian(const dvi_lagrangian *declared)
{
  return (dvi_lagrangian){
      .value = one_point_lagrangian_value,
      .gradient = declared->gradient || declared->gradient_batch ? one_point_lagrangian_gradient
                                                                 : NULL,
      .hessian = declared->hessian || declared->hessian_batch ? one_point_lagrangian_hessian : NULL,
      .qq = declared->qq,
      .qv = declared->qv,
      .vv = declared->vv,
      .rate = declared->rate || declared->rate_batch ? one_point_lagrangian_rate : NULL,
      .user = (void *)declared,
      .taylor = declared->taylor ? one_point_lagrangian_taylor : NULL};
}

dvi_status problem_one_point(problem *made)
{
  int lost = 0;
  dvi_system_terms terms = *made->terms;
  dvi_potential *potentials = keep_array(made, terms.potentials, terms.potential_count,
                                         sizeof *potentials, &lost);
  dvi_force *forces = keep_array(made, terms.forces, terms.force_count, sizeof *forces, &lost);
  dvi_holonomic *holonomics = keep_array(made, terms.holonomics, terms.holonomic_count,
                                         sizeof *holonomics, &lost);
  if (lost) return DVI_NO_MEMORY;
  for (int k = 0; k < terms.holonomic_count; k++)
    holonomics[k] = one_point_holonomic(&made->terms->holonomics[k]);
  for (int k = 0; k < terms.potential_count; k++)
    potentials[k] = one_point_potential(&made->terms->potentials[k]);
  for (int k = 0; k < terms.force_count; k++)
    forces[k] = one_point_force_of(&made->terms->forces[k]);
  terms.potentials = potentials;
  terms.forces = forces;
  terms.holonomics = holonomics;
  dvi_lagrangian lagrangian;
  if (terms.lagrangian) {
    lagrangian = one_point_lagrangian(terms.lagrangian);
    terms.lagrangian = &lagrangian;
  }
  const dvi_system_terms *declared = made->terms;
  dvi_system *batches = made->system;
  const dvi_status status = problem_system(made, &terms);
  if (status == DVI_OK) {
    dvi_system_destroy(&batches);
    return DVI_OK;
  }
  made->terms = declared;
  made->system = batches;
  return status;
}
