#include "study/levels.h"

static dvi_status run_level(double parts, double *error, void *user)
{
  study_level level = {.number = NULL};
  const dvi_status status = study_run((const study_subject *)user, parts, &level);
  *error = level.error;
  return status;
}

static dvi_status measure_roundoff(double parts, double *moved, void *user)
{
  const study_subject *subject = user;
  return subject->roundoff(subject->user, parts, moved);
}

dvi_status levels_choose(const study_subject *subject, const dvi_study_search *wish,
                         dvi_study_levels *choice)
{
  study_subject own = *subject;
  dvi_study_search search = *wish;
  search.size = sizeof search;
  search.order = own.order;
  search.span = own.span;
  search.first_parts = own.first_parts;
  search.size_of_result = own.size;
  search.judge_error = own.judge_error;
  search.may_miss = own.may_miss;
  search.run = run_level;
  search.roundoff = own.roundoff != NULL ? measure_roundoff : NULL;
  search.user = &own;
  return dvi_study_search_levels(&search, choice);
}
