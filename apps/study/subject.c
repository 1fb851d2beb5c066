#include "study/subject.h"

#include <dvi/study.h>
#include <math.h>

/* Clear a level, except for the pointer to its numbers. */
static void level_clear(study_level *level, double refinement)
{
  *level = (study_level){.refinement = refinement,
                         .parts = (double)NAN,
                         .length = (double)NAN,
                         .error = (double)NAN,
                         .seconds = (double)NAN,
                         .number = level->number};
  for (int i = 0; i < STUDY_FURTHER_MAX; i++) level->further[i] = (double)NAN;
}

dvi_status study_run(const study_subject *subject, double refinement, study_level *level)
{
  level_clear(level, refinement);
  const double began = dvi_study_clock();
  const dvi_status status = subject->run(subject->user, refinement, level);
  if (isnan(level->seconds)) level->seconds = dvi_study_clock() - began;
  return status;
}

dvi_status study_watch(const study_subject *subject, double refinement, study_level *level)
{
  return subject->watch != NULL ? subject->watch(subject->user, refinement, level) : DVI_OK;
}

dvi_status study_time(const study_subject *subject, double refinement, study_level *level)
{
  const double began = dvi_study_clock();
  double spent, preparation = 0.0;
  long runs = 0;
  do {
    const dvi_status status = subject->repeat(subject->user, refinement, &preparation);
    if (status != DVI_OK) return status;
    runs++;
    spent = dvi_study_clock() - began;
  } while (dvi_study_repeats(spent) > 1);
  level->seconds = spent / (double)runs;
  return DVI_OK;
}

const char *study_say(const study_words *words, study_phrase phrase, double extent, char *text,
                      size_t size)
{
  return words->say != NULL ? words->say(phrase, extent, text, size) : NULL;
}

int study_count(const table_column *columns)
{
  int count = 0;
  while (columns != NULL && columns[count].title != NULL) count++;
  return count;
}
