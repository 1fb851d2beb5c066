/** The head of a file: facts as attributes of its root, and the names of its columns. */
#ifndef HEAD_H
#define HEAD_H
#include "hdf5/h5.h"
#include "hdf5/hdf5_module.h"

/** Write the facts. */
bool head_write(hid_t file, const hdf5_head *head);

/** Write the names of the columns, an attribute of their dataset. */
bool head_write_columns(hid_t set, const hdf5_head *head);

/** Read the texts [count] of an attribute. Returns false if it is not there, or has other ones than
 * texts, or another number of them. The texts are H5free_memory's. */
bool head_read_texts(hid_t place, const char *name, int count, char **text);

/** Find which of these layouts, which end with NULL, a file has. Returns -1 with a reason if it has
 * another one. */
int head_find_layout(hid_t file, const char *const *layout);

/** Read the names [count] of the columns of a dataset, which are H5free_memory's. */
bool head_read_columns(hid_t set, int count, char **name);

/** Compare the head of a file with what it should be. Returns false, with a reason, if they
 * differ. */
bool head_is_same(hid_t file, hid_t set, const hdf5_head *head);
#endif
