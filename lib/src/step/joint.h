/* The joint pattern of a Lagrangian's Hessian tells which coordinates are coupled by L_qq, L_qv,
 * L_vq or L_vv, or by the derivatives F_q or F_v of forces. The patterns of a one-form, and of a
 * Hamiltonian, include the diagonal. */
#ifndef DVI_STEP_JOINT_H
#define DVI_STEP_JOINT_H
#include "system/system.h"

/* The indices of an entry (i,j) of the joint pattern in the Hessian's blocks, and in those of the
 * forces, or -1. */
typedef struct dvi__joint_entry {
  int qq, qv, vq, vv, by_q, by_v;
} dvi__joint_entry;

/* Check sizes before memory is allocated. DVI_BAD_SIZE unless an int can count `most` numbers for
 * each coordinate, and the entries of a Jacobian with a block of size x size for each entry of the
 * Hessian. No pattern is made. */
dvi_status dvi__joint_check(const dvi_system *system, int size, int most);

/* Make the pattern, and a block [entries] for each of its entries, on the heap. On failure the
 * caller owns the remains, too. The system must be prepared for Hessians. `more` has further
 * entries [n x n] of the pattern, or is NULL. */
dvi_status dvi__joint_create(const dvi_system *system, const dvi__pattern *more,
                             dvi__pattern *joint, dvi__joint_entry **block);

#endif
