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
 * second order that stairs lose (Farjadpour et al. 2006).
 *
 * Surfaces are found where the values at two places differ. Along each axis a box is looked at in
 * its eighths, so that no film through it and across the axis is lost that is thicker than an
 * eighth of the box. A thinner one counts if one of the places is in it, and else not at all. */
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
  const double *value; /* of the material, or of sigma for losses, if it is known, else NULL */
} dvi__average_box;

/* Give the material's value in a box, or that of sigma if it is not NULL, with which losses are
 * those of boxes of one material. NAN if that differs at one of the places where it is looked at.
 * Pieces of the box that are half of it need not be looked at then. Statuses as below. */
dvi_status dvi__average_value(const dvi__average *medium, const dvi__average *sigma,
                              const dvi__average_box *box, double *value);

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
