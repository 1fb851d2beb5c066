/* The callbacks of a system's terms, on functions of a scene. `user` is a dvi__scene_term. */
#ifndef DVI_SCENE_TERMS_CALLBACKS_H
#define DVI_SCENE_TERMS_CALLBACKS_H
#include "scene/elaborate/kernels.h"

/* Fill in a term with its callbacks, patterns and user pointer. Rates are there only if the system
 * depends on time. */
bool dvi__make_potential(dvi_scene *scene, const char *name, dvi__scene_term *term,
                         dvi_potential *potential);
bool dvi__make_lagrangian(dvi_scene *scene, dvi__scene_term *term, dvi_lagrangian *lagrangian);
/* Fill in a one-form with the function alpha(q).w. */
bool dvi__make_one_form(dvi_scene *scene, dvi__scene_term *term, dvi_one_form *form);
/* Fill in a vector potential with the function A(t,q).w. */
bool dvi__make_vector_potential(dvi_scene *scene, dvi__scene_term *term, dvi_vector_potential *A);
bool dvi__make_hamiltonian(dvi_scene *scene, dvi__scene_term *term, dvi_hamiltonian *hamiltonian);
/* Fill in constraints with the function phi(q,p).w, w [term->count]. */
bool dvi__make_constraint(dvi_scene *scene, dvi__scene_term *term, dvi_constraint *constraint);

/* Make the values of the block of inputs, and room for callbacks that work on them. */
bool dvi__make_inputs(dvi_scene *scene);

/* Add factor times the second derivatives of a pair, `columns` columns from `first` on, to a matrix
 * with as many rows as there are coordinates, by columns. Returns as callbacks do. Call
 * dvi__make_inputs before. */
int dvi__term_add_matrix(dvi__scene_term *term, int pair, const double *const *x, double factor,
                         int first, int columns, double *to);

/* Give the derivatives by parameters of a scene that was read by dvi__read_dependence, and those of
 * its start, [n * parameters] each. matrix [n*n] and by_v [n * parameters] are work. Make the
 * callbacks of its objective (dependence.c). */
dvi_dependence dvi__scene_dependence(dvi_scene *scene);
int dvi__scene_start_tangent(const dvi_scene *scene, double *by_q, double *by_p, double *matrix,
                             double *by_v);
bool dvi__make_objective(dvi_scene *scene);

/* Let the controls of the scene act by the function F(t,q,v,u).w (controls.c). */
bool dvi__make_control_force(dvi_scene *scene, dvi__scene_term *term);
/* Let the controls cost what the function C(t,q,v,u) says. */
bool dvi__make_control_cost(dvi_scene *scene, dvi__scene_term *term);

/* Fill in holonomic constraints with the function phi(t,q).w, w [term->count]. Rates are there only
 * if phi depends on time. */
bool dvi__make_nonholonomic(dvi_scene *scene, const char *name, dvi__scene_term *term, bool affine,
                            dvi_nonholonomic *nonholonomic);
bool dvi__make_holonomic(dvi_scene *scene, const char *name, dvi__scene_term *term,
                         dvi_holonomic *holonomic);

/* Fill in the callbacks of a contact with the gap as such a function phi(t,q).w of one row, and the
 * slip T(t,q,v).w, which is linear in v. The latter may be NULL. */
bool dvi__make_contact(dvi_scene *scene, dvi__scene_term *gap, dvi__scene_term *tangent,
                       dvi_contact *contact);

/* Fill in a force with the function F(t,q,v).w, or with minus the function R, of which the force is
 * the derivative by v. */
bool dvi__make_force(dvi_scene *scene, dvi__scene_term *term, dvi_force *force);
bool dvi__make_dissipation(dvi_scene *scene, dvi__scene_term *term, dvi_force *force);

/* Evaluate a generator with the function xi(q).w. dvi__term_value evaluates one number. */
int dvi__term_generator(const double *q, double *xi, void *user);
int dvi__term_value(double t, const double *q, const double *velocity_or_momentum, double *value,
                    void *user);

/* Find a pattern of a function. Complains if there is none. */
bool dvi__term_pattern(dvi_scene *scene, dvi__scene_term *term, int pair, dvi_pattern *pattern,
                       int *full);

#endif
