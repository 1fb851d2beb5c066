/* Paths in a chart that is centred at their start. Varying the start moves the chart, and with it
 * the whole path xi(tau) as it is: that is more, or less, than varying q0 in a chart that stays,
 * and makes
 *     p1 = p0 + h sum_j b_j L_q_j + C
 * with a C that depends on the path's end and on the nodes. For paths that start elsewhere in the
 * chart C is 0. Who has charts says C (system/chart/charted.h), and the action uses it
 * (step/element/action.h). */
#ifndef DVI_SYSTEM_CENTRING_H
#define DVI_SYSTEM_CENTRING_H

typedef struct dvi__centring {
  void *of;
  /* along paths the determinant of the rows' Jacobian changes its sign at folds alone; on a sphere
   * it does at a quarter turn, too, where paths cross */
  int signs;
  /* Before the Lagrangian's derivatives at the nodes are asked for: where the path starts and ends,
   * [n]. */
  void (*place)(void *of, const double *q0, const double *q1);
  /* After its gradients: C [n]. dp: h sum_j b_j L_q_j. */
  void (*correct)(void *of, int nodes, double h, const double *weight, const double *p0,
                  const double *dp, double *C);
  /* Magnitudes [n*s], those of coordinate i at i*s, become those of sums in which a turn mixes
   * coordinates. */
  void (*mix)(void *of, int s, double *magnitude);
  /* The largest turn in s points [n*s], those of coordinate i at i*s, or from others to them, in
   * radians; others NULL: from the centre. */
  double (*turn)(void *of, int s, const double *points, const double *others);
  /* After its Hessians: dC/dq1 in the order of qq, and what C_qq and C_qv are at the nodes: dC =
   * dq1 + sum_j b_j (h C_qq dq + C_qv dv). */
  void (*derive)(void *of, int nodes, double h, const double *weight, const double *p0,
                 const double **C_q1, const double **C_qq, const double **C_qv);
} dvi__centring;

#endif
