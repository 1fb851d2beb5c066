/** The head of a run's files: its columns, and facts about it. */
#ifndef RUN_HEAD_H
#define RUN_HEAD_H
#include "cli/spelling.h"
#include "problem.h"
#include "store/facts.h"
#include "watch/run_request.h"

/** The head. All zero is empty. */
typedef struct run_head {
  hdf5_head rows;
  fact_list facts;
  const char **column; /**< [columns] */
} run_head;

/** Make the head of a run with steps h. Its columns are t and those that name_at lists. Complains
 * and returns false without memory. Call run_head_clear afterwards in any case. */
bool run_head_make(run_head *head, const run_request *request, const problem *scene, double h,
                   word_at name_at, const void *list);

void run_head_clear(run_head *head);
#endif
