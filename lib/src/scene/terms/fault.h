/* What dvi_scene_fault says of the callbacks of this thread. */
#ifndef DVI_SCENE_FAULT_H
#define DVI_SCENE_FAULT_H
#include "scene/elaborate/model.h"

/* Pass on what an evaluation of the term's function at points x returned, and keep where the fault
 * is if it is not 0. `of_series`: Taylor coefficients were asked for. */
int dvi__fault_check(const dvi__scene_term *term, int count, const double *const *x, int of_series,
                     int returned);

/* Forget the fault; and its status, DVI_OK after that. */
void dvi__fault_clear(void);
dvi_status dvi__fault_status(void);

/* The place that it names, and its words behind the place; false if it names none. */
bool dvi__fault_place(dvi__span *span, const char **words);

/* Why there is no program, or no pattern: a sentence for that status. */
const char *dvi__too_large(dvi_status status);

/* Refuse what there is no program or pattern for, for that status; false. */
bool dvi__scene_too_large(dvi_scene *scene, const char *what, dvi_status status);

#endif
