/** The stability of steps, before a run shows it.
 *
 *  Steps of a field are linear. After a common period of all steps of a schedule the state is a
 *  matrix times the state before, the monodromy matrix, and the schedule is stable if none of its
 *  eigenvalues lies outside of the unit circle. Local bounds of the steps do not tell: steps of
 *  different lengths can be in resonance with a field at any fraction of them (Fong, Darve and Lew
 *  2008). */
#ifndef DVI_STABILITY_H
#define DVI_STABILITY_H
#include <dvi/march.h>

enum { DVI_SCHEDULE_SIZE = 160 /**< characters of a schedule's description */ };

/** What is known of the stability of steps. */
typedef struct dvi_stability {
  int is_stable; /**< not 0 if the growth is not above 1 + resolution */
  /** The factor by which the amplitude of the field that grows fastest does so in a unit of time. 1
   *  if none grows */
  double growth;
  double resolution; /**< growths below 1 + resolution are not told from none */
  double period;     /**< the common period of all steps, 0 if there is none or too long a one */
  double span;       /**< the time for which fields were followed */
  /** Fields that were followed: twice the modes of a small field that are not static, all of them.
   *  A few of a large field, those that grow fastest from a start at random */
  int64_t followed;
  char schedule[DVI_SCHEDULE_SIZE]; /**< the steps in words */
} dvi_stability;

#ifdef __cplusplus
extern "C" {
#endif

/** Find how fast the fastest growing field grows under the steps that a march would make.
 *
 *  Currents and dampings are left out. Up to 500 unknowns every mode is followed through a common
 *  period, in coordinates without the static fields, for which the matrix is close to orthogonal.
 *  Of more unknowns, Arnoldi's method finds the largest eigenvalues (Saad 2011, ch. 6). Free steps
 *  may have no common period: their ratios are looked at as fractions with denominators up to 64.
 *  If these do not give a period below a thousand of the longest steps, a field that begins at
 *  random is followed for a long time. `resolution` says what such a search can have missed.
 *
 *  @param[in]  options  those of the march, with the method avi. NULL for its defaults
 *  @param[in]  span     time for which fields are followed at least, 0 for a default
 *  @param[out] report   unchanged on failure
 *  @retval DVI_UNSUPPORTED  the method has equal steps, which are stable below their bound
 *  @retval (others)         as dvi_march_create */
dvi_status dvi_field_stability(const dvi_field *field, const dvi_march_options *options,
                               double span, dvi_stability *report);

#ifdef __cplusplus
}
#endif
#endif
