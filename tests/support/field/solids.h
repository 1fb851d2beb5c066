/* Elastic solids for tests. */
#ifndef TESTS_SUPPORT_FIELD_SOLIDS_H
#define TESTS_SUPPORT_FIELD_SOLIDS_H
#include <dvi/elastic.h>
#include <dvi/integrator.h>

/* A material with rho = lambda = mu = 1 on all cells. */
dvi_elastic_material unit_material(dvi_elastic_law law);

/* Create a solid on a mesh, which the solid owns then, of one material with the other terms. */
dvi_elastic *solid_on(dvi_mesh *mesh, dvi_elastic_material material, dvi_elastic_terms terms);

/* The unit cube, or in a plane the unit square, of Kuhn's simplices, whose nodes along the x axis
 * are at (i/m)^grading, and evenly distributed along the others. */
dvi_elastic *block(int dimension, int cells, double grading, dvi_elastic_law law);

/* Give the velocities scale (.2 Y, -.1 Z, .15 X Z), in a plane scale (.2 Y, .15 X Y) [vertices*n]
 * to the nodes. */
void spin_block(const dvi_elastic *solid, double scale, double *rate);

/* The mechanical system, and an integrator that starts at rest with velocities [vertices*n]. */
dvi_system *system_of_solid(dvi_elastic *solid);
dvi_integrator *start_solid(const dvi_elastic *solid, const dvi_system *system, const char *method,
                            const double *rate);

/* A march by a method with steps of a fraction, and its start at displacements and rates
 * [vertices*n], which may be NULL for 0. */
dvi_march *march_of_solid(const dvi_elastic *solid, const char *method, double fraction);
void start_march_of_solid(dvi_march *march, const double *u, const double *rate);

#endif
