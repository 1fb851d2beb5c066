/** Scenes: systems that a file describes by expressions. docs/scenes.md has the format.
 *
 *  This header is not part of <dvi/dvi.h>. Link dvi::scene (dvi-scene), which needs libyaml beside
 *  libdvi. */
#ifndef DVI_SCENE_H
#define DVI_SCENE_H
#include <dvi/control.h>
#include <dvi/density.h>
#include <dvi/elastic.h>
#include <dvi/field.h>
#include <dvi/march.h>
#include <dvi/moving.h>
#include <dvi/run.h>
#include <dvi/schroedinger.h>
#include <dvi/sensitivity.h>
#include <dvi/system.h>
#include <stddef.h>

/** A scene: the system, its start, and a plan of its run. A scene never changes. Integrators on
 *  several threads may share its system. */
typedef struct dvi_scene dvi_scene;

/** A parameter of a scene. */
typedef struct dvi_scene_parameter {
  const char *name;
  double value; /**< current value. NaN if the parameter is not one number */
  int settable; /**< 1 if the parameter is a number that a setting may replace */
  /** 1 if of all sections `initial` alone uses the parameter and the definitions made of it */
  int start_only;
  /** 1 if the parameter is made of other ones, through which it changes */
  int is_made;
} dvi_scene_parameter;

/** The plan of a scene's run. Strings are NULL and numbers 0 where the scene does not set them. */
typedef struct dvi_scene_plan {
  const char *title, *method;
  double h, t_end;
  double fraction; /**< step of a field, as a fraction of the largest stable one */
  long every;
  int column_count;
  const char *const *column; /**< names for tables */
  int usual_columns;         /**< not 0 if these are of a field that does not choose any */
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

/** Values of a parameter in a parameter sweep. */
typedef struct dvi_scene_range {
  const char *name;
  int count;
  const double *value; /**< [count] */
} dvi_scene_range;

/** The end of a scene's control problem, or of a path of fields with a density. free_q and free_p
 *  are not 0 for the numbers that are free, as in dvi_control_options. */
typedef struct dvi_scene_end {
  const double *q, *p;
  const char *free_q, *free_p;
} dvi_scene_end;

/** A file of a scene. `text` has `size` characters, and perhaps no NUL behind them. */
typedef struct dvi_scene_file {
  const char *name, *text;
  size_t size;
} dvi_scene_file;

/** Facts about a scene, for people and for tests. */
typedef struct dvi_scene_facts {
  /** "separable", "separable with a vector potential", "general Lagrangian", "one-form",
   *  "Hamiltonian", "Hamiltonian with constraints", "static" */
  const char *form;
  /** "identity", "scalar", "diagonal", "sparse", "inertias" (of rotations and angles, and no more).
   *  NULL without a constant mass */
  const char *mass;
  int kernels;   /**< expressions that are summed over elements */
  long elements; /**< elements of all kernels */
  int nodes;     /**< nodes of all expressions, before derivatives */
  /** operations a point. -1: never derived */
  int value_operations, gradient_operations, hessian_operations;
  long hessian_entries;
  long value_points, gradient_points, hessian_points; /**< points evaluated so far */
  int quadratic_potentials; /**< number of potentials with constant Hessians */
} dvi_scene_facts;

/** A field with a density, as the scene declares it: its components are `first` to first +
 *  components - 1. A complex field has two of them, its real and its imaginary part. */
typedef struct dvi_scene_declared {
  const char *name;
  int first, components;
  int is_complex; /**< not 0 if it is */
} dvi_scene_declared;

/** A point that moves with the coordinates: a definition of 2 or 3 numbers without velocities and
 *  momenta. */
typedef struct dvi_scene_point {
  const char *name;
  int size; /**< 2 or 3 */
  /** number k of the point, with user[k], as in dvi_invariant. p may be NULL */
  int (*value)(double t, const double *q, const double *p, double *x, void *user);
  void *user[3];
} dvi_scene_point;

struct dvi_yee_ranks; /* of <dvi/yee.h> */

/** What replaces the mesh of a scene by the share of one process, as soon as it has been made, or
 *  makes the share without a whole mesh. */
typedef struct dvi_scene_division {
  size_t size; /**< sizeof(dvi_scene_division) */
  /** Cut the share out of the whole mesh: dvi_mesh_cut, or dvi_mesh_divide of <dvi/petsc.h>.
   *  Returns DVI_OK, or the status of dvi_last_error(). NULL: the mesh stays whole, and the scene
   *  is one of dvi_scene_read */
  dvi_status (*divide)(const dvi_mesh *mesh, dvi_mesh **share, void *user);
  /** Read the share from a file whose name ends in .h5: dvi_mesh_read_divided of <dvi/petsc.h>.
   *  Returns likewise. NULL, or if *share stays NULL: such files are refused, as they are by
   *  dvi_scene_read */
  dvi_status (*read)(const char *path, dvi_mesh **share, void *user);
  void *user;
  /** Those among which marches by yee divide a grid, for as long as there are marches. NULL if such
   *  marches are refused */
  const struct dvi_yee_ranks *grid;
} dvi_scene_division;

/** A number high + low, with more digits than a double has. high is the double nearest to it. */
typedef struct dvi_pair {
  double high, low;
} dvi_pair;

/** Options of a run of a scene. Zero means what the scene says. All is owned by the caller. */
typedef struct dvi_scene_run_options {
  size_t size;        /**< sizeof(dvi_scene_run_options) */
  const char *method; /**< the method's specification */
  double h, t_end;
  long every;          /**< steps between two rows */
  const double *q;     /**< [nq] another start, with v or p */
  const double *v, *p; /**< [nv] its velocities, or its momenta */
  unsigned parts;      /**< parts of a row (dvi_record_options). Default: coordinates and momenta */
  const double *times; /**< [time_count] times of the rows, in place of `every` */
  int64_t time_count;
  const volatile int *cancel; /**< as in dvi_run_options */
} dvi_scene_run_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Read a scene from a file.
 *
 *  The call opens the files of the components that the scene includes, and perhaps the tableau that
 *  its method names. All of them lie in the scene's folder or below. The plan's method then names
 *  the path of the tableau.
 *  @param      settings  [setting_count] texts "name=value" that replace parameters
 *  @param[out] scene     owned by the caller. NULL on failure
 *  @param[out] message   [size] on failure file, line, column, the error, the line itself and a
 *                        caret. May be NULL
 *  @retval DVI_BAD_FILE    the scene makes no sense
 *  @retval DVI_BAD_OPTION  a setting makes no sense
 *  @retval DVI_BAD_SIZE    a limit of docs/scenes.md is passed
 *  @retval DVI_IO_ERROR    the file cannot be read
 *  @retval DVI_NO_MEMORY   memory could not be allocated
 *  @retval (others)        as dvi_system_create */
dvi_status dvi_scene_read(const char *path, int setting_count, const char *const *settings,
                          dvi_scene **scene, char *message, size_t size);

/** Read a scene from a text of `length` characters. `name` stands for the path, in messages and for
 *  the folder of the scene. Otherwise this is dvi_scene_read. */
dvi_status dvi_scene_parse(const char *name, const char *text, size_t length, int setting_count,
                           const char *const *settings, dvi_scene **scene, char *message,
                           size_t size);

/** Read the scene of a field on the share of one process, otherwise as dvi_scene_read.
 *
 *  All processes read the same scene. It has marches by leapfrog, of waves and Maxwell's fields on
 *  meshes, and by yee on grids, but no system: its terms have the number of unknowns of the share,
 *  and probes of waves, whose values all processes ask for together.
 *
 *  @param      division  its share becomes the scene's mesh, which the scene destroys
 *  @retval DVI_UNSUPPORTED  the scene has no field of waves or Maxwell's, or a grid and no
 *                           `grid` in the division
 *  @retval (others)         as dvi_scene_read and `divide` */
dvi_status dvi_scene_read_share(const char *path, const dvi_scene_division *division,
                                int setting_count, const char *const *settings, dvi_scene **scene,
                                char *message, size_t size);

/** Free a scene, its system and all objects that it owns, and set the pointer to NULL. NULL is
 *  allowed. */
void dvi_scene_destroy(dvi_scene **scene);

/** Return the system. Owned by the scene. That of fields is made by the first call. NULL for NULL,
 *  for a grid that only yee advances, and if a field's system cannot be made: dvi_last_error()
 *  tells why. */
const dvi_system *dvi_scene_system(const dvi_scene *scene);

/** Return the terms of the system. Owned by the scene. NULL for NULL. */
const dvi_system_terms *dvi_scene_terms(const dvi_scene *scene);

/** Return the field of a scene with a mesh, whose unknowns are the coordinates u_1, u_2 and so on.
 *  Owned by the scene. NULL if the scene has no mesh, or a solid on it. */
const dvi_field *dvi_scene_field(const dvi_scene *scene);

/** Return the solid of a scene with `field: elastic`, whose unknowns are the coordinates u_1, u_2
 *  and so on. Owned by the scene. NULL for other scenes. */
const dvi_elastic *dvi_scene_elastic(const dvi_scene *scene);

/** Return the field of a scene with a density, owned by the scene. Its coordinates are named u_1,
 *  u_2 and so on by its fields. NULL if the scene has no density, or one on a mesh that moves. */
const dvi_density *dvi_scene_density(const dvi_scene *scene);

/** Return the field of a scene with a density on a mesh that moves (section moving), owned by the
 *  scene. Its coordinates are named by the axis, x_1 and so on, and by its fields. NULL for other
 *  scenes. */
const dvi_moving *dvi_scene_moving(const dvi_scene *scene);

/** Return the name of component i of the fields with a density ("u", "psi_re", "w_1"), owned by the
 *  scene. NULL if there is none. */
const char *dvi_scene_component(const dvi_scene *scene, int i);

/** Return the name of axis d of the domain of fields with a density, owned by the scene, or NULL if
 *  there is none. */
const char *dvi_scene_axis(const dvi_scene *scene, int d);

/** Give field i of a scene with a density, in the order of the file. Returns 0 if there is none. */
int dvi_scene_declared_of(const dvi_scene *scene, int i, dvi_scene_declared *field);

/** Return Schroedinger's equation of a scene with the section schroedinger, owned by the scene. The
 *  first call makes it. NULL for other scenes, for those whose boundary has values, fluxes or
 *  robin, or whose interaction depends on time, and if it cannot be made. */
const dvi_schroedinger *dvi_scene_schroedinger(const dvi_scene *scene);

/** Return the norm of the ground state that the section solve asks for (dvi_schroedinger_ground). 0
 *  if it asks for none. */
double dvi_scene_ground_norm(const dvi_scene *scene);

/** Write what was found in a density and what was built of it, one fact a line: fields, parts by
 *  the summands of the expression, the space, the terms, and how well momenta can be kept. Cut off
 *  at size. Nothing for other scenes. */
void dvi_scene_density_explain(const dvi_scene *scene, char *text, size_t size);

/** Give the options of dvi_field_solve that the scene sets. Returns 0 if it has no field. */
int dvi_scene_solve_options(const dvi_scene *scene, dvi_field_solve_options *options);

/** Tell if a method is one of marches, for a scene of a field: those of dvi/march.h and yee, of a
 *  solid those of dvi/elastic.h, and for a density multisymplectic (dvi/multisymplectic.h) and,
 *  with the section schroedinger, those of dvi/schroedinger.h.
 *
 *  @param method  its specification. NULL for the scene's own
 *  @return 1 if it is, 0 if it is not, or for a scene without a field */
int dvi_scene_marches(const dvi_scene *scene, const char *method);

/** Create a march of the scene's field, and start it at the scene's start.
 *
 *  The method yee on a generated mesh of boxes works without the mesh (dvi/yee.h), unless A is to
 *  be kept, or the scene starts from A or has probes of parts of the mesh.
 *
 *  @param      options  what they leave open is that of the scene. NULL for all of it
 *  @param[out] march    owned by the caller, for dvi_march_destroy before the scene's end
 *  @retval DVI_BAD_OPTION    the method is not one of marches
 *  @retval DVI_UNSUPPORTED   the scene has no mesh, and the method is not yee; it has a damping; or
 *                            the method is yee, and the star is not circumcentric; or
 *                            dvi_scene_march_refused tells why
 *  @retval (others)          as dvi_march_create, dvi_elastic_march_create, dvi_yee_create and
 *                            dvi_march_start */
dvi_status dvi_scene_march_create(const dvi_scene *scene, const dvi_march_options *options,
                                  dvi_march **march);

/** Tell why a scene with a density cannot have a march. NULL if it may, as far as the scene's kinds
 *  of domain and space go, or if the method is none of marches.
 *
 *  @param[out] section  the scene's section that is to blame. Unchanged without a reason */
const char *dvi_scene_march_refused(const dvi_scene *scene, const char *method,
                                    const char **section);

/** Return the order in time of a march to the motion of the scene's system. 0 if it has another
 *  limit: the steps of multisymplectic have their own mass in space, which is that of fem with the
 *  weight exact, and lumped with the weight trapezoid. 0, too, if the method is none of marches. */
int dvi_scene_march_order(const dvi_scene *scene, const char *method);

/** Measure the laws of a march of the scene's field that begins at random: dvi_field_laws,
 *  dvi_elastic_laws, dvi_multisymplectic_laws, or the change of the "norm", from 1, of
 *  Schroedinger's equation.
 *
 *  @param      options  with a method
 *  @param[out] law      [DVI_LAWS_MAX]
 *  @retval DVI_UNSUPPORTED  the scene has no such march
 *  @retval (others)         as those functions */
dvi_status dvi_scene_march_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                                dvi_law *law, int *count);

/** Give the state of the scene's system at the time of a march: coordinates q [nq] and, unless it
 *  is NULL, momenta p [nv].
 *
 *  @retval DVI_UNSUPPORTED  the march has no A, or the scene no system
 *  @retval (others)         as dvi_march_sample and the system */
dvi_status dvi_scene_march_state(const dvi_scene *scene, const dvi_march *march, double *q,
                                 double *p);

/** Give E or B of a march of the scene's field as vectors of space in the cells of its mesh.
 *
 *  @param[out] vector  [cells*3], cell by cell. Components that the field does not have are 0. Of a
 *                      grid that processes divide, each gets those of the cells of its share of
 *                      the mesh, or without a mesh the first one those of the whole grid, and the
 *                      others nothing. All of them call the function
 *  @retval DVI_UNSUPPORTED  the scene has no such march
 *  @retval (others)         as dvi_march_sample and dvi_form_at_centres */
dvi_status dvi_scene_vectors(const dvi_scene *scene, const dvi_march *march, dvi_march_form form,
                             double *vector);

/** Return the mesh of a scene of fields, owned by the scene. That of a grid for yee, that of a
 *  domain (dvi_space_mesh), which do without, and the start of one that moves (dvi_moving_mesh) are
 *  made by the first call. NULL without a mesh, or
 *  without memory. */
const dvi_mesh *dvi_scene_mesh(dvi_scene *scene);

/** Tell why a scene of a field has a grid for yee, and neither mesh nor system: what only a grid
 *  has ("cpml", "bloch", "wave", "flux"), or "size". NULL if it has a mesh or no field. */
const char *dvi_scene_grid_only(const dvi_scene *scene);

/** Return the start at t = 0, q [nq], v [nv], p [nv]. Owned by the scene. NULL for NULL. */
void dvi_scene_start(const dvi_scene *scene, const double **q, const double **v, const double **p);

/** Return the name of coordinate i of q [nq], for columns ("x", "q_1_x", "R_11", "u_cos"). NULL if
 *  i is out of range. */
const char *dvi_scene_coordinate(const dvi_scene *scene, int i);

/** Return the name of entry i of v [nv] ("v_x", "omega_R_x", "rate_u"). NULL if i is out of
 *  range. */
const char *dvi_scene_velocity(const dvi_scene *scene, int i);

/** Return the name of entry i of p [nv] ("p_x"). NULL if i is out of range. */
const char *dvi_scene_momentum(const dvi_scene *scene, int i);

/** Return the number of bodies if the state is bodies of a plane or of space (one family of vectors
 *  of 2 or 3 coordinates), else 0. */
int dvi_scene_bodies(const dvi_scene *scene);

/** Give point i of a scene without fields, in the order of its definitions. Each call derives its
 *  functions anew, which the scene owns. It is for one thread, while no other uses the scene.
 *
 *  @retval DVI_BAD_ARGUMENT  there is no such point
 *  @retval DVI_BAD_SIZE      a limit of docs/scenes.md is passed
 *  @retval DVI_NO_MEMORY     memory could not be allocated */
dvi_status dvi_scene_point_of(dvi_scene *scene, int i, dvi_scene_point *point);

/** Return the plan of the scene's run. Owned by the scene. */
const dvi_scene_plan *dvi_scene_plan_of(const dvi_scene *scene);

/** Give file i of the scene, owned by the scene. 0 is its own file, and the others are those of its
 *  components, in the order in which they are included. Returns 0 if i is out of range. */
int dvi_scene_file_of(const dvi_scene *scene, int i, dvi_scene_file *file);

/** Return parameter i, in the order of the file. NULL if i is out of range. Owned by the scene. */
const dvi_scene_parameter *dvi_scene_parameter_at(const dvi_scene *scene, int i);

/** Return unused parameter or definition i, one that nothing in the scene mentions. NULL if i is
 *  out of range. Owned by the scene. */
const char *dvi_scene_unused(const dvi_scene *scene, int i);

/** Return event i. NULL if i is out of range. Owned by the scene. */
const dvi_scene_event *dvi_scene_event_at(const dvi_scene *scene, int i);

/** Return the range of parameter i in section `sweep`. NULL if i is out of range. Owned by the
 *  scene. */
const dvi_scene_range *dvi_scene_range_at(const dvi_scene *scene, int i);

/** Return the controls of the scene. They serve one thread at a time. NULL if the scene has none,
 *  or if none of them stands in `forces`. In the scene's system all controls are 0. */
const dvi_controls *dvi_scene_controls(const dvi_scene *scene);

/** Return the name of control i. NULL if i is out of range. Owned by the scene. */
const char *dvi_scene_control(const dvi_scene *scene, int i);

/** Give the end that the scene has, owned by the scene. Returns 0 if there is none. */
int dvi_scene_end_of(const dvi_scene *scene, dvi_scene_end *end);

/** Derive the scene by its parameters, for dvi_sensitivity_create. Parameter k is that of
 *  dvi_scene_parameter_at(scene, k). Those that are not one number, or are made of others, have
 *  derivatives 0. The expressions are elaborated once more, with the parameters as variables.
 *  Indices and bounds stay as they are. Like the scene's controls the dependence serves one thread
 *  at a time.
 *
 *  @param[out] dependence  its callback and data belong to the scene
 *  @param[out] message     [size] as in dvi_scene_read
 *  @retval DVI_UNSUPPORTED  the scene has no Lagrangian of R^n
 *  @retval DVI_BAD_FILE, DVI_BAD_SIZE, DVI_NO_MEMORY  as in dvi_scene_read */
dvi_status dvi_scene_depend(dvi_scene *scene, dvi_dependence *dependence, char *message,
                            size_t size);

/** Compute how the start depends on the parameters, after dvi_scene_depend. by_q and by_p are [n *
 *  parameters], with the derivatives of q and of p by parameter k at k*n.
 *
 *  @retval DVI_BAD_STATE   before dvi_scene_depend
 *  @retval DVI_NOT_FINITE  a derivative is not finite */
dvi_status dvi_scene_start_tangent(const dvi_scene *scene, double *by_q, double *by_p);

/** Return the objective of the scene, with the derivatives by its parameters. It serves one thread
 *  at a time. NULL if there is none. */
const dvi_objective *dvi_scene_objective(const dvi_scene *scene);

/** Collect the facts about a scene and its evaluations so far. Zeros for NULL. */
void dvi_scene_facts_of(const dvi_scene *scene, dvi_scene_facts *facts);

/** Find translations and rotations under which the Lagrangian (or the Hamiltonian and its
 *  constraints) is invariant. Candidates move one coordinate, all coordinates of one shape
 *  together, or two coordinates that are numbers as those of a plane.
 *
 *  The expressions are tested with exact numbers at random points, and a candidate that does not
 *  hold passes with a chance of less than 1e-8. The search is not complete. It treats functions
 *  such as sin as unknown, except that equal arguments give equal values, and it tries only some
 *  candidates in large scenes. Symmetries that the scene declares play no part here. The call
 *  allocates.
 *  @param[out] text  [size] the list, as in "translation of x, rotation of q about z". Cut off at
 *                    size, "" if none is found
 *  @return the number found. -1 for scenes with rotations, motions, directions or angles, for more
 *          than 2e6 nodes of expressions over all elements, without memory, and if a pointer is
 *          NULL */
int dvi_scene_invariance(const dvi_scene *scene, char *text, size_t size);

/** Evaluate the derivatives of the Lagrangian in quadruple precision, for the errors of steps that
 *  lie below the rounding of a double. The call is slow, and allocates.
 *
 *  @param      t, q, v   the point, q and v [n]
 *  @param[out] L_q, L_v  [n] right to about 1e-31, L_q with all forces. Undefined on failure
 *  @retval DVI_UNSUPPORTED   no Lagrangian of R^n (a one-form, a Hamiltonian, rotations, directions
 *                            or angles), or holonomic constraints, or no arithmetic of 113 bits on
 *                            this machine
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_NOT_FINITE    a derivative is not finite at the point
 *  @retval DVI_NO_MEMORY     memory could not be allocated */
dvi_status dvi_scene_quad_gradient(const dvi_scene *scene, dvi_pair t, const dvi_pair *q,
                                   const dvi_pair *v, dvi_pair *L_q, dvi_pair *L_v);

/** Find points where the Lagrangian (or the Hamiltonian) is not smooth: max, min, abs, sign, floor
 *  and if(..) whose condition the state decides.
 *
 *  Where the motion crosses such a point no method is of higher order than the lowest derivative
 *  that jumps there. The order is one higher if time alone decides. The search goes along some
 *  lines from the start, compares Taylor series on both sides, and stops at 64 points. The call
 *  allocates.
 *  @param[out] text  [size] a sentence on the worst point, with file, line and column. "" if none
 *                    was found
 *  @return the order that the worst point leaves, 0 (the function itself jumps) to 5. -1 if none
 *          was found, or for NULL */
int dvi_scene_kink(const dvi_scene *scene, char *text, size_t size);

/** Locate the last failure of a callback of a scene's system on this thread.
 *
 *  The text names the part of an expression that was not finite, or had no Taylor series, with the
 *  time and the coordinates that the part depends on. Or it names the limit that the derivatives
 *  passed. A method may have recovered from the failure since. The failure is the cause of an error
 *  only if the error has the status DVI_CALLBACK_RETRY or DVI_CALLBACK_FAILED.
 *  @return the text. "" if no callback failed since a scene was last read */
const char *dvi_scene_fault(void);

/** Compose a message about a section of the scene, in the form of a scene's own errors, with file,
 *  line and column in front, and the line and a caret below.
 *
 *  @param      section   name of the section, such as "method". If the scene has no such section,
 *                        the message names the file alone
 *  @param      sentence  the sentence of the message
 *  @param[out] message   [size] the message. Untouched if the scene is NULL */
void dvi_scene_tell(const dvi_scene *scene, const char *section, const char *sentence,
                    char *message, size_t size);

/** Write a C file that declares the same system by callbacks of the C API. The file defines
 *    - a function `dvi_status NAME_create(dvi_system **system)`,
 *    - the start, `const double NAME_q[], NAME_v[], NAME_p[]`,
 *    - the plan, `const double NAME_h, NAME_t_end` and, if the scene has a method,
 *      `const char NAME_method[]`,
 *    - the events, if the scene has any, `const dvi_event NAME_events[]`.
 *
 *  With a method and the macro DVI_MAIN the file is a program that runs the scene.
 *
 *  @param name   a C identifier, in front of every external name
 *  @param write  receives the text, part by part. A result other than 0 ends the call with
 *                DVI_IO_ERROR
 *  @retval DVI_BAD_ARGUMENT  name is no identifier of at most 63 letters, or an argument is NULL
 *  @retval DVI_UNSUPPORTED   the scene's method needs Taylor coefficients, which the file does not
 *                            have
 *  @retval DVI_BAD_SIZE      a kernel, or the gradients of constraints, have more numbers than a
 *                            stack has room for
 *  @retval DVI_NO_MEMORY     memory could not be allocated */
dvi_status dvi_scene_emit_c(const dvi_scene *scene, const char *name,
                            int (*write)(const char *text, size_t size, void *user), void *user);

/** Run a scene's system from its start at t = 0 to its end, with the scene's events, of which
 *  terminal ones end the run, and record the run.
 *
 *  @param      options    NULL for the scene's method, step, end and start
 *  @param[out] recording  for dvi_recording_destroy before the scene's end. As dvi_record gives it,
 *                         on failure too
 *  @retval DVI_BAD_ARGUMENT  there is no method, or a start with both or none of v and p
 *  @retval DVI_UNSUPPORTED   the scene has no system (dvi_scene_system)
 *  @retval (others)          as dvi_integrator_create, dvi_integrator_start and dvi_record */
dvi_status dvi_scene_run(const dvi_scene *scene, const dvi_scene_run_options *options,
                         dvi_recording **recording);

/** Return a column of a recorded run of the scene: "t", or a coordinate, velocity, momentum or
 *  invariant by its name. Row k has the number column[k * stride]. Owned by the recording.
 *
 *  @return NULL if the recording has no such column (dvi_recording_derive adds some) */
const double *dvi_scene_column(const dvi_scene *scene, const dvi_recording *recording,
                               const char *name, int *stride);

#ifdef __cplusplus
}
#endif
#endif
