/** Lists of positive numbers on the command line: "1e-6,1e-9". */
#ifndef NUMBERS_H
#define NUMBERS_H

enum { NUMBERS_MAX = 32, NUMBER_SIZE = 32 };

/** The numbers, and how the user spelled them. */
typedef struct numbers {
  int count;
  double number[NUMBERS_MAX];
  char text[NUMBERS_MAX][NUMBER_SIZE];
} numbers;

/** Read a list, separated by commas. Returns DONE; or complains, about `where` ("bench: --at"), and
 *  returns USAGE: an empty place, a word that is no number, one that is not positive, one given
 *  twice, too many. */
int numbers_read(const char *where, const char *text, numbers *list);
#endif
