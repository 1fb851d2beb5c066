/* The list of row terms of an action. */
#ifndef DVI_STEP_ELEMENT_ROW_TERMS_H
#define DVI_STEP_ELEMENT_ROW_TERMS_H
#include "step/element/row_term.h"
#include "system/system.h"

enum { DVI__ROW_TERMS_MOST = 8 };

/* The terms of an action. */
typedef struct dvi__row_terms {
  int count, unknowns;
  dvi__row_term term[DVI__ROW_TERMS_MOST];
  int first[DVI__ROW_TERMS_MOST]; /* first unknown of each term, behind the path's */
  dvi__row_path path;
  /* [n] each, all numbers, the end, h sum b L_q, and what terms add to that */
  double *numbers, *q1, *in_p, *dp;
} dvi__row_terms;

#endif
