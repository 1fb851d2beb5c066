/** Numbers of ranks of dvi bench --scale ranks=1,2,4,...,1e5. */
#ifndef RANK_COUNTS_H
#define RANK_COUNTS_H
#include <stdbool.h>

enum { RANK_COUNTS_MAX = 64 };

/** Whole numbers, ascending. */
typedef struct rank_counts {
  int count;
  double number[RANK_COUNTS_MAX];
} rank_counts;

/** Tell if it is ranks that --scale asks for. */
bool rank_counts_asked(const char *scaled);

/** Read "ranks=A,B,...,C". Three dots go on by the factor B/A up to C, which is there in any case.
 * Returns DONE, or complains and returns USAGE. */
int rank_counts_read(const char *scaled, rank_counts *counts);
#endif
