/* A scene of an elastic solid: what its sections say, and the solid that is made of them.
 *
 * While the sections are read, the coordinates of the scene are those of one place of the
 * reference: its position x, y and z, the outer normal of the boundary there, and the deformation
 * gradient F. Afterwards they are the unknowns of the solid. */
#ifndef DVI_SCENE_ELASTIC_SCENE_ELASTIC_H
#define DVI_SCENE_ELASTIC_SCENE_ELASTIC_H
#include <dvi/elastic.h>

#include "scene/field/scene_field.h"

enum {
  DVI__SOLID_AXES = DVI_ELASTIC_DIMENSION_MAX,
  DVI__SOLID_PLACE = 2 * DVI__SOLID_AXES + DVI__SOLID_AXES * DVI__SOLID_AXES
};

/* What a function may have beside the position. An energy has F alone. */
enum { DVI__SOLID_TIME = 1, DVI__SOLID_NORMAL = 2, DVI__SOLID_ENERGY = 4 };

/* A number, or a vector, as a function of a place. */
typedef struct dvi__solid_function {
  int n, count;
  int first; /* component of a vector that it gives */
  bool has_time;
  dvi_potential component[DVI__SOLID_AXES]; /* each a function of t and of the place */
} dvi__solid_function;

/* What a probe is of. */
typedef enum dvi__solid_quantity {
  DVI__SOLID_DISPLACEMENT,
  DVI__SOLID_VELOCITY,
  DVI__SOLID_POSITION,
  DVI__SOLID_STRESS,
  DVI__SOLID_MISES,
  DVI__SOLID_TOTAL,
  DVI__SOLID_KINETIC,
  DVI__SOLID_STORED,
  DVI__SOLID_LOAD
} dvi__solid_quantity;

/* A probe: one number at a point, or of a part. */
typedef struct dvi__solid_probe {
  const char *name, *part;
  dvi__span span, place; /* of the name, and of the point */
  dvi__solid_quantity of;
  double at[DVI__SOLID_AXES], along[DVI__SOLID_AXES], across[DVI__SOLID_AXES];
  int cell; /* where the point is */
  double weight[DVI__SOLID_AXES + 1];
  const dvi_elastic *solid;
} dvi__solid_probe;

struct dvi__scene_elastic {
  dvi_elastic *solid;
  dvi_elastic_material *material;
  dvi__span *material_span;
  dvi_elastic_condition *condition;
  dvi_elastic_load *load;
  dvi_obstacle *obstacle;
  dvi__solid_probe *probe;
  int materials, conditions, loads, obstacles, probes;
  const dvi__tree *gravity;
  double acceleration[DVI__SOLID_AXES];
  double *weighed; /* [materials*3] of a share: cells with gravity, and powers of their kinds */
  dvi__solid_function *value, *rate; /* the start, NULL for 0 */
  double *u, *velocity;              /* [vertices*n] the start */
};

/* Read an expression of `count` numbers as a function. `may` has the flags DVI__SOLID_.. */
bool dvi__solid_function_read(dvi_scene *scene, const dvi__tree *tree, unsigned may, int count,
                              const char *where, dvi__solid_function **function);

/* Evaluate the function, and its rates. `normal` may be NULL. Return as callbacks do. */
int dvi__solid_function_value(const dvi__solid_function *function, double t, const double *X,
                              const double *normal, double *value);
int dvi__solid_function_rate(const dvi__solid_function *function, double t, const double *X,
                             double *rate);

/* Evaluate a stored energy, as dvi_elastic_material says. `user` is a function. */
int dvi__solid_energy(int64_t count, const double *F, double *W, double *P, double *Hessian,
                      void *user);

/* Turn gravity into loads of the parts that have materials. */
bool dvi__solid_add_gravity(dvi_scene *scene);

/* Refuse a part whose cells have several densities beside its own, on all processes. */
bool dvi__solid_check_gravity(dvi_scene *scene);

/* Find the cells of the probes, and let the scene watch these. */
bool dvi__solid_place_probes(dvi_scene *scene);

/* Refuse a start in which an obstacle is inside of the body. */
bool dvi__solid_check_obstacles(dvi_scene *scene);

/* Read a number above 0, or from 0 on. */
bool dvi__solid_number(dvi_scene *scene, const dvi__tree *tree, const char *what, bool may_vanish,
                       double *number);

#endif
