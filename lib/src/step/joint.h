/* The joint pattern of a Lagrangian's Hessian: which coordinates meet in any of L_qq, L_qv, L_vq and L_vv; of a one-form, and of a Hamiltonian, with
 * the diagonal. */
#ifndef DVI_ACTION_JOINT_H
#define DVI_ACTION_JOINT_H
#include "system/system.h"

/* Where one entry (i,j) of the joint pattern stands in the Hessian's blocks; -1: nowhere. */
typedef struct dvi__block {
  int qq, qv, vq, vv;
} dvi__block;

/* DVI_BAD_SIZE unless an int can count `most` numbers for each coordinate, and the entries of a
 * Jacobian with a block of size x size for each one of the Hessian's: to be called before memory
 * is taken. Completes the Hessian's pattern. */
dvi_status dvi__joint_check(const dvi_system *system, int size, int most);

/* The pattern, and a block [entries] for each of its entries, from the heap; what a failure leaves belongs to the caller, too. The system must be
 * prepared for Hessians. `more`: entries [n x n] that are to be in the pattern, too; NULL: none. */
dvi_status dvi__joint_create(const dvi_system *system, const dvi__pattern *more, dvi__pattern *joint, dvi__block **block);

#endif
