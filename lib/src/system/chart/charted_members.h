/* Charts at the places of several members of an ensemble, side by side. */
#ifndef DVI_SYSTEM_CHART_CHARTED_MEMBERS_H
#define DVI_SYSTEM_CHART_CHARTED_MEMBERS_H
#include "system/chart/charted.h"

typedef struct dvi__charted_members dvi__charted_members;

/* Tell whether a charted system has such charts, as it has without forces, constraints and a
 * reduced Lagrangian. */
int dvi__charted_has_members(const dvi__charted *charted);

/* Create charts of up to `capacity` members, for paths with `nodes` points, after
 * dvi__charted_centring. DVI_NO_MEMORY. */
dvi_status dvi__charted_members_create(dvi__charted *charted, int nodes, int capacity,
                                       dvi__charted_members **members);
void dvi__charted_members_destroy(dvi__charted_members **members);

/* Begin with this number of members, 4 at least. Then take over the charts of the charted system,
 * whose centre is that of member k. */
void dvi__charted_members_begin(dvi__charted_members *members, int width);
void dvi__charted_members_take(dvi__charted_members *members, int k);

/* Compute the gradients at all nodes as the charted system would, without counting them. Rows of
 * numbers are [width]. Node j of member k of a coordinate is at j*width + k. */
dvi_status dvi__charted_members_gradient(dvi__charted_members *members, const double *t,
                                         const double *xi, const double *rate, double *L_xi,
                                         double *L_rate);

/* Compute C of all paths after the gradients (system/chart/centring.h). All arguments but the
 * weights are rows [nx*width], the paths' ends first. */
void dvi__charted_members_correct(dvi__charted_members *members, double h, const double *weight,
                                  const double *end, const double *p0, const double *dp, double *C);

/* Keep the impulse of member k's path, which is the solution. */
void dvi__charted_members_keep(dvi__charted_members *members, int k);

/* Give the charted system the charts of member k, and the path that was kept. */
void dvi__charted_members_give(const dvi__charted_members *members, int k);

#endif
