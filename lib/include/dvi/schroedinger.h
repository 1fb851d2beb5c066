/** Schroedinger's equation on a function space, linear or with an interaction (Gross-Pitaevskii).
 *
 *  A wave function psi(t,x) = sum_i psi_i(t) phi_i(x) with complex coefficients has the action of
 *
 *      L = Re <psi, i hbar psi'> - E,
 *      E = integral of hbar^2/(2m) |grad psi|^2 + V(t,x) |psi|^2 + beta(x) |psi|^4/2,
 *
 *  with integrals by the quadrature of the space. Its stationarity is i hbar M psi' = H(t,psi) psi,
 *  with the mass M of the space and H = -hbar^2/(2m) Laplace + V + beta |psi|^2. Coefficients
 *  psi [2*functions] are the real parts of all functions, and the imaginary parts behind them.
 *
 *  The methods in time, each of which is symplectic and keeps the norm <psi, psi> to roundoff, are
 *
 *      midpoint           i hbar (psi1 - psi0)/dt = H(m) m, m = (psi0 + psi1)/2, order 2
 *      gauss:stages=s     Gauss collocation, order 2s, s from 1 to 8. midpoint is s = 1
 *      split              half a step of phases by the potential, a step of kinetic energy, and the
 *                         other half (Strang), order 2. The kinetic step is exact for fourier, and
 *                         by Cayley's transform on other spaces, whose functions must be nodal
 *      split:order=p      p = 2, 4 or 6, by triple jumps of split
 *
 *  Sources: Leok 2004, sec. 5.8; Hairer, Lubich and Wanner 2006, secs. II.4 and VII.6; Strang 1968;
 *  docs/fields/schroedinger.md. */
#ifndef DVI_SCHROEDINGER_H
#define DVI_SCHROEDINGER_H
#include <dvi/march.h>
#include <dvi/space.h>

/** A Schroedinger equation. It never changes after its creation. */
typedef struct dvi_schroedinger dvi_schroedinger;

/** What an equation is made of. Zero means the default. */
typedef struct dvi_schroedinger_terms {
  size_t size;            /**< sizeof(dvi_schroedinger_terms) */
  const dvi_space *space; /**< shared. Required */
  double hbar, mass;      /**< above 0, with hbar^2/(2 mass) from 1e-200 to 1e200. Default: 1 */
  /** The potential V [count] at points x [dimension*count] axis by axis, finite and up to 1e100.
   *  Returns 0, or another number for a failure. Default: 0 */
  int (*potential)(int64_t count, double t, const double *x, double *V, void *user);
  int depends_on_time; /**< not 0 if V depends on t. Else that of t = 0 is taken once */
  double interaction;  /**< beta, if it is the same everywhere. Default: 0 */
  /** beta [count] at points x, instead. Returns as the potential does */
  int (*interaction_at)(int64_t count, const double *x, double *beta, void *user);
  void *user;
  /** Parts of the boundary (dvi_space_boundary) where psi = 0, with blanks or commas between them.
   *  Everywhere else the normal derivative of psi is 0. "none" for none. Default: all of the
   *  boundary. Periodic axes have none */
  const char *fixed;
  /** 2 or 3 if x >= 0 is the distance from the origin in so many dimensions and psi does not depend
   *  on angles: integrals have the measure 2 pi x dx or 4 pi x^2 dx. One axis, not fourier.
   *  Default: x is a coordinate */
  int radial;
} dvi_schroedinger_terms;

/** What is measured of a wave function. All but the norm and the position are integrals that are
 *  not divided by the norm. */
typedef struct dvi_schroedinger_values {
  double norm;                   /**< <psi, psi> */
  double energy;                 /**< kinetic + potential + interaction */
  double kinetic;                /**< integral of hbar^2/(2m) |grad psi|^2 */
  double potential;              /**< integral of V |psi|^2 */
  double interaction;            /**< integral of beta |psi|^4/2 */
  double position[DVI_AXES_MAX]; /**< integral of x |psi|^2, divided by the norm. 0 without one */
  double momentum[DVI_AXES_MAX]; /**< integral of hbar Im(psi* grad psi). The total current is this,
                                      divided by the mass */
} dvi_schroedinger_values;

/** What is found of a ground state. */
typedef struct dvi_schroedinger_ground_report {
  double mu;     /**< the chemical potential */
  double energy; /**< as of dvi_schroedinger_values */
  /** 1 if it is the state that is followed from no interaction. Else the part of the interaction,
   *  to a thousandth, beyond which that one is a saddle, and this one has less energy */
  double followed;
} dvi_schroedinger_ground_report;

/** Options of a march. Zero means the default. */
typedef struct dvi_schroedinger_march_options {
  size_t size;        /**< sizeof(dvi_schroedinger_march_options) */
  const char *method; /**< as above. Default: midpoint */
  double step;        /**< above 0. Required */
  double span;        /**< the step is shortened so that a whole number of steps makes this span */
  /** [dimension*probes] points, axis by axis, where the march observes the density |psi|^2 and the
   *  current hbar/m Im(psi* grad psi): "density_0", "current_x_0" and so on. Copied */
  const double *probe;
  int probes;
} dvi_schroedinger_march_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Create an equation.
 *
 *  @retval DVI_BAD_ARGUMENT     a part of the boundary is missing, all functions are fixed, or an
 *                               argument is not as described
 *  @retval DVI_UNSUPPORTED      the space has no first derivatives, or no radial measure
 *  @retval DVI_SINGULAR         the mass of a function is not above 0
 *  @retval DVI_BAD_SIZE         there are too many functions
 *  @retval DVI_CALLBACK_FAILED  the potential or the interaction failed
 *  @retval DVI_NOT_FINITE       one of them is not finite. dvi_last_error() names the point
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_schroedinger_create(const dvi_schroedinger_terms *terms,
                                   dvi_schroedinger **equation);

/** Release the equation, and set the pointer to NULL. NULL is allowed. Its marches are released
 *  before. */
void dvi_schroedinger_destroy(dvi_schroedinger **equation);

/** Return the space, owned by the equation. NULL for NULL. */
const dvi_space *dvi_schroedinger_space(const dvi_schroedinger *equation);

/** Measure a wave function.
 *
 *  @param      t       the time of the potential
 *  @param      psi     [2*functions]. Fixed functions count as 0
 *  @param[out] values  unchanged on failure
 *  @retval DVI_BAD_ARGUMENT  an argument is missing or not finite
 *  @retval DVI_NOT_FINITE    the norm or the energy overflows
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval (others)          as the potential fails */
dvi_status dvi_schroedinger_measure(const dvi_schroedinger *equation, double t, const double *psi,
                                    dvi_schroedinger_values *values);

/** Return the name of method i of marches, counted from 0, or NULL beyond the last one. */
const char *dvi_schroedinger_method_name(int i);

/** Create a march (dvi/march.h). Its form A is psi [2*functions], and it has no other forms.
 *
 *  Its bound (dvi_march_facts) is infinite, but for split with an interaction. Beyond it, small
 *  amplitudes beside a wave of the present largest beta |psi|^2 = B are in resonance with it, and
 *  grow. With the largest kinetic energy T of the space it is the h of
 *  T h/hbar + 2 atan(B h/hbar) = pi on fourier, and hbar sqrt(2/(T B)) by Cayley's transform. B
 *  counts as 0 where beta < 0. A march beyond the bound goes on all the same, because it is that of
 *  one wave everywhere.
 *
 *  It makes whole steps. Between two of them it shows a shorter step from the earlier one, beside
 *  the state. A start leaves out what it has of fixed functions. Observables are the members of
 *  dvi_schroedinger_values, "position_x" and so on for each axis, and those of the probes.
 *
 *  @retval DVI_BAD_OPTION    there is no such method, or it has no such option
 *  @retval DVI_BAD_ARGUMENT  an argument is not as described, or a probe lies outside
 *  @retval DVI_UNSUPPORTED   the method does not go with the space, or does not keep the norm
 *  @retval DVI_SINGULAR      a matrix of the steps is singular to working precision
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval (others)          as the potential fails
 *
 *  dvi_march_advance returns DVI_NOT_CONVERGED if neither the iteration of a step nor Newton's
 *  method converges. The march stands then at the step before. A shorter step does. */
dvi_status dvi_schroedinger_march(const dvi_schroedinger *equation,
                                  const dvi_schroedinger_march_options *options, dvi_march **march);

/** Compute the lowest stationary states H psi = E M psi of the equation without interaction, at the
 *  time 0. psi is real.
 *
 *  @param      count   from 1 to half of the free functions, or 1
 *  @param[out] energy  [count] ascending
 *  @param[out] psi     [count][functions] with norm 1, orthogonal, and a positive sign of the first
 *                      coefficient that is at least half of the largest one. May be NULL
 *  @retval DVI_BAD_ARGUMENT   an argument is missing
 *  @retval DVI_BAD_SIZE       count is out of its range
 *  @retval DVI_NOT_CONVERGED  the iteration stopped above its tolerance
 *  @retval DVI_NO_MEMORY      there is no memory
 *  @retval (others)           as dvi_matrix_modes and the potential
 *
 *  By Lanczos' method on the inverse (dvi_matrix_modes) on sparse spaces. For fourier, by LAPACK up
 *  to 400 functions, and by LOBPCG without a matrix for more (Knyazev 2001). */
dvi_status dvi_schroedinger_modes(const dvi_schroedinger *equation, int count, double *energy,
                                  double *psi);

/** Compute the ground state of a norm, H(psi) psi = mu M psi, at the time 0. psi is real.
 *
 *  Newton's method for (psi, mu) follows the lowest mode from no interaction to all of it. Where
 *  attraction makes this state a saddle of E, as that in both sides of a double well, a descent
 *  leads to a state of less energy. It is a minimum, but in a potential with several wells another
 *  one may be lower still. In three dimensions attraction leaves metastable states alone.
 *
 *  @param      norm    above 0
 *  @param[out] report  may be NULL
 *  @param[out] psi     [functions]. May be NULL
 *  @retval DVI_BAD_ARGUMENT   an argument is missing, or the norm is not above 0 and finite
 *  @retval DVI_NOT_CONVERGED  no such state is found. Attraction may let it collapse, as it does in
 *                             two dimensions from |beta| norm mass/hbar^2 = 5.850 on, or leave its
 *                             place open
 *  @retval (others)           as dvi_schroedinger_modes
 *
 *  Sources: Bao and Cai 2013, sec. 3; Weinstein 1983; docs/fields/schroedinger.md. */
dvi_status dvi_schroedinger_ground(const dvi_schroedinger *equation, double norm,
                                   dvi_schroedinger_ground_report *report, double *psi);

/** Write what was built, one fact a line. Cut off at size. */
void dvi_schroedinger_explain(const dvi_schroedinger *equation, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
