/** The library's version. */
#ifndef DVI_VERSION_H
#define DVI_VERSION_H

#define DVI_VERSION_MAJOR 0
#define DVI_VERSION_MINOR 1
#define DVI_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/** Return the version of the linked library, "major.minor.patch". */
const char *dvi_version(void);

#ifdef __cplusplus
}
#endif
#endif
