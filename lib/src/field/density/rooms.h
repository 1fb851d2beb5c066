/* Work memory for callbacks that several threads may run at a time, without a lock. */
#ifndef DVI_FIELD_DENSITY_ROOMS_H
#define DVI_FIELD_DENSITY_ROOMS_H
#include <dvi/status.h>
#include <stdint.h>

typedef struct dvi__rooms dvi__rooms;

/* Make a pool with one room of so many doubles. */
dvi_status dvi__rooms_create(int64_t doubles, dvi__rooms **rooms);
void dvi__rooms_destroy(dvi__rooms **rooms);

/* Take a room. Where all are taken another one is allocated. NULL without memory. */
double *dvi__rooms_take(dvi__rooms *rooms);

/* Give a room back, for the next one who asks. NULL is allowed. */
void dvi__rooms_return(dvi__rooms *rooms, double *room);

#endif
