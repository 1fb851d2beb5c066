/* Random grids of boxes on one process and on several, whose bits are compared. */
#ifndef TESTS_SUPPORT_BOX_SHARES_H
#define TESTS_SUPPORT_BOX_SHARES_H
#include <dvi/yee.h>

/* A grid with its ends, materials, sources and observables, and what one process has. */
typedef struct box_trial box_trial;

/* Make the grid of a number, and run it on one process. */
box_trial *make_box_trial(int number);

/* Run it as one of several processes, of which the trial chooses the division, and return the
 * number of differences: of the step, of the own values, and of what is observed. -1 if it cannot
 * begin, and dvi_last_error tells why. */
int64_t run_box_share(const box_trial *trial, const dvi_yee_ranks *ranks);

void free_box_trial(box_trial *trial);

#endif
