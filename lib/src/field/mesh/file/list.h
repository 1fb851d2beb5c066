/* Arrays that grow. */
#ifndef DVI_FIELD_MESH_FILE_LIST_H
#define DVI_FIELD_MESH_FILE_LIST_H
#include <stddef.h>
#include <stdint.h>

/* Entries of one size. `at` is to be released. */
typedef struct dvi__list {
  void *at;
  int64_t count, room;
} dvi__list;

/* Add a zeroed entry of this size. NULL with a sentence if there is no memory, or if an int cannot
 * number the entries. */
void *dvi__list_add(dvi__list *list, size_t size);

#endif
