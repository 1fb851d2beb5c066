/** The field of a scene, and files of values on its mesh. */
#ifndef FIELD_OF_SCENE_H
#define FIELD_OF_SCENE_H
#include <dvi/density.h>
#include <dvi/elastic.h>
#include <dvi/field.h>

#include "cli/options.h"
#include "problem.h"

/** Take the field of a scene, or its density or its solid, of which one is set and the others are
 * NULL. A command without use for densities or solids gives NULL for them. Returns DONE, or
 * complains that `command` needs a field, destroys the scene and returns the exit code. */
int field_choose(const char *command, const char *name, problem **scene, const dvi_field **field,
                 const dvi_density **density, const dvi_elastic **solid);

/** Return the mesh of a field. */
const dvi_mesh *field_mesh(const dvi_field *field);

/** Print the mesh, what is fixed, and which steps are stable. */
void field_tell(const dvi_field *field);

/** A form to be seen: values at the vertices, or of forms of degree 1 in the cells. */
typedef struct field_view {
  dvi_view view;
  double *values; /**< owned, or NULL */
} field_view;

/** Make a view of a form of the field's degree, whose name and values stay the caller's. Returns
 * DONE, or complains and returns the exit code. Call field_view_clear afterwards in any case. */
int field_view_make(const dvi_field *field, const char *name, const double *form, field_view *view);
void field_view_clear(field_view *view);

/** Write forms [count][cells] of the field's degree with a mesh to a .vtu file, under a name and,
 * if there are several, their numbers from 1. Returns DONE, or complains and returns the exit
 * code. */
int field_write(const dvi_field *field, const char *path, const char *name, int count,
                const double *values);
#endif
