/* Quadratures of triangles and tetrahedra with positive weights and points inside. */
#ifndef DVI_FIELD_SPACE_SIMPLEX_RULE_H
#define DVI_FIELD_SPACE_SIMPLEX_RULE_H

/* Points in barycentric coordinates, weights of sum 1, and the degree of the polynomials for which
 * the rule is exact. */
typedef struct dvi__simplex_rule {
  int n, points, degree;
  double place[14][4], weight[14];
} dvi__simplex_rule;

/* Return the rule with so many points, or the one for products of two functions of a degree if
 * `points` is 0. NULL if there is none. */
const dvi__simplex_rule *dvi__simplex_rule_of(int n, int degree, int points);

#endif
