#include "module/store.h"

#include <dlfcn.h>
#include <stddef.h>
#include <string.h>

#include "cli/command.h"

static const char module_name[] = "dvi_hdf5.so", symbol_name[] = "dvi_hdf5";

/* The module stays until the process ends. */
static const hdf5_module *module;

bool store_is_wanted(const char *path)
{
  static const char ending[] = ".h5";
  const size_t length = path != NULL ? strlen(path) : 0, end = sizeof ending - 1;
  return length > end && strcmp(path + length - end, ending) == 0;
}

const hdf5_module *store_module(const char *path)
{
  if (module != NULL) return module;
  void *library = dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
  if (library != NULL) module = dlsym(library, symbol_name);
  if (module == NULL)
    complain("'%s' is a file of HDF5, and this dvi has no module for it (%s); build dvi where "
             "libhdf5-dev is installed, or take CSV",
             path, dlerror());
  return module;
}

bool store_refuse(const char *path)
{
  complain("cannot write '%s': %s", path, module->reason());
  return false;
}

bool store_begin(whole_file *file, const char *path)
{
  if (!file_open(file, path)) return false;
  if (file->temporary != NULL) return true;
  complain("cannot write '%s': a file of HDF5 is no device and no pipe", path);
  file_discard(file);
  return false;
}
