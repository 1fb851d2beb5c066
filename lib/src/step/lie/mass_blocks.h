/* The mass of a configuration space splits into blocks that are treated alone, and coupled
 * slots. */
#ifndef DVI_STEP_LIE_MASS_BLOCKS_H
#define DVI_STEP_LIE_MASS_BLOCKS_H
#include "group/moser_veselov.h"
#include "system/system.h"

/* A mass block is a line, a direction or an angle with the mass m I, a body, or a rigid motion. A
 * rigid motion is a rotation with the three lines that follow. */
typedef struct dvi__mass_block {
  const dvi__factor_slot *slot;
  double mass; /* 0 for a body without place */
  int rigid;
  double centre[3];      /* centre of mass of a rigid motion, in the body's frame */
  const dvi__body *body; /* body of a rotation, or of a rigid motion about its centre of mass */
} dvi__mass_block;

typedef struct dvi__mass_blocks {
  const dvi_system *system;
  dvi__mass_block *block; /* [alone] */
  dvi__body *body;
  int *together;              /* [slots] not 0 for coupled slots */
  int alone, bodies, coupled; /* number of blocks, of bodies among them, and of coupled slots */
} dvi__mass_blocks;

/* Make the blocks of a system with factors, which must outlive them. To be cleared on failure,
 * too. */
dvi_status dvi__mass_blocks_create(const dvi_system *system, dvi__mass_blocks *blocks);
void dvi__mass_blocks_clear(dvi__mass_blocks *blocks);

/* Write the velocities of a block to v [nv]. */
void dvi__mass_block_velocity(const dvi__mass_block *block, const double *q, const double *p,
                              double *v);

#endif
