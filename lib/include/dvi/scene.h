/** Scenes: systems that a file describes by expressions. docs/scenes.md has the format.
 *
 *  Not part of <dvi/dvi.h>: link dvi::scene (dvi-scene), which needs libyaml beside libdvi. */
#ifndef DVI_SCENE_H
#define DVI_SCENE_H
#include <dvi/system.h>
#include <stddef.h>

/** A scene: the system, its start, and how it wants to be run. It never changes; its system may be
 * shared by integrators on several threads. */
typedef struct dvi_scene dvi_scene;

/** A parameter of a scene. */
typedef struct dvi_scene_parameter {
  const char *name;
  double value; /**< as it is set; NaN if it is not one number */
  int settable; /**< 1: a number that a setting may replace */
  /** 1: of all sections it stands in `initial` alone, and so does what is made of it */
  int start_only;
} dvi_scene_parameter;

/** How a scene wants to be run. Strings are NULL and numbers 0 where it does not say. */
typedef struct dvi_scene_plan {
  const char *title, *method;
  double h, t_end;
  long every;
  int column_count;
  const char *const *column; /**< names for tables */
} dvi_scene_plan;

/** An event of a scene: the sign of an expression changes. */
typedef struct dvi_scene_event {
  const char *name;
  /** as in dvi_event */
  int (*value)(double t, const double *q, const double *v, double *g, void *user);
  void *user;
  int direction; /**< +1 rising, -1 falling, 0 both */
  int terminal;
} dvi_scene_event;

/** Values of a parameter to be swept over. */
typedef struct dvi_scene_range {
  const char *name;
  int count;
  const double *value; /**< [count] */
} dvi_scene_range;

/** What was found in a scene, for people and for tests. */
typedef struct dvi_scene_facts {
  const char *
      form; /**< "separable", "general Lagrangian", "one-form", "Hamiltonian", "Hamiltonian with constraints" */
  const char *
      mass; /**< "identity", "scalar", "diagonal", "sparse", "inertias" (of rotations and angles, and no more); NULL without a constant mass */
  /** expressions that are summed over elements */
  int kernels;
  long elements; /**< of all kernels */
  /** of all expressions, before derivatives */
  int nodes;
  int value_operations, gradient_operations, hessian_operations; /**< a point; -1: never derived */
  long hessian_entries;
  long value_points, gradient_points, hessian_points; /**< evaluated so far */
  /** how many potentials have constant Hessians */
  int quadratic_potentials;
} dvi_scene_facts;

/** A number of more digits than a double has: high + low, with high the double nearest to it. */
typedef struct dvi_pair {
  double high, low;
} dvi_pair;

#ifdef __cplusplus
extern "C" {
#endif

/** Read a scene from a file.
 *
 *  The one other file that is opened for it is the tableau that its method may name, in the scene's
 *  folder or below; the plan's method then has the way to it.
 *  @param      settings  [setting_count] texts "name=value" that replace parameters
 *  @param[out] scene     owned by the caller; NULL on failure
 *  @param[out] message   [size] on failure: file, line, column, what is wrong, the line itself and
 *                        a caret; may be NULL
 *  @retval DVI_BAD_FILE    the scene makes no sense
 *  @retval DVI_BAD_OPTION  a setting does not
 *  @retval DVI_BAD_SIZE    a limit of docs/scenes.md is passed
 *  @retval DVI_IO_ERROR    the file cannot be read
 *  @retval DVI_NO_MEMORY
 *  @retval (others)        as dvi_system_create */
dvi_status dvi_scene_read(const char *path, int setting_count, const char *const *settings,
                          dvi_scene **scene, char *message, size_t size);

/** The same from a text of `length` characters; `name` stands for the path, in messages and for the
 * folder that the scene is in. */
dvi_status dvi_scene_parse(const char *name, const char *text, size_t length, int setting_count,
                           const char *const *settings, dvi_scene **scene, char *message,
                           size_t size);

/** Free a scene, its system and all that was asked of it, and set the pointer to NULL; NULL is
 * allowed. */
void dvi_scene_destroy(dvi_scene **scene);

/** The system, owned by the scene; NULL for NULL. */
const dvi_system *dvi_scene_system(const dvi_scene *scene);

/** The terms that the system was made of, owned by the scene; NULL for NULL. */
const dvi_system_terms *dvi_scene_terms(const dvi_scene *scene);

/** The start at t = 0: q [nq], v [nv], p [nv]; NULL for NULL. */
void dvi_scene_start(const dvi_scene *scene, const double **q, const double **v, const double **p);

/** The name of coordinate i of q [nq], for columns: "x", "q_1_x", "R_11", "u_cos"; NULL if i is out
 * of range. */
const char *dvi_scene_coordinate(const dvi_scene *scene, int i);

/** The name of entry i of v [nv]: "v_x", "omega_R_x", "rate_u"; NULL if i is out of range. */
const char *dvi_scene_velocity(const dvi_scene *scene, int i);

/** The name of entry i of p [nv]: "p_x"; NULL if i is out of range. */
const char *dvi_scene_momentum(const dvi_scene *scene, int i);

/** If the state is bodies of a plane or of space, how many: one family of vectors of 2 or 3; else
 * 0. */
int dvi_scene_bodies(const dvi_scene *scene);

/** How the scene wants to be run; owned by the scene. */
const dvi_scene_plan *dvi_scene_plan_of(const dvi_scene *scene);

/** Parameter i, in the order of the file; NULL if i is out of range. Owned by the scene. */
const dvi_scene_parameter *dvi_scene_parameter_at(const dvi_scene *scene, int i);

/** Parameter or definition i of those that nothing in the scene mentions; NULL if i is out of
 * range. Owned by the scene. */
const char *dvi_scene_unused(const dvi_scene *scene, int i);

/** Event i; NULL if i is out of range. Owned by the scene. */
const dvi_scene_event *dvi_scene_event_at(const dvi_scene *scene, int i);

/** What section `sweep` says of its parameter i; NULL if i is out of range. Owned by the scene. */
const dvi_scene_range *dvi_scene_range_at(const dvi_scene *scene, int i);

/** Counts of evaluations so far, and what was derived; zeros for NULL. */
void dvi_scene_facts_of(const dvi_scene *scene, dvi_scene_facts *facts);

/** Translations and rotations under which the Lagrangian stays as it is (or the Hamiltonian and its
 *  constraints), of each coordinate and of all that have one shape, proved on the expressions;
 *  declared as symmetries, their momenta are watched. What is not found may still be one: of
 *  functions nothing is known but that equal arguments give equal values, and of large scenes not
 *  all is tried. Allocates.
 *
 *  @param[out] text  [size] "translation of x, rotation of q about z"; cut off if it is longer
 *  @return how many; -1 for scenes with rotations, motions, directions or angles, for more than 2e6
 *          parts of all elements, without memory, and for NULL */
int dvi_scene_invariance(const dvi_scene *scene, char *text, size_t size);

/** The derivatives of the Lagrangian in quadruple precision, for the errors of steps that lie below
 *  the rounding of a double. Slow; allocates.
 *
 *  @param      t, q, v   the point, q and v [n]
 *  @param[out] L_q, L_v  [n] right to about 1e-31; undefined on failure
 *  @retval DVI_UNSUPPORTED   no Lagrangian of R^n (a one-form, a Hamiltonian, rotations, directions
 *                            or angles), or no arithmetic of 113 bits on this machine
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_NOT_FINITE
 *  @retval DVI_NO_MEMORY */
dvi_status dvi_scene_quad_gradient(const dvi_scene *scene, dvi_pair t, const dvi_pair *q,
                                   const dvi_pair *v, dvi_pair *L_q, dvi_pair *L_v);

/** Where the Lagrangian (or the Hamiltonian) is not smooth: max, min, abs, sign, floor and if(..)
 *  that the state decides. Where the motion crosses such a place no method is of higher order than
 *  the lowest derivative that jumps there, one more if time alone decides. Looked for along some
 *  lines from the start, at most 64 places; compares Taylor series on both sides. Allocates.
 *
 *  @param[out] text  [size] a sentence on the worst place, with file, line and column; "" without
 *                    one
 *  @return the order that it leaves, 0 (the function itself jumps) to 5; -1 if none was found, or
 *          NULL */
int dvi_scene_kink(const dvi_scene *scene, char *text, size_t size);

/** The part of an expression that was not finite, or had no Taylor series, when a callback of a
 *  scene's system last failed on this thread, with the time and the coordinates that it depends on;
 *  or the limit that its derivatives passed; "" if none failed since a scene was last read. A
 *  method may have got over it since: it is the cause of an error only if that has the status
 *  DVI_CALLBACK_RETRY or DVI_CALLBACK_FAILED. */
const char *dvi_scene_blame(void);

/** A sentence about a section of the scene, in the form of its own errors: file, line and column in
 * front, the line and a caret below.
 *
 *  @param      section   its name, as "method"; if there is none, the place is the file
 *  @param      sentence  what is to be said
 *  @param[out] message   [size]; untouched if the scene is NULL */
void dvi_scene_tell(const dvi_scene *scene, const char *section, const char *sentence,
                    char *message, size_t size);

/** Write a C file that declares the same system by callbacks of the C API: a function `dvi_status
 *  NAME_create(dvi_system **system)`; the start, `const double NAME_q[], NAME_v[], NAME_p[]`; the
 *  plan, `const double NAME_h, NAME_t_end` and, if the scene has one, `const char NAME_method[]`;
 *  and its events, if it has any, `const dvi_event NAME_events[]`. With a method and the macro
 *  DVI_MAIN it is a program that runs the scene.
 *
 *  @param name   a C identifier, in front of every external name
 *  @param write  gets the text, piece by piece; not 0 ends it with DVI_IO_ERROR
 *  @retval DVI_BAD_ARGUMENT  name is no identifier of at most 63 letters, or an argument is NULL
 *  @retval DVI_UNSUPPORTED   the scene's method needs Taylor coefficients, which the file does not
 *                            have
 *  @retval DVI_BAD_SIZE      a kernel, or the gradients of constraints, have more numbers than a
 *                            stack has room for
 *  @retval DVI_NO_MEMORY */
dvi_status dvi_scene_emit_c(const dvi_scene *scene, const char *name,
                            int (*write)(const char *text, size_t size, void *user), void *user);

#ifdef __cplusplus
}
#endif
#endif
