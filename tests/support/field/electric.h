/* Electromagnetic fields and their marches, for tests. */
#ifndef TESTS_SUPPORT_FIELD_ELECTRIC_H
#define TESTS_SUPPORT_FIELD_ELECTRIC_H
#include <dvi/march.h>
#include <dvi/maxwell.h>

#include "support/field/generated.h"
#include "support/field/marches.h"

/* Make the same mesh with a part "core", the cells whose centres are inside. Releases the first
 * one. */
dvi_mesh *with_core(dvi_mesh *mesh, int (*is_inside)(const double *centre));

/* Make a field on a mesh, which is released. `eps` is NULL for 1. The terms lack the star. */
dvi_field *electric(dvi_mesh *mesh, dvi_star_kind kind, const double *eps, dvi_maxwell_terms terms);

/* Make a march, and start it. Forms are NULL for the default. */
dvi_march *march_of(const dvi_field *field, dvi_march_options how, const double *E,
                    const double *A);

/* Integrate a function of place over the k-cells of a field's mesh, for free(). */
double *form_of(const dvi_field *field, int k, dvi_form_function *function);
#endif
