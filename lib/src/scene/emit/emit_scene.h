/* Terms of a scene as C, for the scene's file. */
#ifndef DVI_SCENE_EMIT_EMIT_SCENE_H
#define DVI_SCENE_EMIT_EMIT_SCENE_H
#include "scene/emit/emit.h"
#include "scene/elaborate/model.h"

/* A callback with its name, its parameters but `user`, and the arguments of its function. `asks` is
 * 'v' for the value, 'g' for the gradient by the wanted blocks, or 's' for the second derivatives
 * of the wanted pairs. 'c' asks for gradients of constraints, which have two of these, and 't' for
 * the gradient by time of each row of constraints. */
typedef struct dvi__callback {
  const char *name, *parameters, *arguments;
  char asks;
  char wanted[DVI__PAIRS]; /* 1 for each wanted block or pair */
} dvi__callback;

/* A term as an object, static const TYPE NAME, or one of a list. */
typedef struct dvi__emitted_term {
  const char *type;
  char name[32];
  const char *shown; /* name in tables, or NULL */
  const dvi__scene_term *term;
  int callback_count;
  const dvi__callback *callback;
  int columns;          /* columns of patterns */
  int velocity_columns; /* those of the second one, if they are others (default 0) */
  const char *pattern_name[4];
  const dvi_pattern *pattern[4]; /* patterns up to the first NULL */
  int fast, quadratic;           /* for potentials */
  int without_velocity;          /* for forces */
} dvi__emitted_term;

/* Describe the terms. */
dvi__emitted_term dvi__lagrangian_term(const dvi_scene *scene);
dvi__emitted_term dvi__one_form_term(const dvi_scene *scene);
dvi__emitted_term dvi__vector_term_of(const dvi_scene *scene);
dvi__emitted_term dvi__hamiltonian_term(const dvi_scene *scene);
dvi__emitted_term dvi__constraint_term(const dvi_scene *scene);
dvi__emitted_term dvi__potential_term(const dvi_scene *scene, int k);
dvi__emitted_term dvi__noise_function_term(const dvi_scene *scene, int k);
/* Return the name of a kind of factors in C. */
const char *dvi__factor_kind_name(dvi_factor_kind kind);

/* Write the bodies and the joints between them, as lists of the create function. */
void dvi__emit_joint_lists(dvi__emitter *out, const dvi_scene *scene);

dvi__emitted_term dvi__holonomic_term_of(const dvi_scene *scene, int k);
dvi__emitted_term dvi__nonholonomic_term_of(const dvi_scene *scene, int k);
dvi__emitted_term dvi__force_term_of(const dvi_scene *scene, int k);
dvi__emitted_term dvi__symmetry_term(const dvi_scene *scene, int k);
dvi__emitted_term dvi__invariant_term(const dvi_scene *scene, int k);
dvi__emitted_term dvi__event_term(const dvi_scene *scene, int k);

/* Write a term's callbacks, with their functions. The other functions write the object, or its
 * fields alone, as `.name = .., ..` for a list. */
dvi_status dvi__emit_callbacks(dvi__emitter *out, const dvi__emitted_term *term);
dvi_status dvi__emit_term(dvi__emitter *out, const dvi__emitted_term *term);
void dvi__emit_fields(dvi__emitter *out, const dvi__emitted_term *term);

/* Write the arrays of a pattern. A full pattern has -1 in both. */
void dvi__emit_pattern_arrays(dvi__emitter *out, int columns, const dvi_pattern *pattern,
                              int number[2]);

/* Write a text in quotes. Anything but a plain letter is escaped. */
void dvi__emit_text(dvi__emitter *out, const char *text);

#endif
