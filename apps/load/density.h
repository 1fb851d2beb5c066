/** The field of a scene with a density, and files of its values. */
#ifndef DENSITY_OF_SCENE_H
#define DENSITY_OF_SCENE_H
#include <dvi/density.h>
#include <stdbool.h>

#include "problem.h"

/** Return the density of a problem's scene, or NULL. */
const dvi_density *density_of(const problem *scene);

/** Return whether a problem is a field, with a density, on a mesh alone, or of a solid. */
bool has_field(const problem *scene);

/** Return whether a problem is a field of rotations. */
bool has_rotations(const problem *scene);

/** Tell that a mechanical method does not keep the norm of Schroedinger's equation, and which do.
 * Return USAGE if it takes no such scene at all, or the field is too large for vprk. */
int density_judge(const char *command, const problem *scene, const char *method);

/** Return whether small fields grow without bound, with the least omega^2. */
bool density_grows(const problem *scene, double *least);

/** Tell that small fields grow without bound, as those of a density with a wrong sign. */
void density_warn_growth(const char *command, const problem *scene);

/** Tell that a step is unstable at the start, by frequencies that only potentials have that depend
 * on time or are not quadratic. A method refuses the others itself. */
void density_warn_step(const char *command, const problem *scene, const char *method, double h);

/** Return the number of unknowns of a field. */
int64_t field_unknowns(const problem *scene);

/** Print what was found, built and chosen, and which steps are stable. */
void density_tell(const problem *scene);

/** Return the number of coefficients of all components. */
int64_t density_coefficients(const dvi_density *density);

/** The values of some fields at the vertices of the scene's mesh: all components, and |psi|^2 of
 * complex fields. With several fields the names get numbers from 1. */
typedef struct density_views {
  int count;
  dvi_view *view; /**< [count] */
  struct density_values *values;
} density_views;

/** Prepare for so many fields. Returns DONE, or complains and returns the exit code. Call
 * density_views_clear afterwards in any case. */
int density_views_make(const problem *scene, int fields, density_views *views);
void density_views_clear(density_views *views);

/** Evaluate fields [fields][coefficients]. Returns DONE, or complains and returns the exit code. */
int density_views_fill(density_views *views, const double *U);

/** Write such values as CSV, a row for each vertex with its position. Returns DONE, or complains
 * and returns the exit code. */
int density_write(const problem *scene, const char *path, int fields, const double *U);

/** Write such values with the mesh to a .vtu file. */
int density_view(const problem *scene, const char *path, int fields, const double *U);
#endif
