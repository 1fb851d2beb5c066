/** Order studies: the error at one level after another, the slope that is fitted to it, and whether
 *  that is the order that is claimed. */
#ifndef ORDER_H
#define ORDER_H
#include <dvi/dvi.h>

#include "study/levels.h"
#include "study/subject.h"

enum { CLOSER_LEVELS_MAX = 16, CLOSER_WORDS = 256 };

/** A closer look, where levels do not show the claimed order: other levels, whose errors are
 * measured in more digits. */
typedef struct closer_look {
  bool asked;
  const char *missing; /**< why there is none; NULL: it is below */
  const char *of;      /**< "single steps" */
  const char *digits;  /**< "in quadruple precision" */
  const char *unlike;  /**< what to ask if these levels have the order, and the others far less */
  char title[CLOSER_WORDS], judge[CLOSER_WORDS]; /**< of its table; who judges it */
  int levels;
  double length[CLOSER_LEVELS_MAX], error[CLOSER_LEVELS_MAX];
  double excess;     /**< the slope of these errors less the order: 1 for errors of one part */
  dvi_order_fit fit; /**< of the order */
  bool settled;
} closer_look;

/** What was found for one subject. */
typedef struct order_result {
  char name[STUDY_NAME];
  const study_words *words;
  int claimed;             /**< its order */
  bool chooses;            /**< so that the length is that of the first part alone */
  double extent;           /**< how far it went */
  char judge[STUDY_JUDGE]; /**< by whom it was judged, in words */
  double judge_error;
  int levels;
  double length[STUDY_LEVELS_MAX]; /**< without sign */
  double error[STUDY_LEVELS_MAX];
  double floor, ceiling; /**< errors outside are not fitted */
  dvi_order_fit fit;
  bool settled;       /**< the slope is the same all over the fitted levels */
  closer_look closer; /**< asked where the levels do not show the claimed order */
} order_result;

/** Run all levels, and fit the order. Each is a row of the table, whose columns are
 *  order_columns. */
dvi_status order_measure(const study_subject *subject, const levels_choice *choice, int levels,
                         result_table *rows, order_result *result);

/** Fill in the columns of the table, ended by one without a title. */
enum { ORDER_COLUMNS_MAX = 8 + STUDY_FURTHER_MAX + STUDY_COUNTS_MAX };
void order_columns(const study_words *words, table_column *columns);

/** The order that level k and the one before it show; NaN if there is none. */
double order_local_slope(const order_result *result, int k);

/** How many levels the fit has. */
int order_fitted(const order_result *result);

/** Whether the closer look has an order, and whether it has the last word: its order counts if
 * errors of the levels fall about as it foretells. */
bool order_closer_settled(const order_result *result);
bool order_closer_decides(const order_result *result);

/** Whether a settled slope is the claimed order. */
bool order_holds(const order_result *result);
#endif
