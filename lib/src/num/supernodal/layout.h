/* What supernodes have, for the files of this room. */
#ifndef DVI_NUM_SUPERNODAL_LAYOUT_H
#define DVI_NUM_SUPERNODAL_LAYOUT_H
#include <stddef.h>

#include "num/supernodal/supernodes.h"

/* Columns of a panel, at most. Wider supernodes have several panels, so that a panel fits into a
 * cache. */
enum { DVI__PANEL_MOST = 64 };

/* Numbers behind the last panel, which products read. */
enum { DVI__BEHIND = 8 };

/* Columns first .. first+width-1 of a supernode. Their rows are the columns themselves, and then
 * what is below, ascending. The numbers are stored by columns of `height` numbers. Those above the
 * diagonal mean nothing. */
typedef struct dvi__panel {
  int first, width, height;
  const int *row; /* [height] */
  double *L;      /* [width*height] */
} dvi__panel;

struct dvi__supernodes {
  dvi__elimination of;
  int panels;
  dvi__panel *panel; /* [panels] */
  int *panel_of;     /* [n] of each column */
  int *rows;         /* lists of the supernodes */
  double *numbers;
  size_t count; /* of them */
  int tallest;
  /* work: place of a row in the panel that is factored [n]; other panels that change a panel, as
   * lists with their first ones and next ones [panels], and the first row of each that is not
   * done */
  int *place_of, *first_of, *next, *done;
  double *scaled;  /* [PANEL_MOST*PANEL_MOST] */
  double *product; /* [(tallest+BEHIND)*PANEL_MOST] */
};

dvi_status dvi__supernodes_lay_out(dvi__supernodes *supernodes);

#endif
