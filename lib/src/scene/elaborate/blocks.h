/* The blocks of the functions of a scene. */
#ifndef DVI_SCENE_ELABORATE_BLOCKS_H
#define DVI_SCENE_ELABORATE_BLOCKS_H
#include "expr/function/function.h"

/* The blocks. Functions of momenta have these in the block of velocities. Inputs are the controls,
 * and behind them the parameters, in functions that are derived by these. */
enum { DVI__TIME, DVI__COORDINATES, DVI__VELOCITIES, DVI__MULTIPLIERS, DVI__INPUTS, DVI__BLOCKS };

/* The pairs whose second derivatives methods want. The first letter is that of the rows. */
enum {
  DVI__PAIR_QQ,
  DVI__PAIR_QV,
  DVI__PAIR_VV,
  DVI__PAIR_QW,
  DVI__PAIR_VW,
  DVI__PAIR_TQ,
  DVI__PAIR_TV,
  DVI__PAIR_VQ,
  DVI__PAIR_WQ,
  DVI__PAIR_WV,
  DVI__PAIR_TW,
  DVI__PAIR_QU,
  DVI__PAIR_VU,
  DVI__PAIR_WU,
  DVI__PAIRS
};
extern const dvi__block_pair dvi__scene_pairs[DVI__PAIRS];

#endif
