/* A field on a moving mesh, and what the files of this room share.
 *
 * Numbers of a node are its position and its values, numbers = dimension + components. The
 * Lagrangian is a sum over stencils of a few nodes: cells, and in one dimension chains of more
 * nodes. Each is a function of the nodes' numbers and of their rates, with derivatives by all of
 * them in one array: first those by numbers, node by node, then those by rates. */
#ifndef DVI_FIELD_MOVING_MOVING_H
#define DVI_FIELD_MOVING_MOVING_H
#include <dvi/moving.h>

#include "num/pattern.h"

enum {
  DVI__CELL_NODES = DVI_MOVING_AXES_MAX + 1,
  DVI__NODE_NUMBERS = DVI_MOVING_AXES_MAX + DVI_MOVING_COMPONENTS_MAX,
  DVI__STENCIL_NODES = 4, /* of the widest stencil */
  DVI__STENCIL_NUMBERS = DVI__STENCIL_NODES * DVI__NODE_NUMBERS,
  DVI__MOVING_VARIABLES = (2 + DVI_MOVING_AXES_MAX) * DVI_MOVING_COMPONENTS_MAX,
  DVI__MOVING_PAIRS = DVI__MOVING_VARIABLES * (DVI__MOVING_VARIABLES + 1) / 2
};

/* A node of a stencil, or its image so many periods away. Beyond an end the node is -1. */
typedef struct dvi__corner {
  int node, turn[DVI_MOVING_AXES_MAX];
} dvi__corner;

/* Stencils of one kind. */
typedef struct dvi__stencils {
  int count, nodes;
  dvi__corner *corner; /* [count*nodes] */
  /* [count][nodes*numbers][nodes*numbers] entry of the pattern for a row and a column, or -1 */
  int *entry;
} dvi__stencils;

/* The symmetry that adds to one number of all nodes. */
typedef struct dvi__number_translation {
  const dvi_moving *moving;
  int number;
  char name[24];
} dvi__number_translation;

struct dvi_moving {
  int dimension, cells, nodes; /* nodes without the periodic last one of an axis */
  int listed;                  /* nodes with it */
  int components, numbers, unknowns, periodic, points;
  dvi_moving_motion motion;
  double mu, kappa, stretch, viscosity, dispersion, path_step;
  dvi_mesh *mesh; /* in two dimensions */
  double *node;   /* [dimension*listed] positions of reference, axis by axis */
  double *known;  /* [nodes*numbers] those of numbers that are no unknowns */
  int *unknown;   /* [nodes*numbers] coordinate, or -1 */
  double from;    /* of the axis */
  double volume;  /* of all cells of reference */
  double period[DVI_MOVING_AXES_MAX];
  double jump[DVI_MOVING_AXES_MAX * DVI_MOVING_COMPONENTS_MAX];
  int translations;
  dvi_density_part part;
  dvi_jet variable[DVI__MOVING_VARIABLES];
  int pair[DVI__MOVING_PAIRS][2];
  dvi_moving_mean mean;
  int (*space_derivative)(int count, double t, const double *x, const double *z, double *l_x,
                          double *l_xz, double *l_xx, void *user);
  int (*path)(int count, double t, const double *X, double *x, double *rate, void *user);
  void *user;
  double place[DVI_MOVING_POINTS_MAX][DVI__CELL_NODES]; /* of quadrature points, barycentric */
  double weight[DVI_MOVING_POINTS_MAX];
  dvi__stencils cell, bend, drag;           /* the last two along an axis, of 3 and 4 nodes */
  dvi__pattern pattern, drag_pattern, arcs; /* arcs: gradients of the constraints */
  dvi__number_translation translation[DVI__NODE_NUMBERS]; /* the symmetries */
  dvi_symmetry symmetry[DVI__NODE_NUMBERS];               /* what the terms of the system list */
  dvi_lagrangian lagrangian;
  dvi_force viscous;
  dvi_holonomic equal;
};

/* A state, or one at rest with v = NULL. */
typedef struct dvi__moving_state {
  double t;
  const double *q, *v;
} dvi__moving_state;

/* Sums of the Lagrangian and its derivatives. Each may be NULL. */
typedef struct dvi__moving_sums {
  double *L, *L_q, *L_v, *L_qq, *L_qv, *L_vv;
} dvi__moving_sums;

/* A function of the numbers of a stencil's nodes, with derivatives by them. */
typedef struct dvi__stencil {
  int half, size; /* numbers, and those with their rates */
  double y[2 * DVI__STENCIL_NUMBERS];
  double value, first[2 * DVI__STENCIL_NUMBERS];
  double second[4 * DVI__STENCIL_NUMBERS * DVI__STENCIL_NUMBERS]; /* [size*size] */
} dvi__stencil;

/* The volume of a cell, a length or an area, and the gradients of its barycentric coordinates. */
typedef struct dvi__simplex {
  double volume, gradient[DVI__CELL_NODES][DVI_MOVING_AXES_MAX];
} dvi__simplex;

/* Give the volume of the cell whose nodes have the numbers y. It is negative if the cell is turned
 * over. */
double dvi__moving_volume(const dvi_moving *m, const double *y);

/* Give the simplex of such a cell. */
dvi__simplex dvi__moving_simplex(const dvi_moving *m, const double *y);

/* A cell, its numbers and rates, and the gradients of its components. */
typedef struct dvi__moving_element {
  const dvi_moving *m;
  int nodes, rates; /* place of the rates */
  double y[2 * DVI__CELL_NODES * DVI__NODE_NUMBERS];
  dvi__simplex simplex;
  double gradient[DVI_MOVING_COMPONENTS_MAX][DVI_MOVING_AXES_MAX];
} dvi__moving_element;

/* Give a cell. Returns as dvi__moving_gather does. */
int dvi__moving_element_at(const dvi_moving *m, const dvi__moving_state *state, int cell,
                           dvi__moving_element *e);

/* Give a number of node 0, or its rate, at a point of a cell, in barycentric coordinates. */
double dvi__moving_between(const dvi__moving_element *e, const double *place, int number);

/* Give a variable of a density there: u, u_t, u_x or u_y. */
double dvi__moving_variable(const dvi__moving_element *e, const double *place, const dvi_jet *jet);

/* Make the mesh whose points are nodes as they are [dimension*listed]. Its cells are those of
 * reference. */
dvi_status dvi__moving_mesh_of(const dvi_moving *m, const double *node, dvi_mesh **mesh);

/* Find the cells of points [dimension*count] among nodes as they are now [dimension*listed], or -1
 * for points outside. */
dvi_status dvi__moving_find_cells(const dvi_moving *m, const double *node, int64_t count,
                                  const double *x, int *cell);

/* Give the barycentric coordinates of a point, whose axes are `stride` apart, in a cell, and how
 * many periods away its image in the cell is. */
void dvi__moving_place(const dvi__moving_element *e, int64_t stride, const double *x, double *place,
                       double *turn);

/* Complain of a point that is in no cell. */
dvi_status dvi__moving_refuse_point(const dvi_moving *m, const double *node, const double *x,
                                    int64_t stride);

/* Give the corner for a node of an axis, counted on beyond its ends. */
dvi__corner dvi__moving_corner(const dvi_moving *m, int node);

/* Give the place of reference of a corner [dimension]. */
void dvi__moving_reference(const dvi_moving *m, const dvi__corner *corner, double *X);

/* Give the position and the rate of a node of reference position X on the path, each [dimension].
 * Returns as the path does. */
int dvi__moving_follow(const dvi_moving *m, double t, const double *X, double *x, double *rate);

/* Read the numbers and rates of corners into y [2*count*numbers]. Returns as callbacks do, and 1
 * with a reason if they have a cell that is turned over. */
int dvi__moving_gather(const dvi_moving *m, const dvi__moving_state *state,
                       const dvi__corner *corner, int count, double *y);

/* Start a stencil of some nodes with zero derivatives. */
void dvi__stencil_clear(const dvi_moving *m, int nodes, dvi__stencil *s);

/* Add stencil k to the sums. */
void dvi__stencil_scatter(const dvi_moving *m, const dvi__stencils *of, int k,
                          const dvi__stencil *s, const dvi__moving_sums *sums);

/* Add the stiffness of a cell, with derivatives up to an order, to its stencil. */
void dvi__moving_add_barrier(const dvi_moving *m, int cell, int order, const dvi__simplex *now,
                             dvi__stencil *s);

/* Add the integrals over cells and the stiffness of the mesh. Returns as callbacks do. */
int dvi__moving_add_cells(const dvi_moving *m, const dvi__moving_state *state,
                          const dvi__moving_sums *sums);

/* Add the dispersion. Returns as callbacks do. */
int dvi__moving_add_bends(const dvi_moving *m, const dvi__moving_state *state,
                          const dvi__moving_sums *sums);

/* Set all sums to the Lagrangian and its derivatives. Returns as callbacks do. */
int dvi__moving_sum(const dvi_moving *m, const dvi__moving_state *state,
                    const dvi__moving_sums *sums);

/* Fail with the reason of a callback, by a status, or else with what it returned. */
dvi_status dvi__moving_refuse(dvi_status status, int returned);

/* Place so many quadrature points in a cell, in barycentric coordinates. */
dvi_status dvi__moving_rule(int dimension, int points, double (*place)[DVI__CELL_NODES],
                            double *weight);

/* Look for a cell that has no volume. Returns 1 with a reason then, or as the path does. */
int dvi__moving_admit(const dvi_moving *m, const dvi__moving_state *state);

/* Refuse a state on whose mesh a cell has no volume. DVI_BAD_ARGUMENT, or as the path fails. */
dvi_status dvi__moving_check(const dvi_moving *m, const dvi__moving_state *state);

/* The force of viscosity, with derivatives in the drag pattern, as callbacks of a dvi_force. */
int dvi__moving_drag(double t, const double *q, const double *v, double *F, void *user);
int dvi__moving_drag_jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                              void *user);

/* The constraints of DVI_MOVING_EQUAL: one for each pair of cells side by side, their pattern, and
 * the callbacks of a dvi_holonomic. */
dvi_status dvi__moving_lay_out_arcs(dvi_moving *m);
int dvi__moving_arc_value(double t, const double *q, double *phi, void *user);
int dvi__moving_arc_gradient(double t, const double *q, double *phi_q, void *user);
int dvi__moving_arc_hessian(double t, const double *q, const double *w, double *phi_w_qq,
                            void *user);

/* A wave at the listed nodes, in the order of a dvi_moving_wave. */
typedef struct dvi__wave_values {
  double *x, *velocity, *u, *u_x, *u_t;
} dvi__wave_values;

/* Move the nodes along a wave to arcs of one length, and give them velocities that keep that. */
dvi_status dvi__moving_even_out(const dvi_moving *m, dvi_moving_wave *wave, void *user,
                                dvi__wave_values *w);

/* Check terms. The messages name what is wrong. */
dvi_status dvi__moving_check_terms(const dvi_moving_terms *t);

/* Return the components of terms. */
int dvi__moving_components(const dvi_moving_terms *t);

/* Make `count` stencils of nodes side by side on an axis, number k from node first + k on. */
dvi_status dvi__moving_chain(const dvi_moving *m, int first, int count, int nodes,
                             dvi__stencils *s);

/* Take nodes and cells from the axis or the mesh, mark what is no unknown, and give its values. */
dvi_status dvi__moving_take_axis(const dvi_moving_terms *terms, dvi_moving *m);
dvi_status dvi__moving_take_mesh(const dvi_moving_terms *terms, dvi_moving *m);

/* Place the nodes of reference so that the monitor has one integral in all cells. */
dvi_status dvi__moving_grade(const dvi_moving_terms *terms, dvi_moving *m);

/* Number the unknowns, and make patterns and the places of all stencils in them. */
dvi_status dvi__moving_lay_out(dvi_moving *m);

/* Tell if the positions of the nodes are unknowns. */
static inline int dvi__moving_is_free(const dvi_moving *m)
{
  return m->motion != DVI_MOVING_PRESCRIBED;
}

#endif
