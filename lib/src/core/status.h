/* Failing with a sentence. */
#ifndef DVI_CORE_STATUS_H
#define DVI_CORE_STATUS_H
#include <dvi/status.h>

#if defined(__GNUC__)
#define DVI_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define DVI_PRINTF(text, first)
#endif

/* Size of a sentence with the 0 at its end. */
enum { DVI__SENTENCE_SIZE = 1024 };

/* Return the status of a failed call from the calling function. Allowed only where that function
 * owns nothing. */
#define DVI_TRY(call)                              \
  do {                                             \
    const dvi_status try_status_ = (call);         \
    if (try_status_ != DVI_OK) return try_status_; \
  } while (0)

/* Set this thread's error sentence and return the status. */
dvi_status dvi__fail(dvi_status status, const char *format, ...) DVI_PRINTF(2, 3);

/* Put "context: " in front of this thread's error sentence and return the status. */
dvi_status dvi__fail_in(dvi_status status, const char *format, ...) DVI_PRINTF(2, 3);

/* Keep a reason for the number that a callback of the library itself is about to return, and return
 * the number. The sentence on the callback's failure takes the reason. */
int dvi__return_because(int returned, const char *format, ...) DVI_PRINTF(2, 3);

/* Move this thread's reason to text [DVI__SENTENCE_SIZE]. The text is empty without one. */
void dvi__take_reason(char *text);

#endif
