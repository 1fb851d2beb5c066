#include "field/density/rooms.h"

#include <stdatomic.h>

#include "core/memory.h"
#include "core/status.h"

enum { KEPT = 64 };

struct dvi__rooms {
  int64_t doubles;
  _Atomic(double *) idle[KEPT];
};

dvi_status dvi__rooms_create(int64_t doubles, dvi__rooms **rooms)
{
  *rooms = DVI_NEW(dvi__rooms, 1);
  double *first = DVI_NEW(double, doubles);
  if (*rooms == NULL || first == NULL) {
    dvi__release(*rooms);
    dvi__release(first);
    *rooms = NULL;
    return dvi__fail(DVI_NO_MEMORY, "density: no memory for %lld numbers of work",
                     (long long)doubles);
  }
  (*rooms)->doubles = doubles;
  atomic_store(&(*rooms)->idle[0], first);
  return DVI_OK;
}

void dvi__rooms_destroy(dvi__rooms **rooms)
{
  if (*rooms == NULL) return;
  for (int i = 0; i < KEPT; i++) dvi__release(atomic_load(&(*rooms)->idle[i]));
  dvi__release(*rooms);
  *rooms = NULL;
}

double *dvi__rooms_take(dvi__rooms *rooms)
{
  for (int i = 0; i < KEPT; i++) {
    if (atomic_load_explicit(&rooms->idle[i], memory_order_relaxed) == NULL) continue;
    double *room = atomic_exchange(&rooms->idle[i], NULL);
    if (room != NULL) return room;
  }
  return DVI_NEW(double, rooms->doubles);
}

void dvi__rooms_return(dvi__rooms *rooms, double *room)
{
  for (int i = 0; i < KEPT && room != NULL; i++) {
    double *none = NULL;
    if (atomic_compare_exchange_strong(&rooms->idle[i], &none, room)) return;
  }
  dvi__release(room);
}
