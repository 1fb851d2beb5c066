/* The potentials of a solid's mechanical system. */
#ifndef DVI_FIELD_ELASTIC_POTENTIALS_H
#define DVI_FIELD_ELASTIC_POTENTIALS_H
#include "field/elastic/system.h"

/* The potential of a share of the energy stored, by sums over cells. */
dvi_potential dvi__solid_cell_potential(dvi__solid_potential *part, const char *name);

/* The potential of the stiffness at rest by its matrix, where displacements that are given are
 * steady. */
dvi_potential dvi__solid_matrix_potential(dvi__solid_system *s, const char *name);

/* The potential of the loads. */
dvi_potential dvi__solid_load_potential(dvi__solid_system *s);

/* Find what the potentials of matrices and of steady loads keep. */
dvi_status dvi__solid_make_pull(dvi__solid_system *s);
dvi_status dvi__solid_make_load(dvi__solid_system *s);

#endif
