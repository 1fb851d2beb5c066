/* An open file of datasets. */
#ifndef DVI_PETSC_SLABS_STRUCT_H
#define DVI_PETSC_SLABS_STRUCT_H
#include <hdf5.h>

#include "slabs.h"

struct dvi__slabs {
  const dvi__world *world; /* NULL of one process alone */
  hid_t id;
  char *path, *beside; /* the file that is written */
  H5E_auto2_t printer; /* of HDF5's own words, which are not wanted */
  void *printer_user;
};

/* Return the type of numbers in memory. */
hid_t dvi__slabs_type(dvi__number_type type);

#endif
