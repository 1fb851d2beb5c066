/* The kinds of terms, with the names of their callbacks and patterns. */
#include <stdio.h>

#include "scene/emit/emit_scene.h"

#define BATCH "int count, const double *t, const double *q"
#define POINT "double t, const double *q"
#define ONLY(number) \
  {                  \
    [number] = 1     \
  }
#define SECOND                                                 \
  {                                                            \
    [DVI__PAIR_QQ] = 1, [DVI__PAIR_QV] = 1, [DVI__PAIR_VV] = 1 \
  }
#define MOTION                                    \
  {                                               \
    [DVI__COORDINATES] = 1, [DVI__VELOCITIES] = 1 \
  }

static const dvi_pattern none; /* of a term that lacks one */

enum { RATE = 3 }; /* the callback that only systems with time have */

static const dvi__callback potential_callbacks[] = {
    {"value_batch", BATCH ", double *V", "count, t, q, NULL, NULL, V", 'v', {0}},
    {"gradient_batch", BATCH ", double *V_q", "count, t, q, NULL, NULL, V_q", 'g',
     ONLY(DVI__COORDINATES)},
    {"hessian_batch", BATCH ", double *V_qq", "count, t, q, NULL, NULL, V_qq", 's',
     ONLY(DVI__PAIR_QQ)},
    {"rate_batch", BATCH ", double *V_t", "count, t, q, NULL, NULL, V_t", 'g', ONLY(DVI__TIME)},
};

static const dvi__callback lagrangian_callbacks[] = {
    {"value_batch", BATCH ", const double *v, double *L", "count, t, q, v, NULL, L", 'v', {0}},
    {"gradient_batch", BATCH ", const double *v, double *L_q, double *L_v",
     "count, t, q, v, NULL, L_q, L_v", 'g', MOTION},
    {"hessian_batch", BATCH ", const double *v, double *L_qq, double *L_qv, double *L_vv",
     "count, t, q, v, NULL, L_qq, L_qv, L_vv", 's', SECOND},
    {"rate_batch", BATCH ", const double *v, double *L_t", "count, t, q, v, NULL, L_t", 'g',
     ONLY(DVI__TIME)},
};

static const dvi__callback form_callbacks[] = {
    {"value", "const double *q, double *alpha", "1, NULL, q, NULL, dvi_zeros, alpha", 'g',
     ONLY(DVI__MULTIPLIERS)},
    {"gradient", "const double *q, double *alpha_q", "1, NULL, q, NULL, dvi_zeros, alpha_q", 's',
     ONLY(DVI__PAIR_QW)},
    {"hessian", "const double *q, const double *w, double *alpha_w_qq",
     "1, NULL, q, NULL, w, alpha_w_qq", 's', ONLY(DVI__PAIR_QQ)},
};

/* The derivatives by w do not depend on w, which is q here. */
static const dvi__callback vector_callbacks[] = {
    {"value_batch", BATCH ", double *A", "count, t, q, NULL, q, A", 'g', ONLY(DVI__MULTIPLIERS)},
    {"gradient_batch", BATCH ", double *A_q", "count, t, q, NULL, q, A_q", 's', ONLY(DVI__PAIR_QW)},
    {"hessian_batch", BATCH ", const double *w, double *A_w_qq", "count, t, q, NULL, w, A_w_qq",
     's', ONLY(DVI__PAIR_QQ)},
    {"rate", POINT ", double *A_t", "1, &t, q, NULL, w, A_t + a", 't', ONLY(DVI__TIME)},
};

static const dvi__callback hamiltonian_callbacks[] = {
    {"value", POINT ", const double *p, double *H", "1, &t, q, p, NULL, H", 'v', {0}},
    {"gradient", POINT ", const double *p, double *H_q, double *H_p", "1, &t, q, p, NULL, H_q, H_p",
     'g', MOTION},
    {"hessian", POINT ", const double *p, double *H_qq, double *H_qp, double *H_pp",
     "1, &t, q, p, NULL, H_qq, H_qp, H_pp", 's', SECOND},
};

static const dvi__callback constraint_callbacks[] = {
    {"value", "const double *q, const double *p, double *phi", "1, NULL, q, p, dvi_zeros, phi", 'g',
     ONLY(DVI__MULTIPLIERS)},
    {"gradient",
     "const double *q, const double *p, double *phi_z",
     "1, NULL, q, p, dvi_zeros",
     'c',
     {[DVI__PAIR_QW] = 1, [DVI__PAIR_VW] = 1}},
    {"hessian",
     "const double *q, const double *p, const double *w, double *qq, double *qp, double *pp",
     "1, NULL, q, p, w, qq, qp, pp", 's', SECOND},
};

static const dvi__callback holonomic_callbacks[] = {
    {"value", POINT ", double *phi", "1, &t, q, NULL, dvi_zeros, phi", 'g', ONLY(DVI__MULTIPLIERS)},
    {"gradient", POINT ", double *phi_q", "1, &t, q, NULL, dvi_zeros, phi_q", 's',
     ONLY(DVI__PAIR_QW)},
    {"hessian", POINT ", const double *w, double *phi_w_qq", "1, &t, q, NULL, w, phi_w_qq", 's',
     ONLY(DVI__PAIR_QQ)},
    {"rate", POINT ", double *phi_t", "1, &t, q, NULL, w, phi_t + a", 't', ONLY(DVI__TIME)},
};

static const dvi__callback nonholonomic_callbacks[] = {
    {"value", POINT ", double *A", "1, &t, q, dvi_zeros, dvi_zeros, A", 's', ONLY(DVI__PAIR_VW)},
    {"derivative", POINT ", const double *v, double *Av_q", "1, &t, q, v, dvi_zeros, Av_q", 's',
     ONLY(DVI__PAIR_WQ)},
    {"affine", POINT ", double *a", "1, &t, q, dvi_zeros, dvi_zeros, a", 'g',
     ONLY(DVI__MULTIPLIERS)},
};

static const dvi__callback force_callbacks[] = {
    {"value", POINT ", const double *v, double *F", "1, &t, q, v, dvi_zeros, F", 'g',
     ONLY(DVI__MULTIPLIERS)},
    {"jacobian",
     POINT ", const double *v, double *F_q, double *F_v",
     "1, &t, q, v, dvi_zeros, F_q, F_v",
     's',
     {[DVI__PAIR_WQ] = 1, [DVI__PAIR_WV] = 1}},
};

static const dvi__callback dissipation_callbacks[] = {
    {"value_batch", BATCH ", const double *v, double *F", "count, t, q, v, NULL, F", 'g',
     ONLY(DVI__VELOCITIES)},
    {"jacobian_batch",
     BATCH ", const double *v, double *F_q, double *F_v",
     "count, t, q, v, NULL, F_v, F_q",
     's',
     {[DVI__PAIR_VQ] = 1, [DVI__PAIR_VV] = 1}},
};

static const dvi__callback symmetry_callback = {"generator", "const double *q, double *xi",
                                                "1, NULL, q, NULL, dvi_zeros, xi", 'g',
                                                ONLY(DVI__MULTIPLIERS)};
static const dvi__callback invariant_callback = {
    "value", POINT ", const double *p, double *I", "1, &t, q, p, NULL, I", 'v', {0}};
static const dvi__callback event_callback = {
    "value", POINT ", const double *v, double *g", "1, &t, q, v, NULL, g", 'v', {0}};

dvi__emitted_term dvi__lagrangian_term(const dvi_scene *scene)
{
  const dvi_lagrangian *L = &scene->lagrangian;
  return (dvi__emitted_term){.type = "dvi_lagrangian",
                             .name = "lagrangian",
                             .term = L->user,
                             .callback_count = RATE + !scene->terms.autonomous,
                             .callback = lagrangian_callbacks,
                             .columns = scene->n,
                             .pattern_name = {"qq", "qv", "vv"},
                             .pattern = {&L->qq, &L->qv, &L->vv}};
}

dvi__emitted_term dvi__one_form_term(const dvi_scene *scene)
{
  const dvi_one_form *form = &scene->one_form;
  return (dvi__emitted_term){.type = "dvi_one_form",
                             .name = "one_form",
                             .term = form->user,
                             .callback_count = 3,
                             .callback = form_callbacks,
                             .columns = scene->n,
                             .pattern_name = {"gradients", "qq"},
                             .pattern = {&form->gradients, &form->qq}};
}

dvi__emitted_term dvi__vector_term_of(const dvi_scene *scene)
{
  const dvi_vector_potential *A = &scene->vector_potential;
  return (dvi__emitted_term){.type = "dvi_vector_potential",
                             .name = "vector_potential",
                             .term = A->user,
                             .callback_count = RATE + !scene->terms.autonomous,
                             .callback = vector_callbacks,
                             .columns = scene->n,
                             .pattern_name = {"gradients", "qq"},
                             .pattern = {&A->gradients, &A->qq}};
}

dvi__emitted_term dvi__hamiltonian_term(const dvi_scene *scene)
{
  const dvi_hamiltonian *H = &scene->hamiltonian;
  return (dvi__emitted_term){.type = "dvi_hamiltonian",
                             .name = "hamiltonian",
                             .term = H->user,
                             .callback_count = 3,
                             .callback = hamiltonian_callbacks,
                             .columns = scene->n,
                             .pattern_name = {"qq", "qp", "pp"},
                             .pattern = {&H->qq, &H->qp, &H->pp}};
}

dvi__emitted_term dvi__constraint_term(const dvi_scene *scene)
{
  const dvi_constraint *phi = &scene->constraint;
  return (dvi__emitted_term){.type = "dvi_constraint",
                             .name = "constraint",
                             .term = phi->user,
                             .callback_count = 3,
                             .callback = constraint_callbacks,
                             .columns = scene->n,
                             .pattern_name = {"qq", "qp", "pp", "gradients"},
                             .pattern = {&phi->qq, &phi->qp, &phi->pp, &phi->gradients}};
}

static dvi__emitted_term potential_term_of(const dvi_scene *scene, const dvi_potential *V,
                                           const char *name, int k)
{
  dvi__emitted_term term = {.type = "dvi_potential",
                            .shown = V->name,
                            .term = V->user,
                            .callback_count = RATE + (V->rate_batch != NULL),
                            .callback = potential_callbacks,
                            .columns = scene->n,
                            .pattern_name = {"qq"},
                            .pattern = {&V->qq},
                            .fast = V->fast,
                            .quadratic = V->quadratic};
  (void)snprintf(term.name, sizeof term.name, "%s_%d", name, k);
  return term;
}

dvi__emitted_term dvi__potential_term(const dvi_scene *scene, int k)
{
  return potential_term_of(scene, &scene->terms.potentials[k], "potential", k);
}

dvi__emitted_term dvi__noise_function_term(const dvi_scene *scene, int k)
{
  return potential_term_of(scene, &scene->noise.functions[k], "noise_function", k);
}

dvi__emitted_term dvi__holonomic_term_of(const dvi_scene *scene, int k)
{
  const dvi_holonomic *phi = &scene->holonomics[k];
  dvi__emitted_term term = {.type = "dvi_holonomic",
                            .shown = phi->name,
                            .term = phi->user,
                            .callback_count = 3 + (phi->rate != NULL),
                            .callback = holonomic_callbacks,
                            .columns = scene->n,
                            .pattern_name = {"qq", "", "", "gradients"},
                            .pattern = {&phi->qq, &none, &none, &phi->gradients}};
  (void)snprintf(term.name, sizeof term.name, "holonomic_%d", k);
  return term;
}

dvi__emitted_term dvi__nonholonomic_term_of(const dvi_scene *scene, int k)
{
  const dvi_nonholonomic *A = &scene->nonholonomics[k];
  dvi__emitted_term term = {.type = "dvi_nonholonomic",
                            .shown = A->name,
                            .term = A->user,
                            .callback_count = 2 + (A->affine != NULL),
                            .callback = nonholonomic_callbacks,
                            .columns = scene->n,
                            .pattern_name = {"by_q", "", "", "transposed"},
                            .pattern = {&A->by_q, &none, &none, &A->transposed}};
  (void)snprintf(term.name, sizeof term.name, "nonholonomic_%d", k);
  return term;
}

dvi__emitted_term dvi__force_term_of(const dvi_scene *scene, int k)
{
  const dvi_force *F = &scene->force[k];
  const int of_dissipation = F->value_batch != NULL;
  dvi__emitted_term term = {.type = "dvi_force",
                            .shown = F->name,
                            .term = F->user,
                            .callback_count = 1 +
                                              (F->jacobian_batch != NULL || F->jacobian != NULL),
                            .callback = of_dissipation ? dissipation_callbacks : force_callbacks,
                            .columns = scene->n,
                            .velocity_columns = scene->nv,
                            .pattern_name = {"by_q", "by_v"},
                            .pattern = {&F->by_q, F->without_velocity ? NULL : &F->by_v},
                            .without_velocity = F->without_velocity};
  (void)snprintf(term.name, sizeof term.name, "force_%d", k);
  return term;
}

/* Describe a term that has one callback and a name. */
static dvi__emitted_term watched_term(const char *type, const char *kind, int k, const char *shown,
                                      const dvi__scene_term *of, const dvi__callback *callback)
{
  dvi__emitted_term term = {
      .type = type, .shown = shown, .term = of, .callback_count = 1, .callback = callback};
  (void)snprintf(term.name, sizeof term.name, "%s_%d", kind, k);
  return term;
}

dvi__emitted_term dvi__symmetry_term(const dvi_scene *scene, int k)
{
  const dvi_symmetry *symmetry = &scene->terms.symmetries[k];
  return watched_term("dvi_symmetry", "symmetry", k, symmetry->name, symmetry->user,
                      &symmetry_callback);
}

dvi__emitted_term dvi__invariant_term(const dvi_scene *scene, int k)
{
  const dvi_invariant *invariant = &scene->terms.invariants[k];
  return watched_term("dvi_invariant", "invariant", k, invariant->name, invariant->user,
                      &invariant_callback);
}

dvi__emitted_term dvi__event_term(const dvi_scene *scene, int k)
{
  const dvi_scene_event *event = &scene->event[k];
  return watched_term("dvi_event", "event", k, event->name, event->user, &event_callback);
}
