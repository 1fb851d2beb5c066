/* A scene of an electromagnetic field: what its sections say, and what is made of it, a field on a
 * mesh or a grid for yee. */
#ifndef DVI_SCENE_FIELD_MAXWELL_H
#define DVI_SCENE_FIELD_MAXWELL_H
#include <dvi/march.h>
#include <dvi/maxwell.h>

#include "scene/field/scene_field.h"

/* A factor of time. Of a moment, the current is its rate. */
typedef struct dvi__signal {
  dvi__scene_term *term;
  dvi_potential potential; /* the factor as a function of t, with its rate */
  bool is_moment;
} dvi__signal;

typedef enum dvi__wall_word {
  DVI__WALL_PMC,
  DVI__WALL_PEC,
  DVI__WALL_ABSORBING,
  DVI__WALL_PERIODIC,
  DVI__WALL_CPML,
  DVI__WALL_BLOCH
} dvi__wall_word;

typedef struct dvi__scene_wall {
  const char *part;
  dvi__span span;
  dvi__wall_word word;
  double number; /* layers, or the phase */
} dvi__scene_wall;

/* Permittivity, permeability and conductivity. */
enum { DVI__EPS, DVI__MU, DVI__SIGMA, DVI__QUANTITIES };

/* Materials of a part of cells. NULL for what is not said. */
typedef struct dvi__scene_material {
  const char *part;
  dvi__place *place[DVI__QUANTITIES];
  dvi__span span[DVI__QUANTITIES];
} dvi__scene_material;

/* A dipole, with a signal for each axis, a density of a current, or a plane wave. */
typedef struct dvi__scene_source {
  dvi__span span;
  const dvi__tree *at, *wave;
  double point[3];
  dvi__signal *signal[3]; /* one of a density and of a wave */
  dvi__place_vector *density;
  double lower[3], upper[3], direction[3], polarization[3];
} dvi__scene_source;

/* A probe of the scene, one of each component of a vector. */
typedef struct dvi__scene_probe {
  dvi__span span, place; /* of the name, and of the point */
  const char *name, *of, *part;
  double at[3], along[3]; /* along the axes of space */
  double lower[3], upper[3];
  bool has_box; /* a flux through a box of a grid */
} dvi__scene_probe;

struct dvi__scene_maxwell {
  bool is_scalar;        /* E is one number */
  int E, B;              /* their numbers of components */
  const char *grid_only; /* what of the scene a mesh cannot have, or NULL */
  dvi__scene_material *material;
  dvi__scene_wall *wall;
  dvi__scene_source *source;
  dvi__scene_probe *probe;
  int materials, walls, sources, probes;
  dvi__place_vector *of_E, *of_B, *of_A; /* the start, NULL for 0 */
  double *start_E, *start_B, *start_A;   /* [cells] of the mesh, or NULL */
};

/* Note whether the field is Maxwell's, before the mesh is read. */
bool dvi__maxwell_begin(dvi_scene *scene);

/* Tell if the scene has a grid of boxes that is advanced by yee alone, without a mesh. Set space
 * and dimension then. */
bool dvi__is_grid_alone(dvi_scene *scene);

/* The names of the sides of a grid of boxes: lower and upper end of each axis. */
extern const char *const dvi__grid_side[6];

/* Let the axes of a grid repeat themselves where the boundary says so, before the mesh is made. */
bool dvi__maxwell_read_periodic(dvi_scene *scene);

/* The readers of sections. */
bool dvi__maxwell_read_materials(dvi_scene *scene, const dvi__tree *section);
bool dvi__maxwell_read_walls(dvi_scene *scene, const dvi__tree *section);
bool dvi__maxwell_read_probes(dvi_scene *scene, const dvi__tree *section);
bool dvi__maxwell_read_start(dvi_scene *scene, const dvi__tree *section);

/* Read a function of time. */
bool dvi__signal_read(dvi_scene *scene, const dvi__tree *tree, bool is_moment,
                      dvi__signal **signal);
/* The factor itself, the current of a signal, and its integral. `user` is a signal. */
int dvi__signal_factor(double t, double *value, void *user);
int dvi__signal_value(double t, double *value, void *user);
int dvi__signal_impulse(double from, double to, double *value, void *user);

/* Make the field on the scene's mesh, and its start. Complains. */
bool dvi__maxwell_make(dvi_scene *scene, const dvi__tree *section);

/* Check what only a grid has, and make a march of it. */
bool dvi__grid_make(dvi_scene *scene);
dvi_status dvi__grid_march(const dvi_scene *scene, const dvi_march_options *options,
                           dvi_march **march);

/* Give E or B of such a march in the middle of each box, as means of the values around it. */
dvi_status dvi__grid_vectors(const dvi_scene *scene, const dvi_march *march, dvi_march_form form,
                             double *vector);

/* The components of the form B, or of E, from those of a vector in space. */
void dvi__maxwell_form(const struct dvi__scene_field *field, bool is_B, const double *vector,
                       double *form);

#endif
