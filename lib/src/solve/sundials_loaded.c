/* SUNDIALS for the shared library, loaded when it is first needed. The build names the library that
 * has the table. */
#define _POSIX_C_SOURCE 200809L /* dlopen */
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>

#include "core/status.h"
#include "solve/sundials.h"

const dvi__sundials_table *dvi__sundials = NULL;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static char reason[512];

static void load(void)
{
  void *library = dlopen(DVI_SUNDIALS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (library != NULL) dvi__sundials = dlsym(library, "dvi__sundials_linked");
  if (dvi__sundials != NULL) return;
  const char *why = dlerror();
  (void)snprintf(reason, sizeof reason, "%s", why != NULL ? why : "reason unknown");
}

dvi_status dvi__sundials_load(void)
{
  (void)pthread_once(&once, load);
  if (dvi__sundials != NULL) return DVI_OK;
  return dvi__fail(DVI_SOLVER_FAILED, "SUNDIALS cannot be loaded: %s", reason);
}
