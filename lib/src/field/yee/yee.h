/* Yee's grid (dvi/yee.h).
 *
 * All components are stored along rows in x. A row has DVI__YEE_LEFT numbers before the place 0,
 * the places of nodes 0 to cells, and zeros up to whole vectors. The rows of all components at one
 * (j, k) follow each other, so that a step goes through memory once, without many streams. Axes
 * that the grid has carry one layer more at each end, which holds zeros or copies of the other end.
 *
 * The component c has E_c on the edge from node (i, j, k) along c, and B_c through the face from
 * that node across c. With (c, a, b) in cyclic order
 *     B_c -= dt (D_a E_b - D_b E_a),   E_c += M_1^-1 dt (D_a M_2 B_b - D_b M_2 B_a),
 * where D is the forward difference of E, and the backward one of B. Both forms hold integrals, so
 * that B's row has no metric. In E's row lengths along c cancel: at node i of the axis a the first
 * difference is dt/l*_i (B_i/l_i - B_{i-1}/l_{i-1}). */
#ifndef DVI_FIELD_YEE_YEE_H
#define DVI_FIELD_YEE_YEE_H
#include <dvi/yee.h>
#include <math.h>
#include <stdatomic.h>

#include "field/yee/lanes.h"
#include "march/kind.h"
#include "num/team.h"

enum { DVI__YEE_LEFT = 8, DVI__YEE_E = 0, DVI__YEE_B = 3, DVI__YEE_DIFFERENCES = 4 };

/* Factors of absorbing layers, at the boxes of one end of an axis. Each difference D becomes
 * D + r D + psi with psi <- b psi + a D, r = 1/kappa - 1. Factors of nodes act on E, those of boxes
 * on B. Arrays are padded by zeros to whole vectors. */
typedef struct dvi__yee_layers {
  int count; /* boxes, 0 without layers */
  int width; /* padded */
  int first; /* first box, and first node, of the arrays without padding */
  int start; /* place of the first entry of the arrays: `first`, or before it by the padding */
  double *b[2], *a[2], *r[2], *up[2], *down[2]; /* [width] for E and B */
  double *psi;                                  /* [copies], see layers.c */
  size_t psi_count;
} dvi__yee_layers;

typedef struct dvi__yee_axis {
  int cells, nodes;    /* nodes that count: cells + 1, or cells if the axis repeats itself */
  int is_trivial;      /* the grid has no such axis: one box of length 1, without differences */
  int wraps;           /* it repeats itself */
  int is_uniform;      /* all differences at free nodes have the same factor */
  int free[2];         /* nodes free[0] to free[1]-1 have unknowns */
  double cosine, sine; /* of the phase */
  double *node;        /* [cells+1] */
  double *length;      /* [cells] */
  double *dual;        /* [cells+1] */
  double *up, *down;   /* [padded] dt/(l*_i l_i) and dt/(l*_i l_{i-1}), 0 outside */
  dvi_yee_end end[2];
  dvi__yee_layers layers[2];
} dvi__yee_axis;

/* Something that acts on one value of a row: add w[0] drive[from] + w[1] drive[from+1]. */
typedef struct dvi__yee_act {
  int32_t place, from; /* place in the rows of one (j, k) */
  double w[2];
} dvi__yee_act;

/* Acts by rows: those of row r are first[r] to first[r+1]-1. */
typedef struct dvi__yee_acts {
  int64_t count, capacity;
  int64_t *row; /* [count] while they are collected, and [rows+1] the firsts afterwards */
  dvi__yee_act *act;
} dvi__yee_acts;

/* An edge on absorbing ends, at a place of its row. See absorb.c. */
typedef struct dvi__yee_wall {
  int32_t place;
  double s;    /* dt S/(2 M_1) */
  double part; /* s/(1 + s + that of conductors) */
} dvi__yee_wall;

/* The signal of a current or dipole. Its impulse over a step is kept, summed up, for the charge. */
typedef struct dvi__yee_source {
  dvi_yee_signal *signal;
  void *user;
  int is_moment;
  double impulse, compensation; /* since the start */
} dvi__yee_source;

/* A plane wave on a grid of its own. See wave.c. */
typedef struct dvi__yee_beam dvi__yee_beam;

/* A time between the last step and the next one. See sample.c. */
typedef struct dvi__yee_moment dvi__yee_moment;

/* How processes speak with each other about planes of a divided grid. See planes.c. */
typedef struct dvi__yee_planes dvi__yee_planes;

typedef struct dvi__yee {
  int axes, degree;
  dvi__yee_axis axis[3];
  int copies;        /* 2 with a phase, else 1 */
  int slot[6];       /* of E_c and B_c among the rows of one (j, k), -1 without it */
  int components;    /* number of slots */
  int edges_slots;   /* slots of E. They come first */
  size_t width;      /* numbers of a row */
  size_t count;      /* places that a loop passes over */
  int parts[3];      /* processes along an axis, 1 unless it is divided. x is not */
  int part[3];       /* the number of this process along each axis */
  int own[3][2];     /* nodes own[l][0] to own[l][1]-1 of an axis are of this process */
  int ghosts[3][2];  /* planes before and behind these that it works on, too. See planes.c */
  int first[3];      /* the place along an axis that is the first one in memory */
  int around[3];     /* boxes of a divided axis that repeats itself, 0 for others */
  size_t rows[2];    /* rows along y, planes along z, with the layers around them */
  size_t size;       /* numbers of a copy */
  ptrdiff_t next[3]; /* from a place to the next one along an axis, 0 if trivial */
  double *state[2];  /* [size] */
  /* Materials, NULL for those of vacuum: [rows][edges_slots][width] beside E */
  double *ce;          /* 1/(eps (1+s)) with s = sigma dt/(2 eps) */
  double *ca;          /* (1-s)/(1+s). NULL without losses */
  double *loss;        /* s. NULL without losses */
  double *worn;        /* sum of s (E+ + E-), the conducted part of D. NULL without losses */
  char *loses;         /* [rows][edges_slots] if a row has any loss. NULL without losses */
  double *mi;          /* 1/mu, [rows][components - edges_slots][width] beside B */
  int64_t *wall_first; /* [rows of edges + 1] first ones of the rows. NULL without them */
  dvi__yee_wall *wall;
  double dt, bound, t0, t;
  int64_t step;            /* steps since the start: B at t0 + step dt, E half a step later */
  int64_t unknowns, faces; /* of the whole grid */
  dvi__yee_source *source; /* [sources] */
  int sources;
  dvi__yee_beam *beam; /* [beams] */
  int beams;
  dvi__yee_acts on_edges, on_faces;
  int drives;    /* numbers that act on a step */
  double *drive; /* [together + 2][drives], the last two for samples */
  dvi__yee_moment *moment;
  dvi__yee_planes *planes; /* NULL unless the grid is divided */
  double *charge;          /* [nodes] outflow of D at the start, NULL before one with a field */
  dvi_yee_probe *probe;
  dvi_yee_flux *flux;
  char *names;
  double *impulses; /* [drives], for charges */
  int probes, fluxes;
  int threads, together, tile;
  dvi__team *team;      /* NULL for one thread */
  double *scratch;      /* [threads][DVI__YEE_SCRATCH][width] */
  atomic_int *progress; /* [tiles], see sweep.c */
  const dvi__yee_lanes *lanes;
} dvi__yee;

enum { DVI__YEE_SCRATCH = 10, DVI__YEE_MOST_TOGETHER = 16 };

/* ---- places ---- */

/* Tell if processes divide an axis among them. */
static inline int dvi__yee_is_divided(const dvi__yee *y, int axis)
{
  return y->parts[axis] > 1;
}

/* Give how many layers an axis has before (0) the own places, or behind (1) the own boxes. */
static inline int dvi__yee_margin(const dvi__yee *y, int axis, int side)
{
  const int ghosts = y->ghosts[axis][side];
  return ghosts > 0 ? ghosts : !y->axis[axis].is_trivial;
}

/* Give the number of a place along an axis among those in memory. An axis that is divided has
 * planes of the other processes beside the own ones, and may repeat itself. */
static inline size_t dvi__yee_row_along(const dvi__yee *y, int axis, int i)
{
  int row = i - y->first[axis];
  if (y->around[axis] > 0) {
    if (row < 0) row += y->around[axis];
    if (row >= (int)y->rows[axis - 1]) row -= y->around[axis];
  }
  return (size_t)row;
}

/* Give the number of the rows at (j, k), which may be -1 on axes that the grid has. */
static inline size_t dvi__yee_row(const dvi__yee *y, int j, int k)
{
  return dvi__yee_row_along(y, 2, k) * y->rows[0] + dvi__yee_row_along(y, 1, j);
}

/* Give the place 0 of a component's row. `component` is DVI__YEE_E + c or DVI__YEE_B + c. */
static inline size_t dvi__yee_at(const dvi__yee *y, int component, int j, int k)
{
  return (dvi__yee_row(y, j, k) * (size_t)y->components + (size_t)y->slot[component]) * y->width +
         DVI__YEE_LEFT;
}

/* Give the place 0 of the row beside E_c in the arrays of materials, and beside B_c. */
static inline size_t dvi__yee_at_edges(const dvi__yee *y, int c, int j, int k)
{
  return (dvi__yee_row(y, j, k) * (size_t)y->edges_slots + (size_t)y->slot[c]) * y->width +
         DVI__YEE_LEFT;
}

static inline size_t dvi__yee_at_faces(const dvi__yee *y, int c, int j, int k)
{
  const int slots = y->components - y->edges_slots;
  return (dvi__yee_row(y, j, k) * (size_t)slots +
          (size_t)(y->slot[DVI__YEE_B + c] - y->edges_slots)) *
             y->width +
         DVI__YEE_LEFT;
}

/* Tell if a place of the row of E_c has losses. */
static inline int dvi__yee_loses(const dvi__yee *y, int c, int j, int k)
{
  return y->loses != NULL && y->loses[dvi__yee_at_edges(y, c, j, k) / y->width];
}

/* Tell if E_c or B_c reaches along the axis, so that it has a place for each box, not node. */
static inline int dvi__yee_reaches(int component, int axis)
{
  return (component < DVI__YEE_B) == (component % 3 == axis);
}

/* Give the number of places of a component along an axis. */
static inline int dvi__yee_places(const dvi__yee *y, int component, int axis)
{
  const dvi__yee_axis *a = &y->axis[axis];
  return dvi__yee_reaches(component, axis) ? a->cells : a->nodes;
}

/* Give the first place of a component along an axis that this process has, and the one behind the
 * last. */
static inline int dvi__yee_begin(const dvi__yee *y, int axis)
{
  return y->own[axis][0];
}
static inline int dvi__yee_end(const dvi__yee *y, int component, int axis)
{
  const int places = dvi__yee_places(y, component, axis);
  return y->own[axis][1] < places ? y->own[axis][1] : places;
}

/* Tell if a place is of this process, or with others of its number along an axis. */
static inline int dvi__yee_owns_along(const dvi__yee *y, int axis, int i)
{
  return !dvi__yee_is_divided(y, axis) || (i >= y->own[axis][0] && i < y->own[axis][1]);
}
static inline int dvi__yee_owns(const dvi__yee *y, const int *place)
{
  return dvi__yee_owns_along(y, 1, place[1]) && dvi__yee_owns_along(y, 2, place[2]);
}

/* Give the places of an axis at which this process updates E, or B, so that `left` more steps need
 * nothing of other processes, where it has ghosts: from range[0] to range[1]-1. On an axis that
 * repeats itself they may be beyond its ends. */
static inline void dvi__yee_reach(const dvi__yee *y, int axis, int is_face, int left, int *range)
{
  range[0] = y->own[axis][0] - (y->ghosts[axis][0] > 0 ? left + is_face : 0);
  range[1] = y->own[axis][1] + (y->ghosts[axis][1] > 0 ? left : 0);
}

/* Give the place of the grid for one that is beyond the end of an axis that repeats itself. */
static inline int dvi__yee_around(const dvi__yee *y, int axis, int i)
{
  const dvi__yee_axis *a = &y->axis[axis];
  if (i < 0) return i + a->cells;
  return a->wraps && i >= a->cells ? i - a->cells : i;
}

/* Tell if this process updates a component in some step at the number i along an axis, and at a
 * place. */
static inline int dvi__yee_updates_along(const dvi__yee *y, int component, int axis, int i)
{
  const int around = y->around[axis];
  int range[2];
  if (!dvi__yee_is_divided(y, axis)) return 1;
  dvi__yee_reach(y, axis, component >= DVI__YEE_B, y->together - 1, range);
  return (i >= range[0] && i < range[1]) || (i - around >= range[0] && i - around < range[1]) ||
         (i + around >= range[0] && i + around < range[1]);
}
static inline int dvi__yee_updates(const dvi__yee *y, int component, const int *place)
{
  return dvi__yee_updates_along(y, component, 1, place[1]) &&
         dvi__yee_updates_along(y, component, 2, place[2]);
}

/* Give the last own plane of boxes along an axis. */
static inline int dvi__yee_last_boxes(const dvi__yee *y, int axis)
{
  return dvi__yee_end(y, axis, axis) - 1;
}

/* Tell if E_c has an unknown at the place i of an axis. */
static inline int dvi__yee_is_free(const dvi__yee *y, int c, int axis, int i)
{
  const dvi__yee_axis *a = &y->axis[axis];
  return c == axis ? i >= 0 && i < a->cells : i >= a->free[0] && i < a->free[1];
}

/* Tell if a node of an axis is on an absorbing end. */
static inline int dvi__yee_absorbs_at(const dvi__yee_axis *a, int node)
{
  return (node == 0 && a->end[0].kind == DVI_YEE_ABSORBING) ||
         (node == a->cells && a->end[1].kind == DVI_YEE_ABSORBING);
}

/* Tell if E_c has an unknown at a place. */
static inline int dvi__yee_is_unknown(const dvi__yee *y, int c, const int *place)
{
  return dvi__yee_is_free(y, c, 0, place[0]) && dvi__yee_is_free(y, c, 1, place[1]) &&
         dvi__yee_is_free(y, c, 2, place[2]);
}

/* ---- materials at a place ---- */

/* Give where the arrays of materials have a component's place. */
static inline size_t dvi__yee_beside(const dvi__yee *y, int component, const int *place)
{
  const size_t row = component < DVI__YEE_B
                         ? dvi__yee_at_edges(y, component, place[1], place[2])
                         : dvi__yee_at_faces(y, component - DVI__YEE_B, place[1], place[2]);
  return row + (size_t)place[0];
}

/* Give s of E_c in conductors. */
static inline double dvi__yee_conduction(const dvi__yee *y, int c, const int *place)
{
  return y->loss != NULL ? y->loss[dvi__yee_beside(y, c, place)] : 0;
}

/* Give s of E_c on absorbing ends, 0 elsewhere. See absorb.c. */
double dvi__yee_wall_loss(const dvi__yee *yee, int c, const int *place);

/* Give s of E_c, of conductors and absorbing ends. */
static inline double dvi__yee_loss(const dvi__yee *y, int c, const int *place)
{
  return dvi__yee_conduction(y, c, place) + dvi__yee_wall_loss(y, c, place);
}

/* Give 1/eps of E_c. */
static inline double dvi__yee_over_eps(const dvi__yee *y, int c, const int *place)
{
  if (y->ce == NULL) return 1;
  return y->ce[dvi__yee_beside(y, c, place)] * (1 + dvi__yee_conduction(y, c, place));
}

/* Give 1/mu of B_c. */
static inline double dvi__yee_over_mu(const dvi__yee *y, int c, const int *place)
{
  return y->mi != NULL ? y->mi[dvi__yee_beside(y, DVI__YEE_B + c, place)] : 1;
}

/* ---- time ---- */

/* Give the part of a step that is within a few roundings of the times. */
static inline double dvi__yee_spare(const dvi__yee *y, double t)
{
  return 4 * 2.3e-16 * (fabs(t) + fabs(y->t0)) / y->dt + 1e-12;
}

/* ---- axis.c ---- */

/* Make an axis from its terms, or a trivial one from NULL. */
dvi_status dvi__yee_make_axis(const dvi_yee_axis *terms, int number, dvi__yee_axis *axis);
void dvi__yee_clear_axis(dvi__yee_axis *axis);
/* Set the factors of differences for a step. */
void dvi__yee_set_step(dvi__yee_axis *axis, double dt);
/* Give the node nearest to a coordinate. */
int dvi__yee_nearest(const dvi__yee_axis *axis, double x);
/* Give the box that holds a coordinate, and its part of the box' length. */
int dvi__yee_locate(const dvi__yee_axis *axis, double x, double *part);
/* Give the pieces of boxes around a node: one or two boxes, with their bounds. */
int dvi__yee_pieces(const dvi__yee_axis *axis, int node, int *cell, double *lower, double *upper);

/* ---- grid.c ---- */

/* Make the grid's axes and its sizes without any memory for fields. */
dvi_status dvi__yee_make_grid(const dvi_yee_terms *terms, dvi__yee *yee);

/* Give the number of a form's cells that this process has, and of all. */
int64_t dvi__yee_form_size(const dvi__yee *yee, dvi_march_form form);
int64_t dvi__yee_whole_size(const dvi__yee *yee, dvi_march_form form);
/* Give the number of nodes that this process has. */
size_t dvi__yee_count_nodes(const dvi__yee *yee);
/* Give the number of a place among the cells of its form in the whole grid. */
int64_t dvi__yee_whole_number(const dvi__yee *yee, int component, const int *place);
/* Give the component and the place of a form's cell. */
void dvi__yee_place_of(const dvi__yee *yee, dvi_march_form form, int64_t number, int *component,
                       int *place);
/* Integrate a component of a function over a box, along the axes for which `reaches` is not 0. */
dvi_status dvi__yee_integrate_box(const double *lower, const double *upper, const int *reaches,
                                  dvi_form_function *function, void *user, int which, double *sum);

/* ---- media.c ---- */

/* Make the arrays of materials, but for losses, which need a step. */
dvi_status dvi__yee_make_media(const dvi_yee_terms *terms, dvi__yee *yee);
dvi_status dvi__yee_make_losses(const dvi_yee_terms *terms, dvi__yee *yee);
/* Give the mean of sqrt(eps/mu) over the pieces of boxes around an edge. */
dvi_status dvi__yee_admittance(const dvi_yee_terms *terms, const dvi__yee *yee, int c,
                               const int *place, double *mean);
/* Give the entry of a star: M_1 of E_c, without the losses in ce, or M_2 of B_c. */
double dvi__yee_star(const dvi__yee *yee, int component, const int *place);
/* Give `count` of them along x, from a place on. */
void dvi__yee_stars(const dvi__yee *yee, int component, const int *place, int count, double *star);

/* ---- bound.c ---- */

/* Give the largest stable step, infinite if nothing moves. */
dvi_status dvi__yee_find_bound(dvi__yee *yee, double *bound);
/* Give the place x [3] where boxes and materials demand the smallest step, in the whole grid. */
void dvi__yee_tightest(const dvi__yee *yee, double *x);

/* ---- lanczos.c ---- */

/* Bound the largest eigenvalue of a grid without losses, whose factors are those of a step of 1, by
 * at most a thousandth of it, given another bound. */
dvi_status dvi__yee_lanczos(const dvi__yee *yee, double other, double *bound);

/* ---- layers.c ---- */

/* The four differences along an axis a that layers change: of E_c in B_b, of E_b in B_c, of H_c in
 * E_b, and of H_b in E_c, with (a, b, c) in cyclic order. */
dvi_status dvi__yee_make_layers(dvi__yee *yee);
/* Give the place 0 of psi along x, or with the axis x the first of the layers' entries. `which` is
 * 0 to 3 in the order above. `layer` counts from the first of the layers, and is not used for x. */
size_t dvi__yee_psi_at(const dvi__yee *yee, int axis, int end, int copy, int which, int layer,
                       int j, int k);

/* Copy all of the rows at (j, k) to a buffer or from it. Return how many numbers they are. */
size_t dvi__yee_copy_sums(const dvi__yee *yee, int j, int k, double *buffer, int takes);

/* ---- row.c ---- */

/* Who updates rows: a member of the team, in one of the steps that are taken together. */
typedef struct dvi__yee_worker {
  const dvi__yee *yee;
  double *scratch;     /* [DVI__YEE_SCRATCH][width] */
  const double *drive; /* [drives] of the step */
} dvi__yee_worker;

void dvi__yee_update_faces(const dvi__yee_worker *worker, int j, int k);
void dvi__yee_update_edges(const dvi__yee_worker *worker, int j, int k);
/* Copy what other ends of axes that repeat themselves need from the rows at (j, k). */
void dvi__yee_wrap_rows(const dvi__yee *yee, int j, int k);

/* ---- sweep.c ---- */

/* Choose how many steps go together, as all processes do. */
dvi_status dvi__yee_choose_together(dvi__yee *yee, const dvi_yee_terms *terms);
/* Choose the tiles, and make what sweeps need. */
dvi_status dvi__yee_make_sweeps(dvi__yee *yee, const dvi_yee_terms *terms);
/* Take up to `together` steps with the drives that are prepared. */
void dvi__yee_sweep(dvi__yee *yee, int steps);

/* ---- absorb.c ---- */

/* Make the list of edges on absorbing ends, after materials and losses. */
dvi_status dvi__yee_make_walls(const dvi_yee_terms *terms, dvi__yee *yee);
/* Keep what a row of E_c is on absorbing ends before a step, and absorb there after it. */
void dvi__yee_keep_before(const dvi__yee *yee, int c, int j, int k, const double *e,
                          double *before);
void dvi__yee_absorb(const dvi__yee *yee, int c, int j, int k, const double *before, double *e);
/* Return how many edges of a row of E_c are on absorbing ends, where there are any. */
int64_t dvi__yee_count_walls(const dvi__yee *yee, int c, int j, int k);

/* ---- start.c ---- */

dvi_status dvi__yee_start(void *yee, const dvi_march_state *state);
/* Copy values at ends of axes that repeat themselves, and of other processes, to where the first
 * step looks for them. */
void dvi__yee_wrap_values(dvi__yee *yee);

/* ---- sources.c ---- */

dvi_status dvi__yee_make_sources(const dvi_yee_terms *terms, dvi__yee *yee);
/* Give the drives of the first half step from t0, in the first row of drives. */
dvi_status dvi__yee_start_sources(dvi__yee *yee, double t0);
/* Let the sums of impulses begin with those of the first half step. */
void dvi__yee_restart_impulses(dvi__yee *yee);
/* Prepare the drives of the next steps. *ready of them have signals that did not fail. */
dvi_status dvi__yee_prepare(dvi__yee *yee, int steps, int *ready);
/* Add the impulses of steps that have been taken. */
void dvi__yee_take_impulses(dvi__yee *yee, int steps);
/* DVI_BAD_ARGUMENT if a point is outside of the grid. */
dvi_status dvi__yee_check_inside(const dvi__yee *yee, const double *x, const char *what,
                                 int number);
/* Give the place of one of the cells of a component around a point, and Whitney's weight there. The
 * bits of `which`, from 0 to 7, choose the far one along each axis. */
void dvi__yee_whitney(const dvi__yee *yee, int component, const double *x, int which, int *place,
                      double *weight);

/* ---- acts.c ---- */

/* Add an act on a component's place. */
dvi_status dvi__yee_add_act(const dvi__yee *yee, dvi__yee_acts *acts, int component,
                            const int *place, int from, double w0, double w1);
/* Sort acts by their rows and places. */
dvi_status dvi__yee_sort_acts(const dvi__yee *yee, dvi__yee_acts *acts);
void dvi__yee_clear_acts(dvi__yee_acts *acts);
/* Give what drives add to a component's place. */
double dvi__yee_acted(const dvi__yee *yee, const dvi__yee_acts *acts, int component,
                      const int *place, const double *drive);

/* ---- sample.c ---- */

/* A value of the copies. */
typedef struct dvi__yee_value {
  double re, im;
} dvi__yee_value;

struct dvi__yee_moment {
  int is_now; /* nothing has moved since it was set */
  const dvi__yee *yee;
  double part;            /* from 0 to 1, the part of the next step */
  const double *on_faces; /* drives of B's next step */
  const double *on_edges; /* drives of E from the last half step to this time */
  const double *below[3]; /* B at this time before the own planes of divided axes */
};

/* Give what E_c and B_c are at a place, which may be beyond the end of an axis that repeats
 * itself, and 0 outside. */
dvi__yee_value dvi__yee_stored(const dvi__yee *yee, int component, const int *place);
dvi__yee_value dvi__yee_B_at(const dvi__yee_moment *moment, int c, const int *place);
dvi__yee_value dvi__yee_E_at(const dvi__yee_moment *moment, int c, const int *place);
/* Give B at the moment to the processes after this one, which need it for E. */
void dvi__yee_pass_moment(dvi__yee_moment *moment);
/* Move E_c at a place from the start to half a step later, with the curl of H if there is B. */
void dvi__yee_start_edge(const dvi__yee_moment *moment, int c, const int *place, int has_B);
/* Set the moment to the march's time, and prepare its drives. */
dvi_status dvi__yee_set_moment(const dvi__yee *yee);
dvi_status dvi__yee_sample(const void *yee, dvi_march_form form, int64_t count, const int *cell,
                           double *values);

/* ---- wave.c ---- */

dvi_status dvi__yee_make_waves(const dvi_yee_terms *terms, dvi__yee *yee);
void dvi__yee_clear_waves(dvi__yee *yee);
/* Ask for the signals of all waves at a time, before the first one moves. */
dvi_status dvi__yee_ask_waves(dvi__yee *yee, double t);
void dvi__yee_start_waves(dvi__yee *yee);
/* Move the waves by a step, and give their drives. */
void dvi__yee_move_waves(dvi__yee *yee, double *drive);
/* Give the drives of a moment. */
void dvi__yee_sample_waves(const dvi__yee_moment *moment, double *on_faces, double *on_edges);
/* Give a wave's part of the state. */
double *dvi__yee_line_of(const dvi__yee *yee, int wave, size_t *count);
/* Tell if a node is on the surface of a wave's box, or if a box touches it from outside. */
int dvi__yee_is_on_wave(const dvi__yee *yee, const int *place, int is_box);

/* ---- observe.c ---- */

dvi_status dvi__yee_make_observables(const dvi_yee_terms *terms, dvi__yee *yee);
/* Keep the charges of a start. */
void dvi__yee_keep_charge(dvi__yee *yee);
int dvi__yee_observables(const void *yee);
const char *dvi__yee_observable(const void *yee, int i);
dvi_status dvi__yee_observe(const void *yee, int i, double *value);

/* ---- saved.c ---- */

/* Numbers of the state that follow each other. */
typedef struct dvi__yee_piece {
  double *x; /* NULL if another process has them */
  size_t count;
} dvi__yee_piece;

enum { DVI__YEE_PIECES = 48 };

/* Give the pieces at (j, k), which are as many on all processes, and as long: of the fields, of
 * what was conducted, and of the sums of layers, or the charges of the start. Return their
 * number. */
int dvi__yee_saved(const dvi__yee *yee, int j, int k, dvi__yee_piece *piece);
int dvi__yee_saved_charge(const dvi__yee *yee, int j, int k, dvi__yee_piece *piece);

/* ---- files.c ---- */

dvi_status dvi__yee_save(const void *yee, dvi__sections_writer *writer);
dvi_status dvi__yee_load(void *yee, const dvi__sections *sections);

#endif
