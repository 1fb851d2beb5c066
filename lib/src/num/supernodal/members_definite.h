/* Factors A = P^T L D L^T P of small positive definite matrices with one sparse pattern, with the
 * members of an ensemble as lanes (num/simd/members.h). The operations are those of num/ldl.c, in
 * the same order for each member, and so are the bits. */
#ifndef DVI_NUM_SUPERNODAL_MEMBERS_DEFINITE_H
#define DVI_NUM_SUPERNODAL_MEMBERS_DEFINITE_H
#include <dvi/status.h>

/* Most columns. num/ldl.c takes larger matrices in dense blocks, in another order. */
enum { DVI__MEMBERS_DEFINITE_MOST = 32 };

typedef struct dvi__members_definite dvi__members_definite;

/* Create factors of up to `capacity` matrices n x n of a pattern with both triangles, by columns.
 * Column order[k] is eliminated as column k. */
dvi_status dvi__members_definite_create(int n, const int *start, const int *row, const int *order,
                                        int capacity, dvi__members_definite **factor);
void dvi__members_definite_destroy(dvi__members_definite **factor);

/* Factor the matrices of `width` members, values [entries*width]. least [width] becomes the
 * smallest D_k/A_kk, or what is not a number or not positive where there is no factor. */
void dvi__members_definite_factor(dvi__members_definite *factor, int width, const double *values,
                                  double *least);

/* Replace b [n*width] by A^-1 b. */
void dvi__members_definite_solve(dvi__members_definite *factor, int width, double *b);

#endif
