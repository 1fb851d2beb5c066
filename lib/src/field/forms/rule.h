/* Gauss's rule with five points an axis on simplices and boxes.
 *
 * A k-cell is the image of the cube [0,1]^k. For a box the map is linear. For a simplex with the
 * edges u_i = p_i - p_0 it is, after Duffy (1982),
 *
 *     x = p_0 + sum_i s_i u_i,   s_i = t_i prod_{j < i} (1 - t_j),
 *
 * with the Jacobian prod_i (1 - t_i)^(k-i) of s, i from 1 to k. */
#ifndef DVI_FIELD_FORMS_RULE_H
#define DVI_FIELD_FORMS_RULE_H
#include <dvi/mesh.h>

enum { DVI__RULE_POINTS = 5 };

typedef struct dvi__rule {
  double node[DVI__RULE_POINTS], weight[DVI__RULE_POINTS];
} dvi__rule;

dvi_status dvi__rule_make(dvi__rule *rule);

/* Give the number of points on a k-cell. */
int dvi__rule_count(int k);

/* Give the place s [k] of a point along the edges of the cell. Returns its weight. The weights of a
 * box sum to 1, and those of a simplex to 1/k!. */
double dvi__rule_point(const dvi__rule *rule, dvi_cell_kind kind, int k, int point, double *s);

#endif
