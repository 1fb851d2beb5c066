/* The text of dvi_scene_fault for the callbacks of this thread. */
#ifndef DVI_SCENE_TERMS_FAULT_H
#define DVI_SCENE_TERMS_FAULT_H
#include "scene/elaborate/model.h"

/* Return the result of an evaluation of the term's function at points x, and keep the place of the
 * fault if that is not 0. `of_series` is 1 for Taylor coefficients. */
int dvi__fault_check(const dvi__scene_term *term, int count, const double *const *x, int of_series,
                     int returned);

/* Forget the fault. dvi__fault_status returns its status, DVI_OK after that. */
void dvi__fault_clear(void);
dvi_status dvi__fault_status(void);

/* Return the place of the fault, and the words behind it. Returns false if there is no place. */
bool dvi__fault_place(dvi__span *span, const char **words);

/* Return a sentence that explains why there is no program, or no pattern, for this status. */
const char *dvi__too_large(dvi_status status);

/* Refuse an expression without a program or pattern, for this status. Returns false. */
bool dvi__scene_too_large(dvi_scene *scene, const char *what, dvi_status status);

#endif
