/* The sections of a scene, their readers, and functions shared by these. docs/CONTRIBUTING.md tells
 * how to add one. */
#ifndef DVI_SCENE_SECTIONS_SECTIONS_H
#define DVI_SCENE_SECTIONS_SECTIONS_H
#include <dvi/march.h>

#include "scene/elaborate/context.h"

/* Read the whole scene from its tree, that is names, terms, start and plan. Its system is made
 * later. */
bool dvi__scene_read_tree(dvi_scene *scene);

/* Refuse a document that is no scene, and sections that no scene has. */
bool dvi__check_section_names(dvi_scene *scene, const dvi__tree *tree);

/* Declare the readers. dvi__read_<name> reads the section of this name. */
#define SECTION(name, presence, example, line) \
  bool dvi__read_##name(dvi_scene *scene, const dvi__tree *section);
#define REFUSED_SECTION(name, line)
#include "scene/sections/sections.def"
#undef SECTION
#undef REFUSED_SECTION

/* ---- functions shared by readers, which refuse with a place and then return false ---- */

/* Refuse a section that is no mapping, or no text. */
bool dvi__want_mapping(dvi_scene *scene, const dvi__tree *tree, const char *what);
bool dvi__want_text(dvi_scene *scene, const dvi__tree *tree, const char *what);

/* Refuse a name of a column, potential or event that is no identifier. */
bool dvi__want_name(dvi_scene *scene, const char *text, dvi__span span);

/* Refuse keys of a mapping that are not among known[count], and name the nearest one. */
bool dvi__want_keys(dvi_scene *scene, const dvi__tree *mapping, const char *what, int count,
                    const char *const *known);

/* Read the expression that a part of the file holds, a scalar or a list. */
bool dvi__tree_expression(dvi_scene *scene, const dvi__tree *tree, const dvi__expression **e);

/* Return the name in an expression without the prefix of its file. For words such as scalar and
 * ground, which are words in few places and names elsewhere. */
const char *dvi__word_of(const dvi_scene *scene, const dvi__expression *e);

/* Read a number, or a whole number of at least `least`, made of parameters. */
bool dvi__tree_number(dvi_scene *scene, const dvi__tree *tree, const char *what, double *number);
bool dvi__tree_whole(dvi_scene *scene, const dvi__tree *tree, const char *what, int least,
                     int *number);

/* Add a coordinate of `size` numbers from `first` on, a number (rank 0) or a vector (rank 1). */
bool dvi__add_lines(dvi_scene *scene, const char *name, dvi__span span, int rank, int first,
                    int size);

/* Read a point, or a direction, of `count` numbers. */
bool dvi__point_read(dvi_scene *scene, const dvi__tree *tree, int count, const char *what,
                     double *point);

/* Read one of some words. */
bool dvi__tree_word(dvi_scene *scene, const dvi__tree *tree, const char *what, int count,
                    const char *const *word, int *which);

/* Refuse a file in a method's specification that is not in the scene's folder or below. The
 * specification then has the way to the file from here. */
bool dvi__scene_place_file(dvi_scene *scene, dvi__span span, const char **method);

/* Find the file of a component, named from the folder of the file in which the name stands. Refuses
 * a place that is not in the scene's folder or below. */
bool dvi__scene_place_component(dvi_scene *scene, dvi__span span, const char *named_file,
                                const char **path);

/* Find the file of a mesh in the same way. */
bool dvi__scene_place_mesh(dvi_scene *scene, dvi__span span, const char *named_file,
                           const char **path);

/* Read the section initial of a field, and release what a field owns (scene/field). */
bool dvi__read_field_start(dvi_scene *scene, const dvi__tree *section);
void dvi__scene_field_clear(dvi_scene *scene);

/* Tell if the tree of a scene has a density, and if it has a mesh or a density. */
bool dvi__has_density(const dvi_scene *scene);
bool dvi__is_of_field(const dvi_scene *scene);

/* Read the sections of a density that other fields have, too, and take over the mesh on which it
 * lives (scene/density). */
bool dvi__density_take_mesh(dvi_scene *scene, const dvi__tree *section, dvi_mesh *mesh);
bool dvi__density_read_boundary(dvi_scene *scene, const dvi__tree *section);
bool dvi__density_read_start(dvi_scene *scene, const dvi__tree *section);
bool dvi__density_read_solve(dvi_scene *scene, const dvi__tree *section);
bool dvi__density_read_probes(dvi_scene *scene, const dvi__tree *section);
const dvi_mesh *dvi__density_mesh(dvi_scene *scene);
void dvi__scene_density_clear(dvi_scene *scene);

/* Tell if the scene's mesh is the share of one of several processes. */
bool dvi__is_share(const dvi_scene *scene);

/* Tell if it has a grid that several processes divide. It may be that of a share as well. */
bool dvi__has_divided_grid(const dvi_scene *scene);

/* Do so for a solid (scene/elastic): note whether the field is one, before the mesh is read, check
 * the mesh, name a place, read the sections that other fields have, too, and refuse those that only
 * others have. */
bool dvi__elastic_begin(dvi_scene *scene);
bool dvi__is_elastic(const dvi_scene *scene);
bool dvi__elastic_check_mesh(dvi_scene *scene, const dvi__tree *section);
bool dvi__elastic_name_place(dvi_scene *scene, const dvi__tree *section);
bool dvi__elastic_read_materials(dvi_scene *scene, const dvi__tree *section);
bool dvi__elastic_read_boundary(dvi_scene *scene, const dvi__tree *section);
bool dvi__elastic_read_start(dvi_scene *scene, const dvi__tree *section);
bool dvi__elastic_read_probes(dvi_scene *scene, const dvi__tree *section);
bool dvi__elastic_refuse_section(dvi_scene *scene, const dvi__tree *section, const char *name);
bool dvi__elastic_make(dvi_scene *scene, const dvi__tree *section);
void dvi__elastic_clear(dvi_scene *scene);

/* Return the name of what marches of the solid observe, NULL beyond the last one. */
const char *dvi__elastic_observable(const dvi_scene *scene, int i);

dvi_status dvi__elastic_fastest(const dvi_scene *scene, double *omega);
bool dvi__elastic_marches(const char *method);
dvi_status dvi__elastic_march(const dvi_scene *scene, const dvi_march_options *options,
                              dvi_march **march);
dvi_status dvi__elastic_march_state(const dvi_scene *scene, const dvi_march *march, double *q,
                                    double *p);
dvi_status dvi__elastic_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                             dvi_law *law, int *count);

/* Do for a density what functions of dvi/scene.h do for a field. */
bool dvi__density_marches(const dvi_scene *scene, const char *method);
dvi_status dvi__density_march(const dvi_scene *scene, const dvi_march_options *options,
                              dvi_march **march);
dvi_status dvi__density_march_state(const dvi_scene *scene, const dvi_march *march, double *q,
                                    double *p);
/* Tell if a march of a density may show a column. */
bool dvi__density_has_column(const dvi_scene *scene, const char *name);

/* Let a run show energy, momenta, and what else is watched. */
bool dvi__choose_field_columns(dvi_scene *scene);

/* List the columns of a field's run, but for those of mechanical methods, if `known` is not NULL.
 * Returns how many they are. */
int dvi__list_field_columns(const dvi_scene *scene, const char **known);
/* Tell if a mechanical method may show the column of a field's system. */
bool dvi__is_mechanical_column(const dvi_scene *scene, const char *name);

/* Return the section that declares the motion, lagrangian, kinetic, one_form, constraints,
 * hamiltonian, field or density. NULL if none does. */
const dvi__tree *dvi__motion_section(const dvi_scene *scene);

/* Read the motion and the start once more as functions of the parameters (dependence.c). */
bool dvi__read_dependence(dvi_scene *scene);

/* Tell parameters, after all sections, where the expressions made of them stand. Refuses settings
 * of those that stand nowhere. */
bool dvi__read_uses(dvi_scene *scene);

#endif
