/** The solid of a scene, and what is shown of it. */
#ifndef ELASTIC_OF_SCENE_H
#define ELASTIC_OF_SCENE_H
#include <dvi/elastic.h>

#include "problem.h"

/** Return the solid of a problem's scene, or NULL. */
const dvi_elastic *elastic_of(const problem *scene);

/** Print the mesh, masses, what is held, and which steps are stable. */
void elastic_tell(const problem *scene);

/** Print how many cells avi evaluates beside verlet, with steps of the same fraction. */
void elastic_tell_cost(const problem *scene, const char *method, double fraction);

enum { ELASTIC_VIEWS = 4 };

/** The places X + u of the nodes, with displacements and velocities there, and Cauchy's and von
 * Mises' stresses in the cells. */
typedef struct elastic_views {
  double *point; /**< [vertices*n] */
  int count;
  dvi_view view[ELASTIC_VIEWS];
  double *value;
} elastic_views;

/** Make them of displacements and velocities [vertices*n]. Returns DONE, or complains and returns
 * the exit code. Call elastic_views_clear afterwards in any case. */
int elastic_views_make(const problem *scene, const double *u, const double *velocity,
                       elastic_views *views);
void elastic_views_clear(elastic_views *views);

/** Make them of a state of the mechanical system. */
int elastic_views_of_state(const problem *scene, double t, const double *q, const double *p,
                           elastic_views *views);

/** Write modes [count][vertices*n] on the mesh at rest to a .vtu file. */
int elastic_write_modes(const problem *scene, const char *path, int count, const double *mode);
#endif
