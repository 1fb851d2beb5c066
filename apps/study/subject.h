/** What is studied: anything that can be run at levels of refinement, and whose error and cost can
 * be measured at each. A method on a problem is one, with its steps for levels, a code with its
 *  tolerances, a quadrature with its points, a mesh with its cells.
 *
 *  Studies of order, of work against error, and of digits that can be trusted know no more of it
 * than what is here. */
#ifndef SUBJECT_H
#define SUBJECT_H
#include <dvi/status.h>
#include <stdbool.h>

#include "csv/table.h"

enum { STUDY_FURTHER_MAX = 4, STUDY_COUNTS_MAX = 8, STUDY_NAME = 320, STUDY_JUDGE = 256 };

/** An error must exceed what blurs it by this factor to count. */
#define STUDY_FLOOR_MARGIN 10.0

/** What came out at a level. What a subject does not set is 0, and NaN of numbers of type
 *  double. */
typedef struct study_level {
  double refinement; /**< as it was asked for: into how many parts, or a tolerance */
  double parts;      /**< as many as it took in the end */
  double length;     /**< of a part; the first one's if lengths are chosen */
  double error;
  double further[STUDY_FURTHER_MAX]; /**< other errors, as study_words names them */
  double counted[STUDY_COUNTS_MAX];  /**< work, and what else is counted */
  double seconds;                    /**< of process time, of one run */
  double *number; /**< room for the numbers of the result, if they are wanted; NULL: they are not */
} study_level;

/** What a sentence of a report can need of the subject. */
typedef enum study_phrase {
  STUDY_REACH,    /**< how far a run goes: "to t = 10" */
  STUDY_PLACE,    /**< where it is judged: "at t = 10" */
  STUDY_WHOLE,    /**< what errors are of: "the span" */
  STUDY_ROUNDOFF, /**< what hides small errors, if it is not the judge's own error */
  STUDY_MORE,     /**< what to do about too few levels, */
  STUDY_FINER,    /**< parts that are too large, */
  STUDY_COARSER,  /**< parts that are too small, */
  STUDY_EQUAL,    /**< parts whose lengths are chosen, so that an error is no power of the first, */
  STUDY_NEARER,   /**< a slope that does not settle, */
  STUDY_LOWER     /**< the same of an order that is too high for errors of doubles */
} study_phrase;

/** What things are called in tables and sentences. */
typedef struct study_words {
  const char *subject, *problem; /**< titles of columns: "method", "problem" */
  const char *length, *parts;    /**< "h", "steps" */
  const char *preparation;     /**< the part of the time before the first part: "create_seconds" */
  const table_column *further; /**< further errors, ended by one without a title */
  const table_column *counted; /**< what is counted, ended so, too */

  /** Words for a sentence: `text` [size] or a constant; NULL: there are none, and the sentence ends
   *  before. */
  const char *(*say)(study_phrase phrase, double extent, char *text, size_t size);
} study_words;

/** The callbacks. All return DVI_OK; a status above 0 if this level has no result, but another one
 * may have; or one below 0, which ends the study. */
typedef struct study_subject {
  const char *name, *problem; /**< in tables */
  const study_words *words;
  double extent;      /**< how far a run goes, for words */
  int order;          /**< that is claimed */
  double span;        /**< what is cut into parts */
  double first_parts; /**< where a search for the first level begins */
  double size;        /**< of the solution, above 0 */
  const char *judge;  /**< who says what the solution is, in words; NULL: nobody is named */
  double judge_error; /**< of what is taken for the solution */
  bool chooses;       /**< lengths of parts are chosen on the way */
  bool may_miss;      /**< it may end far from the solution however many parts there are */

  /** Run once: fills error, parts, length, counted, and number if that is not NULL. */
  dvi_status (*run)(void *user, double refinement, study_level *level);
  /** Run again, to watch what only a slower run shows: fills `further`, and of `counted` what run
   * does not. NULL: there is none. */
  dvi_status (*watch)(void *user, double refinement, study_level *level);
  /** Run, and do no more: for the clock. *preparation grows by the seconds of process time before
   * the first part, NaN if they are not known. */
  dvi_status (*repeat)(void *user, double refinement, double *preparation);
  /** How far roundoff moves the result. NULL: nothing is known of it. */
  dvi_status (*roundoff)(void *user, double refinement, double *moved);
  /** How tables call the level: "tol=1e-08" to text [size]. NULL: by its length, "h=0.1". */
  void (*setting)(void *user, double refinement, char *text, size_t size);
  /** Why the last level had no result. */
  const char *(*reason)(void *user);
  void *user;
} study_subject;

/** Run a level: `level` [1] is filled anew, but for `number`. */
dvi_status study_run(const study_subject *subject, double refinement, study_level *level);

/** Run it again, to watch it; DVI_OK and nothing done if there is nothing to watch. */
dvi_status study_watch(const study_subject *subject, double refinement, study_level *level);

/** Run it as often as a clock needs: fills seconds. */
dvi_status study_time(const study_subject *subject, double refinement, study_level *level);

/** Words of the subject; NULL if it has none. */
const char *study_say(const study_words *words, study_phrase phrase, double extent, char *text,
                      size_t size);

/** How many titles a list of columns has, which is ended by one without; NULL has none. */
int study_count(const table_column *columns);
#endif
