#include "field/mesh/file/list.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

void *dvi__list_add(dvi__list *list, size_t size)
{
  if (list->count == list->room) {
    const int64_t room = list->room > 0 ? 2 * list->room : 16;
    char *more = room < INT_MAX ? DVI_NEW(char, (size_t)room *size) : NULL;
    if (more == NULL) {
      (void)dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for %lld entries", (long long)room);
      return NULL;
    }
    if (list->count > 0) memcpy(more, list->at, (size_t)list->count * size);
    dvi__release(list->at);
    list->at = more;
    list->room = room;
  }
  return (char *)list->at + (size_t)list->count++ * size;
}
