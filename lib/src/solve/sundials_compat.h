/* All differences between SUNDIALS 6.4 and 7.x but names (sundials.def).
 *
 * 7.0 gave SUNContext_Create a communicator of its own type and moved error handling from each
 * integrator to the context. The library never prints, so SUNDIALS must not either. Its error
 * handlers are replaced by one that discards, and its logger, which warns past the handlers, is
 * taken away. */
#ifndef DVI_SOLVE_SUNDIALS_COMPAT_H
#define DVI_SOLVE_SUNDIALS_COMPAT_H
#include <stddef.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_logger.h>
#include <sundials/sundials_types.h>

#define DVI__SUNDIALS_AT_LEAST(major, minor) \
  (SUNDIALS_VERSION_MAJOR > (major) ||       \
   (SUNDIALS_VERSION_MAJOR == (major) && SUNDIALS_VERSION_MINOR >= (minor)))

#if DVI__SUNDIALS_AT_LEAST(7, 0)

#define DVI__SUNDIALS_NO_COMMUNICATOR SUN_COMM_NULL

static inline void dvi__sundials_discard(int line, const char *function, const char *file,
                                         const char *message, SUNErrCode code, void *user,
                                         SUNContext context)
{
  (void)line, (void)function, (void)file, (void)message, (void)code, (void)user, (void)context;
}

static inline int dvi__sundials_silence_context(SUNContext context)
{
  const SUNErrCode cleared = SUNContext_ClearErrHandlers(context);
  return cleared != 0 ? cleared : SUNContext_PushErrHandler(context, dvi__sundials_discard, NULL);
}

/* An integrator is silent already through its context. */
#define DVI__SUNDIALS_SILENCE(set_error_handler, memory) ((void)(memory), 0)

#else

#define DVI__SUNDIALS_NO_COMMUNICATOR NULL

/* NOLINTNEXTLINE(readability-non-const-parameter): the type is SUNDIALS' */
static inline void dvi__sundials_discard(int code, const char *module, const char *function,
                                         char *message, void *user)
{
  (void)code, (void)module, (void)function, (void)message, (void)user;
}

static inline int dvi__sundials_silence_context(SUNContext context)
{
  (void)context;
  return 0;
}

/* Silence one integrator, as in DVI__SUNDIALS_SILENCE(KINSetErrHandlerFn, memory). 0 on success. */
#define DVI__SUNDIALS_SILENCE(set_error_handler, memory) \
  set_error_handler((memory), dvi__sundials_discard, NULL)

#endif

/* Make a silent context. Returns 0 on success. On failure *context is NULL. SUNContext_Free frees
 * it. */
static inline int dvi__sundials_context(SUNContext *context)
{
  *context = NULL;
  const int created = SUNContext_Create(DVI__SUNDIALS_NO_COMMUNICATOR, context);
  if (created != 0) return created;
  int silenced = dvi__sundials_silence_context(*context);
  if (silenced == 0) silenced = SUNContext_SetLogger(*context, NULL);
  if (silenced != 0) (void)SUNContext_Free(context);
  return silenced;
}

#endif
