/* A locale with a decimal comma. */
#ifndef SUPPORT_COMMA_H
#define SUPPORT_COMMA_H

/* Make such a locale in the folder (support/files.h), because none need be installed. Set it for
 * this process and for the processes that it starts. The test fails if that is impossible. */
void set_comma_locale(void);

/* Set the locale C, and remove the other one. */
void set_point_locale(void);

#endif
