/** Order studies. They measure the error at one level after another, fit a slope, and decide
 * whether the slope is the claimed order. */
#ifndef ORDER_H
#define ORDER_H
#include <dvi/dvi.h>

#include "study/levels.h"
#include "study/subject.h"

enum { CLOSER_LEVELS_MAX = 16, CLOSER_WORDS = 256 };

/** A closer look where levels do not show the claimed order. Other levels are run, whose errors are
 * measured in more digits. */
typedef struct closer_look {
  bool asked;
  const char *missing; /**< reason why there is no closer look, or NULL */
  const char *of;      /**< its parts, such as "single steps" */
  const char *digits;  /**< its precision, such as "in quadruple precision" */
  /** question to ask if these levels have the order, and the others fall far slower */
  const char *unlike;
  char title[CLOSER_WORDS], judge[CLOSER_WORDS]; /**< title of its table, and name of its judge */
  int levels;
  double length[CLOSER_LEVELS_MAX], error[CLOSER_LEVELS_MAX];
  double excess;     /**< excess of these errors' slope over the order, 1 for errors of one part */
  dvi_order_fit fit; /**< fit of the order */
  bool settled;
} closer_look;

/** The result for one subject. */
typedef struct order_result {
  char name[STUDY_NAME];
  const study_words *words;
  int claimed; /**< claimed order */
  /** the subject chooses lengths, so that the length is that of the first part alone */
  bool chooses;
  double extent;           /**< extent of the run */
  char judge[STUDY_JUDGE]; /**< description of the judge */
  double judge_error;
  int levels;
  double length[DVI_STUDY_LEVELS_MAX]; /**< length without sign */
  double error[DVI_STUDY_LEVELS_MAX];
  double floor, ceiling; /**< errors outside are not fitted */
  dvi_order_fit fit;
  bool settled;       /**< slope is the same all over the fitted levels */
  double seconds;     /**< process time of a run of the last level */
  closer_look closer; /**< closer look, requested where the levels do not show the claimed order */
} order_result;

/** Run all levels, and fit the order. Each level is a row of the table, whose columns are
 * order_columns. */
dvi_status order_measure(const study_subject *subject, const dvi_study_levels *choice, int levels,
                         result_table *rows, order_result *result);

/** Run up to six further levels by the ratio of the last two, while order_may_settle and a run
 * takes no more than a second. */
dvi_status order_extend(const study_subject *subject, result_table *rows, order_result *result);

/** Fill in the columns of the table, which end with one without a title. */
enum { ORDER_COLUMNS_MAX = 8 + STUDY_FURTHER_MAX + STUDY_COUNTS_MAX };
void order_columns(const study_words *words, table_column *columns);

/** Return the order between level k and the level before it, or NaN if there is none. */
double order_local_slope(const order_result *result, int k);

/** Return the number of levels of the fit. */
int order_fitted(const order_result *result);

/** Return whether a further level may settle the slope. The errors of the last two fall about as
 * claimed, and the next one is above the floor. */
bool order_may_settle(const order_result *result);

/** Return whether the closer look has an order, and whether it decides. Its order counts if errors
 * of the levels fall about as it predicts. */
bool order_closer_settled(const order_result *result);
bool order_closer_decides(const order_result *result);

/** Return whether a settled slope is the claimed order. */
bool order_holds(const order_result *result);
#endif
