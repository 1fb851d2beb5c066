/* Which slots of a configuration space the mass lets one take by themselves, and what they are
 * then. */
#ifndef DVI_ACTION_PIECES_H
#define DVI_ACTION_PIECES_H
#include "group/moser_veselov.h"
#include "system/system.h"

/* A line, a direction or an angle with the mass m I, a body, or a rigid motion: a rotation with the
 * three lines that follow. */
typedef struct dvi__mass_block {
  const dvi__factor_slot *slot;
  double mass; /* 0 of a body without place */
  int rigid;
  double centre[3];      /* of the mass of a rigid motion, in the body's frame */
  const dvi__body *body; /* of a rotation; of a rigid motion about its centre of mass */
} dvi__mass_block;

typedef struct dvi__mass_blocks {
  const dvi_system *system;
  dvi__mass_block *piece; /* [alone] */
  dvi__body *body;
  int *together;              /* [slots] not 0 for those that are coupled */
  int alone, bodies, coupled; /* pieces; bodies among them; slots that are coupled */
} dvi__mass_blocks;

/* Of a system with factors, which must outlive them. To be cleared on failure, too. */
dvi_status dvi__mass_blocks_create(const dvi_system *system, dvi__mass_blocks *pieces);
void dvi__mass_blocks_clear(dvi__mass_blocks *pieces);

/* rho x R^T p_x of the momenta p [nv] at q [nq], for a rigid motion: what Pi has more than the
 * momentum about the centre of mass. */
void dvi__mass_block_moment(const dvi__mass_block *piece, const double *q, const double *p,
                            double moment[3]);

/* The velocities of a piece in v [nv]. */
void dvi__mass_block_velocity(const dvi__mass_block *piece, const double *q, const double *p,
                              double *v);

#endif
