/* The parts of the cells of one axis. */
#ifndef DVI_FIELD_MULTISCALE_FINE_AXIS_H
#define DVI_FIELD_MULTISCALE_FINE_AXIS_H
#include <dvi/status.h>

typedef struct dvi__fine_axis {
  int cells; /* of the coarse grid */
  int fine;  /* parts of each */
  int parts; /* cells * fine */
  int is_periodic;
  double *end; /* [parts+1] of the parts, ascending */
} dvi__fine_axis;

/* Divide the cells between nodes [cells+1]. DVI_NO_MEMORY. On failure nothing is owned. */
dvi_status dvi__fine_axis_create(const double *node, int cells, int fine, int is_periodic,
                                 dvi__fine_axis *axis);
void dvi__fine_axis_clear(dvi__fine_axis *axis);

/* Return the number of nodes of the coarse grid, and that of a cell's left (0) or right (1) end. */
int dvi__fine_axis_nodes(const dvi__fine_axis *axis);
int dvi__fine_axis_node(const dvi__fine_axis *axis, int cell, int right);

/* Find the part that holds x, and the place of x in it, from 0 to 1. Return 0 if x is outside,
 * which on a periodic axis only NaN and infinity are. */
int dvi__fine_axis_locate(const dvi__fine_axis *axis, double x, int *part, double *place);

/* Return the length of a part, and the point at a place in it. */
static inline double dvi__fine_axis_length(const dvi__fine_axis *axis, int part)
{
  return axis->end[part + 1] - axis->end[part];
}

static inline double dvi__fine_axis_point(const dvi__fine_axis *axis, int part, double place)
{
  return axis->end[part] + place * dvi__fine_axis_length(axis, part);
}

/* Return a part of the periodic continuation as one of the axis. */
static inline int dvi__fine_axis_wrap(const dvi__fine_axis *axis, int part)
{
  const int rest = part % axis->parts;
  return rest < 0 ? rest + axis->parts : rest;
}

#endif
