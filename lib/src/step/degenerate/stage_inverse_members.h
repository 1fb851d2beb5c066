/* The inverses of stage_inverse.h for several members of an ensemble abreast (num/simd/abreast.h),
 * each with the bits of its own. */
#ifndef DVI_STEP_DEGENERATE_STAGE_INVERSE_MEMBERS_H
#define DVI_STEP_DEGENERATE_STAGE_INVERSE_MEMBERS_H
#include "num/simd/abreast.h"
#include "step/degenerate/stage_inverse.h"

typedef struct dvi__stage_inverse_members dvi__stage_inverse_members;

/* Create inverses with the tables of one, which must outlive them. */
dvi_status dvi__stage_inverse_members_create(const dvi__stage_inverse *one,
                                             dvi__stage_inverse_members **members);
void dvi__stage_inverse_members_destroy(dvi__stage_inverse_members **members);

/* The numbers of an entry, without one of the end in each row. */
typedef struct dvi__stage_entry_members {
  dvi__abreast A[DVI__STAGE_LANES], B[DVI__STAGE_LANES], K[DVI__STAGE_LANES], a;
} dvi__stage_entry_members;

/* As dvi__stage_inverse_entry, _begin and _solve. `regular` becomes 0 for members whose matrix is
 * far from 1. */
dvi__stage_entry_members *dvi__stage_inverse_members_entry(dvi__stage_inverse_members *members,
                                                           int i, int j);
void dvi__stage_inverse_members_begin(dvi__stage_inverse_members *members, int count,
                                      const double *weight, int regular[DVI__ABREAST]);
void dvi__stage_inverse_members_solve(dvi__stage_inverse_members *members, dvi__abreast *r);

#endif
