/* Read before every source of the library when clang-tidy analyses it: tells the analyzer, which
 * sees one file at a time, that dvi__fail returns the status that it was given. Without this it
 * follows paths on which a failure returned DVI_OK. */
#include "core/status.h"

#define dvi__fail(status, ...) ((void)(dvi__fail)(status, __VA_ARGS__), status)
#define dvi__fail_in(status, ...) ((void)(dvi__fail_in)(status, __VA_ARGS__), status)
