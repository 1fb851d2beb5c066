/* The motion about a fixed centre, v' = -mu q/|q|^3, exact for a time tau of any size and sign, in
 * a plane or in space. mu may be negative, for a repulsion.
 *
 * With Stumpff's functions c_k and G_k = s^k c_k(beta s^2), beta = 2 mu/r0 - v.v and eta = q.v,
 *
 *     tau = r0 G_1 + eta G_2 + mu G_3,      r = r0 G_0 + eta G_1 + mu G_2 = d tau/ds > 0,
 *     q(tau) = (1 - mu G_2/r0) q + (r0 G_1 + eta G_2) v,
 *     v(tau) = -mu G_1/(r r0) q + (1 - mu G_2/r) v,
 *
 * so that ellipses, parabolas and hyperbolas are one case. Source: Stiefel and Scheifele 1971, sec.
 * 11; Conway 1986 (Laguerre's method for the first equation). */
#ifndef DVI_STEP_SPLIT_ORBIT_H
#define DVI_STEP_SPLIT_ORBIT_H

/* An orbit from q and v, and its point at tau. q(tau) - q = f_less_1 q + g v, and v(tau) - v =
 * f_rate q + g_rate_less_1 v. */
typedef struct dvi__orbit {
  double mu, r0, eta, beta;
  double s, G[4], r;
  double f_less_1, g, f_rate, g_rate_less_1;
} dvi__orbit;

/* Put the orbit at tau from q and v [dimension]. `guess` is an s near the solution, or 0. Numbers
 * are not finite where the motion meets the centre. */
void dvi__orbit_place(double mu, int dimension, const double *q, const double *v, double tau,
                      double guess, dvi__orbit *orbit);

/* Multiply a covector lambda [dimension] on q(tau) by the transposed derivatives of q(tau): by q,
 * to_q, and by v, to_v. */
void dvi__orbit_pullback(const dvi__orbit *orbit, int dimension, const double *q, const double *v,
                         const double *lambda, double *to_q, double *to_v);

#endif
