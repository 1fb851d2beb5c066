/* The inside of a charted system, shared by the files charted*.c. */
#ifndef DVI_SYSTEM_CHART_CHARTED_STRUCT_H
#define DVI_SYSTEM_CHART_CHARTED_STRUCT_H
#include "core/status.h"
#include "group/chart_nodes.h"
#include "system/chart/charted.h"
#include "system/chart/reduced.h"

/* Points are evaluated in groups of this size, which does not depend on the size of the batch. */
enum { DVI__GROUP = 8 };

/* Position of a block of chart coordinates in a pattern, by its first entry and the length of its
 * columns. */
typedef struct dvi__place {
  int first, column;
} dvi__place;

/* Entry of a block of two slots, and its row and column there. */
typedef struct dvi__block_entry {
  int entry, row, column;
} dvi__block_entry;

/* Block of two slots in a matrix of stored coordinates, with the first of its entries, which end
 * where those of the next block begin, and its places in the new system's patterns. */
typedef struct dvi__slot_block {
  int row, column, first;
  dvi__place qq, qv, vv;
} dvi__slot_block;

typedef struct dvi__slot_blocks {
  int count;
  dvi__slot_block *block; /* [count+1] */
  dvi__block_entry *entry;
} dvi__slot_blocks;

/* Second derivatives of the new system, in the order of its patterns. */
typedef struct dvi__hessian {
  double *qq, *qv, *vv;
} dvi__hessian;

/* Blocks that couple a body's rotation and its place x. Rotation is in rows and x in columns of qq
 * and qv. vv has both ways. */
typedef struct dvi__coupling {
  dvi__place qq[3], qv[3], vv[3], vv_back[3];
} dvi__coupling;

/* Holonomic constraints of one term in the charts (charted_rows.c). */
typedef struct dvi__charted_rows {
  dvi__charted *of;
  const dvi__holonomic_term *term; /* of the base */
  int *slot, slot_count;           /* slots that the rows touch */
  dvi__pattern gradients, qq;      /* in the charts */
  /* block of every entry of the base's gradients, by its first entry, and of its Hessian */
  int *in_gradients;
  dvi__place *in_qq, *own_in_qq;
} dvi__charted_rows;

struct dvi__charted {
  const dvi_system *base;
  dvi_system *system;
  dvi__evaluator *evaluator; /* evaluator of base */
  dvi_counters *counters;
  dvi__chart *chart; /* charts [slots] */
  /* slot of each stored coordinate [nq], and of each chart coordinate [nx] */
  int *slot, *slot_of_x;
  dvi_status failure; /* status and sentence of the last evaluation */
  char sentence[DVI__SENTENCE_SIZE];
  /* functions [slots] of the charts, at one point */
  dvi__functions *functions;
  /* A group's points t [GROUP], others [nq*GROUP], with w = M y'. */
  double *t, *y, *rate, *L_y, *w;
  double *L_yy; /* second derivatives [entries*GROUP] */
  /* tangents [nq*3*GROUP] at the points of a group, number i of point k at i*GROUP + k */
  double *T, *S;
  double *slot_blocks;                 /* [4*9*GROUP] a slot's second derivatives there */
  dvi__pattern qq, qv, vv;             /* patterns of the new system */
  dvi__slot_blocks masses, potentials; /* blocks of vv that are not 0, and of qq */
  /* Diagonal blocks [slots] of the slots. Lines may have none. */
  dvi__place *own_in_qq, *own_in_qv;
  /* Parts of a Lagrangian without potentials that the group leaves invariant (charted_reduced.c).
   * reduced.bodies is NULL for other Lagrangians. */
  dvi__reduced reduced;
  /* Masses of factors that it does not couple [slots*9], NULL if the mass couples factors, and the
   * diagonal of each slot's own mass [slots*3] (charted_mass.c). */
  double *inertia, *own_mass;
  double *stumpff; /* [slots*DVI__NODE_FUNCTIONS*GROUP] Stumpff's functions at a group's points */
  /* Constraints [base's count], and work at one point: y, dy/dxi, gradients, Hessian, gradient of
   * phi.w, numbers of dvi__holonomic_at. */
  dvi__charted_rows *rows;
  double *rows_y, *rows_T, *rows_phi_y, *rows_phi_yy, *rows_covector, *rows_moved;
  /* Forces at one point: the stored velocity and F, [nv] each. Patterns of the charts' forces. */
  double *force_v, *force;
  dvi__pattern force_q, force_rate;
  dvi__place *own_in_vv;     /* diagonal blocks [slots] */
  dvi__coupling *coupled_in; /* coupling blocks [bodies] */
  /* Paths from the centre (dvi__charted_centring), for which from_centre is not 0. N is moment
   * [slots*3*capacity], at node j of a batch [(3 c + a)*capacity + j]. */
  int from_centre, capacity;
  double *W, *end, *moment; /* W [slots*9], xi1 [nx], and N */
  /* Impulses mu1 - mu0 [slots*3] of the last path by the Lagrangian, and by other forces on the
   * way. A rotation has them in the centre's frame. */
  double *impulse, *kick;
  int *first, *width;          /* first coordinate [nx] of every coordinate's block, and its size */
  double *turned_T, *turned_S; /* y x and y' x, times W, as T and S */
  double *C_q1, *C_qq, *C_qv;  /* derivatives [entries], [entries*capacity] */
};

/* Return 1 for rotations and directions, which turn and have moments. */
static inline int dvi__turns(const dvi__factor_slot *slot)
{
  return slot->kind == DVI__ROTATION || slot->kind == DVI__SPHERE;
}

/* Return the tangents of stored coordinate i of a slot, among those of all. */
static inline const double *dvi__charted_tangents_of(const dvi__factor_slot *slot,
                                                     const double *tangents, int i)
{
  return tangents + 3 * (size_t)slot->q +
         (size_t)(i - slot->q) * (size_t)dvi__chart_size(slot->kind);
}

/* Make the charts' constraints, and declare them. `list` [base's count] is for the terms of the new
 * system. */
dvi_status dvi__charted_make_rows(dvi__charted *charted, dvi_holonomic *list);
void dvi__charted_clear_rows(dvi__charted *charted);

/* Make the charts' force, and declare it, if the base has forces. */
dvi_status dvi__charted_make_force(dvi__charted *charted, dvi_force *force);
void dvi__charted_clear_force(dvi__charted *charted);

/* Compute the pattern of full blocks where slots meet in a or b, which may be NULL. With `own` all
 * diagonal blocks are added, without it those of slots that are no lines. */
dvi_status dvi__charted_slot_pattern(const dvi__charted *charted, const dvi__pattern *a,
                                     const dvi__pattern *b, int own, dvi__pattern *made);

/* Find the block in `made` of every entry of `part`, a matrix of stored coordinates, and of every
 * slot. */
dvi_status dvi__charted_place_entries(const dvi__charted *charted, const dvi__pattern *part,
                                      const dvi__pattern *made, dvi__place **places);
dvi_status dvi__charted_place_own(const dvi__charted *charted, const dvi__pattern *made,
                                  dvi__place **places);

/* Find the first entry of the block of two slots in a pattern of the new system. */
dvi__place dvi__charted_place(const dvi__charted *charted, const dvi__pattern *pattern,
                              int row_slot, int column_slot);

/* Add a matrix [rows*columns] to its block, for point k of `count`. */
void dvi__charted_add_block(const dvi__place *at, int rows, int columns, const double *matrix,
                            size_t count, size_t k, double *values);

/* Compute the new system's patterns, and the blocks in them of all entries of the stored
 * coordinates. */
dvi_status dvi__charted_make_patterns(dvi__charted *charted);

/* Callbacks of the new system. */
int dvi__charted_value(int count, const double *t, const double *xi, const double *rate, double *L,
                       void *user);
int dvi__charted_gradient(int count, const double *t, const double *xi, const double *rate,
                          double *L_xi, double *L_rate, void *user);
int dvi__charted_hessian(int count, const double *t, const double *xi, const double *rate,
                         double *L_qq, double *L_qv, double *L_vv, void *user);

/* The same callbacks for a reduced Lagrangian. dvi__reduced_place finds its blocks, once. */
int dvi__reduced_value(int count, const double *t, const double *xi, const double *rate, double *L,
                       void *user);
int dvi__reduced_gradient(int count, const double *t, const double *xi, const double *rate,
                          double *L_xi, double *L_rate, void *user);
int dvi__reduced_hessian(int count, const double *t, const double *xi, const double *rate,
                         double *L_qq, double *L_qv, double *L_vv, void *user);
dvi_status dvi__reduced_place(dvi__charted *charted);

/* Read the masses of slots. */
dvi_status dvi__charted_read_masses(dvi__charted *charted);

/* Compute the change of a body's angular momentum on a path, in the frame of the centre. A moving x
 * with momentum changes the angular one by Ad*. */
void dvi__reduced_impulse(const dvi__charted *charted, const dvi__reduced_body *body,
                          const double *p0, double *impulse);

/* Add the derivative of the charted momentum there by the end of x to the blocks of qq. */
void dvi__reduced_derive(const dvi__charted *charted, const dvi__reduced_body *body,
                         const dvi__coupling *at, const double *p0, double *C_q1);

/* Return the number of a callback for a status. The status is kept with its sentence. */
int dvi__charted_verdict(dvi__charted *charted, dvi_status status);

/* Fail for a coordinate that is beyond its chart by this angle. */
dvi_status dvi__charted_too_large(double turned);

/* Add left^T (entry) right to the block of an entry (i,j), for point k of `count`. */
void dvi__charted_add_entry(const dvi__place *at, int rows, int columns, double entry,
                            const double *left, const double *right, size_t count, size_t k,
                            double *values);

/* Copy xi or rate of point k of a batch of `count`, for a slot. */
void dvi__charted_gather(const dvi__factor_slot *slot, int count, int k, const double *batch,
                         double *one);

/* Compute y, rate, L_y = -V_y and w of the group that begins at point `first` of a batch. */
dvi_status dvi__charted_forces(dvi__charted *charted, int count, int first, int group,
                               const double *t, const double *xi, const double *rate);

/* Give the numbers of slot c at a group of points that begins at point `first` of a batch. xi and
 * rate may be NULL if they are not read. */
dvi__chart_nodes dvi__charted_nodes(const dvi__charted *charted, int c, int count, int first,
                                    int group, const double *xi, const double *rate);

/* Compute N at the nodes of a group whose forces are known. */
void dvi__charted_find_moments(dvi__charted *charted, int first, int group);

/* List the blocks of the mass and of the potentials (charted_blocks.c). */
dvi_status dvi__charted_make_blocks(dvi__charted *charted);
void dvi__charted_clear_blocks(dvi__charted *charted);

/* Add the products of T, S and, on a path, turned_T and turned_S with these blocks, for the group
 * that begins at point `first` of a batch. */
void dvi__charted_add_blocks(const dvi__charted *charted, int count, int first, int group,
                             int on_path, const dvi__hessian *to);

/* Add T^T M T at point 0 of a group. */
void dvi__charted_add_mass(const dvi__charted *charted, double *mass);

/* Add the diagonal blocks of slot c. */
void dvi__charted_add_own_blocks(const dvi__charted *charted, int c, const double *in_qq,
                                 const double *in_qv, size_t count, size_t k, double *qq,
                                 double *qv);

/* Compute W at the end of the path. */
void dvi__charted_find_turns(dvi__charted *charted);

/* Compute the change of W N into C_qq and C_qv. The first function clears both. Slots and blocks
 * add theirs to them with the Hessian (charted_hessian.c). The last subtracts L's own Hessian. */
void dvi__charted_clear_changes(dvi__charted *charted, int count);
void dvi__charted_finish_changes(const dvi__charted *charted, int count, const double *L_qq,
                                 const double *L_qv);

/* Return 1 if a batch of `count` points has the nodes of a path from the centre. */
int dvi__charted_on_path(const dvi__charted *charted, int count);

#endif
