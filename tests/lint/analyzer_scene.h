/* The same for the library of scenes: dvi__complain and its like return false. */
/* Sources ask for these before any header: syntax.c for POSIX, files.c for realpath. */
#define _XOPEN_SOURCE 700
#include "scene/terms/callbacks.h"
#include "scene/terms/fault.h"
#include "text/complaint.h"
#include "scene/sections/sections.h"

#define dvi__complain(...) ((void)(dvi__complain)(__VA_ARGS__), false)
#define dvi__refuse(...) ((void)(dvi__refuse)(__VA_ARGS__), false)
#define dvi__scene_refuse(...) ((void)(dvi__scene_refuse)(__VA_ARGS__), false)
#define dvi__scene_no_memory(...) ((void)(dvi__scene_no_memory)(__VA_ARGS__), false)
#define dvi__complain_of_memory(...) ((void)(dvi__complain_of_memory)(__VA_ARGS__), false)
#define dvi__scene_too_large(...) ((void)(dvi__scene_too_large)(__VA_ARGS__), false)
#define dvi__names_unknown(...) ((void)(dvi__names_unknown)(__VA_ARGS__), false)
