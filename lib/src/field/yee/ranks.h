/* The division of a grid among processes, planes that these give each other, and sums over all of
 * them. */
#ifndef DVI_FIELD_YEE_RANKS_H
#define DVI_FIELD_YEE_RANKS_H
#include "field/yee/yee.h"
#include "num/accumulator.h"

/* How processes speak with each other. See planes.c. */
struct dvi__yee_planes {
  dvi_yee_ranks ranks;
  int failed;                             /* what a function returned, 0 for success */
  int filled;                             /* ghosts that are as their owners have them */
  int has_layers[3];                      /* ghosts of some process are in an axis' layers */
  double *sent, *received[3], *moment[3]; /* what goes across an axis, the last for a moment */
};

/* ---- divide.c ---- */

/* Find the own places of this process, from the axes, and how many steps go together. */
dvi_status dvi__yee_divide(const dvi_yee_terms *terms, dvi__yee *yee);
/* Give the first box of a part of an axis. */
int dvi__yee_first_box(const dvi__yee *yee, int axis, int part);

/* ---- ranks.c ---- */

/* Return the number of this process, and how many there are. */
int dvi__yee_rank(const dvi__yee *yee);
int dvi__yee_processes(const dvi__yee *yee);
/* These functions are called on all processes, and do nothing on a whole grid. After one has
 * failed, the others do nothing, and dvi__yee_check_ranks tells so, until processes begin anew.
 * That returns the failure, so that it can be put back. */
dvi_status dvi__yee_check_ranks(const dvi__yee *yee);
int dvi__yee_begin_ranks(const dvi__yee *yee);
void dvi__yee_lose_ranks(const dvi__yee *yee, int failure);
/* Fail on all processes, with the same status, if one of them has failed. The second one speaks
 * even after a failure to speak, and the last one where a process may have no grid. */
dvi_status dvi__yee_agree(const dvi__yee *yee, dvi_status status);
dvi_status dvi__yee_agree_anew(const void *yee, dvi_status status);
dvi_status dvi__yee_agree_of(const dvi_yee_terms *terms, dvi_status status);
/* Give the sum of all processes, rounded once, and replace numbers by the largest of all. */
double dvi__yee_sum_of_all(const dvi__yee *yee, dvi__accumulator *sum);
void dvi__yee_largest_of_all(const dvi__yee *yee, int count, double *number);
/* Replace integers by their sums over all processes, or give the sum modulo 2^64. */
void dvi__yee_add_all(const dvi__yee *yee, int count, int64_t *number);
uint64_t dvi__yee_sum_modulo(const dvi__yee *yee, uint64_t number);

/* ---- planes.c ---- */

/* Make room for planes that go to other processes, or come from them. Nothing on a whole grid. */
dvi_status dvi__yee_make_planes(const dvi_yee_terms *terms, dvi__yee *yee);
void dvi__yee_clear_planes(dvi__yee *yee);
/* The next ones are called on all processes, too, and do nothing after a failure to speak. */
/* Give B of the last boxes to the process after this one along each axis that is divided, and E of
 * the first nodes to the one before, which a step needs there, of the components across the
 * axis. */
void dvi__yee_pass_faces(const dvi__yee *yee);
void dvi__yee_pass_edges(const dvi__yee *yee);
/* Have E and B, and the sums of layers, of so many planes of the neighbours before and behind the
 * own ones: nothing if they are there since the last steps. Nothing without ghosts. */
void dvi__yee_fill_ghosts(const dvi__yee *yee, int planes);
/* Tell that something has moved since. */
void dvi__yee_spoil_ghosts(const dvi__yee *yee);
/* Give B along an axis of its first plane to the process before this one. */
void dvi__yee_pass_faces_back(const dvi__yee *yee);
/* Give numbers of a plane to the process after this one along an axis. They are put to
 * dvi__yee_plane_sent, with room for the copies of all components of a form. Those of the process
 * before are returned: fields of a moment, which have a phase and last, or others, which last until
 * planes go across the axis again. */
double *dvi__yee_plane_sent(const dvi__yee *yee);
const double *dvi__yee_pass_plane(const dvi__yee *yee, int axis, int is_moment);
/* Give the place of a component, of a copy, in such a plane. */
size_t dvi__yee_at_plane(const dvi__yee *yee, int axis, int component, int copy, const int *place);

#endif
