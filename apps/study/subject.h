/** The subject of a study. A subject can be run at levels of refinement, and its error and cost can
 * be measured at each level. Examples are a method on a problem with its steps as levels, a code
 * with its tolerances, a quadrature with its points, and a mesh with its cells.
 *
 * Studies of order, of work against error, and of digits that can be trusted know nothing else of a
 * subject. */
#ifndef SUBJECT_H
#define SUBJECT_H
#include <dvi/status.h>
#include <stdbool.h>

#include "csv/table.h"

enum { STUDY_FURTHER_MAX = 4, STUDY_COUNTS_MAX = 8, STUDY_NAME = 320, STUDY_JUDGE = 256 };

/** The result at a level. Members that a subject does not set are 0, or NaN for type double. */
typedef struct study_level {
  double refinement; /**< requested refinement, a number of parts or a tolerance */
  double parts;      /**< number of parts that were taken */
  double length;     /**< length of a part, of the first one if lengths are chosen */
  double error;
  double further[STUDY_FURTHER_MAX]; /**< other errors, as study_words names them */
  double counted[STUDY_COUNTS_MAX];  /**< work, and other counts */
  double seconds;                    /**< process time of one run */
  double *number; /**< memory for the numbers of the result, or NULL if they are not wanted */
} study_level;

/** The phrases that a sentence of a report can take from the subject. */
typedef enum study_phrase {
  STUDY_REACH,    /**< extent of a run, such as "to t = 10" */
  STUDY_PLACE,    /**< place of the judgement, such as "at t = 10" */
  STUDY_WHOLE,    /**< object of the errors, such as "the span" */
  STUDY_ROUNDOFF, /**< cause that hides small errors, other than the judge's own error */
  STUDY_MORE,     /**< advice on too few levels */
  STUDY_FURTHER,  /**< advice on a slope that settles at the last levels */
  STUDY_FINER,    /**< advice on parts that are too large */
  STUDY_COARSER,  /**< advice on parts that are too small */
  /** advice on parts of chosen lengths, where an error is no power of the first length */
  STUDY_EQUAL,
  STUDY_NEARER, /**< advice on a slope that does not settle */
  STUDY_LOWER   /**< advice on a slope of an order that is too high for errors of doubles */
} study_phrase;

/** The words of a subject in tables and sentences. */
typedef struct study_words {
  const char *subject, *problem; /**< titles of columns, such as "method", "problem" */
  const char *length, *parts;    /**< titles of columns, such as "h", "steps" */
  const char *preparation; /**< title of the time before the first part, such as "create_seconds" */
  const table_column *further; /**< further errors, ended by one without a title */
  const table_column *counted; /**< counts, ended by one without a title */

  /** Return words for a sentence, in `text` [size] or constant. NULL if there are none, and the
   * sentence ends before. */
  const char *(*say)(study_phrase phrase, double extent, char *text, size_t size);
} study_words;

/** The callbacks. They return DVI_OK, a status above 0 if this level has no result but another one
 * may have, or a status below 0, which ends the study. */
typedef struct study_subject {
  const char *name, *problem; /**< names in tables */
  const study_words *words;
  double extent;      /**< extent of a run, in words */
  int order;          /**< claimed order */
  double span;        /**< interval that is divided into parts */
  double first_parts; /**< parts at which a search for the first level begins */
  double size;        /**< size of the solution, above 0 */
  const char *judge;  /**< description of the judge, or NULL if nobody is named */
  double judge_error; /**< error of the solution to compare with */
  bool chooses;       /**< lengths of parts are chosen during the run */
  bool may_miss;      /**< runs with any number of parts may end far from the solution */

  /** Run once. Fills error, parts, length, counted, and number if that is not NULL. */
  dvi_status (*run)(void *user, double refinement, study_level *level);
  /** Run again for quantities that only a slower run shows. Fills `further`, and those of `counted`
   * that `run` leaves out. May be NULL. */
  dvi_status (*watch)(void *user, double refinement, study_level *level);
  /** Run for the clock, and do nothing else. *preparation grows by the seconds of process time
   * before the first part, by NaN if they are not known. */
  dvi_status (*repeat)(void *user, double refinement, double *preparation);
  /** Measure how far roundoff moves the result. NULL if that is not known. */
  dvi_status (*roundoff)(void *user, double refinement, double *moved);
  /** Write the name of the level in tables, such as "tol=1e-08", to text [size]. The default is its
   * length, such as "h=0.1". */
  void (*setting)(void *user, double refinement, char *text, size_t size);
  /** Return the reason why the last level had no result. */
  const char *(*reason)(void *user);
  void *user;
} study_subject;

/** Run a level. All of `level` [1] is filled, except the pointer `number`. */
dvi_status study_run(const study_subject *subject, double refinement, study_level *level);

/** Run a level again by `watch`. Does nothing and returns DVI_OK if there is none. */
dvi_status study_watch(const study_subject *subject, double refinement, study_level *level);

/** Run a level as often as the clock needs. Fills seconds. */
dvi_status study_time(const study_subject *subject, double refinement, study_level *level);

/** Return words of the subject, or NULL if it has none. */
const char *study_say(const study_words *words, study_phrase phrase, double extent, char *text,
                      size_t size);

/** Count the titles of a list of columns, which ends with one without a title. NULL has none. */
int study_count(const table_column *columns);
#endif
