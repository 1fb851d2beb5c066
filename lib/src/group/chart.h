/* Charts of a factor of the configuration space, centred at a point y0 of it: y(xi) with y(0) = y0,
 * s = |xi|^2, c_k Stumpff's functions.
 *
 *     line       y = y0 + xi
 *     circle     y = c_0 y0 + c_1 xi y0',  y0' = y0 turned by 90 degrees                    U(1) as unit vectors
 *     sphere     y = c_0 y0 + c_1 B xi,    B an orthonormal basis of the tangent plane      S^2: great circles, the horizontal lift to SO(3)
 *     rotation   R = R0 exp(xi^),          exp = I + c_1 xi^ + c_2 xi^^2                    SO(3): nine entries, row by row
 *
 * They are natural: a rotation of y0 rotates y. A Lagrangian on the stored coordinates y becomes
 * one of xi: what that takes of the derivatives of y is here, in contractions f(xi) = w.y(xi) with
 * a covector w, all of the form f = w_0 c_0 + c_1 z.xi + c_2 xi.B xi + constant.
 *
 * What is tied to a point of the manifold itself, and stored with a state, is: v = dy/dt (circle:
 * the angular rate; rotation: the angular velocity in the body's frame), and the momentum p of this
 * v. Source: Leok 2004, sec. 5.3 and 5.4 (with the derivative of the exponential map on the side
 * that the chart's left factor asks for); Iserles et al. 2000. */
#ifndef DVI_GROUP_CHART_H
#define DVI_GROUP_CHART_H

typedef enum dvi__chart_kind { DVI__LINE, DVI__CIRCLE, DVI__SPHERE, DVI__ROTATION } dvi__chart_kind;

/* Most numbers: of a point; of chart coordinates; of a stored velocity. */
enum { DVI__CHART_POINT = 9, DVI__CHART_SIZE = 3, DVI__CHART_VELOCITY = 3 };

/* How many numbers: of a point y; of a stored velocity; of chart coordinates. */
static inline int dvi__chart_stored(dvi__chart_kind kind)
{
  static const int count[] = {1, 2, 3, 9};
  return count[kind];
}

static inline int dvi__chart_velocities(dvi__chart_kind kind)
{
  return kind == DVI__SPHERE || kind == DVI__ROTATION ? 3 : 1;
}

static inline int dvi__chart_size(dvi__chart_kind kind)
{
  static const int count[] = {1, 1, 2, 3};
  return count[kind];
}

typedef struct dvi__chart {
  dvi__chart_kind kind;
  double y0[DVI__CHART_POINT];
  double basis[2][3]; /* of the tangent plane: circle, sphere */
} dvi__chart;

/* What everything at one xi is made of: of[k][j] is the derivative of order j of c_k in s; c_3 has
 * two. Nothing of a line needs them. */
typedef struct dvi__functions {
  double of[4][4];
} dvi__functions;

void dvi__chart_functions(dvi__chart_kind kind, const double *xi, dvi__functions *c);

/* Centre it at a point. */
void dvi__chart_centre(dvi__chart_kind kind, const double *y0, dvi__chart *chart);

/* y(xi), orthogonal without bias where it is a rotation. */
void dvi__chart_place(const dvi__chart *chart, const double *xi, double *y);

/* y(xi), and v = dy/dt for dxi/dt = rate. */
void dvi__chart_point(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                      const double *rate, double *y, double *v);

/* y(xi) - y0, right to a rounding of its own size. */
void dvi__chart_moser_veselov(const dvi__chart *chart, const double *xi, double *leap);

/* y, where the chart is centred, to y(xi), with its carry: it does not leave the manifold, however
 * many steps there are. */
void dvi__chart_move(const dvi__chart *chart, const double *xi, double *y, double *carry);

/* The gradient of a.y(xi) + b.v(xi,rate), in xi and in rate. */
void dvi__chart_gradient(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, const double *a, const double *b, double *in_xi,
                         double *in_rate);

/* Its second derivatives, [size*size]: in xi; in xi and rate. */
void dvi__chart_curvature(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                          const double *rate, const double *a, const double *b, double *in_xi,
                          double *mixed);

/* T = dy/dxi = dv/drate and S = dv/dxi: row i is T[i*size]. */
void dvi__chart_tangents(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, double *T, double *S);

/* Of a rotation: the gradient of l.Omega in xi and in rate [3], Omega = dexp_{-xi} rate the
 * velocity in the body's frame, l fixed; its second derivatives in xi, and in xi (rows) and rate,
 * [9]. */
void dvi__chart_turning_gradient(const dvi__functions *c, const double *xi, const double *rate,
                                 const double *l, double *in_xi, double *in_rate);
void dvi__chart_turning_curvature(const dvi__functions *c, const double *xi, const double *rate,
                                  const double *l, double *in_xi, double *mixed);

/* ---- rotations and spheres: what turning them in space does, by w x y; `turned` [3] are the
 * components of w ---- */

/* Rows y x: row i is what a turn does to stored number i, [stored*3]; the same for v. */
void dvi__chart_turns(dvi__chart_kind kind, const double *y, double *turns);

/* The moment a.(w x y) = w.moment, added. */
void dvi__chart_add_moment(dvi__chart_kind kind, const double *y, const double *a, double *moment);

/* The angular momentum: that of a direction is in space; that of a rotation in the centre's frame,
 * where it is p. What it is of the chart's momentum at the centre, and what moments in space add to
 * it. */
void dvi__chart_angular_momentum(const dvi__chart *chart, const double *p, double *angular);
void dvi__chart_add_impulse(const dvi__chart *chart, const double *impulse, double *angular);

/* From it: the chart's momentum at xi, and its derivative in xi [size*size]. */
void dvi__chart_momentum(const dvi__chart *chart, const double *xi, const double *angular,
                         double *p);
void dvi__chart_momentum_derivative(const dvi__chart *chart, const double *xi,
                                    const double *angular, double *derivative);

/* y to y(xi), and the stored momentum p, to whose angular momentum this is added first: both with
 * their carries, to twice the digits, so that what is not added to is conserved. */
void dvi__chart_transport(const dvi__chart *chart, const double *xi, const double *added, double *y,
                          double *y_compensation, double *p, double *p_compensation);

/* W [size*3]: the chart's momentum at xi of a moment in space. */
void dvi__chart_moments(const dvi__chart *chart, const double *xi, double *W);

/* xi of a point y, nearer than half a turn. */
void dvi__chart_inverse(const dvi__chart *chart, const double *y, double *xi);

/* At the centre: the rate of a stored velocity, and back; the chart's momentum of a stored one, and
 * back. */
void dvi__chart_enter(const dvi__chart *chart, const double *stored, double *local);
void dvi__chart_store(const dvi__chart *chart, const double *local, double *stored);

/* The stored velocity at y(xi) of a rate. */
void dvi__chart_leave_velocity(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                               const double *rate, double *stored);

/* |xi|, and how large it may be: half a turn; infinite for a line. */
double dvi__chart_angle(dvi__chart_kind kind, const double *xi);
double dvi__chart_bound(dvi__chart_kind kind);

#endif
