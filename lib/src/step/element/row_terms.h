/* The list of row terms of an action. */
#ifndef DVI_STEP_ELEMENT_ROW_TERMS_H
#define DVI_STEP_ELEMENT_ROW_TERMS_H
#include "step/element/row_term.h"
#include "system/system.h"

enum { DVI__ROW_TERMS_MOST = 8 };

/* What an action keeps of its terms. */
typedef struct dvi__row_terms {
  int count, unknowns;
  dvi__row_term term[DVI__ROW_TERMS_MOST];
  int first[DVI__ROW_TERMS_MOST]; /* unknown of each term, behind the path's */
  dvi__row_path path;
  double *numbers, *q1, *in_p, *dp; /* [n] each: the end, h sum b L_q, what terms add to it */
} dvi__row_terms;

#endif
