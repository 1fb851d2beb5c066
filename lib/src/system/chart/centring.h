/* Paths in a chart that is centred at their start. Varying the start moves the chart, and with it
 * the whole path xi(tau). This differs from varying q0 in a fixed chart, and makes
 *
 *     p1 = p0 + h sum_j b_j L_q_j + C
 *
 * with a C that depends on the path's end and on the nodes. For paths that start elsewhere in the
 * chart C is 0. The charted system provides C (system/chart/charted.h), and the action uses C
 * (step/element/action.h). */
#ifndef DVI_SYSTEM_CHART_CENTRING_H
#define DVI_SYSTEM_CHART_CENTRING_H

typedef struct dvi__centring {
  void *of;
  /* not 0 if along paths the determinant of the rows' Jacobian changes its sign at folds alone. On
   * a sphere the sign also changes at a quarter turn, where paths cross. */
  int signs;
  /* Set start and end [n] of the path, before the Lagrangian's derivatives at the nodes are
   * evaluated. */
  void (*place)(void *of, const double *q0, const double *q1);
  /* Compute C [n] after the gradients. dp is h sum_j b_j L_q_j. */
  void (*correct)(void *of, int nodes, double h, const double *weight, const double *p0,
                  const double *dp, double *C);
  /* Replace magnitudes [n*s], those of coordinate i at i*s, by those of sums in which a turn mixes
   * coordinates. */
  void (*mix)(void *of, int s, double *magnitude);
  /* Return the largest turn in radians among s points [n*s], those of coordinate i at i*s, measured
   * from `others`. If others is NULL, turns are measured from the centre. */
  double (*turn)(void *of, int s, const double *points, const double *others);
  /* Compute after the Hessians dC/dq1 in the order of qq, and C_qq and C_qv at the nodes, with
   * dC = dq1 + sum_j b_j (h C_qq dq + C_qv dv). */
  void (*derive)(void *of, int nodes, double h, const double *weight, const double *p0,
                 const double **C_q1, const double **C_qq, const double **C_qv);
  /* A momentum f [n] that other forces add at the point xi [n] of the path is f + more at its end.
   * `carry` computes more [n], and counts its angular momentum, which the state gets on arrival. */
  void (*carry)(void *of, const double *xi, const double *f, double *more);
  /* Compute the derivatives of `more` by f, by xi and by the path's end, in blocks of coordinates,
   * [3 n]. Number 3 i + b is that of coordinate i by coordinate first[i] + b, for b < width[i]. */
  void (*carry_derivatives)(void *of, const double *xi, const double *f, double *by_f,
                            double *by_xi, double *by_end);
  const int *first, *width;
} dvi__centring;

#endif
