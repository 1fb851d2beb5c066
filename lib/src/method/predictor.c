#include "method/predictor.h"

#include <math.h>
#include <string.h>

/* Differences that are kept. More of them would amplify roundings. */
enum { DIFFERENCES = 5 };

/* The memory holds the length of the steps, the number of known differences, that of those in use,
 * and the differences of orders 0 to 4 [unknowns] each. */
enum { LENGTH, KNOWN, USED, FIRST };

size_t dvi__predictor_memory(size_t unknowns)
{
  return FIRST + DIFFERENCES * unknowns;
}

/* Give a number of differences. That of a damaged checkpoint may be anything. */
static int count_of(const double *memory, double h, int place)
{
  const double count = memory[place];
  return memory[LENGTH] == h && count >= 0 && count <= DIFFERENCES ? (int)count : 0;
}

void dvi__predictor_correct(dvi__predictor *p, const double *memory, double h, double *x)
{
  const int used = count_of(memory, h, USED);
  memcpy(p->plain, x, p->unknowns * sizeof *x);
  p->h = h;
  for (int k = 0; k < used; k++) {
    const double *difference = memory + FIRST + (size_t)k * p->unknowns;
    for (size_t i = 0; i < p->unknowns; i++) x[i] += difference[i];
  }
}

/* Replace the differences by those of the next error. Gives what each number of differences would
 * have left of it. */
static void renew_differences(const dvi__predictor *p, const double *x, double *difference,
                              double left[DIFFERENCES + 1])
{
  double most[DIFFERENCES + 1] = {0};
  for (size_t i = 0; i < p->unknowns; i++) {
    double next = x[i] - p->plain[i];
    for (int k = 0; k < DIFFERENCES; k++) {
      double *kept = difference + (size_t)k * p->unknowns + i;
      const double change = next - *kept;
      most[k] = fabs(next) > most[k] ? fabs(next) : most[k];
      *kept = next;
      next = change;
    }
    most[DIFFERENCES] = fabs(next) > most[DIFFERENCES] ? fabs(next) : most[DIFFERENCES];
  }
  memcpy(left, most, sizeof most);
}

void dvi__predictor_learn(dvi__predictor *p, double *memory, double h, const double *x)
{
  double left[DIFFERENCES + 1];
  const int known = count_of(memory, h, KNOWN);
  int used = 0;
  memory[LENGTH] = memory[KNOWN] = memory[USED] = 0;
  if (p->h != h) return;
  renew_differences(p, x, memory + FIRST, left);
  for (int k = 1; k <= known; k++)
    if (left[k] < left[used]) used = k;
  memory[LENGTH] = h;
  memory[KNOWN] = known < DIFFERENCES ? known + 1 : DIFFERENCES;
  memory[USED] = used;
}

void dvi__predictor_leave(dvi__predictor *p)
{
  p->h = 0;
}

/* ---- members abreast ---- */

static int count_of_lane(const dvi__abreast *memory, double h, int place, int lane)
{
  const double numbers[] = {
      [LENGTH] = memory[LENGTH][lane], [KNOWN] = memory[KNOWN][lane], [USED] = memory[USED][lane]};
  return count_of(numbers, h, place);
}

WIDE static void correct_guesses(size_t unknowns, const dvi__abreast *difference,
                                 const dvi__abreast_mask is_used[DIFFERENCES], dvi__abreast *x)
{
  for (size_t k = 0; k < DIFFERENCES; k++)
    for (size_t i = 0; i < unknowns; i++) {
      const dvi__abreast sum = x[i] + difference[k * unknowns + i];
      abreast_replace(&is_used[k], &sum, &x[i]);
    }
}

void dvi__predictor_correct_abreast(size_t unknowns, const dvi__abreast *memory, double h,
                                    dvi__abreast *plain, dvi__abreast *x)
{
  dvi__abreast_mask is_used[DIFFERENCES];
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    const int used = count_of_lane(memory, h, USED, lane);
    for (int k = 0; k < DIFFERENCES; k++) is_used[k][lane] = -(int64_t)(k < used);
  }
  memcpy(plain, x, unknowns * sizeof *x);
  correct_guesses(unknowns, memory + FIRST, is_used, x);
}

/* Choose the number of differences of a lane. */
static void use_differences(dvi__abreast *memory, double h, int lane,
                            const dvi__abreast left[DIFFERENCES + 1])
{
  const int known = count_of_lane(memory, h, KNOWN, lane);
  int used = 0;
  for (int k = 1; k <= known; k++)
    if (left[k][lane] < left[used][lane]) used = k;
  memory[LENGTH][lane] = h;
  memory[KNOWN][lane] = known < DIFFERENCES ? known + 1 : DIFFERENCES;
  memory[USED][lane] = used;
}

WIDE static void renew_abreast(size_t unknowns, const dvi__abreast *plain, const dvi__abreast *x,
                               dvi__abreast *difference, dvi__abreast left[DIFFERENCES + 1])
{
  dvi__abreast most[DIFFERENCES + 1] = {{0}};
  for (size_t i = 0; i < unknowns; i++) {
    dvi__abreast next = x[i] - plain[i];
    for (size_t k = 0; k < DIFFERENCES; k++) {
      dvi__abreast *kept = difference + k * unknowns + i;
      const dvi__abreast change = next - *kept;
      abreast_larger(&most[k], &next);
      *kept = next;
      next = change;
    }
    abreast_larger(&most[DIFFERENCES], &next);
  }
  memcpy(left, most, sizeof most);
}

void dvi__predictor_learn_abreast(size_t unknowns, dvi__abreast *memory, double h,
                                  const dvi__abreast *plain, const dvi__abreast *x)
{
  dvi__abreast left[DIFFERENCES + 1];
  renew_abreast(unknowns, plain, x, memory + FIRST, left);
  for (int lane = 0; lane < DVI__ABREAST; lane++) use_differences(memory, h, lane, left);
}
