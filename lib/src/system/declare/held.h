/* The system of a contact that is held closed. */
#ifndef DVI_SYSTEM_DECLARE_HELD_H
#define DVI_SYSTEM_DECLARE_HELD_H
#include "system/system.h"

/* Make the system in which the gap of contact k is a holonomic constraint, phi(t,q) = 0. All else
 * belongs to `system`, which must outlive it. DVI_UNSUPPORTED beside a vector potential. */
dvi_status dvi__held_create(const dvi_system *system, int k, const dvi_system **held);
void dvi__held_destroy(const dvi_system **held);

#endif
