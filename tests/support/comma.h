/* A locale with a decimal comma. */
#ifndef SUPPORT_COMMA_H
#define SUPPORT_COMMA_H

/* Make one in the folder (support/files.h), for none need be installed, and set it for this process
 * and for those that it starts. The test fails where that cannot be. */
void set_comma(void);

/* Back to the locale C, without the other one. */
void set_point(void);

#endif
