/* Processes that share a mesh, as threads of one. */
#ifndef TESTS_SUPPORT_FIELD_RANKS_H
#define TESTS_SUPPORT_FIELD_RANKS_H
#include <dvi/mesh.h>
#include <dvi/yee.h>

/* Cut the mesh into shares, and let each thread work with its own. The threads speak with each
 * other as processes do. `owner` is [n-cells]. */
void run_ranks(const dvi_mesh *whole, int count, const int *owner,
               void (*work)(const dvi_mesh *share, int rank, void *user), void *user);

/* Let each thread work as one of `count` processes that divide a grid of boxes. */
void run_box_ranks(int count, void (*work)(const dvi_yee_ranks *ranks, void *user), void *user);

/* Ranks that count how often planes go to neighbours, which fails while the line is cut, with how
 * many numbers, and how long that takes. */
typedef struct watched_ranks {
  const dvi_yee_ranks *ranks;
  int passes, is_cut;
  int64_t numbers;
  double seconds;
} watched_ranks;

/* The watched ones last as long as those that are returned. */
dvi_yee_ranks watch_ranks(watched_ranks *watched);

#endif
