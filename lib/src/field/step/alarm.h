/* The alarm of marches whose steps may be in resonance with a field. */
#ifndef DVI_FIELD_STEP_ALARM_H
#define DVI_FIELD_STEP_ALARM_H
#include <dvi/status.h>

/* The words of a method in the sentences of its alarm. */
typedef struct dvi__alarm_words {
  const char *method, *reference; /* what the energy is compared with */
  const char *remedy, *last;      /* of a growth, and of one without end */
} dvi__alarm_words;

/* Judge an energy, whose size beside that of its reference is `growth`. DVI_STEP_TOO_LARGE if it is
 * above *allowed, which is doubled then, so that a run can go on. DVI_NOT_FINITE if it is not
 * finite or 1e100 times too large. */
dvi_status dvi__judge_growth(const dvi__alarm_words *words, double t, double energy, double growth,
                             double *allowed);

#endif
