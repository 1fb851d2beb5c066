/** Lists of positive numbers on the command line, such as "1e-6,1e-9". */
#ifndef NUMBERS_H
#define NUMBERS_H

enum { NUMBERS_MAX = 32, NUMBER_SIZE = 32 };

/** Numbers, and their spelling by the user. */
typedef struct numbers {
  int count;
  double number[NUMBERS_MAX];
  char text[NUMBERS_MAX][NUMBER_SIZE];
} numbers;

/** Read a list, separated by commas. Returns DONE, or complains and returns USAGE. Refused are
 * empty places, words that are no numbers, numbers that are not positive or are given twice, and
 * too many numbers. Messages begin with `where`, such as "bench: --at". */
int numbers_read(const char *where, const char *text, numbers *list);
#endif
