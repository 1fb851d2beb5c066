/** The blocks of a grid that processes share by yee, foreseen without the others: a process stands
 *  for one of many, steps its block, and counts what it would have received. */
#ifndef BLOCKS_H
#define BLOCKS_H
#include <dvi/march.h>
#include <dvi/yee.h>
#include <stdint.h>

#include "cli/options.h"
#include "problem.h"

/** What a process has of the grid, and receives in an exchange. */
typedef struct block {
  int64_t values; /**< of E and B */
  int together;   /**< steps that are taken after one exchange */
  int64_t ghosts; /**< values that come from others in it */
  int messages;   /**< that bring them */
  int neighbours; /**< processes from which they come */
} block;

/** A scene whose grid is divided into blocks. */
typedef struct block_cutter block_cutter;

/** Open a scene for that, with its "name=value" settings. Returns DONE, or complains and returns
 *  the exit code. Call block_cutter_close in any case. */
int block_cutter_open(const char *path, const words *settings, block_cutter **cutter);
void block_cutter_close(block_cutter **cutter);

/** Make the march of process `rank` of `count`, alone: what others would give it, it has not. The
 *  step is the scene's if h is NaN. Returns DVI_OK, or the status of dvi_last_error(). */
dvi_status block_march(block_cutter *cutter, int rank, int count, double h, dvi_march **march);

/** Take steps of such a march, which is the last one that was made, and count. */
dvi_status block_count(block_cutter *cutter, dvi_march *march, block *counted);
#endif
