/** Files of HDF5, which the module dvi_hdf5 writes and reads. */
#ifndef STORE_H
#define STORE_H
#include <stdbool.h>

#include "cli/file.h"
#include "hdf5/hdf5_module.h"

/** Return whether a file is one of HDF5 by its name, which ends in .h5. NULL is none. */
bool store_is_wanted(const char *path);

/** Return the module, which is loaded by the first call. NULL if it cannot be loaded, which is
 * complained of, with the path that wants it. */
const hdf5_module *store_module(const char *path);

/** Complain that a file cannot be written, for the module's reason. Returns false. */
bool store_refuse(const char *path);

/** Open a temporary file beside the path, for the module to write. Complains and returns false if
 * that is impossible. */
bool store_begin(whole_file *file, const char *path);
#endif
