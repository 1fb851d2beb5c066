/* The struct of a stacked shot, for stacked_shot.c and stacked_pattern.c. */
#ifndef DVI_STEP_ONESTEP_STACKED_STRUCT_H
#define DVI_STEP_ONESTEP_STACKED_STRUCT_H
#include "step/onestep/stacked_shot.h"

/* A block of the Jacobian is 1, or h times f_z, f_z^T or the second derivatives of L(t,q,v(q,p)) at
 * a point. The second enumeration selects its columns. */
typedef enum dvi__stack_content {
  DVI__ONE,
  DVI__FLOW,
  DVI__FLOW_TRANSPOSED,
  DVI__LAGRANGIAN_ZZ
} dvi__stack_content;
typedef enum dvi__stack_columns { DVI__BOTH, DVI__FIRST, DVI__SECOND } dvi__stack_columns;

typedef struct dvi__stack_block {
  int row, column; /* indices of blocks */
  dvi__stack_content content;
  dvi__stack_columns columns;
  int point; /* point of the vector field */
  double factor;
} dvi__stack_block;

struct dvi__stacked_shot {
  const dvi_system *system;
  dvi__runge_kutta method;
  dvi__course course;
  dvi__vector_field *field;
  dvi__evaluator *evaluator;
  int n, blocks; /* number of unknowns and of blocks */
  /* The Jacobian. joint is the pattern of H's second derivatives in z. flow and transposed [entries
   * of joint] are the indices in H_zz of the entries of f_z and f_z^T. */
  dvi__pattern joint, pattern;
  int *flow, *transposed;
  dvi__stack_block *block;
  int block_count;
  int *where;   /* indices in `pattern` of the entries of each block, block by block */
  double *H_zz; /* [entries of joint] at one point */
  /* The current step. */
  double t0, h;
  const double *q0, *p0;
  int known;              /* not 0 if all points of x are placed and differentiated */
  double *unit;           /* [n] */
  double *x;              /* [unknowns] in their own units */
  double *rate;           /* [2n * pieces*stages] h f at the stages */
  double *kappa;          /* [2n * pieces*stages] */
  double *slope;          /* [2n * (pieces+1)] h b L_z at the nodes */
  double *point, *turned; /* [2n] */
};

/* The indices of the blocks of unknowns and of rows. */
static inline int dvi__stack_W(const dvi__stacked_shot *s, int piece, int stage)
{
  return piece * (s->method.stages + 1) + stage;
}

/* m starts from 1, because the start is no block of its own. */
static inline int dvi__stack_node(const dvi__stacked_shot *s, int m)
{
  return m * (s->method.stages + 1) - 1;
}

static inline int dvi__stack_Gamma(const dvi__stacked_shot *s, int piece, int stage)
{
  return (s->course.pieces + piece) * (s->method.stages + 1) + stage;
}

static inline int dvi__stack_lambda(const dvi__stacked_shot *s, int m)
{
  return (s->course.pieces + m + 1) * (s->method.stages + 1) - 1;
}

static inline int dvi__stack_start(const dvi__stacked_shot *s)
{
  return 2 * s->course.pieces * (s->method.stages + 1);
}

/* The indices of points of the vector field. */
static inline int dvi__stack_stage_point(const dvi__stacked_shot *s, int piece, int stage)
{
  return piece * s->method.stages + stage;
}

static inline int dvi__stack_node_point(const dvi__stacked_shot *s, int m)
{
  return s->course.pieces * s->method.stages + m;
}

/* Make joint and pattern, and all indices into them. */
dvi_status dvi__stacked_shot_lay_out(dvi__stacked_shot *step, const dvi_system *system);
void dvi__stacked_shot_clear_layout(dvi__stacked_shot *step);

#endif
