/* The sections of a scene and who reads them. */
#ifndef DVI_SCENE_SECTIONS_H
#define DVI_SCENE_SECTIONS_H
#include "scene/elaborate/context.h"

/* Settings "name=value" from outside. */
typedef struct dvi__scene_settings {
  int count;
  const char *const *text;
  char *used; /* [count] */
} dvi__scene_settings;

/* Read the whole scene from its tree: names, terms, start, plan. Its system is made later. */
bool dvi__scene_read_tree(dvi_scene *scene, dvi__scene_settings *settings);

bool dvi__read_parameters(dvi_scene *scene, const dvi__tree *section,
                          dvi__scene_settings *settings);
bool dvi__read_coordinates(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_definitions(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_lagrangian(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_kinetic(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_one_form(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_hamiltonian(
    dvi_scene *scene, const dvi__tree *section); /* alone; the next reads one with constraints */
bool dvi__read_constraints(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_symmetries(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_invariants(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_events(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_initial(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_report(dvi_scene *scene, const dvi__tree *section);
bool dvi__read_sweep(dvi_scene *scene, const dvi__tree *section);

/* ---- what readers share ---- */

/* Refuse with a place; false. */
bool dvi__scene_refuse(dvi_scene *scene, dvi__span span, const char *format, ...)
    DVI__TEXT_PRINTF(3, 4);

/* A section that must be a mapping, or a text. */
/* The file that a method's specification names: it must lie in the scene's folder or below, and the
 * specification then has the way to it from here. */
bool dvi__scene_place_file(dvi_scene *scene, dvi__span span, const char **method);

bool dvi__want_mapping(dvi_scene *scene, const dvi__tree *tree, const char *what);
bool dvi__want_text(dvi_scene *scene, const dvi__tree *tree, const char *what);

/* The section that says what moves: lagrangian, kinetic, one_form, constraints or hamiltonian; NULL
 * if none does. */
const dvi__tree *dvi__what_moves(const dvi_scene *scene);

/* Refuse what is no identifier: names of columns, potentials and events. */
bool dvi__want_name(dvi_scene *scene, const char *text, dvi__span span);

/* Refuse keys of a mapping that are none of known[count], and name the nearest one. */
bool dvi__want_keys(dvi_scene *scene, const dvi__tree *mapping, const char *what, int count,
                    const char *const *known);

/* The expression that a part of the file holds: a scalar, or a list. */
bool dvi__tree_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e);

/* A number, or a whole one of at least `least`, made of parameters. */
bool dvi__tree_number(dvi_scene *scene, const dvi__tree *tree, const char *what, double *number);
bool dvi__tree_whole(dvi_scene *scene, const dvi__tree *tree, const char *what, int least,
                     int *number);

/* After all sections: tell parameters where what is made of them stands, and refuse settings of
 * those that stand nowhere. */
bool dvi__read_uses(dvi_scene *scene, const dvi__scene_settings *settings);

/* ---- columns ---- */

/* Refuse a name that dvi run has as a column already, but for those of a coordinate (or NULL); and
 * coordinates whose columns are called alike. */
bool dvi__column_is_new(dvi_scene *scene, const char *text, dvi__span span,
                        const dvi__coordinate *of);
bool dvi__labels_differ(dvi_scene *scene);

/* ---- coordinates as keys ---- */

/* x, x[3] or x[i], u[i,3], of a motion B.R or B.x; and of these the numbers, the velocities x',
 * omega(R) or rate(u), or the momenta p(x). */
typedef struct dvi__target {
  const dvi__coordinate *x;
  unsigned says;            /* DVI__SAYS_Q, _V or _P */
  dvi__subscripts index;    /* each a number, or the name in `each` */
  const char *each[2];      /* the index of a formula for all its values, or NULL */
  int fixed;                /* how many indices are numbers */
  const char *call;         /* "omega" or "rate", or NULL */
  const dvi__slots *places; /* in q, or in v and p */
  dvi__span span;
} dvi__target;

bool dvi__read_target(dvi_scene *scene, const dvi__tree *key, dvi__target *target);

/* In a context that dvi__context_make has made, elaborate what stands at a target: as many numbers
 * as it has, or as each of its members has, and where these are in q, v or p. */
bool dvi__target_value(dvi__context *c, const dvi__target *target, const dvi__tree *tree,
                       dvi__value *value, dvi__numbering *numbering, const dvi__expression **e);

/* How far number k of that value is from the first one. */
int dvi__target_place(const dvi__target *target, int k);

#endif
