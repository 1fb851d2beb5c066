/** Noise and friction of a heat bath beside a constant mass (docs/mechanics/noise.md). */
#ifndef DVI_NOISE_H
#define DVI_NOISE_H
#include <dvi/ensemble.h>

/** Noise. A heat bath has friction and noise that keep the momenta at a temperature. Noise
 *  functions h_k(q) shake the system by the forces -h_k'(q), each by a Wiener process of its own.
 *  The equations of motion are those of Langevin (Leimkuhler and Matthews 2013, eq. 1) and of
 *  Bou-Rabee and Owhadi (2009, eq. 1.1), in the sense of Stratonovich,
 *
 *      dq = M^-1 p dt,
 *      dp = (F - V_q) dt - gamma p dt + sqrt(2 gamma kT) M^(1/2) dW - sum_k h_k'(q) o dW_k.
 *
 *  Without noise functions the states are distributed as exp(-H/kT), if there are no other forces
 *  and all potentials are autonomous. Without friction the motion of each path is symplectic. The
 *  noise is a function of the seed, the stream, the number of the step and the coordinate alone.
 *  The same seed and stream give the same path on any machine and with any number of threads. Each
 *  stream has its own path.
 *
 *  Noise stands beside a positive constant mass, and perhaps holonomic constraints.
 *  dvi_system_create refuses it beside factors, nonholonomic constraints, contacts, a vector
 *  potential, damping, a general Lagrangian, a one-form or a Hamiltonian (DVI_UNSUPPORTED), and
 *  numbers out of their range (DVI_BAD_ARGUMENT). */
typedef struct dvi_noise {
  double temperature; /**< kT, an energy, 0 or more */
  double friction;    /**< gamma, 1/time, 0 or more */
  unsigned long long seed;
  unsigned stream; /**< member k of an ensemble has stream + k (modulo 2^32) */
  /** Noise functions h_k(q), whose value and gradient are required. Their unit is that of an
   *  action over the root of a time. A rate, `fast` and `quadratic` have no meaning. Names and
   *  patterns are copied. Default: none */
  const dvi_potential *functions;
  int function_count;
} dvi_noise;

#ifdef __cplusplus
extern "C" {
#endif

/** Compute the kinetic temperature 2K/(n - m) of a system with noise and constraints of rank m, in
 *  the unit of dvi_noise's, an energy.
 *
 *  K is that of the momenta after the last O of the step, which for BAOAB stands in its middle. The
 *  mean of that one is kT for a harmonic oscillator with steps of any length, while the mean at the
 *  ends of steps falls short by a part h^2 omega^2/4 (Leimkuhler and Matthews 2013). Before the
 *  first step K is that of the state.
 *  @retval DVI_UNSUPPORTED   the system declares no noise, or its constraints leave no freedom
 *  @retval DVI_BAD_STATE     the integrator has no state yet
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL */
dvi_status dvi_integrator_temperature(dvi_integrator *integrator, double *temperature);

/** Compute the kinetic temperature of one member, as dvi_integrator_temperature. Each member of a
 *  system with noise has a stream of its own (dvi_noise). */
dvi_status dvi_ensemble_temperature(dvi_ensemble *ensemble, int member, double *temperature);

#ifdef __cplusplus
}
#endif
#endif
