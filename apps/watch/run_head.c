#include "watch/run_head.h"

#include <math.h>
#include <stdlib.h>

#include "cli/command.h"

static bool list_columns(run_head *head, word_at name_at, const void *list)
{
  int count = 0;
  while (name_at(count, list) != NULL) count++;
  head->column = calloc((size_t)count + 1, sizeof *head->column);
  if (head->column == NULL) {
    complain("out of memory");
    return false;
  }
  head->column[0] = "t";
  for (int k = 0; k < count; k++) head->column[k + 1] = name_at(k, list);
  head->rows.columns = count + 1;
  head->rows.column = head->column;
  return true;
}

bool run_head_make(run_head *head, const run_request *request, const problem *scene, double h,
                   word_at name_at, const void *list)
{
  fact_list *facts = &head->facts;
  if (!list_columns(head, name_at, list) || !facts_add_problem(facts, scene, request->command) ||
      !facts_add_settings(facts, scene, &request->settings))
    return false;
  facts_add_text(facts, "method", request->method, true);
  facts_add_text(facts, "time_transform", request->how.transform, true);
  facts_add_text(facts, "step_control", request->how.control, true);
  facts_add_number(facts, "h", h, true);
  facts_add_number(facts, "every", (double)request->every, true);
  head->rows.layout = "dvi rows 1";
  head->rows.expected = request->final ? 1 : fabs(request->t_end / h) / (double)request->every;
  head->rows.facts = facts->count;
  head->rows.fact = facts->fact;
  return true;
}

void run_head_clear(run_head *head)
{
  facts_clear(&head->facts);
  free(head->column);
  *head = (run_head){.column = NULL};
}
