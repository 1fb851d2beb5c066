/* What processes that divide a grid agree on, and sums over all of them. */
#include "core/status.h"
#include "field/yee/ranks.h"

/* ---- failures ---- */

int dvi__yee_rank(const dvi__yee *y)
{
  return y->planes != NULL ? y->planes->ranks.rank : 0;
}

int dvi__yee_processes(const dvi__yee *y)
{
  return y->planes != NULL ? y->planes->ranks.count : 1;
}

static dvi_status refuse_silence(const dvi_yee_ranks *r, int failed)
{
  return dvi__fail(DVI_CALLBACK_FAILED,
                   "yee: process %d of %d could not speak with the others: code %d", r->rank,
                   r->count, failed);
}

dvi_status dvi__yee_check_ranks(const dvi__yee *y)
{
  if (y->planes == NULL || y->planes->failed == 0) return DVI_OK;
  return refuse_silence(&y->planes->ranks, y->planes->failed);
}

int dvi__yee_begin_ranks(const dvi__yee *y)
{
  const int failed = y->planes != NULL ? y->planes->failed : 0;
  if (y->planes != NULL) y->planes->failed = 0;
  return failed;
}

void dvi__yee_lose_ranks(const dvi__yee *y, int failure)
{
  if (failure != 0) y->planes->failed = failure;
}

/* Agree by what a function returned, and by the largest status of all and its negative. */
static dvi_status settle(const dvi_yee_ranks *r, int failed, const double *extreme,
                         dvi_status status)
{
  const dvi_status agreed = (dvi_status)(extreme[1] > 0 ? -extreme[1] : extreme[0]);
  if (failed != 0) return status != DVI_OK ? status : refuse_silence(r, failed);
  if (status != DVI_OK || agreed == DVI_OK) return agreed;
  return dvi__fail(agreed, "yee: another one of %d processes failed, whose sentence tells why",
                   r->count);
}

dvi_status dvi__yee_agree(const dvi__yee *y, dvi_status status)
{
  double extreme[2] = {status, -(double)status}; /* failures have numbers above or below 0 */
  if (y->planes == NULL) return status;
  dvi__yee_largest_of_all(y, 2, extreme);
  return settle(&y->planes->ranks, y->planes->failed, extreme, status);
}

dvi_status dvi__yee_agree_of(const dvi_yee_terms *terms, dvi_status status)
{
  const int is_known = terms != NULL && terms->size == sizeof *terms && terms->ranks != NULL &&
                       terms->ranks->size == sizeof *terms->ranks;
  double extreme[2] = {status, -(double)status};
  if (!is_known || terms->ranks->count < 2 || terms->ranks->largest == NULL) return status;
  const int failed = terms->ranks->largest(2, extreme, terms->ranks->user);
  return settle(terms->ranks, failed, extreme, status);
}

dvi_status dvi__yee_agree_anew(const void *self, dvi_status status)
{
  const dvi__yee *y = self;
  const int lost = dvi__yee_begin_ranks(y);
  status = dvi__yee_agree(y, status);
  dvi__yee_lose_ranks(y, lost);
  return status;
}

/* ---- sums ---- */

void dvi__yee_largest_of_all(const dvi__yee *y, int count, double *number)
{
  dvi__yee_planes *p = y->planes;
  if (p != NULL && p->failed == 0) p->failed = p->ranks.largest(count, number, p->ranks.user);
}

void dvi__yee_add_all(const dvi__yee *y, int count, int64_t *number)
{
  dvi__yee_planes *p = y->planes;
  if (p != NULL && p->failed == 0) p->failed = p->ranks.sum(count, number, p->ranks.user);
}

/* Halves of numbers do not overflow. */
uint64_t dvi__yee_sum_modulo(const dvi__yee *y, uint64_t number)
{
  int64_t half[2] = {(int64_t)(number & UINT32_MAX), (int64_t)(number >> 32)};
  dvi__yee_add_all(y, 2, half);
  return (uint64_t)half[0] + ((uint64_t)half[1] << 32);
}

double dvi__yee_sum_of_all(const dvi__yee *y, dvi__accumulator *sum)
{
  if (y->planes != NULL) {
    dvi__accumulator_carry(sum);
    dvi__yee_add_all(y, DVI__SUM_NUMBERS, sum->number);
  }
  return dvi__accumulator_value(sum);
}
