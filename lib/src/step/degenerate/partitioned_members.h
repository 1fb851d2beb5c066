/* The equations of partitioned.h for several members of an ensemble abreast (num/simd/abreast.h),
 * for one-forms with a projection along directions at the ends, and Jacobians that are inverted.
 * Members differ in their starts, and the step is the same. Each has the bits of its own step. */
#ifndef DVI_STEP_DEGENERATE_PARTITIONED_MEMBERS_H
#define DVI_STEP_DEGENERATE_PARTITIONED_MEMBERS_H
#include "num/simd/abreast.h"
#include "step/degenerate/partitioned.h"

typedef struct dvi__partitioned_members dvi__partitioned_members;

/* Tell whether members of this step can go side by side. */
int dvi__partitioned_has_members(const dvi__partitioned *partitioned);

dvi_status dvi__partitioned_members_create(dvi__partitioned *partitioned,
                                           dvi__partitioned_members **members);
void dvi__partitioned_members_destroy(dvi__partitioned_members **members);

/* Put the members' steps at t [1] and q, p, carried [n], which the caller keeps unchanged. */
void dvi__partitioned_members_place(dvi__partitioned_members *members, double h,
                                    const dvi__abreast *t, const dvi__abreast *q,
                                    const dvi__abreast *p, const dvi__abreast *carried);

/* As dvi__partitioned_continue, for members whose last steps had one length. */
void dvi__partitioned_members_continue(dvi__partitioned_members *members, double ratio,
                                       const dvi__abreast *last, dvi__abreast *x);

/* As dvi__partitioned_invert. `regular` becomes 0 for members whose Jacobian must be factored. */
dvi_status dvi__partitioned_members_invert(dvi__partitioned_members *members, const dvi__abreast *x,
                                           int regular[DVI__ABREAST]);

/* Compute the corrections r = J^-1 R(x) by the Jacobians that were inverted last. Members that do
 * not go on get any numbers. */
dvi_status dvi__partitioned_members_correct(dvi__partitioned_members *members,
                                            const dvi__abreast *x, const int going[DVI__ABREAST],
                                            dvi__abreast *r);

/* Write the increments dq [n] of q at x. */
void dvi__partitioned_members_ends(dvi__partitioned_members *members, const dvi__abreast *x,
                                   dvi__abreast *dq);

/* Compute p = alpha(q) at the new places q [n]. `regular` becomes 0 for members with a singular
 * two-form between the start and there. */
dvi_status dvi__partitioned_members_constrain(dvi__partitioned_members *members,
                                              const dvi__abreast *q, dvi__abreast *p,
                                              int regular[DVI__ABREAST]);

#endif
