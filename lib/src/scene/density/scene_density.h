/* A scene of fields with a density: what its sections say, and the field that is made of them.
 *
 * While the sections are read, the coordinates of the scene are those of one place (dvi__jets):
 * its position and the derivatives of the fields there. Expressions are functions of these.
 * Afterwards the scene's coordinates are the unknowns of the field. */
#ifndef DVI_SCENE_DENSITY_SCENE_DENSITY_H
#define DVI_SCENE_DENSITY_SCENE_DENSITY_H
#include <dvi/density.h>
#include <dvi/multisymplectic.h>
#include <dvi/schroedinger.h>

#include "scene/elaborate/kernels.h"

/* ---- functions of one place ---- */

/* A function of time, position and variables of the field. It is zero if `term` is NULL. */
typedef struct dvi__local {
  dvi__scene_term *term;
  int dimension;
  bool has_time;
  unsigned axes;  /* bit a is 1 if it depends on the position along axis a */
  bool is_placed; /* the position is a variable */
  int variables;
  dvi_jet *variable;  /* [variables] */
  dvi__span *span;    /* [variables] of the first use of each */
  int pairs, entries; /* entries of the pattern, which has both triangles */
  int (*pair)[2];     /* [pairs] a >= b */
  int *entry;         /* [pairs] of each pair in the pattern */
  double straight;    /* of a fixed value that is straight between multiples of this time, or 0 */
} dvi__local;

/* Make a function of kernels of one element, and empty the list. */
bool dvi__local_make(dvi_scene *scene, dvi__kernels *list, dvi__local **local);

/* Do the same with the position as variables. That along axis i has the component -1 - i. */
bool dvi__local_make_placed(dvi_scene *scene, dvi__kernels *list, dvi__local **local);

/* Read an expression, a number or a vector of `count`, as functions local[count] of position, and
 * of the time or the field as far as `may` says (DVI__MENTIONS_T, DVI__OF_FIELD). */
enum { DVI__OF_FIELD = DVI__MENTIONS_V };
bool dvi__local_read(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                     int count, dvi__local **local);

/* Read a matrix of 3 x 3 functions of position. */
bool dvi__local_read_matrix(dvi_scene *scene, const dvi__tree *tree, const char *where,
                            dvi__local **local);

/* Read the derivative of a function of time and position along an axis. */
bool dvi__local_read_slope(dvi_scene *scene, const dvi__tree *tree, int axis, const char *where,
                           int count, dvi__local **local);

/* Evaluate l [count], l_z [variables*count] and l_zz [pairs*count], of which each may be NULL.
 * Returns as callbacks do. `user` is a dvi__local. */
int dvi__local_density(int count, double t, const double *x, const double *z, double *l,
                       double *l_z, double *l_zz, void *user);
/* Evaluate the derivative in time, l_t [count]. */
int dvi__local_time(int count, double t, const double *x, const double *z, double *l_t, void *user);

/* Evaluate a function of time and position. */
int dvi__local_value(const dvi__local *local, int64_t count, double t, const double *x, double *f);
/* Evaluate its first and second derivatives in time, of which the latter may be NULL. */
int dvi__local_rates(const dvi__local *local, int64_t count, double t, const double *x, double *f_t,
                     double *f_tt);

/* ---- the scene ---- */

/* Components of a field of rotations, nine entries and a turn. */
enum { DVI__TURN_COMPONENTS = 12 };

/* A field as it is declared, components `first` to first + components - 1. */
typedef struct dvi__declared_field {
  const char *name;
  dvi__span span;
  bool is_complex, is_vector; /* a complex field is a vector of two */
  bool is_rotation;           /* dvi__jets tells what its components are */
  int first, components;
} dvi__declared_field;

/* Schroedinger's equation of a scene, made when it is first asked for. */
struct dvi__equation {
  double hbar, mass;
  int radial; /* 0, or the dimension */
  dvi__local *potential, *interaction;
  dvi_schroedinger *made; /* or NULL */
};

/* The classes into which the summands of a density are sorted, which are those of its parts. */
enum { DVI__DENSITY_CLASSES = DVI_DENSITY_GENERAL + 1 };

/* A mesh that moves, and what moves it. */
typedef struct dvi__scene_moving dvi__scene_moving;

/* A field of rotations (rotations.c). */
typedef struct dvi__scene_rotations dvi__scene_rotations;

struct dvi__scene_density {
  dvi__jets jets;
  dvi_axis axis[DVI_AXES_MAX]; /* [jets.dimension], without a mesh */
  dvi__span axis_span[DVI_AXES_MAX];
  const dvi__tree *place; /* the section domain or mesh */
  dvi_mesh *mesh;         /* or NULL */
  dvi_mesh *shown;        /* of a domain, for values. NULL before it is asked for */
  const char *kind;       /* of the space, or NULL */
  dvi__declared_field *field;
  int fields;
  const char **component; /* [components] names for columns */
  dvi_density_condition *condition;
  int conditions, condition_room;
  bool has_placed_data;             /* a value or a flux depends on position */
  dvi__local **start, **start_rate; /* [components] or NULL for 0 */
  bool start_moves;                 /* it depends on time, and has its own rates */
  dvi__local **final;               /* [components] or NULL without an end */
  struct dvi__density_probe *probe; /* [probes] */
  int probes;
  const dvi__tree *section;               /* density or schroedinger */
  dvi__local *part[DVI__DENSITY_CLASSES]; /* NULL for classes without summands */
  int summands[DVI__DENSITY_CLASSES];
  int degree;                    /* of the density in the fields, or -1 if no polynomial */
  unsigned placed_axes;          /* bit a is 1 if it depends on the position along axis a */
  bool is_static;                /* it has no rates */
  char chosen[DVI_AXES_MAX][96]; /* kinds of the axes, with the points chosen here */
  dvi_space *space;
  dvi_density *density;
  int64_t functions;
  dvi_multisymplectic_symmetry *symmetry; /* [symmetries] of a march on a lattice */
  int symmetries;
  struct dvi__equation *equation;  /* NULL without the section schroedinger */
  dvi__scene_moving *moving;       /* or NULL */
  dvi__scene_rotations *rotations; /* or NULL */
  double ground;                   /* norm of the ground state that is asked for, or 0 */
};

/* Read the section final, if there is one, and make the end of it. */
bool dvi__density_read_final(dvi_scene *scene);
bool dvi__density_make_final(dvi_scene *scene);

/* Find the velocities [nv] of a state, which the caller frees in any case. */
dvi_status dvi__density_velocity(const dvi_scene *scene, double t, const double *q, const double *p,
                                 double **v);

/* Return the number of components of all fields. */
static inline int dvi__components(const dvi_scene *scene)
{
  return scene->density->jets.components;
}

/* Find a field by its name, or NULL. */
const dvi__declared_field *dvi__field_named(const dvi_scene *scene, const char *name);

/* Return the axis of this name, or -1. */
int dvi__axis_named(const dvi_scene *scene, const char *name);

/* Elaborate the density into one number, or that of Schroedinger's equation. */
bool dvi__density_node(dvi__context *c, const dvi__tree *section, dvi__node *node);
bool dvi__schroedinger_node(dvi__context *c, const dvi__tree *section, dvi__node *node);

/* Sort the summands of a node into parts, and set what is known of the density. */
bool dvi__density_sort(dvi__context *c, dvi__node root);

/* Return the whole number behind a name such as "cells=" in the kind of an axis, or the usual one.
 * Tell if the functions of the axis are elements that are linear in each cell. */
long dvi__axis_option(const char *kind, const char *name, long usual);
bool dvi__axis_is_linear(const char *kind);

/* Make the space, for a density of the degree that is known. */
bool dvi__density_make_space(dvi_scene *scene);

/* Complain with the library's last sentence about a section, or of the part of an expression that
 * has no value. Returns false. */
bool dvi__density_complain(dvi_scene *scene, const dvi__tree *section, dvi_status status);

/* Refuse variable k of a function, which is of too high an order along an axis. */
bool dvi__refuse_order(dvi_scene *scene, const dvi__local *local, int k, int axis);

/* Give the coefficients [components*functions] of the start and of its rate. */
bool dvi__density_start(dvi_scene *scene, double *U, double *rate);

/* Refuse a section initial, of coefficients U, that is off the values that are fixed. */
bool dvi__density_check_ends(dvi_scene *scene, const double *U);

/* Interpolate functions of[components], which may be NULL, at time t into
 * U [components*functions]. */
dvi_status dvi__density_interpolate(const struct dvi__scene_density *s, dvi__local *const *of,
                                    double t, double *U);

/* Evaluate the rate of a component at the start, which the scene has. Returns as callbacks do.
 * Interpolate that of all. */
int dvi__density_start_rate(const struct dvi__scene_density *s, int component, int64_t count,
                            const double *x, double *rate);
dvi_status dvi__density_interpolate_rate(const struct dvi__scene_density *s, double *rate);

/* List the parts of the density, at most DVI__DENSITY_CLASSES. Returns how many they are. */
int dvi__density_parts(const struct dvi__scene_density *s, dvi_density_part *part);

/* Declare the probes as what is watched. */
bool dvi__density_make_probes(dvi_scene *scene);

/* ---- marches ---- */

/* Tell why there is no lattice, with the section to blame. NULL if there is one. */
const char *dvi__lattice_refused(const dvi_scene *scene, const char **section);

/* Tell if short steps of the method tend to the motion of the scene's system, which has the mass of
 * the space. */
bool dvi__lattice_is_semidiscrete(const dvi_scene *scene, const char *method);

/* Find shifts and turns of the fields that leave the density as it is. */
bool dvi__lattice_find_symmetries(dvi_scene *scene);

/* Create and start a march on the lattice, and measure its laws. */
dvi_status dvi__lattice_march(const dvi_scene *scene, const dvi_march_options *options,
                              dvi_march **march);
dvi_status dvi__lattice_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                             dvi_law *law, int *count);

/* Do the same for Schroedinger's equation. dvi__equation_order gives the order of a method. */
bool dvi__equation_marches(const dvi_scene *scene, const char *method);
int dvi__equation_order(const char *method);
const char *dvi__equation_refused(const dvi_scene *scene, const char **section);
/* Refuse a ground state of which there is none. */
bool dvi__equation_check_ground(dvi_scene *scene);
dvi_status dvi__equation_march(const dvi_scene *scene, const dvi_march_options *options,
                               dvi_march **march);
dvi_status dvi__equation_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                              dvi_law *law, int *count);

/* ---- meshes that move (moving.c, moving_make.c, moving_probe.c) ---- */

/* Keep the whole density as one function. */
bool dvi__moving_take_density(dvi__context *c, dvi__node root);

/* Make the field, its unknowns and its start. */
bool dvi__moving_make(dvi_scene *scene);
void dvi__moving_clear(dvi_scene *scene);
void dvi__moving_explain(const dvi_scene *scene, char *text, size_t size);

/* Refuse what a probe of such a field has not, and a point x, unless it is NULL, that is outside at
 * the start. */
bool dvi__moving_check_probe(dvi_scene *scene, const dvi__local *function, const double *x,
                             const char *name, dvi__span span);

/* Evaluate a function of the field, its slopes and its rate at a point x, or its integral if x is
 * NULL. Returns as callbacks do. */
int dvi__moving_value(const dvi_scene *scene, const dvi__local *function, bool has_rates, double t,
                      const double *q, const double *p, const double *x, double *value);

/* ---- fields of rotations (rotations.c, rotations_probe.c) ---- */

/* Read the start, R and omega(R). */
bool dvi__rotations_read_start(dvi_scene *scene, const dvi__tree *section);

/* Take a density apart, and make the field, its unknowns and its start. */
bool dvi__rotations_take_density(dvi__context *c, dvi__node root);
bool dvi__rotations_make(dvi_scene *scene);
void dvi__rotations_clear(dvi_scene *scene);
void dvi__rotations_explain(const dvi_scene *scene, char *text, size_t size);

/* Find the node of a probe, and refuse what such a probe has not. Evaluate it there. Returns as
 * callbacks do. */
bool dvi__rotations_check_probe(dvi_scene *scene, const dvi__local *function, const char *name,
                                dvi__span span, const double *point, int *node);
int dvi__rotations_value(const dvi_scene *scene, const dvi__local *function, double t, int node,
                         const double *q, const double *p, double *value);

#endif
