/* The inside of a charted system, for its files: charted.c, charted_pattern.c,
 * charted_lagrangian.c, charted_hessian.c, charted_path.c. */
#ifndef DVI_SYSTEM_CHARTED_STRUCT_H
#define DVI_SYSTEM_CHARTED_STRUCT_H
#include "core/status.h"
#include "system/chart/charted.h"
#include "system/chart/reduced.h"

/* Points are taken in groups, whose size does not depend on the batch that is asked for. */
enum { DVI__GROUP = 8 };

/* Where a block of chart coordinates stands in a pattern: its first entry, and how long its columns
 * are. */
typedef struct dvi__place {
  int first, column;
} dvi__place;

/* Blocks of a body's rotation and its place x: rotation in rows and x in columns of qq and qv, both
 * ways in vv. */
typedef struct dvi__coupling {
  dvi__place qq[3], qv[3], vv[3], vv_back[3];
} dvi__coupling;

struct dvi__charted {
  const dvi_system *base;
  dvi_system *system;
  dvi__evaluator *evaluator; /* of base */
  dvi_counters *counters;
  dvi__chart *chart;     /* [slots] */
  int *slot, *slot_of_x; /* [nq], [nx] that a stored coordinate, and a chart's, belongs to */
  dvi_status failure;    /* of the last evaluation, and why */
  char sentence[DVI__SENTENCE_SIZE];
  /* [slots*GROUP] of the charts, at the points of a group */
  dvi__functions *functions;
  /* a group: [GROUP], [nq*GROUP]; w = M y' */
  double *t, *y, *rate, *L_y, *w;
  double *L_yy;            /* [entries*GROUP] */
  double *T, *S;           /* [nq*3], of one point */
  double *curved, *mixed;  /* [slots*9], of one point */
  dvi__pattern qq, qv, vv; /* of the new system */
  /* of every entry of the stored coordinates' matrices */
  dvi__place *in_qq, *mass_in_qq, *mass_in_qv, *mass_in_vv;
  /* [slots] of their diagonal blocks; of lines these may be missing */
  dvi__place *own_in_qq, *own_in_qv;
  /* Without potentials, and left as it is by the group: what its Lagrangian is made of
   * (charted_reduced.c); bodies NULL: it is not. */
  dvi__reduced reduced;
  dvi__place *own_in_vv;     /* [slots] */
  dvi__coupling *coupled_in; /* [bodies] */
  /* Paths from the centre (dvi__charted_centring): not 0 for those; N [slots*3*capacity], at node j
   * of a batch [(3 c + a)*capacity + j]. */
  int from_centre, capacity;
  double *W, *end, *moment; /* W [slots*9], xi1 [nx] */
  /* [slots*3] mu1 - mu0 of the last path, of a rotation in the centre's frame */
  double *impulse;
  double *turned_T, *turned_S; /* [nq*3] y x and y' x, times W, of one point */
  double *C_q1, *C_qq, *C_qv;  /* [entries], [entries*capacity] */
};

/* Rotations and directions turn, and have moments. */
static inline int dvi__turns(const dvi__factor_slot *slot)
{
  return slot->kind == DVI__ROTATION || slot->kind == DVI__SPHERE;
}

/* Of slot c at point k of a group. */
static inline dvi__functions *dvi__charted_functions(const dvi__charted *x, int c, int k)
{
  return &x->functions[(size_t)c * DVI__GROUP + (size_t)k];
}

/* Where the block of two slots begins in a pattern of the new system. */
dvi__place dvi__charted_place(const dvi__charted *charted, const dvi__pattern *pattern,
                              int row_cell, int column_cell);

/* values += the matrix [rows*columns] in its block, for point k of `count`. */
void dvi__charted_add_block(const dvi__place *at, int rows, int columns, const double *matrix,
                            size_t count, size_t k, double *values);

/* The new system's patterns, and where in them what comes from the stored coordinates belongs. */
dvi_status dvi__charted_make_patterns(dvi__charted *charted);

/* Callbacks of the new system. */
int dvi__charted_value(int count, const double *t, const double *xi, const double *rate, double *L,
                       void *user);
int dvi__charted_gradient(int count, const double *t, const double *xi, const double *rate,
                          double *L_xi, double *L_rate, void *user);
int dvi__charted_hessian(int count, const double *t, const double *xi, const double *rate,
                         double *L_qq, double *L_qv, double *L_vv, void *user);

/* The same of a reduced one; its places, once; and of its paths. */
int dvi__reduced_value(int count, const double *t, const double *xi, const double *rate, double *L,
                       void *user);
int dvi__reduced_gradient(int count, const double *t, const double *xi, const double *rate,
                          double *L_xi, double *L_rate, void *user);
int dvi__reduced_hessian(int count, const double *t, const double *xi, const double *rate,
                         double *L_qq, double *L_qv, double *L_vv, void *user);
dvi_status dvi__reduced_place(dvi__charted *charted);

/* What the angular momentum of a body changes by on a path, in the frame of the centre: where x
 * goes with momentum, by Ad*. */
void dvi__reduced_impulse(const dvi__charted *charted, const dvi__body *body, const double *p0,
                          double *impulse);

/* What the charted momentum there changes by with the end of x, added in the blocks of qq. */
void dvi__reduced_derive(const dvi__charted *charted, const dvi__body *body,
                         const dvi__coupling *at, const double *p0, double *C_q1);

/* What a callback returns for a status, which is kept with its sentence. */
int dvi__charted_verdict(dvi__charted *charted, dvi_status status);

/* A coordinate that is beyond its chart by this angle. */
dvi_status dvi__charted_too_large(double turned);

/* xi or rate of point k of a batch of `count`, for a slot. */
void dvi__charted_gather(const dvi__factor_slot *slot, int count, int k, const double *batch,
                         double *one);

/* y, rate, L_y = -V_y and w of the group that begins at point `first` of a batch. */
dvi_status dvi__charted_forces(dvi__charted *charted, int count, int first, int group,
                               const double *t, const double *xi, const double *rate);

/* A slot's numbers of two of these arrays at point k of a group. */
void dvi__charted_pair(const dvi__factor_slot *slot, int group, int k, const double *first,
                       const double *second, double *a, double *b);

/* N at the nodes of a group whose forces are known. */
void dvi__charted_find_moments(dvi__charted *charted, int first, int group);

/* left^T M right for point k of `count`, in the blocks of `in`; left^T L_yy T in those of qq, for
 * point in_group of a group. Rows of left and right are those of stored coordinates. */
void dvi__charted_add_mass_product(const dvi__charted *charted, const dvi__place *in,
                                   const double *left, const double *right, size_t count, size_t k,
                                   double *values);
void dvi__charted_add_potentials(const dvi__charted *charted, int group, int in_group,
                                 const double *left, size_t count, size_t k, double *L_qq);

/* The diagonal blocks of slot c. */
void dvi__charted_add_own_blocks(const dvi__charted *charted, int c, const double *in_qq,
                                 const double *in_qv, size_t count, size_t k, double *qq,
                                 double *qv);

/* W at the end of the path. */
void dvi__charted_find_turns(dvi__charted *charted);

/* What W N changes by, at point k of a group whose tangents are known, into C_qq and C_qv; first of
 * all they are cleared, last L's own Hessian is taken off. */
void dvi__charted_clear_changes(dvi__charted *charted, int count);
void dvi__charted_add_moment_changes(dvi__charted *charted, int count, int first, int group, int k);
void dvi__charted_finish_changes(const dvi__charted *charted, int count, const double *L_qq,
                                 const double *L_qv);

/* Whether a batch of `count` points is one of nodes of a path from the centre. */
int dvi__charted_on_path(const dvi__charted *charted, int count);

#endif
