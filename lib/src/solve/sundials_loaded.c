/* SUNDIALS for the shared library, loaded when it is first needed. The build names the library that
 * has the table. */
#define _POSIX_C_SOURCE 200809L /* dlopen, sigaction */
#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>

#include "core/status.h"
#include "solve/sundials.h"

const dvi__sundials_table *dvi__sundials = NULL;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static char reason[512];

enum { SIGNALS = 32 };

/* Load the library, and leave signals to whoever has them: UCX, which comes along with some MPI,
 * takes SIGHUP for its own debugging. */
static void *open_library(void)
{
  struct sigaction before[SIGNALS];
  int known[SIGNALS];
  for (int s = 1; s < SIGNALS; s++) known[s] = sigaction(s, NULL, &before[s]) == 0;
  void *library = dlopen(DVI_SUNDIALS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  for (int s = 1; s < SIGNALS; s++)
    if (known[s]) (void)sigaction(s, &before[s], NULL);
  return library;
}

static void load(void)
{
  void *library = open_library();
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
