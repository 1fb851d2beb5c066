/** Status codes and the sentence that explains the last failure. */
#ifndef DVI_STATUS_H
#define DVI_STATUS_H

/** Every status with its name, number and meaning.
 *
 *  0 is success. A positive status says that this step failed and another one may succeed, in most
 *  cases a smaller one. A negative status says that the call cannot succeed as it stands. */
#define DVI_STATUS_LIST(X)                                                               \
  X(DVI_OK, 0, "success")                                                                \
  X(DVI_NOT_CONVERGED, 1, "the step's equations could not be solved")                    \
  X(DVI_NOT_FINITE, 2, "NaN or Inf where a finite number is needed")                     \
  X(DVI_CALLBACK_RETRY, 3, "a callback asked for a smaller step")                        \
  X(DVI_JUMP, 4, "the jump between two elements is large against the motion")            \
  X(DVI_STEP_TOO_LARGE, 5, "the step is beyond where its solution, or a rotation, goes") \
  X(DVI_BAD_ARGUMENT, -1, "an argument is missing or out of range")                      \
  X(DVI_BAD_SIZE, -2, "a count or size is out of range")                                 \
  X(DVI_BAD_OPTION, -3, "an unknown option, or a value that it cannot take")             \
  X(DVI_NO_MEMORY, -4, "memory could not be allocated")                                  \
  X(DVI_CALLBACK_FAILED, -5, "a callback failed for good")                               \
  X(DVI_SINGULAR, -6, "a mass, a velocity Hessian or an action's is singular")           \
  X(DVI_UNSUPPORTED, -7, "the method cannot use a term that the system declares")        \
  X(DVI_BAD_STATE, -8, "the call is out of order")                                       \
  X(DVI_IO_ERROR, -9, "a file could not be read or written")                             \
  X(DVI_BAD_FILE, -10, "a file is cut short, corrupt, or belongs to another system")     \
  X(DVI_REFERENCE_FAILED, -11, "a reference integrator stopped before the end")          \
  X(DVI_SOLVER_FAILED, -12, "a solver library failed in a way that no smaller step mends")

/** The result of a function that can fail. */
typedef enum dvi_status {
#define DVI_STATUS_ENUM(name, number, meaning) name = number,
  DVI_STATUS_LIST(DVI_STATUS_ENUM)
#undef DVI_STATUS_ENUM
} dvi_status;

#ifdef __cplusplus
extern "C" {
#endif

/** Return the status as its own identifier, for example "DVI_NOT_CONVERGED". Never NULL. */
const char *dvi_status_name(dvi_status status);

/** Return the meaning of a status in one sentence. Never NULL. */
const char *dvi_status_meaning(dvi_status status);

/** Describe the last failure on this thread in one sentence, with its place and a remedy.
 *
 *  @return a string owned by the library, valid until the next failure on this thread. "" if
 *          nothing failed yet. */
const char *dvi_last_error(void);

#ifdef __cplusplus
}
#endif
#endif
