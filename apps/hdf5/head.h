/** The head of a file: facts as attributes of its root, and the names of its columns. */
#ifndef HEAD_H
#define HEAD_H
#include "hdf5/h5.h"
#include "hdf5/hdf5_module.h"

/** Write the facts. */
bool head_write(hid_t file, const hdf5_head *head);

/** Write the names of the columns, an attribute of their dataset. */
bool head_write_columns(hid_t set, const hdf5_head *head);

/** Compare the head of a file with what it should be. Returns false, with a reason, if they
 * differ. */
bool head_is_same(hid_t file, hid_t set, const hdf5_head *head);
#endif
