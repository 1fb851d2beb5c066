/* Charts of a factor of the configuration space, centred at a point y0 of the factor. A chart is a
 * map y(xi) with y(0) = y0. Here s = |xi|^2, and c_k are Stumpff's functions.
 *
 *     line       y = y0 + xi
 *     circle     y = c_0 y0 + c_1 xi y0',  y0' = y0 turned by 90 degrees
 *                U(1) as unit vectors
 *     sphere     y = c_0 y0 + c_1 B xi,    B an orthonormal basis of the tangent plane
 *                S^2 by great circles, the horizontal lift to SO(3)
 *     rotation   R = R0 exp(xi^),          exp = I + c_1 xi^ + c_2 xi^^2
 *                SO(3) by nine entries, row by row
 *
 * The charts are natural, for a rotation of y0 rotates y. A Lagrangian on the stored coordinates y
 * becomes a Lagrangian of xi. This file has the derivatives of y that are needed for it, as
 * contractions f(xi) = w.y(xi) with a covector w. All have the form f = w_0 c_0 + c_1 z.xi + c_2
 * xi.B xi + constant.
 *
 * A state stores y, the velocity v = dy/dt and the momentum p conjugate to v. For a circle v is the
 * angular rate. For a rotation v is the angular velocity in the body's frame. Source: Leok 2004,
 * sec. 5.3 and 5.4 (with the derivative of the exponential map on the side that the chart's left
 * factor asks for); Iserles et al. 2000. */
#ifndef DVI_GROUP_CHART_H
#define DVI_GROUP_CHART_H

typedef enum dvi__chart_kind { DVI__LINE, DVI__CIRCLE, DVI__SPHERE, DVI__ROTATION } dvi__chart_kind;

/* Largest counts of numbers: of a point, of chart coordinates, of a stored velocity. */
enum { DVI__CHART_POINT = 9, DVI__CHART_SIZE = 3, DVI__CHART_VELOCITY = 3 };

/* Return the count of numbers of a point y, of a stored velocity, of chart coordinates. */
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
  double basis[2][3]; /* basis of the tangent plane (circle, sphere) */
} dvi__chart;

/* Stumpff's functions and their derivatives at one xi. of[k][j] is the derivative of order j of c_k
 * in s. c_3 has two derivatives. A line needs none of them. */
typedef struct dvi__functions {
  double of[4][4];
} dvi__functions;

void dvi__chart_functions(dvi__chart_kind kind, const double *xi, dvi__functions *c);

/* Centre a chart at the point y0. */
void dvi__chart_centre(dvi__chart_kind kind, const double *y0, dvi__chart *chart);

/* Compute y(xi). A rotation stays orthogonal without bias. */
void dvi__chart_place(const dvi__chart *chart, const double *xi, double *y);

/* Compute y(xi), and v = dy/dt for dxi/dt = rate. */
void dvi__chart_point(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                      const double *rate, double *y, double *v);

/* Compute the displacement y(xi) - y0 to relative rounding accuracy. */
void dvi__chart_displacement(const dvi__chart *chart, const double *xi, double *displacement);

/* Move y from the chart's centre to y(xi), with its compensation. The point stays on the manifold
 * for any number of steps. */
void dvi__chart_move(const dvi__chart *chart, const double *xi, double *y, double *compensation);

/* Compute the gradient of a.y(xi) + b.v(xi,rate) in xi and in rate. */
void dvi__chart_gradient(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, const double *a, const double *b, double *in_xi,
                         double *in_rate);

/* Compute the second derivatives [size*size] of that function in xi, and in xi and rate. */
void dvi__chart_curvature(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                          const double *rate, const double *a, const double *b, double *in_xi,
                          double *mixed);

/* Compute T = dy/dxi = dv/drate and S = dv/dxi. Row i is T[i*size]. */
void dvi__chart_tangents(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                         const double *rate, double *T, double *S);

/* Compute for a rotation the gradient [3] of l.Omega in xi and in rate. Omega = dexp_{-xi} rate is
 * the velocity in the body's frame, and l is fixed. The second function gives the second
 * derivatives [9] in xi, and in xi (rows) and rate. */
void dvi__chart_turning_gradient(const dvi__functions *c, const double *xi, const double *rate,
                                 const double *l, double *in_xi, double *in_rate);
void dvi__chart_turning_curvature(const dvi__functions *c, const double *xi, const double *rate,
                                  const double *l, double *in_xi, double *mixed);

/* ---- rotations and spheres under rotations of space, y' = w x y ---- */

/* Add the moment, which is defined by a.(w x y) = w.moment. */
void dvi__chart_add_moment(dvi__chart_kind kind, const double *y, const double *a, double *moment);

/* Compute the angular momentum of the chart's momentum p at the centre. A direction has it in
 * space. A rotation has it in the centre's frame, where it equals p. The second function adds
 * moments in space. */
void dvi__chart_angular_momentum(const dvi__chart *chart, const double *p, double *angular);
void dvi__chart_add_impulse(const dvi__chart *chart, const double *impulse, double *angular);

/* Compute the chart's momentum at xi from the angular momentum, and its derivative in xi
 * [size*size]. */
void dvi__chart_momentum(const dvi__chart *chart, const double *xi, const double *angular,
                         double *p);
void dvi__chart_momentum_derivative(const dvi__chart *chart, const double *xi,
                                    const double *angular, double *derivative);

/* Move y to y(xi) and the stored momentum p with it, after `added` is added to the angular momentum
 * of p. Both are compensated to twice the digits. Components to which nothing is added are
 * conserved. */
void dvi__chart_transport(const dvi__chart *chart, const double *xi, const double *added, double *y,
                          double *y_compensation, double *p, double *p_compensation);

/* Compute W [size*3], which maps a moment in space to the chart's momentum at xi. */
void dvi__chart_moments(const dvi__chart *chart, const double *xi, double *W);

/* Compute the angular momentum [3] of the chart's momentum p at xi, of a rotation in the centre's
 * frame, of a direction in space. */
void dvi__chart_angular_momentum_at(const dvi__chart *chart, const double *xi, const double *p,
                                    double *angular);

/* Carry a momentum f from xi to `end`, where it keeps its angular momentum, carried = E f. The
 * second function computes its derivatives [size*size] in f, which is E, in xi, and in `end`. */
void dvi__chart_carry(const dvi__chart *chart, const double *xi, const double *end, const double *f,
                      double *carried);
void dvi__chart_carry_derivatives(const dvi__chart *chart, const double *xi, const double *end,
                                  const double *f, double *in_f, double *in_xi, double *in_end);

/* Compute xi of a point y that is nearer than half a turn. */
void dvi__chart_inverse(const dvi__chart *chart, const double *y, double *xi);

/* Compute eta, the coordinates of y(xi) in the chart `next`, whose centre is y(end), and those of
 * this chart's centre. Both are right to a few roundings, as guesses need them. */
void dvi__chart_follow(const dvi__chart *chart, const dvi__chart *next, const double *end,
                       const double *xi, double *eta);
void dvi__chart_back(const dvi__chart *chart, const dvi__chart *next, const double *end,
                     double *eta);

/* Convert at the centre between a stored velocity and the chart's rate, and between a stored
 * momentum and the chart's momentum. */
void dvi__chart_enter(const dvi__chart *chart, const double *stored, double *local);
void dvi__chart_store(const dvi__chart *chart, const double *local, double *stored);

/* Compute the stored velocity at y(xi) for a rate. */
void dvi__chart_leave_velocity(const dvi__chart *chart, const dvi__functions *c, const double *xi,
                               const double *rate, double *stored);

/* Compute |xi|, and its bound. The bound is half a turn, and infinite for a line. */
double dvi__chart_angle(dvi__chart_kind kind, const double *xi);
double dvi__chart_bound(dvi__chart_kind kind);

#endif
