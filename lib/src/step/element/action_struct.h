/* The inside of an action element, for the files of this room. */
#ifndef DVI_STEP_ELEMENT_ACTION_STRUCT_H
#define DVI_STEP_ELEMENT_ACTION_STRUCT_H
#include "step/element/action.h"
#include "num/simd/lanes.h"
#include "step/element/row_terms.h"
#include "step/joint.h"
#include "space/basis.h"
#include "system/evaluate/lagged.h"

/* Number of tables that continue the results of the last step into the next, one for each ratio of
 * their lengths. A composition of 17 substeps has as many ratios in turn. */
enum { DVI__SHIFTS = 20 };

typedef struct dvi__shifts {
  double *table;             /* [DVI__SHIFTS * size of one] */
  double ratio[DVI__SHIFTS]; /* ratio of each table, 0 if there is none */
  int oldest;                /* table to be replaced next */
} dvi__shifts;

struct dvi__action {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  dvi__action_space space;
  int n, s, r; /* coordinates, degree, quadrature nodes */
  /* s functions and r points of the user, for which user_element.c fills the tables; members that
   * need a basis are absent */
  int by_user;
  dvi__space trial; /* the basis, ready for evaluation anywhere */
  /* Length of a row over the nodes and over the functions, padded for products in lanes
   * (num/simd/lanes.h). */
  int lanes, path_lanes;
  /* Tables over (k, j), stored [k*lanes + j]. */
  double *psi, *bar, *dpsi; /* psi_k(c_j), psi_k(c_j) - psi_k(1), psi_k'(c_j) */
  double *node, *weight;    /* [r] */
  /* With damping `weight` holds b_j e^{gamma (c_j - 1/2) h}, and these are b_j [r] and that h. Else
   * NULL, and 0. */
  double *undamped, damped_h;
  double *end;                           /* [s] psi_k(1) */
  double *stiffness, *stiffness_inverse; /* [s*s] K_kl = sum_j b_j psi_k' psi_l' */
  double *fit_point, *fit, *straight;    /* [s], [s*s] rows, [s] */
  double *at_fit;     /* [s*path_lanes] psi_k at the fitting points, by columns */
  dvi__shifts shift;  /* continuation of paths, [s*path_lanes] by columns */
  double *shift_rows; /* [s*s] work */
  /* Continuation of numbers at the nodes (continuation.c). NULL if none are continued. */
  int fit_terms;
  long double *fit_factor, *fit_nodes; /* [terms*terms] C and [r*terms] W_k, in one block */
  /* The element's place. */
  double t0, h;
  const double *q0, *p0;
  /* Batches over the nodes, [n*r]. */
  double *t, *Q, *V, *L_q, *L_v; /* gradients times the weights b_j */
  double *line;                  /* [2 s + 2 r] work for one coordinate */
  double *rows;                  /* [n*s] work */
  /* The tables transposed, for the rows, [j*path_lanes + k]. */
  double *bar_row, *slope_row; /* psi_k(c_j) - psi_k(1), psi_k'(c_j) */
  double *stiffness_row;       /* [s*path_lanes] K^{-1} */
  /* Fixed-point iteration (fixed_point.h). NULL if the mass couples coordinates. */
  struct {
    int stages, lanes;   /* r, or 2 r with a vector potential, and the length of their rows */
    double *matrix;      /* [stages*lanes] c_i - P_ij by columns */
    double *node;        /* [lanes] c */
    double *slant;       /* [r] 1/2 - c */
    double *path;        /* [stages*path_lanes] from forces to paths, by columns */
    double *start, *low; /* [n] h/m p0 and its rounding error */
    double *factor;      /* [n] h/m */
    double *weight;      /* [stages] -h b_j, and b_j of a vector potential */
    double h;            /* the h of factor and weight */
    dvi__shifts shift;   /* from the last step's forces to offsets, [stages*lanes] by columns */
    dvi__fixed_point iteration; /* what the loops work on at the element's place */
    /* With a vector potential, numbers of both kinds of stages [n*stages], and p0 - sum_j a_j [n].
     * Else the first two are L_q and Q. */
    double *force, *Q, *kinetic;
    dvi__lagged *lagged; /* of slow potentials beside fast ones, or NULL */
  } fixed_point;
  double *Z;    /* [n*fixed_point.lanes] offsets of the nodes from q0, and h v */
  int iterated; /* the forces are those of a fixed-point iteration */
  /* Chord. */
  double scaled_h;       /* h of the last row scales */
  double *middle_vv;     /* L_vv at one point (general Lagrangians) */
  double *middle[2];     /* q, v at that point, and the array below, in one block */
  double *middle_basis;  /* [2 s] psi and psi' there */
  dvi__linear *chord;    /* factors middle_vv */
  double *chord_inverse; /* [n*n] by columns, NULL if n is too large for it to pay */
  /* Jacobian. NULL until prepared. */
  dvi__pattern joint;         /* [n x n] union of qq, qv, vq, vv */
  dvi__pattern pattern;       /* [n s x n s] */
  dvi__joint_entry *block;    /* [entries of joint] */
  double *H_qq, *H_qv, *H_vv; /* [entries*r] */
  double *F_q, *F_v;          /* [entries*r] of the forces, NULL without forces */
  double *moved;              /* [4 n*r] work of products, NULL until prepared */
  dvi__row_terms terms;
  struct dvi__centred_paths *centred;         /* charts centred at the start, or NULL */
  struct dvi__constrained_rows *constrained;  /* holonomic constraints, or NULL */
  struct dvi__carried_forces *carried_forces; /* forces in charts, or NULL */
  struct dvi__nonholonomic_rows *nonholonomic;
  struct dvi__preconditioner *preconditioner;  /* of quadratic potentials, or NULL */
  struct dvi__transformed_stages *transformed; /* of a time-transformed system, or NULL */
  /* Paths between two points (two_point.h). NULL until prepared. */
  struct {
    double *bubble;     /* [(s-1)*s] beta_m in the functions psi_k */
    double *chi, *dchi; /* [(s+1)*lanes] tables over the nodes */
    double *rows, *dp;  /* [n*s], [n] work */
  } two_point;
  /* Energies. NULL until prepared. */
  double *value, *rate; /* [r] L, L_t */
  /* [n*r] derivatives of L_v V - L by q and by the path's derivative in tau */
  double *by_q, *by_v;
  /* [n*r], [n*r], [r] L_tq, L_tv, L_tt, NULL for an autonomous system */
  double *rate_q, *rate_v, *rate_t;
  double *moved_t, *moved_rate; /* [r] work of their differences */
  double *moved_q, *moved_v;    /* [n*r] work of their differences */
};

/* Largest number of coordinates for which the chord's inverse is cheaper than solving for each of
 * the s functions. */
enum { DVI__CHORD_INVERSE = 16 };

/* Allocate and fill all tables of the space (table.c). */
dvi_status dvi__action_fill_tables(dvi__action *action);

/* Give the table from the last step's forces to the sums of forces in a step `ratio` times as long,
 * [r*lanes] by columns, and that from the last path to the continued one, [s*path_lanes]. */
const double *dvi__action_fixed_point_shift(dvi__action *action, double ratio);
const double *dvi__action_path_shift(dvi__action *action, double ratio);

/* Prepare the tables below. DVI_NO_MEMORY. */
dvi_status dvi__action_prepare_continuation(dvi__action *action);

/* Give the table from numbers h b_j x_j of the last step to those of this one, [r*lanes] by
 * columns. */
const double *dvi__action_stage_shift(dvi__action *action, dvi__shifts *shifts, double ratio);

typedef struct dvi__centred_paths dvi__centred_paths;
typedef struct dvi__constrained_rows dvi__constrained_rows;
typedef struct dvi__carried_forces dvi__carried_forces;
typedef struct dvi__nonholonomic_rows dvi__nonholonomic_rows;

/* Add the row terms' parts to the joint pattern and, with their own unknowns, to the Jacobian's.
 * Announce a path to them before L's derivatives are evaluated. Add their parts to the rows, to the
 * magnitudes, the derivatives and the scales. */
dvi_status dvi__action_join_terms(const dvi__action *action, dvi__pattern *joint);
dvi_status dvi__action_wide_pattern(const dvi__action *action, dvi__pattern *pattern);
void dvi__action_place_terms(dvi__action *action, const double *Y);
dvi_status dvi__action_add_term_rows(dvi__action *action, const double *Y, double *R);
void dvi__action_add_term_magnitudes(const dvi__action *action, double *magnitude);
dvi_status dvi__action_add_term_derivatives(dvi__action *action, const double *Y, double *values);
void dvi__action_scale_terms(const dvi__action *action, double *scale);

/* Free the memory of dvi__action_centre, and of dvi__action_constrain. */
void dvi__action_clear_charts(dvi__action *action);
void dvi__action_clear_constraints(dvi__action *action);
void dvi__action_clear_carried_forces(dvi__action *action);

/* In charts, change the rows and dp for a momentum f [n] that is added at the point xi [n] of the
 * path. Without charts nothing changes. */
void dvi__action_carry(dvi__action *action, const double *xi, const double *f, double *R,
                       double *dp);

/* Do so for a momentum of a force that h sum_j b_j L_q_j has already. The correction C replaces
 * that sum by the Lagrangian's own moments wherever something turns. */
void dvi__action_carry_force(dvi__action *action, const double *xi, const double *f, double *R,
                             double *dp);

/* Count a momentum [n] that is added at the end of the path. */
void dvi__action_arrive(const dvi__action *action, const double *added);

/* How rows change in charts with the momenta that are added on the way, each array NULL without
 * charts (system/chart/centring.h). */
typedef struct dvi__carried {
  const double *by_f, *by_xi, *by_end; /* [3 n] */
  const int *first, *width;            /* [n] */
} dvi__carried;

/* Prepare for the momentum f at xi. */
dvi__carried dvi__action_carried(dvi__action *action, const double *xi, const double *f);

/* Give the change of `more` in row `row` with a column of whole blocks, of which entry e is in that
 * row. */
double dvi__carried_entry(const dvi__carried *carried, int row, const double *column, int e);

/* Subtract end_k dmore for the movements of xi and of the path's end. psi [s] are the functions at
 * xi. */
void dvi__action_carry_movements(const dvi__action *action, const dvi__carried *carried,
                                 const double *psi, const dvi__row_jacobian *J);

/* Drop what constraints know of the start of the element, when another one is placed. */
void dvi__action_forget_start(dvi__action *action);

/* The same functions of nonholonomic constraints, and dvi__action_constrain_end without holonomic
 * ones. */
void dvi__action_clear_rolling(dvi__action *action);
void dvi__action_forget_rolling(dvi__action *action);
dvi_status dvi__action_end_rolling(dvi__action *action, const double *Y, double *dp);

/* Move dp until the velocity at the end of the path fulfils all constraints. p, v [n] are work. */
dvi_status dvi__action_end_on_rows(dvi__action *action, const double *Y, double *p, double *v,
                                   double *dp);

/* Set the weights of a damped action for the length h. */
void dvi__action_damp(dvi__action *action, double h);

/* The preconditioner of the fixed-point iteration (preconditioner.c). Prepare it if the system has
 * such potentials, after the tables of fixed_point.c. DVI_NO_MEMORY. */
dvi_status dvi__action_prepare_preconditioner(dvi__action *action);
void dvi__action_clear_preconditioner(dvi__action *action);

/* Make its inverses for the step's h. */
void dvi__preconditioner_set_step(dvi__action *action);

/* Put the nodes where K and the other forces make them, for which Z holds the sums over j of
 * (c_i - P_ij) g_j. */
void dvi__preconditioner_begin(dvi__action *action);

/* Make one iteration with the forces -L_q at the nodes, as dvi__lanes_iterate. */
void dvi__preconditioner_iterate(dvi__action *action, double *change, double *largest);

/* Take the part of K out of the forces g [n*r] at the nodes Q. */
void dvi__preconditioner_other_forces(const dvi__action *action, double *g);

/* Do the same for members side by side, with the bits of one alone (members.h). The last function
 * takes the part of K out of the forces kept. */
struct dvi__action_members;
void dvi__preconditioner_begin_members(struct dvi__action_members *members);
void dvi__preconditioner_iterate_members(struct dvi__action_members *members);
void dvi__preconditioner_other_forces_of_members(struct dvi__action_members *members);

/* Give the table by which forces move the nodes (lagged.h). */
dvi__place_table dvi__action_place_table(const dvi__action *action);

/* The iteration of a time-transformed element (transformed.c). Prepare it if the system is of its
 * kind, with as many nodes as functions. The others are those of fixed_point.h. */
dvi_status dvi__action_prepare_transformed(dvi__action *action);
void dvi__action_clear_transformed(dvi__action *action);
void dvi__transformed_begin(dvi__action *action, const double *Y);
void dvi__transformed_continue(dvi__action *action, double ratio, const double *flows);
dvi_status dvi__transformed_iterate(dvi__action *action, double *change, double *largest);
void dvi__transformed_path(const dvi__action *action, double *Y);
void dvi__transformed_ends(const dvi__action *action, double *dq, double *dq_low, double *dp);
void dvi__transformed_flows(const dvi__action *action, double *flows);

/* Fill its tables, place and momentum [r*lanes] and path [r*path_lanes] (fixed_point.c). */
dvi_status dvi__action_fill_transformed(const dvi__action *action, double *place, double *momentum,
                                        double *path);

/* Free the memory of dvi__action_prepare_energy. */
void dvi__action_clear_energy(dvi__action *action);

/* Create an element whose tables user_element.c fills at every new length. It has place, residual,
 * Hessians and ends. */
dvi_status dvi__action_create_by_user(const dvi_system *system, int functions, int points,
                                      dvi_counters *counters, dvi__action **action);

/* Scale rows by the velocity Hessian in the order of vv. NULL stands for the constant mass. */
void dvi__action_scale_by(const dvi__action *action, const double *L_vv, double *scale);

/* Set the numbers of the fixed-point iteration that depend on h alone. */
void dvi__action_set_step(dvi__action *action);

/* Evaluate the Hessians, and the derivatives of forces, at `count` points. */
dvi_status dvi__action_evaluate_hessians(dvi__action *action, int count, const double *t,
                                         const double *q, const double *v);

/* Free the memory for Hessians and the Jacobian, which may be prepared again. */
void dvi__action_clear_jacobian(dvi__action *action);

/* Write column l of a block, its first `rows` rows, which are
 *
 *     sum_j b_j [ (psi_k - psi_k(1)) (h L_qq psi_l + L_qv psi_l')
 *                 + psi_k' (L_vq psi_l + L_vv psi_l'/h) ],
 *
 * with L_qq + F_q and L_qv + F_v beside psi_k - psi_k(1) if there are forces F. */
void dvi__action_block_column(const dvi__action *action, const dvi__joint_entry *block, int l,
                              int rows, double *column);

/* Write in_q and in_v [r], which may stand in `line`,
 *
 *     b_j (h (L_qq + F_q) f + (L_qv + F_v) f')   and   b_j (L_vq f + L_vv f'/h),
 *
 * for one entry of the joint pattern and a function with the values f and f' [r] at the nodes. */
void dvi__action_weigh_hessian(const dvi__action *action, const dvi__joint_entry *block,
                               const double *f, const double *df, double *in_q, double *in_v);

/* Free the memory of dvi__action_prepare_two_point. */
void dvi__action_clear_two_point(const dvi__action *action);

/* Fill the batches Q and V with the path's points at the nodes. */
void dvi__action_stages(const dvi__action *action, const double *Y);

/* Give an entry of a Hessian at one point, 0 where its pattern has none. */
static inline double dvi__entry_or_zero(const double *H, int place)
{
  return place >= 0 ? H[place] : 0.0;
}

/* The n systems of decoupled.h of a time-transformed system whose own Hessian is sparse
 * (transformed.c). *rank_two is NULL for all others, and where full matrices are as fast. */
typedef struct dvi__rank_two dvi__rank_two;

dvi_status dvi__rank_two_create(const dvi_system *system, dvi__rank_two **rank_two);
void dvi__rank_two_destroy(dvi__rank_two **rank_two);

/* Give the pattern, which has two rows and columns more than there are coordinates. */
const dvi__pattern *dvi__rank_two_pattern(const dvi__rank_two *rank_two);

/* Evaluate the Hessian at one place, for the systems of U, T and h, real (parts = 1) or complex
 * (2). */
dvi_status dvi__rank_two_evaluate(dvi__rank_two *rank_two, double t, const double *q,
                                  const double *w);
void dvi__rank_two_assemble(const dvi__rank_two *rank_two, double h, int parts, const double *U,
                            const double *T, double *values);

#endif
