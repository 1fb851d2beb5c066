/* Own operations for SUNDIALS' serial vectors. */
#ifndef DVI_SOLVE_VECTOR_H
#define DVI_SOLVE_VECTOR_H
#include <nvector/nvector_serial.h>

/* Replace the operations that KINSOL calls on a vector and on its clones by the loops of vector.c.
 * Debian's SUNDIALS 6.4.1 is compiled without optimisation, and its loops cost more than a small
 * step's residual. */
void dvi__vector_use_own_operations(N_Vector vector);

/* Let a vector of equal numbers give any of them for the least. */
void dvi__vector_is_constant(N_Vector vector);

#endif
