/* Stars of boxes whose material changes inside of them.
 *
 * In a box with the edge along an axis, and the piece of the edge's dual face across it, the field
 * has the same D across the edge everywhere along it, and the same voltage everywhere across it:
 *
 *     M_1 = int over the piece of [ int along the edge of dl/eps ]^-1.
 *
 * Likewise with the face across the axis, and the piece of its dual edge along it:
 *
 *     M_2 = int over the piece of [ int over the face of mu dA ]^-1.
 *
 * Both are exact for layers across or along an axis, wherever their surfaces are, which keeps the
 * second order that stairs lose (Farjadpour et al. 2006). */
#ifndef DVI_FIELD_YEE_AVERAGE_H
#define DVI_FIELD_YEE_AVERAGE_H
#include <dvi/forms.h>

/* A material's functions and its name in sentences. */
typedef struct dvi__average {
  dvi_form_function *function;
  void *user;
  const char *name;
} dvi__average;

/* A box in a space of `space` axes. A number of an axis beyond them stands for an axis along which
 * nothing changes and all lengths are 1. */
typedef struct dvi__average_box {
  int space;
  double lower[3], upper[3];
} dvi__average_box;

/* Add the part of M_1 of an edge along the axis, or of M_2 of a face across it, to *star.
 * DVI_CALLBACK_FAILED, DVI_NOT_FINITE, or DVI_BAD_ARGUMENT for values that are not positive. */
dvi_status dvi__average_edge(const dvi__average *eps, const dvi__average_box *box, int axis,
                             double *star);
dvi_status dvi__average_face(const dvi__average *mu, const dvi__average_box *box, int axis,
                             double *star);

/* Add the part of the star of sigma, whose field is that of M_1:
 *     int over the piece of int along the edge of sigma/eps^2 dl / [ int of dl/eps ]^2.
 * eps may have no function, for 1. sigma may be 0. */
dvi_status dvi__average_loss(const dvi__average *eps, const dvi__average *sigma,
                             const dvi__average_box *box, int axis, double *star);

#endif
