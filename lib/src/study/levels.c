/* The search for levels whose errors show an order. */
#include <dvi/study.h>
#include <float.h>
#include <math.h>

#include "core/status.h"

enum { SEARCH_TRIES = 40, ROOM_LEVELS = 6 };

/* Largest number of parts of a first level that is searched, so that the search ends within
 * seconds, and of the last level after it. */
static const long search_max = 1L << 17, finest_max = 1L << 22;

/* Least ratio of the first error to the floor. It leaves five decades for the levels. */
static const double level_room = 1e5;

/* an error of 1 % of the solution's size is no longer asymptotic */
static const double ceiling_digits = 1e-2;

/* The state of a search. */
typedef struct search {
  const dvi_study_search *wanted;
  dvi_study_levels *found;
  double error; /* of the level that was tried last. NaN if it has no result */
} search;

static double clamp(double x, double low, double high)
{
  return fmin(fmax(x, low), high);
}

/* Choose a target for the first level's error. A high order shows late, when the terms beyond the
 * leading one have died out, but passes its few levels in many digits. A low order needs too many
 * parts to come near the floor. */
static double first_target(const search *s)
{
  const double size = s->wanted->size_of_result, order = s->wanted->order;
  if (s->wanted->first_error > 0.0) return s->wanted->first_error * size;
  const double digits = fmax(3.0 + 0.5 * order, fmin(1.0 + order, 15.0));
  return clamp(level_room * s->found->floor, pow(10.0, -digits) * size, 0.1 * s->found->ceiling);
}

/* Predict the number of parts from one error by the order. The number lies strictly between too_few
 * and enough, which is 0 if unknown. */
static long next_guess(const search *s, long parts, double error, double target, long too_few,
                       long enough)
{
  const double factor = isfinite(error)
                            ? clamp(pow(error / target, 1.0 / s->wanted->order), 0.25, 4.0)
                            : 2.0;
  const double high = enough > 0 ? (double)enough - 1.0 : (double)search_max;
  return lround(clamp(ceil((double)parts * factor), (double)too_few + 1.0, high));
}

static dvi_status try_level(search *s, long parts)
{
  s->error = (double)NAN;
  return s->wanted->run((double)parts, &s->error, s->wanted->user);
}

/* Search for the first level, of more parts than too_few, whose error is the nearest below three
 * times the target. A level without a result is too rough. */
static dvi_status find_first(search *s, long too_few, long *first)
{
  const double target = first_target(s);
  long fine = 0; /* last level below the target, 0 if there is none yet */
  double error_of_fine = 0.0;
  *first = lround(clamp(ceil(s->wanted->first_parts), (double)too_few + 1.0, (double)search_max));
  for (int i = 0; i < SEARCH_TRIES; i++) {
    const dvi_status status = try_level(s, *first);
    if (status < 0) return status;
    const double error = status == DVI_OK ? s->error : (double)NAN;
    if (error <= 3.0 * target && error >= 0.1 * target) return DVI_OK;
    if (error <= 3.0 * target) {
      fine = *first;
      error_of_fine = error;
    } else {
      too_few = *first;
    }
    if (too_few + 1 == fine || too_few >= search_max) break;
    *first = next_guess(s, *first, error, target, too_few, fine);
  }
  *first = fine > 0 ? fine : too_few;
  if (fine == 0) return try_level(s, too_few);
  s->error = error_of_fine;
  return DVI_OK;
}

static dvi_status find_floor(search *s, long parts)
{
  const dvi_study_search *wanted = s->wanted;
  double moved = 0.0;
  const dvi_status status = wanted->roundoff != NULL
                                ? wanted->roundoff((double)parts, &moved, wanted->user)
                                : DVI_OK;
  moved = fmax(DBL_EPSILON * wanted->size_of_result, status == DVI_OK ? moved : 0.0);
  s->found->floor = DVI_STUDY_FLOOR_MARGIN * fmax(wanted->judge_error, moved);
  return status;
}

/* Find the first level, and the floor there. A level without a result at the floor depends on
 * roundoff and is too rough, too. */
static dvi_status find_first_and_floor(search *s, long *first)
{
  long too_few = 0;
  dvi_status status = find_first(s, too_few, first);
  while (status == DVI_OK && (status = find_floor(s, *first)) > 0 && *first < search_max) {
    too_few = *first;
    status = find_first(s, too_few, first);
  }
  /* Repeat the search, now that the floor is known. */
  return status == DVI_OK ? find_first(s, too_few, first) : status;
}

/* Choose the ratio that leads from the first error to a little above the floor, if possible with at
 * most so many parts. */
static double choose_ratio(const search *s, long first, double finest)
{
  const int levels = s->wanted->levels;
  const double span = s->error / (3.0 * s->found->floor);
  const double ratio = span > 1.0 && levels > 1
                           ? pow(span, 1.0 / (s->wanted->order * (levels - 1.0)))
                           : 1.0;
  const double most = levels > 1 ? pow(finest / (double)first, 1.0 / (levels - 1.0)) : 2.0;
  return clamp(ratio, 1.05, clamp(most, 1.05, 2.0));
}

/* Return whether so many levels, each with one part more than the one before, stay above the
 * floor. */
static int levels_have_room(const search *s, long first, int levels)
{
  const double finest = (double)(first + levels - 1);
  return s->error * pow((double)first / finest, s->wanted->order) > s->found->floor;
}

/* Return whether even many parts fail, or end far from the solution. Finer levels would cost much
 * and tell nothing. */
static int is_lost(const search *s, dvi_status status)
{
  static const double far = 10.0; /* multiple of the largest error that tells an order */
  return s->wanted->may_miss &&
         (status > 0 || (status == DVI_OK && !(s->error <= far * s->found->ceiling)));
}

static void set_parts(const search *s, long first, double ratio)
{
  long *parts = s->found->parts;
  parts[0] = first;
  for (int k = 1; k < s->wanted->levels; k++) {
    parts[k] = lround((double)first * pow(ratio, k));
    if (parts[k] <= parts[k - 1]) parts[k] = parts[k - 1] + 1;
  }
}

static dvi_status search_check(const dvi_study_search *wanted, const dvi_study_levels *found)
{
  if (wanted == NULL || found == NULL || wanted->size != sizeof *wanted || wanted->run == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "search of levels: give run, room for levels, and size = "
                                       "sizeof(dvi_study_search)");
  if (wanted->levels < 1 || wanted->levels > DVI_STUDY_LEVELS_MAX || wanted->order < 1)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "search of levels: %d levels are not from 1 to %d, or the order %d is below 1",
                     wanted->levels, (int)DVI_STUDY_LEVELS_MAX, wanted->order);
  if (!isfinite(wanted->span) || wanted->span == 0.0 || !(wanted->size_of_result > 0.0) ||
      !isfinite(wanted->size_of_result) || !(wanted->judge_error >= 0.0))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "search of levels: the span, the size of the result or the judge's error is "
                     "out of range");
  if (!(wanted->length >= 0.0) || !(wanted->ratio >= 0.0) || !(wanted->first_error >= 0.0) ||
      !(wanted->first_parts >= 0.0))
    return dvi__fail(DVI_BAD_ARGUMENT, "search of levels: a wish is negative or NaN");
  return DVI_OK;
}

dvi_status dvi_study_search_levels(const dvi_study_search *wanted, dvi_study_levels *found)
{
  DVI_TRY(search_check(wanted, found));
  search s = {.wanted = wanted, .found = found};
  const int given = wanted->length > 0.0;
  long first = 0;
  dvi_status status;
  *found = (dvi_study_levels){.ceiling = ceiling_digits * wanted->size_of_result,
                              .floor = DVI_STUDY_FLOOR_MARGIN * wanted->judge_error};
  if (given) {
    first = lround(
        clamp(fabs(wanted->span) / wanted->length, 1.0, (double)DVI_STUDY_FIRST_PARTS_MAX));
    status = try_level(&s, first);
    if (status == DVI_OK) status = find_floor(&s, first);
  } else {
    status = find_first_and_floor(&s, &first);
    if (is_lost(&s, status)) return DVI_OK;
  }
  if (status != DVI_OK) return status;
  found->room = levels_have_room(&s, first,
                                 wanted->levels < ROOM_LEVELS ? wanted->levels : ROOM_LEVELS);
  const double finest = given ? HUGE_VAL : (double)finest_max;
  set_parts(&s, first, wanted->ratio > 0.0 ? wanted->ratio : choose_ratio(&s, first, finest));
  return DVI_OK;
}
