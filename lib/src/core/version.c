#include <dvi/version.h>

#define TEXT(x) #x
#define DOTTED(major, minor, patch) TEXT(major) "." TEXT(minor) "." TEXT(patch)

const char *dvi_version(void)
{
  return DOTTED(DVI_VERSION_MAJOR, DVI_VERSION_MINOR, DVI_VERSION_PATCH);
}
