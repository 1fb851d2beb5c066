/* Read before every source of the library when clang-tidy analyses it: tells the analyzer, which sees one file at a time, that dvi__fail
 * returns the status that it was given, and dvi__complain and its like false. Without this it follows paths on which a failure returned DVI_OK or true. */
#include "core/status.h"
#include "scene/complaint.h"
#include "scene/sections.h"

#define dvi__fail(status, ...) ((void)(dvi__fail)(status, __VA_ARGS__), status)
#define dvi__fail_in(status, ...) ((void)(dvi__fail_in)(status, __VA_ARGS__), status)
#define dvi__complain(...) ((void)(dvi__complain)(__VA_ARGS__), false)
#define dvi__refuse(...) ((void)(dvi__refuse)(__VA_ARGS__), false)
#define dvi__scene_refuse(...) ((void)(dvi__scene_refuse)(__VA_ARGS__), false)
#define dvi__scene_no_memory(...) ((void)(dvi__scene_no_memory)(__VA_ARGS__), false)
#define dvi__names_unknown(...) ((void)(dvi__names_unknown)(__VA_ARGS__), false)
