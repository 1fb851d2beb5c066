/* The sections of a scene: their readers, and what these share. docs/CONTRIBUTING.md tells how to
 * add one. */
#ifndef DVI_SCENE_SECTIONS_H
#define DVI_SCENE_SECTIONS_H
#include "scene/elaborate/context.h"

/* Read the whole scene from its tree: names, terms, start, plan. Its system is made later. */
bool dvi__scene_read_tree(dvi_scene *scene);

/* Readers: dvi__read_<name> reads the section of this name. */
#define SECTION(name, presence, example, line) \
  bool dvi__read_##name(dvi_scene *scene, const dvi__tree *section);
#define REFUSED_SECTION(name, line)
#include "scene/sections/sections.def"
#undef SECTION
#undef REFUSED_SECTION

/* ---- what readers share: each refuses with a place, and returns false then ---- */

/* A section must be a mapping, or a text. */
bool dvi__want_mapping(dvi_scene *scene, const dvi__tree *tree, const char *what);
bool dvi__want_text(dvi_scene *scene, const dvi__tree *tree, const char *what);

/* Names of columns, potentials and events are identifiers. */
bool dvi__want_name(dvi_scene *scene, const char *text, dvi__span span);

/* Keys of a mapping are among known[count]; the nearest one is named if one is not. */
bool dvi__want_keys(dvi_scene *scene, const dvi__tree *mapping, const char *what, int count,
                    const char *const *known);

/* The expression that a part of the file holds: a scalar, or a list. */
bool dvi__tree_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e);

/* A number, or a whole one of at least `least`, made of parameters. */
bool dvi__tree_number(dvi_scene *scene, const dvi__tree *tree, const char *what, double *number);
bool dvi__tree_whole(dvi_scene *scene, const dvi__tree *tree, const char *what, int least,
                     int *number);

/* The file that a method's specification names must lie in the scene's folder or below. The
 * specification then has the way to it from here. */
bool dvi__scene_place_file(dvi_scene *scene, dvi__span span, const char **method);

/* The section that says what moves: lagrangian, kinetic, one_form, constraints or hamiltonian; NULL
 * if none does. */
const dvi__tree *dvi__what_moves(const dvi_scene *scene);

/* After all sections: tell parameters where what is made of them stands. Settings of those that
 * stand nowhere are refused. */
bool dvi__read_uses(dvi_scene *scene);

#endif
