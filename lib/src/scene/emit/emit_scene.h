/* Terms of a scene as C, and what the scene's file says of them. */
#ifndef DVI_SCENE_EMIT_SCENE_H
#define DVI_SCENE_EMIT_SCENE_H
#include "scene/emit/emit.h"
#include "scene/elaborate/model.h"

/* A callback: its name, its parameters but `user`, and what the function gets for them. `asks` is
 * 'v', 'g' or 's': the value, the gradient by the blocks that are wanted, or the second derivatives
 * of the pairs that are; 'c': gradients of constraints, which have two of these. */
typedef struct dvi__callback {
  const char *name, *parameters, *arguments;
  char asks;
  char wanted[DVI__PAIRS]; /* blocks or pairs: 1 for those that are */
} dvi__callback;

/* A term as an object: static const TYPE NAME, or one of a list. */
typedef struct dvi__emitted_term {
  const char *type;
  char name[32];
  const char *shown; /* in tables; NULL: it has no name there */
  const dvi__scene_term *term;
  int callback_count;
  const dvi__callback *callback;
  int columns; /* of patterns */
  const char *pattern_name[4];
  const dvi_pattern *pattern[4]; /* up to the first NULL */
  int fast, quadratic;           /* of potentials */
} dvi__emitted_term;

/* Describe the terms. */
dvi__emitted_term dvi__lagrangian_term(const dvi_scene *scene);
dvi__emitted_term dvi__one_form_term(const dvi_scene *scene);
dvi__emitted_term dvi__hamiltonian_term(const dvi_scene *scene);
dvi__emitted_term dvi__constraint_term(const dvi_scene *scene);
dvi__emitted_term dvi__potential_term(const dvi_scene *scene, int k);
dvi__emitted_term dvi__symmetry_term(const dvi_scene *scene, int k);
dvi__emitted_term dvi__invariant_term(const dvi_scene *scene, int k);
dvi__emitted_term dvi__event_term(const dvi_scene *scene, int k);

/* Write its callbacks, with their functions; the object; or its fields alone, as `.name = .., ..`
 * for a list. */
dvi_status dvi__emit_callbacks(dvi__emitter *out, const dvi__emitted_term *term);
dvi_status dvi__emit_term(dvi__emitter *out, const dvi__emitted_term *term);
void dvi__emit_fields(dvi__emitter *out, const dvi__emitted_term *term);

/* The arrays of a pattern; -1 in both: a full one. */
void dvi__emit_pattern_arrays(dvi__emitter *out, int columns, const dvi_pattern *pattern,
                              int number[2]);

/* A text in quotes; whatever is no plain letter is escaped. */
void dvi__emit_text(dvi__emitter *out, const char *text);

#endif
