/* Which cells of a configuration space the mass lets one take by themselves, and what they are then. */
#ifndef DVI_ACTION_PIECES_H
#define DVI_ACTION_PIECES_H
#include "group/leap.h"
#include "system/system.h"

/* A line, a direction or an angle with the mass m I, a body, or a rigid motion: a rotation with the three lines that follow. */
typedef struct dvi__piece {
  const dvi__cell *cell;
  double mass; /* 0 of a body without place */
  int rigid;
  double centre[3];      /* of the mass of a rigid motion, in the body's frame */
  const dvi__body *body; /* of a rotation; of a rigid motion about its centre of mass */
} dvi__piece;

typedef struct dvi__pieces {
  const dvi_system *system;
  dvi__piece *piece; /* [alone] */
  dvi__body *body;
  int *together;              /* [cells] not 0 for those that are coupled */
  int alone, bodies, coupled; /* pieces; bodies among them; cells that are coupled */
} dvi__pieces;

/* Of a system with factors, which must outlive them. To be cleared on failure, too. */
dvi_status dvi__pieces_create(const dvi_system *system, dvi__pieces *pieces);
void dvi__pieces_clear(dvi__pieces *pieces);

/* rho x R^T p_x of the momenta p [nv] at q [nq], for a rigid motion: what Pi has more than the momentum about the centre of mass. */
void dvi__piece_moment(const dvi__piece *piece, const double *q, const double *p, double moment[3]);

/* The velocities of a piece in v [nv]. */
void dvi__piece_velocity(const dvi__piece *piece, const double *q, const double *p, double *v);

#endif
